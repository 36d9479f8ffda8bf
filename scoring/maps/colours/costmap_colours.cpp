#include "scoring/maps/colours/costmap_colours.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {
namespace {

using CostColour = cv::Vec3i;  // red, green, blue

constexpr int kOff = 24;  // of a channel: rounding, and what JPEG adds
const CostColour kUnknownOfCosts{112, 137, 134};

/// Share of RViz's magenta in the obstacles' colour, over the black walls of a map; 0: too few pixels have such a one.
double opacity_of_obstacles(const RgbImage& image) {
  constexpr std::size_t kOneIn = 500;  // pixels
  constexpr int kLeast = 60;           // paler ones are no colours that anybody sees
  std::array<std::size_t, 256> count{};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const int r = image.rgb[i], g = image.rgb[i + 1], b = image.rgb[i + 2];
    if (r >= kLeast && std::abs(r - b) <= kOff && 4 * g <= r) ++count[static_cast<std::size_t>((r + b) / 2)];
  }
  // The brightest that many have: costs in the middle of their scale are as red as blue, too, but darker.
  for (int at = 255; at > kLeast; --at) {
    const auto first = count.begin() + (at - kOff), last = count.begin() + at + 1;
    if (kOneIn * std::accumulate(first, last, std::size_t{0}) >= image.rgb.size() / 3)
      return static_cast<double>(std::max_element(first, last) - count.begin()) / 255.0;
  }
  return 0.0;
}

/// 255 where the robot's middle would hit: cyan of that opacity over any grey.
cv::Mat inscribed(const RgbImage& image, double opacity) {
  cv::Mat out = cv::Mat::zeros(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const p = image.pixel(x, y);
      const double off = p[1] - p[0] - 255.0 * opacity;
      if (std::abs(p[1] - p[2]) <= kOff && std::abs(off) <= 2 * kOff) out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// The floor under it: red of cyan comes from there. 0: nothing shows through.
int floor_under(const RgbImage& image, const cv::Mat& cyan, double opacity) {
  constexpr double kOpaque = 0.95;
  double red = 0.0, pixels = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (cyan.at<unsigned char>(y, x) == 0) continue;
      red += image.pixel(x, y)[0];
      pixels += 1.0;
    }
  if (opacity >= kOpaque || pixels == 0.0) return 0;
  return std::clamp(static_cast<int>(red / pixels / (1.0 - opacity) + 0.5), 0, 255);
}

struct Shade {
  CostColour colour;
  Occupancy means = Occupancy::Free;
};

/// What RViz draws, of that opacity over a map with that floor.
std::vector<Shade> shades_of(double opacity, int floor) {
  constexpr int kSteps = 12;  // of the costs
  const auto over = [opacity](const CostColour& own, int ground) {
    CostColour out;
    for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<unsigned char>(opacity * own[i] + (1.0 - opacity) * ground);
    return out;
  };
  std::vector<Shade> out{{over({255, 0, 255}, 0), Occupancy::Occupied},
                         {kUnknownOfCosts, Occupancy::Unknown},
                         {over({0, 255, 255}, floor)},
                         {{0, 0, 0}},
                         {{floor, floor, floor}},
                         {{230, 230, 230}},  // of a map that shows where costs are 0
                         {{255, 255, 255}}};
  for (int i = 0; i <= kSteps; ++i) out.push_back({over({255 * i / kSteps, 0, 255 - 255 * i / kSteps}, floor)});
  return out;
}

struct Nearest {
  Occupancy means = Occupancy::Unknown;
  bool is_near = false;
};

Nearest nearest_of(const std::vector<Shade>& shades, const std::uint8_t* pixel) {
  constexpr int kNear = 3 * kOff * kOff;
  int least = std::numeric_limits<int>::max();
  Nearest out;
  for (const Shade& shade : shades) {
    int off = 0;
    for (int i = 0; i < 3; ++i) off += (pixel[i] - shade.colour[i]) * (pixel[i] - shade.colour[i]);
    if (off >= least) continue;
    least = off;
    out = {shade.means, off <= kNear};
  }
  return out;
}

}  // namespace

std::optional<LabelImage> classify_costmap(const RgbImage& image) {
  constexpr double kBeside = 0.3;        // of what is next to obstacles; unknown ground has no costs
  constexpr double kMostStrange = 0.05;  // of the pixels: their colours are none of RViz's; blending leaves some
  const double opacity = opacity_of_obstacles(image);
  if (opacity == 0.0) return std::nullopt;
  const cv::Mat around = inscribed(image, opacity);
  const std::vector<Shade> shades = shades_of(opacity, floor_under(image, around, opacity));
  LabelImage out{cv::Mat(image.height, image.width, CV_8U), "a costmap's colours, costs around walls are free"};
  out.by_level = true;
  std::size_t strange = 0;
  for (int y = 0; y < image.height; ++y) {
    unsigned char* const to = out.classes.ptr<unsigned char>(y);
    const std::uint8_t* last = nullptr;
    Nearest nearest;
    for (int x = 0; x < image.width; ++x) {  // runs of one colour are asked once
      const std::uint8_t* const p = image.pixel(x, y);
      if (last == nullptr || !std::equal(p, p + 3, last)) nearest = nearest_of(shades, p);
      to[x] = static_cast<unsigned char>(nearest.means);
      strange += nearest.is_near ? 0 : 1;
      last = p;
    }
  }
  if (static_cast<double>(strange) > kMostStrange * static_cast<double>(out.classes.total())) return std::nullopt;
  const cv::Mat walls = out.classes == static_cast<int>(Occupancy::Occupied);
  cv::Mat beside;
  cv::dilate(walls, beside, cv::Mat::ones(3, 3, CV_8U));
  beside &= ~walls;
  if (cv::countNonZero(beside & around) < kBeside * std::max(1, cv::countNonZero(beside))) return std::nullopt;
  return out;
}

}  // namespace rubble::scoring
