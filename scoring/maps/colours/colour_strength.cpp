#include "scoring/maps/colours/colour_strength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "scoring/maps/colours/league_palette.h"

namespace rubble::scoring {
namespace {

double light_of(const Rgb& c) { return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2]; }

Rgb strengthened(const Rgb& c, double by) {
  const double light = light_of(c);
  const auto of = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(light + by * (value - light), 0.0, 255.0)));
  };
  return {of(c[0]), of(c[1]), of(c[2])};
}

/// How often values occur, and which is in the middle.
struct Values {
  std::array<std::size_t, 256> count{};
  std::size_t all = 0;
  void add(int value) {
    ++count[static_cast<std::size_t>(value)];
    ++all;
  }
  int middle() const {
    std::size_t at = 0;
    for (std::size_t below = count[0]; 2 * below < all;) below += count[++at];
    return static_cast<int>(at);
  }
  /// Most are within a few of it: not smeared.
  bool agree() const {
    constexpr int kNear = 3;
    std::size_t near = 0;
    for (int i = std::max(0, middle() - kNear); i <= std::min(255, middle() + kNear); ++i)
      near += count[static_cast<std::size_t>(i)];
    return 2 * near >= all;
  }
};

/// Of walls, also where red ended at 0.
bool is_dark_blue(int r, int g, int b) { return r <= 60 && g <= 80 && b >= 90 && g >= r && 4 * (g - r) >= b - r - 60; }

}  // namespace

double colour_strength(const RgbImage& image) {
  constexpr std::size_t kOneInWalls = 500, kOneInFloor = 20;  // pixels
  constexpr double kLeast = 1.06, kMost = 3.0;
  constexpr int kSlack = 8;
  Values wall_blue, floor_red, floor_green;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const int r = image.rgb[i], g = image.rgb[i + 1], b = image.rgb[i + 2];
    if (is_dark_blue(r, g, b)) wall_blue.add(b);
    if (g < 190 || g < std::max(r, b) + 40 || std::abs(r - b) > kSlack) continue;
    floor_red.add(r);
    floor_green.add(g);
  }
  const std::size_t pixels = image.rgb.size() / 3;
  const auto within = [](double by) { return by >= kLeast && by <= kMost ? by : 1.0; };
  if (kOneInWalls * wall_blue.all >= pixels && wall_blue.agree()) {
    const double light = light_of(league::kWall);
    return within((wall_blue.middle() - light) / (league::kWall[2] - light));
  }
  if (kOneInFloor * floor_red.all < pixels) return 1.0;
  const double light = light_of(league::kSearched);
  const double by = (light - floor_red.middle()) / (light - league::kSearched[0]);
  const double green = std::min(255.0, light + by * (league::kSearched[1] - light));
  return std::abs(green - floor_green.middle()) <= kSlack ? within(by) : 1.0;
}

Rgb before_strengthening(const Rgb& colour, double by) {
  constexpr int kRounding = 8;
  for (const Rgb& own : league::kAll) {
    const Rgb now = strengthened(own, by);
    const auto is_near = [&](std::size_t i) { return std::abs(now[i] - colour[i]) <= kRounding; };
    if (is_near(0) && is_near(1) && is_near(2)) return own;
  }
  return strengthened(colour, 1.0 / by);
}

}  // namespace rubble::scoring
