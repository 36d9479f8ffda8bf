#include "scoring/maps/colours/grey_levels.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/grey_roles.h"
#include "scoring/maps/colours/nearest_ground.h"
#include "scoring/maps/colours/reading_doubts.h"

namespace rubble::scoring {
namespace {

constexpr int kUnknownTolerance = 12;  // around the unknown grey, where the picture is not pure
constexpr int kWallBelow = 140;        // of 0 (wall) to 255 (free): at least 45 % wall
constexpr int kArea = 9;               // wider than walls [pixels]
constexpr int kMostAreas = 4;          // that one map has
constexpr int kLeastStep = 28;         // of 255, between two classes: levels scatter by 12, and fringes lie between
constexpr int kLeastPureStep = 4;      // the same where every pixel is of a level: colours may have come as near
constexpr double kSure = 0.75;         // share of what walls or rim say, for free and unknown ground to be told
constexpr double kPale = 0.85;         // lines that reach less of the walls' grey in their middle are blurred
constexpr double kMostPale = 0.25;     // share of them that sharp pictures have (where a wall ends)

/// Greys as if walls were 0 and free ground 255.
cv::Mat in_order(const cv::Mat& grey, const GreyRoles& roles) {
  cv::Mat table(1, 256, CV_8U);
  for (int g = 0; g < 256; ++g)
    table.at<unsigned char>(g) =
        cv::saturate_cast<unsigned char>(255.0 * (g - roles.wall) / static_cast<double>(roles.free - roles.wall));
  cv::Mat out;
  cv::LUT(grey, table, out);
  return out;
}

/// Between two of the greys that were told apart.
int least_step(const GreyRoles& roles) {
  int out = std::abs(roles.free - roles.wall);
  if (roles.unknown >= 0)
    out = std::min({out, std::abs(roles.unknown - roles.wall), std::abs(roles.unknown - roles.free)});
  return out;
}

/// Lines drawn over the ground, such as a grid: the class of the nearest pixel of ground.
void fill_drawn(const cv::Mat& grey, const std::vector<int>& drawn, cv::Mat& classes) {
  cv::Mat lines = cv::Mat::zeros(grey.size(), CV_8U);
  for (const int level : drawn) lines |= grey == level;
  const cv::Mat no_ground = lines | (classes == static_cast<int>(Occupancy::Occupied));
  cv::Mat ground = classes.clone();
  ground.setTo(static_cast<int>(Occupancy::Unknown), no_ground);  // where there is no ground at all
  carry_ground(no_ground, ground);
  ground.copyTo(classes, lines);
}

/// Each pixel is of the level that it has.
cv::Mat by_level(const cv::Mat& grey, const GreyRoles& roles) {
  cv::Mat table(1, 256, CV_8U);
  for (int g = 0; g < 256; ++g) {
    const int to_wall = std::abs(g - roles.wall), to_free = std::abs(g - roles.free);
    const int to_unknown = roles.unknown < 0 ? 256 : std::abs(g - roles.unknown);
    const Occupancy o = to_wall <= std::min(to_free, to_unknown) ? Occupancy::Occupied
                        : to_free < to_unknown                   ? Occupancy::Free
                                                                 : Occupancy::Unknown;
    table.at<unsigned char>(g) = static_cast<unsigned char>(o);
  }
  cv::Mat out;
  cv::LUT(grey, table, out);
  return out;
}

/// Share of the walls' darkest pixels, each among its eight neighbours, that do not reach the walls' grey: pictures
/// that were blurred or made smaller leave walls pale in their middle, too.
double pale_share(const cv::Mat& even, const cv::Mat& unknown) {
  cv::Mat least;
  cv::erode(even, least, cv::Mat::ones(3, 3, CV_8U));
  const cv::Mat middles = (even == least) & (even < kWallBelow) & ~unknown;
  const int all = cv::countNonZero(middles);
  const int pale = cv::countNonZero(middles & (even > (1.0 - kPale) * 255.0));
  return all > 0 ? static_cast<double>(pale) / all : 0.0;
}

/// What was taken for canvas may be ground: a wall between it and free ground looks like their blended border.
bool are_walls_like_the_rim_of(const cv::Mat& canvas, const cv::Mat& grey, const GreyRoles& roles) {
  if (roles.unknown >= 0 || cv::countNonZero(canvas) == 0) return false;
  const double beyond = cv::mean(grey, canvas)[0];
  const double least = std::min<double>(beyond, roles.free), most = std::max<double>(beyond, roles.free);
  const double apart = std::max<double>(kUnknownTolerance, 0.2 * (most - least));  // thin walls are pale when blended
  return roles.wall > least + apart && roles.wall < most - apart;
}

}  // namespace

std::vector<int> greys_there(const cv::Mat& grey) {
  std::array<bool, 256> there{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) there[grey.at<unsigned char>(y, x)] = true;
  std::vector<int> out;
  for (int g = 0; g < 256; ++g)
    if (there[static_cast<std::size_t>(g)]) out.push_back(g);
  return out;
}

cv::Mat grey_of(const RgbImage& image) {
  cv::Mat grey(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    unsigned char* row = grey.ptr<unsigned char>(y);
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      row[x] = static_cast<unsigned char>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  }
  return grey;
}

cv::Mat transparent_pixels(const RgbImage& image) {
  cv::Mat out = cv::Mat::zeros(image.height, image.width, CV_8U);
  if (image.alpha.empty()) return out;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.alpha[image.index(x, y)] < 128) out.at<unsigned char>(y, x) = 255;
  return out;
}

namespace {

/// Without the noise of a camera, where there is some: lines stay (bilateral filter: Tomasi & Manduchi 1998).
cv::Mat without_noise(const cv::Mat& grey, bool& noisy) {
  constexpr double kMostEven = 0.7;  // of the pixels of drawn, blurred and compressed maps are as those around
  constexpr int kNoise = 2;          // off them
  cv::Mat middle, off;
  cv::medianBlur(grey, middle, 3);
  cv::absdiff(grey, middle, off);
  noisy = cv::countNonZero(off >= kNoise) > (1.0 - kMostEven) * static_cast<double>(grey.total());
  if (!noisy) return grey;
  std::vector<int> count(256, 0);
  for (int y = 0; y < off.rows; ++y)
    for (int x = 0; x < off.cols; ++x) ++count[off.at<unsigned char>(y, x)];
  int level = 0;
  for (int below = count[0]; level < 255 && below < 0.68 * static_cast<double>(off.total());)
    below += count[static_cast<std::size_t>(++level)];
  cv::Mat out;
  cv::bilateralFilter(grey, out, 9, 5.0 * level, 3.0, cv::BORDER_REPLICATE);
  return out;
}

}  // namespace

LabelImage classify_grey(const cv::Mat& picture, const cv::Mat& apart, const cv::Mat& canvas) {
  bool noisy = false;
  const cv::Mat grey = without_noise(picture, noisy);
  const GreyRoles roles = grey_roles(grey, apart);
  LabelImage out;
  out.recognised = "grey levels" + std::string(noisy ? " with noise" : "") + ", " + roles.text();
  if (roles.areas > kMostAreas)
    out.refusal = "covers areas with " + std::to_string(roles.areas) +
                  " different greys or colours, as an image of room labels does; give the map that it was made from";
  if (!roles.pure && (roles.between || are_walls_like_the_rim_of(canvas, grey, roles)))
    out.refusal =
        "has thin lines of grey " + std::to_string(roles.wall) +
        " between darker and lighter areas, and was blended: walls and borders look the same; save it without "
        "interpolation, smoothing or loss (and of a costmap the map that it was made of)";
  if (roles.unknown >= 0) out.recognised += cv::format(" (%.0f %% sure)", 100.0 * roles.sure);
  if (roles.unknown >= 0 && roles.sure < kSure)
    out.doubt += kDoubt + std::string("free and unknown ground may be the other way round");
  if (const int step = least_step(roles); step <= (roles.pure ? kLeastPureStep : kLeastStep))
    out.doubt += kDoubt + cv::format("two of these greys differ by %d of 255 only", step);
  if (roles.pure) {
    out.by_level = true;
    out.classes = by_level(grey, roles);
    if (!roles.drawn.empty()) {
      fill_drawn(grey, roles.drawn, out.classes);
      out.recognised += ", lines drawn over the ground removed";
    }
    return out;
  }
  const cv::Mat even = in_order(grey, roles);
  out.classes = cv::Mat(grey.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Free)));
  out.classes.setTo(static_cast<int>(Occupancy::Occupied), even < kWallBelow);
  const auto tell_pale = [&](const cv::Mat& not_asked) {
    if (pale_share(even, not_asked) > kMostPale) out.recognised += kWallsPale;
  };
  if (roles.unknown < 0) {
    tell_pale(cv::Mat::zeros(grey.size(), CV_8U));
    return out;
  }
  // The fringe between a wall and free space passes through the same grey: only an area of it is unknown, and its
  // rim is a mixture with wall or free.
  cv::Mat unknown = (grey >= roles.unknown - kUnknownTolerance) & (grey <= roles.unknown + kUnknownTolerance);
  cv::morphologyEx(unknown, unknown, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat rim;
  cv::dilate(unknown, rim, cv::Mat::ones(3, 3, CV_8U));
  tell_pale(rim);
  const double level = 255.0 * (roles.unknown - roles.wall) / (roles.free - roles.wall);
  unknown |= roles.in_order() ? rim & (even >= 0.55 * level) & (even <= level + kUnknownTolerance)
                              : rim & (even >= kWallBelow);
  // An area as dark as walls, such as what a viewer shows around the map, is none.
  for (const int other : roles.others) {
    cv::Mat area = (grey >= other - kUnknownTolerance) & (grey <= other + kUnknownTolerance) & (even < kWallBelow);
    cv::morphologyEx(area, area, cv::MORPH_OPEN, cv::Mat::ones(kArea, kArea, CV_8U));
    unknown |= area;
  }
  out.classes.setTo(static_cast<int>(Occupancy::Unknown), unknown);
  return out;
}

}  // namespace rubble::scoring
