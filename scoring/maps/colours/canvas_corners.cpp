#include "scoring/maps/colours/canvas_corners.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/grey_levels.h"

namespace rubble::scoring {
namespace {

constexpr double kBorderUnknown = 0.95;  // share of the region's rim that must be unknown
constexpr double kBroadRegion = 4.0;     // half width of the region [pixels]: thinner ones are walls at the border

constexpr int kOneGrey = 12;           // of one grey
constexpr int kRipples = 24;           // of one grey beside an edge in a JPEG
constexpr double kMostOfBorder = 0.6;  // share of the region's rim that has one grey but for ripples
constexpr int kBlend = 3;              // pixels that smooth interpolation blends at an edge

/// The ring around a region, `off` pixels off it: the next ones hold an interpolated edge. Empty for regions that are
/// not broad.
cv::Mat ring_around(const cv::Mat& region, int off) {
  if (static_cast<std::size_t>(cv::countNonZero(region)) == region.total()) return {};  // nothing is around it
  cv::Mat padded;
  cv::copyMakeBorder(region, padded, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  cv::Mat inner;
  cv::distanceTransform(padded, inner, cv::DIST_L2, 3);
  double broadest = 0.0;
  cv::minMaxLoc(inner, nullptr, &broadest);
  if (broadest < kBroadRegion) return {};
  cv::Mat ring;
  cv::dilate(region, ring, cv::Mat::ones(2 * off + 3, 2 * off + 3, CV_8U));
  cv::Mat first;
  cv::dilate(region, first, cv::Mat::ones(2 * off + 1, 2 * off + 1, CV_8U));
  ring &= ~first;
  return ring;
}

/// Share of the ring that lies in `ground`; 0 without a ring.
double share_in(const cv::Mat& ring, const cv::Mat& ground) {
  const int total = ring.empty() ? 0 : cv::countNonZero(ring);
  return total == 0 ? 0.0 : cv::countNonZero(ring & ground) / static_cast<double>(total);
}

std::array<cv::Point, 4> corners_of(const cv::Mat& image) {
  return {{{0, 0}, {image.cols - 1, 0}, {0, image.rows - 1}, {image.cols - 1, image.rows - 1}}};
}

/// The connected region of the pixel's value, give or take. A copy: filters look beyond a part of an image, and flood
/// fill writes a border into its mask.
cv::Mat region_at(cv::Mat& image, const cv::Point& seed, int tolerance) {
  cv::Mat mask = cv::Mat::zeros(image.rows + 2, image.cols + 2, CV_8U);
  cv::floodFill(image, mask, seed, cv::Scalar(), nullptr, cv::Scalar(tolerance), cv::Scalar(tolerance),
                4 | cv::FLOODFILL_MASK_ONLY | cv::FLOODFILL_FIXED_RANGE | (255 << 8));
  return mask(cv::Rect(1, 1, image.cols, image.rows)).clone();
}

/// Corners of one value in one region have it in common, and what was found of it: of pictures of 10^8 pixels it takes
/// seconds to look at one.
void pass_over(const cv::Mat& image, const cv::Mat& region, const cv::Point& corner, cv::Mat& seen) {
  for (const cv::Point& other : corners_of(image))
    if (region.at<unsigned char>(other) != 0 && image.at<unsigned char>(other) == image.at<unsigned char>(corner))
      seen.at<unsigned char>(other.y > 0 ? 1 : 0, other.x > 0 ? 1 : 0) = 1;
}

bool is_passed_over(const cv::Mat& seen, const cv::Point& corner) {
  return seen.at<unsigned char>(corner.y > 0 ? 1 : 0, corner.x > 0 ? 1 : 0) != 0;
}

/// Never blended: four greys, as a map and its canvas have, are all.
bool is_of_few_levels(const std::vector<int>& greys) { return greys.size() <= 4; }

/// Greys that count as one: of a picture of few levels only those nearer than any two that it has.
int alike_of(const std::vector<int>& greys) {
  int out = kOneGrey;
  for (std::size_t i = 1; i < greys.size() && is_of_few_levels(greys); ++i)
    out = std::min(out, (greys[i] - greys[i - 1]) / 2);
  return out;
}

/// A blended edge passes through all greys between two; a wall whose grey lies between them has one.
bool has_a_line_between(const cv::Mat& grey, const cv::Mat& way, int inside, int beside, int alike) {
  constexpr double kThere = 0.25;  // of the way
  constexpr double kOneLine = 0.6;
  const cv::Mat between = way & (grey > std::min(inside, beside) + alike) & (grey < std::max(inside, beside) - alike);
  if (share_in(way, between) < kThere) return false;
  const int level = main_grey(grey, between);
  return share_in(between, (grey >= level - alike) & (grey <= level + alike)) >= kOneLine;
}

/// Nothing but blends of two greys lies on the way out of the region: no wall stands between it and what is beside.
bool is_open(const cv::Mat& grey, const cv::Mat& region, int inside, int beside, bool few, int alike) {
  const int overshoot = few ? 0 : 30;  // of smooth interpolation
  cv::Mat way;
  cv::dilate(region, way, cv::Mat::ones(2 * kBlend + 1, 2 * kBlend + 1, CV_8U));
  way &= ~region;
  if (has_a_line_between(grey, way, inside, beside, alike)) return false;
  return share_in(way, (grey >= std::min(inside, beside) - overshoot) &
                           (grey <= std::max(inside, beside) + overshoot)) >= kBorderUnknown;
}

/// Filled-in corners have no thin parts: one that has is ground of the walls' own grey, and those hang on to it.
bool has_thin_parts(const cv::Mat& region) {
  constexpr double kTips = 0.02;
  cv::Mat padded, areas, near;
  cv::copyMakeBorder(region, padded, 8, 8, 8, 8, cv::BORDER_REPLICATE);
  cv::morphologyEx(padded, areas, cv::MORPH_OPEN, cv::Mat::ones(9, 9, CV_8U));
  cv::dilate(areas, near, cv::Mat::ones(15, 15, CV_8U));
  const cv::Mat rest = padded & ~near;
  return cv::countNonZero(rest) > kTips * cv::countNonZero(region);
}

/// What a turned picture leaves of its canvas is a rectangle with more than one grey in it.
bool leaves_a_picture(const cv::Mat& grey, const cv::Mat& canvas) {
  constexpr double kConvex = 0.96;
  constexpr double kLevel = 0.005;
  const cv::Mat picture = ~canvas;
  // The hull of the first and the last pixel of each row is that of all.
  std::vector<cv::Point> ends, hull;
  std::array<int, 256> count{};
  for (int y = 0; y < picture.rows; ++y) {
    int first = -1, last = -1;
    for (int x = 0; x < picture.cols; ++x) {
      if (picture.at<unsigned char>(y, x) == 0) continue;
      if (first < 0) first = x;
      last = x;
      ++count[grey.at<unsigned char>(y, x)];
    }
    if (first >= 0) ends.insert(ends.end(), {{first, y}, {last, y}});
  }
  if (ends.empty()) return false;
  const double pixels = cv::countNonZero(picture);
  cv::convexHull(ends, hull);
  if (pixels < kConvex * cv::contourArea(hull)) return false;
  return std::count_if(count.begin(), count.end(), [&](int n) { return n >= kLevel * pixels; }) >= 2;
}

bool covers_areas(const cv::Mat& mask) {
  cv::Mat areas;
  cv::morphologyEx(mask, areas, cv::MORPH_OPEN, cv::Mat::ones(5, 5, CV_8U));
  return 2 * cv::countNonZero(areas) >= cv::countNonZero(mask);
}

/// The ring around the region is of one grey, which covers areas. JPEG leaves ripples along the region's rim: most of
/// the ring has that grey, and all of it where they are smoothed.
bool lies_in_one_ground(const cv::Mat& grey, const cv::Mat& region, const cv::Mat& ring, int alike) {
  const auto ground = [&](const cv::Mat& picture, int tolerance) {
    const int level = main_grey(picture, ring);
    return cv::Mat((picture >= level - tolerance) & (picture <= level + tolerance) & ~region);
  };
  const auto encloses = [&](const cv::Mat& beside) {
    return share_in(ring, beside) >= kBorderUnknown && covers_areas(beside);
  };
  if (encloses(ground(grey, alike))) return true;
  if (alike < kOneGrey) return false;  // two of its few levels are as near to each other as ripples
  if (share_in(ring, ground(grey, kRipples)) < kMostOfBorder) return false;
  cv::Mat smooth;
  cv::medianBlur(grey, smooth, 5);
  return encloses(ground(smooth, kRipples));
}

}  // namespace

int main_grey(const cv::Mat& grey, const cv::Mat& of) {
  std::array<int, 256> count{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (of.at<unsigned char>(y, x) != 0) ++count[grey.at<unsigned char>(y, x)];
  return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

void clear_canvas_corners(cv::Mat& classes) {
  const auto unknown = static_cast<unsigned char>(Occupancy::Unknown);
  if (classes.empty()) return;
  cv::Mat seen = cv::Mat::zeros(2, 2, CV_8U);
  for (const cv::Point& corner : corners_of(classes)) {
    if (classes.at<unsigned char>(corner) == unknown || is_passed_over(seen, corner)) continue;
    const cv::Mat region = region_at(classes, corner, 0);
    pass_over(classes, region, corner, seen);
    if (share_in(ring_around(region, 1), classes == static_cast<int>(Occupancy::Unknown)) < kBorderUnknown) continue;
    cv::Mat grown;
    cv::dilate(region, grown, cv::Mat::ones(3, 3, CV_8U));
    classes.setTo(unknown, grown);
    seen.setTo(0);  // what lies around the other regions has changed
  }
}

cv::Mat canvas_corners(const cv::Mat& grey) {
  cv::Mat out = cv::Mat::zeros(grey.size(), CV_8U);
  if (grey.empty()) return out;
  const std::vector<int> greys = greys_there(grey);
  const int alike = alike_of(greys);
  cv::Mat copy = grey;
  cv::Mat seen = cv::Mat::zeros(2, 2, CV_8U);
  for (const cv::Point& corner : corners_of(grey)) {
    if (out.at<unsigned char>(corner) != 0 || is_passed_over(seen, corner)) continue;
    const cv::Mat region = region_at(copy, corner, alike);
    pass_over(grey, region, corner, seen);
    const cv::Mat ring = ring_around(region, kBlend);
    if (ring.empty()) continue;
    const int level = main_grey(grey, ring);
    if (!lies_in_one_ground(grey, region, ring, alike) ||
        !is_open(grey, region, grey.at<unsigned char>(corner), level, is_of_few_levels(greys), alike) ||
        has_thin_parts(region))
      continue;
    cv::Mat grown;
    cv::dilate(region, grown, cv::Mat::ones(5, 5, CV_8U));
    out |= grown;
  }
  if (cv::countNonZero(out) == 0) return out;
  return leaves_a_picture(grey, out) ? out : cv::Mat::zeros(grey.size(), CV_8U);
}

}  // namespace rubble::scoring
