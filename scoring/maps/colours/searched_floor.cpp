#include "scoring/maps/colours/searched_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/tint.h"

namespace rubble::scoring {
namespace {

const Tint kWallTint = tint_of(league::kWall);
const Tint kSearchedTint = tint_of(league::kSearched);
const Tint kUnsureTint = tint_of(league::kSearchedUnsure);
const double kUnsureShare = kUnsureTint.red / kSearchedTint.red;

/// What a tint is a mixture of, beside greys.
struct Shares {
  double green;  ///< of the surest
  double wall;
};

Shares shares_of(const Tint& t) {
  const double both = kWallTint.blue * kSearchedTint.red - kSearchedTint.blue * kWallTint.red;
  return {std::clamp((kWallTint.blue * t.red - kWallTint.red * t.blue) / both, 0.0, 1.0),
          std::clamp((t.blue * kSearchedTint.red - t.red * kSearchedTint.blue) / both, 0.0, 1.0)};
}

/// By how much such a share made white floor darker. Between the two greens of the league as between white and the less
/// sure one; a mixture of white and the surest becomes a little lighter than white.
double darker_by(double share) {
  const double unsure = 255.0 - kUnsureTint.light, sure = 255.0 - kSearchedTint.light;
  return share < kUnsureShare ? unsure * share / kUnsureShare
                              : unsure + (sure - unsure) * (share - kUnsureShare) / (1.0 - kUnsureShare);
}

/// Brightness of the floor in a mixture.
double floor_light(const Shares& shares) {
  return 255.0 - darker_by(std::min(1.0, shares.green / std::max(1e-9, 1.0 - shares.wall)));
}

/// Whether a tint is too light for what it is a mixture of. So is floor beside walls, out of which JPEG takes the
/// green: it would be as light as unexplored ground; and floor that symbols gave their blue to.
bool is_floor(const Tint& t, const Shares& shares) {
  constexpr double kAsLightAsFloor = 170.0;  // whose own is 189 to 210; unexplored ground has more than both
  constexpr double kSurelyGreen = 0.25, kSomeGreen = 0.05, kSlack = 20.0;
  if (t.light > kAsLightAsFloor) return shares.green >= kSurelyGreen;
  const double mixed = shares.wall * kWallTint.light + (1.0 - shares.wall) * floor_light(shares);
  return shares.green >= kSomeGreen && t.light > mixed + kSlack;
}

/// What floor gets: lighter than unexplored ground (246 at most), and with room for the faint blue that JPEG moves from
/// thin walls into it, by which these are known.
constexpr double kFloorLight = 251.0;

/// As light as it were on white floor: from wall to floor brightness is stretched. JPEG's green runs into sharp walls,
/// so what is as dark as wall stays so whatever green it has.
double light_on_white(const Tint& t, const Shares& shares) {
  if (is_floor(t, shares)) return kFloorLight;
  return kWallTint.light +
         (t.light - kWallTint.light) * (255.0 - kWallTint.light) / (floor_light(shares) - kWallTint.light);
}

bool is_searched(const std::uint8_t* p) {
  constexpr int kSlack = 16;
  return std::abs(p[1] - league::kSearched[1]) <= kSlack && std::abs(p[0] - p[2]) <= kSlack &&
         p[0] >= league::kSearched[0] - kSlack && p[0] <= league::kSearchedUnsure[0] + kSlack;
}

}  // namespace

RgbImage without_searched_floor(const RgbImage& image) {
  constexpr int kSmear = 17;           // [pixels]
  constexpr std::size_t kOneIn = 200;  // pixels; fewer are no floor
  cv::Mat searched(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) searched.at<unsigned char>(y, x) = is_searched(image.pixel(x, y)) ? 255 : 0;
  if (kOneIn * static_cast<std::size_t>(cv::countNonZero(searched)) < image.rgb.size() / 3) return image;
  cv::dilate(searched, searched, cv::Mat::ones(kSmear, kSmear, CV_8U));
  RgbImage out = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (searched.at<unsigned char>(y, x) == 0) continue;
      std::uint8_t* const p = out.pixel(x, y);
      const Tint was = tint_of(p);
      const Shares shares = shares_of(was);
      const double share = shares.green;
      const double light = light_on_white(was, shares);
      const Rgb now = rgb_of(Tint{light, was.blue - share * kSearchedTint.blue, was.red - share * kSearchedTint.red});
      std::copy(now.begin(), now.end(), p);
    }
  return out;
}

}  // namespace rubble::scoring
