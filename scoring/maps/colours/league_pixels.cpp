#include "scoring/maps/colours/league_pixels.h"

#include <algorithm>
#include <cstdlib>

namespace rubble::scoring::league {
namespace {

/// Walls as a sharp filter leaves them (bicubic, Lanczos): it exaggerates their contrast with what is beside them,
/// white or searched floor, and the darkest colours end at 0.
bool is_exaggerated_wall(const Colour& c) { return c.r <= 10 && c.g <= 52 && c.b >= 85 && c.b <= 122; }

constexpr int kBlueOfWall = league::kWall[2] - league::kWall[0];           // blue over red
constexpr int kWallDarker = league::kFree[0] - brightness(league::kWall);  // than white

bool is_checkerboard(const Colour& c) {
  return near_colour(c, league::kUnexplored, 0) || near_colour(c, league::kUnexploredLight, 0);
}

}  // namespace

int spread(const Colour& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); }

bool near_colour(const Colour& a, const Colour& b, int tolerance) {
  return std::abs(a.r - b.r) <= tolerance && std::abs(a.g - b.g) <= tolerance && std::abs(a.b - b.b) <= tolerance;
}

bool looks_unexplored(const Colour& c) { return spread(c) <= 6 && c.g >= 216 && c.g <= 245; }

double wall_share(const Colour& c) {
  constexpr int kSlack = 35;  // of brightness
  if (is_exaggerated_wall(c)) return 1.0;
  const int blue = c.b - c.r;
  const int green = c.g - c.r;
  if (blue < 24 || 100 * green < 25 * blue || 100 * green > 55 * blue) return 0.0;
  if (kBlueOfWall * (brightness(c) - 255 - kSlack) > -kWallDarker * std::min(blue, kBlueOfWall)) return 0.0;
  return blue / static_cast<double>(kBlueOfWall);
}

void Census::count(const Colour& c, std::size_t count) {
  pixels += count;
  if (is_checkerboard(c)) checkerboard += count;
  if (near_colour(c, league::kUnexplored, 0)) darker += count;
  if (looks_unexplored(c) && c.b > c.r) unexplored += count;
  const double share = wall_share(c);
  if (share > 0.2 && share < 0.9) blended_walls += count;
  if (share <= 0.5 || !near_colour(c, league::kWall, 45)) return;
  walls += count;
  if (near_colour(c, league::kWall, 0)) pure_walls += count;
}

Census census(const RgbImage& image) {
  return census_of(image, [](const Rgb& colour) { return colour; });
}

}  // namespace rubble::scoring::league
