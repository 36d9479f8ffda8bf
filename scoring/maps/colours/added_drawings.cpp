#include "scoring/maps/colours/added_drawings.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/grey_roles.h"
#include "scoring/maps/colours/half_width.h"
#include "scoring/maps/colours/nearest_ground.h"

namespace rubble::scoring {
namespace {

constexpr double kLeastInk = 0.0005;  // of all pixels
constexpr int kSmear = 8;             // JPEG smears colours as far [pixels]
constexpr double kGreyRest = 0.995;   // of the pixels that are not ink or beside it
constexpr int kWallTolerance = 12;
constexpr double kLeastWalls = 0.001;  // of all pixels
constexpr double kThinWalls = 2.5;     // mean distance of a wall's pixels to its rim, at the most [pixels]

constexpr double kWholeSide = 0.95;     // of a side of the picture that is margin
constexpr double kLeastPanel = 0.2;     // of the picture's area
constexpr double kFullPanel = 0.97;     // of its bounding box
constexpr double kLeastKnown = 0.02;    // of the panel, to be a map
constexpr double kLeastUnknown = 0.02;  // of the panel
constexpr double kUnknownRim = 0.5;     // of the panel's rim
constexpr double kWholeRim = 0.95;
constexpr int kLetter = 9;  // strokes and ticks are thinner [pixels]
constexpr int kLeastPanelSide = 4 * kLetter;
constexpr int kThickestFrame = 8;  // that has another margin within [pixels]
constexpr int kUnknownClass = static_cast<int>(Occupancy::Unknown);
constexpr int kFreeClass = static_cast<int>(Occupancy::Free);
constexpr int kWallClass = static_cast<int>(Occupancy::Occupied);

double share_of(const cv::Mat& mask) {
  return mask.total() == 0 ? 0.0 : cv::countNonZero(mask) / static_cast<double>(mask.total());
}

/// Largest difference between the channels of each pixel.
cv::Mat colourfulness(const RgbImage& image) {
  cv::Mat out(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const auto [least, most] = std::minmax({p[0], p[1], p[2]});
      out.at<unsigned char>(y, x) = static_cast<unsigned char>(most - least);
    }
  return out;
}

/// Coloured pixels that are few, on greys; empty where the picture is otherwise.
cv::Mat ink_of(const RgbImage& image) {
  const cv::Mat tint = colourfulness(image);
  const cv::Mat strong = tint > kInkColour;
  if (share_of(strong) < kLeastInk || share_of(strong) > kMostInk) return {};
  const auto is_grey_beyond = [&](int reach) {
    cv::Mat near;
    cv::dilate(strong, near, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
    const cv::Mat rest = ~near;
    return cv::countNonZero(rest & (tint <= kMostTint)) >= kGreyRest * cv::countNonZero(rest);
  };
  if (!is_grey_beyond(1) && !is_grey_beyond(kSmear)) return {};
  cv::Mat beside;
  cv::dilate(strong, beside, cv::Mat::ones(3, 3, CV_8U));
  return strong | (beside & (tint > kMostTint));
}

/// The walls of the greys beside `ink`; empty where these are not thin.
cv::Mat thin_walls(const cv::Mat& grey, const cv::Mat& not_asked) {
  const GreyRoles roles = grey_roles(grey, not_asked);
  cv::Mat walls = (grey >= roles.wall - kWallTolerance) & (grey <= roles.wall + kWallTolerance) & ~not_asked;
  if (share_of(walls) < kLeastWalls) return {};
  return mean_half_width(walls) <= kThinWalls ? walls : cv::Mat();
}

/// Most of these walls lie beside the ink: they are its rim, and the coloured lines are the walls.
bool are_rims_of(const cv::Mat& ink, const cv::Mat& walls) {
  cv::Mat near;
  cv::dilate(ink, near, cv::Mat::ones(2 * kSmear + 1, 2 * kSmear + 1, CV_8U));
  return 4 * cv::countNonZero(walls & ~near) < cv::countNonZero(walls);
}

/// The ink with what JPEG or blending left of it beside: faintly tinted, and paler than walls are.
cv::Mat with_rims(const RgbImage& image, const cv::Mat& grey, const cv::Mat& ink, const cv::Mat& walls) {
  constexpr int kBeside = 7;  // [pixels]
  constexpr int kFaint = 12;  // difference of the channels
  constexpr int kPaler = 50;  // than walls
  const double wall = cv::mean(grey, walls)[0], around = cv::mean(grey, ~walls)[0];
  const cv::Mat pale = wall < around ? cv::Mat(grey > wall + kPaler) : cv::Mat(grey < wall - kPaler);
  cv::Mat beside;
  cv::dilate(ink, beside, cv::Mat::ones(kBeside, kBeside, CV_8U));
  return ink | (beside & pale & ~walls & (colourfulness(image) > kFaint));
}

/// Where ink crosses a wall, or covers a piece of it: between two ends of walls in a row or column.
cv::Mat walls_across(const cv::Mat& walls, const cv::Mat& ink) {
  constexpr int kWidest = 11;  // [pixels]: less than between the walls of a passage
  cv::Mat rows, columns;
  const int width = std::min(kWidest, 2 * static_cast<int>(std::lround(2.0 * mean_half_width(ink))) + 3);
  cv::morphologyEx(walls, rows, cv::MORPH_CLOSE, cv::Mat::ones(1, width, CV_8U));
  cv::morphologyEx(walls, columns, cv::MORPH_CLOSE, cv::Mat::ones(width, 1, CV_8U));
  return (rows | columns) & ink;
}

/// Of the pixels of the rectangle's rim those of this class.
double share_of_rim(const cv::Mat& classes, const cv::Rect& panel, int of) {
  const cv::Mat part = classes(panel);
  double here = 0.0;
  for (const cv::Mat& side : {part.row(0), part.row(part.rows - 1), part.col(0), part.col(part.cols - 1)})
    here += cv::countNonZero(side == of);
  return here / (2.0 * (part.rows + part.cols));
}

/// Free ground of `part` that is connected with its rim.
cv::Mat margin_of(const cv::Mat& part) {
  cv::Mat padded;
  cv::copyMakeBorder(part == kFreeClass, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  cv::floodFill(padded, {0, 0}, cv::Scalar(128), nullptr, cv::Scalar(), cv::Scalar(), 4);
  return cv::Mat(padded == 128)(cv::Rect(1, 1, part.cols, part.rows)).clone();
}

bool covers_a_side(const cv::Mat& margin) {
  for (const cv::Mat& side : {margin.row(0), margin.row(margin.rows - 1), margin.col(0), margin.col(margin.cols - 1)})
    if (share_of(side) >= kWholeSide) return true;
  return false;
}

/// The rectangle that the margin around it leaves of `part`, without lettering.
std::optional<cv::Rect> panel_within(const cv::Mat& part) {
  if (part.rows < kLeastPanelSide || part.cols < kLeastPanelSide) return std::nullopt;
  const cv::Mat margin = margin_of(part);
  if (!covers_a_side(margin)) return std::nullopt;
  cv::Mat rest = ~margin, labels, stats, centres;
  cv::morphologyEx(rest, rest, cv::MORPH_OPEN, cv::Mat::ones(kLetter, kLetter, CV_8U));
  const int count = cv::connectedComponentsWithStats(rest, labels, stats, centres, 4, CV_32S);
  int largest = 0;
  for (int i = 1; i < count; ++i)
    if (largest == 0 || stats.at<int>(i, cv::CC_STAT_AREA) > stats.at<int>(largest, cv::CC_STAT_AREA)) largest = i;
  if (largest == 0) return std::nullopt;
  const auto at = [&](int what) { return stats.at<int>(largest, what); };
  const cv::Rect box(at(cv::CC_STAT_LEFT), at(cv::CC_STAT_TOP), at(cv::CC_STAT_WIDTH), at(cv::CC_STAT_HEIGHT));
  if (box.area() < kLeastPanel * static_cast<double>(part.total()) || box.size() == part.size() ||
      at(cv::CC_STAT_AREA) < kFullPanel * box.area())
    return std::nullopt;
  return box;
}

/// A map begins with unknown ground, or with the frame around it.
bool is_map(const cv::Mat& classes, const cv::Rect& panel) {
  const cv::Mat part = classes(panel);
  return share_of(part == kFreeClass) >= kLeastKnown && share_of(part == kUnknownClass) >= kLeastUnknown &&
         (share_of_rim(classes, panel, kUnknownClass) >= kUnknownRim ||
          share_of_rim(classes, panel, kWallClass) >= kWholeRim);
}

/// A margin within the frame: what it leaves begins with unknown ground.
std::optional<cv::Rect> panel_within_frame(const cv::Mat& classes, cv::Rect panel) {
  const auto small = [&] { return panel.width < kLeastPanelSide || panel.height < kLeastPanelSide; };
  for (int i = 0; i < kThickestFrame && !small() && share_of_rim(classes, panel, kWallClass) >= kUnknownRim; ++i)
    panel = {panel.x + 1, panel.y + 1, panel.width - 2, panel.height - 2};
  if (small()) return std::nullopt;
  const std::optional<cv::Rect> inner = panel_within(classes(panel));
  if (!inner) return std::nullopt;
  const cv::Rect box = *inner + panel.tl();
  return is_map(classes, box) && share_of_rim(classes, box, kUnknownClass) >= kUnknownRim ? std::optional(box)
                                                                                          : std::nullopt;
}

/// A line around unknown ground is a frame; around free ground it may be a wall.
cv::Rect without_frame(const cv::Mat& classes, const cv::Rect& panel) {
  cv::Rect inner = panel;
  for (int i = 0; i < kThickestFrame && inner.width > kLeastPanelSide && inner.height > kLeastPanelSide; ++i) {
    if (share_of_rim(classes, inner, kWallClass) < kWholeRim) break;
    inner = {inner.x + 1, inner.y + 1, inner.width - 2, inner.height - 2};
  }
  return share_of_rim(classes, inner, kUnknownClass) >= kUnknownRim ? inner : panel;
}

/// What is around the panel is unknown.
void keep_only(cv::Mat& classes, const cv::Rect& panel) {
  cv::Mat cleared(classes.size(), CV_8U, cv::Scalar(kUnknownClass));
  classes(panel).copyTo(cleared(panel));
  classes = cleared;
}

}  // namespace

bool paint_over_colours(const RgbImage& image, const cv::Mat& apart, cv::Mat& grey) {
  const cv::Mat ink = ink_of(image);
  if (ink.empty()) return false;
  const cv::Mat walls = thin_walls(grey, ink | apart);
  if (walls.empty() || are_rims_of(ink, walls)) return false;
  const cv::Mat all = with_rims(image, grey, ink, walls);
  const cv::Mat crossed = walls_across(walls, all);
  cv::Mat ground = grey.clone();
  carry_ground(all | walls, ground);
  ground.copyTo(grey, all);
  if (cv::countNonZero(crossed) > 0) grey.setTo(cv::mean(grey, walls)[0], crossed);
  return true;
}

bool even_out_coloured_walls(const RgbImage& image, const cv::Mat& apart, cv::Mat& grey) {
  constexpr int kAlike = 60;            // of the lines' greys, a tenth left out at either end: one pen
  constexpr double kHalfAsFar = 0.5;    // off the ground as the most around: JPEG smears colours less strongly
  constexpr int kAround = 5;            // [pixels]
  constexpr double kWidestLines = 4.0;  // mean distance to their rim [pixels]
  const cv::Mat ink = ink_of(image);
  if (ink.empty()) return false;
  const cv::Mat walls = thin_walls(grey, ink | apart);
  if (!walls.empty() && !are_rims_of(ink, walls)) return false;
  cv::Mat ground = grey.clone();
  cv::Mat near;
  cv::dilate(ink, near, cv::Mat::ones(3, 3, CV_8U));
  if (!walls.empty()) near |= walls;
  carry_ground(near, ground);
  cv::Mat off(grey.size(), CV_8U), most;
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) {
      int far = 0;
      for (int i = 0; i < 3; ++i) far = std::max(far, std::abs(image.pixel(x, y)[i] - ground.at<unsigned char>(y, x)));
      off.at<unsigned char>(y, x) = static_cast<unsigned char>(far);
    }
  off.setTo(0, ~near);
  cv::dilate(off, most, cv::Mat::ones(kAround, kAround, CV_8U));
  cv::Mat least;
  most.convertTo(least, CV_8U, kHalfAsFar);
  const cv::Mat lines = near & (off >= least) & (off > kInkColour);
  if (cv::countNonZero(lines) == 0 || mean_half_width(lines) > kWidestLines) return false;
  std::vector<unsigned char> greys;
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (lines.at<unsigned char>(y, x) != 0) greys.push_back(grey.at<unsigned char>(y, x));
  std::sort(greys.begin(), greys.end());
  if (greys[9 * greys.size() / 10] - greys[greys.size() / 10] < kAlike) return false;
  const bool on_light = cv::mean(ground)[0] >= 128.0;
  // Nothing but lines on one ground: what JPEG left of them there is no second one.
  constexpr int kOneGround = 12;
  cv::Mat middle;
  cv::medianBlur(ground, middle, 5);
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(middle, &low, &high);
  if (high - low <= kOneGround) ground.setTo(cv::mean(ground)[0]);
  ground.copyTo(grey, near);
  grey.setTo(on_light ? 0 : 255, lines);
  return true;
}

bool clear_around_panel(cv::Mat& classes) {
  const std::optional<cv::Rect> outer = panel_within(classes);
  if (!outer) return false;
  const std::optional<cv::Rect> inner = panel_within_frame(classes, *outer);
  if (!inner && !is_map(classes, *outer)) return false;
  keep_only(classes, without_frame(classes, inner.value_or(*outer)));
  return true;
}

bool clear_around_league_map(cv::Mat& classes) {
  const std::optional<cv::Rect> panel = panel_within(classes);
  if (!panel || !is_map(classes, *panel) || share_of_rim(classes, *panel, kUnknownClass) < kWholeRim) return false;
  keep_only(classes, *panel);
  return true;
}

}  // namespace rubble::scoring
