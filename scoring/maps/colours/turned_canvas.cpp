#include "scoring/maps/colours/turned_canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/angle.h"
#include "scoring/maps/colours/canvas_corners.h"

namespace rubble::scoring {
namespace {

constexpr int kOneLevel = 12;       // of one grey
constexpr double kOffSide = 1.0;    // off a side, at the most [pixels]
constexpr double kSides = 0.7;      // share of the picture's outline that lies on its sides; walls may cover the rest
constexpr double kLeastTilt = 3.0;  // of a side over its length [pixels]
constexpr int kLine = 9;            // walls are thinner [pixels]
constexpr double kLines = 0.7;      // share of what has the walls' grey that is thinner
constexpr double kDrawn = 0.005;    // share of the picture that walls cover at the least
constexpr double kSecondGround = 0.01;  // and a second ground
constexpr double kSharp = 0.6;          // share of the outermost pixels that is not blended
constexpr double kMargin = 0.8;         // share of what lies along the sides that is of one ground
constexpr double kWallAround = 2.0;     // thickness [pixels]

/// All pixels that are connected to a corner and of its grey; empty unless all corners are.
cv::Mat around(const cv::Mat& grey) {
  const std::array<cv::Point, 4> corners{
      {{0, 0}, {grey.cols - 1, 0}, {0, grey.rows - 1}, {grey.cols - 1, grey.rows - 1}}};
  const auto at = [&](const cv::Point& p) { return static_cast<int>(grey.at<unsigned char>(p)); };
  cv::Mat mask = cv::Mat::zeros(grey.rows + 2, grey.cols + 2, CV_8U);
  cv::Mat copy = grey;
  for (const cv::Point& corner : corners) {
    if (std::abs(at(corner) - at(corners.front())) > kOneLevel) return {};
    if (mask.at<unsigned char>(corner + cv::Point(1, 1)) == 0)
      cv::floodFill(copy, mask, corner, cv::Scalar(), nullptr, cv::Scalar(kOneLevel), cv::Scalar(kOneLevel),
                    4 | cv::FLOODFILL_MASK_ONLY | cv::FLOODFILL_FIXED_RANGE | (255 << 8));
  }
  return mask(cv::Rect(1, 1, grey.cols, grey.rows)).clone();
}

/// Convex hull of all that is not `outside`: that of the first and the last pixel of each row.
std::vector<cv::Point> hull_within(const cv::Mat& outside) {
  std::vector<cv::Point> ends, hull;
  for (int y = 0; y < outside.rows; ++y) {
    const unsigned char* const row = outside.ptr(y);
    const unsigned char* const end = row + outside.cols;
    const auto* const first = std::find(row, end, 0);
    if (first == end) continue;
    int last = outside.cols - 1;
    while (row[last] != 0) --last;
    ends.emplace_back(static_cast<int>(first - row), y);
    ends.emplace_back(last, y);
  }
  if (!ends.empty()) cv::convexHull(ends, hull);
  return hull;
}

struct Rectangle {
  double angle = 0.0;                   ///< of the first axis, 0 to pi / 2
  std::array<double, 2> low{}, high{};  ///< along the two axes [pixels]
  double on_sides = 0.0;                ///< length of the hull's edges on it, less where they are off it [pixels]

  cv::Point2d axis(std::size_t i) const {
    return i == 0 ? cv::Point2d(std::cos(angle), std::sin(angle)) : cv::Point2d(-std::sin(angle), std::cos(angle));
  }
};

/// An edge that the image's frame has cut.
bool is_on_frame(const cv::Point& a, const cv::Point& b, const cv::Size& size) {
  const auto both = [](int p, int q, int side) { return p == side && q == side; };
  return both(a.x, b.x, 0) || both(a.y, b.y, 0) || both(a.x, b.x, size.width - 1) || both(a.y, b.y, size.height - 1);
}

Rectangle rectangle_at(double angle, const std::vector<cv::Point>& hull, const cv::Size& size) {
  Rectangle out;
  out.angle = angle;
  std::vector<double> along(hull.size());
  std::vector<double> off(hull.size(), 0.0);  // of each edge
  std::vector<double> least(hull.size(), kOffSide);
  for (std::size_t i = 0; i < 2; ++i) {
    const cv::Point2d axis = out.axis(i);
    std::transform(hull.begin(), hull.end(), along.begin(), [&](const cv::Point& p) { return axis.dot(p); });
    const auto [low, high] = std::minmax_element(along.begin(), along.end());
    out.low[i] = *low;
    out.high[i] = *high;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const double a = along[k], b = along[(k + 1) % hull.size()];
      least[k] = std::min({least[k], std::max(a, b) - *low, *high - std::min(a, b)});
    }
  }
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const cv::Point &a = hull[k], &b = hull[(k + 1) % hull.size()];
    if (!is_on_frame(a, b, size)) out.on_sides += cv::norm(b - a) * (1.0 - least[k] / kOffSide);
  }
  return out;
}

/// The rectangle on whose sides most of the hull lies.
Rectangle best_rectangle(const std::vector<cv::Point>& hull, const cv::Size& size) {
  const double step = 0.5 / std::hypot(size.width, size.height);
  Rectangle best;
  for (double angle = 0.0; angle < kPi / 2; angle += step) {
    const Rectangle here = rectangle_at(angle, hull, size);
    if (here.on_sides > best.on_sides) best = here;
  }
  return best;
}

double outline(const std::vector<cv::Point>& hull, const cv::Size& size) {
  double sum = 0.0;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const cv::Point &a = hull[k], &b = hull[(k + 1) % hull.size()];
    if (!is_on_frame(a, b, size)) sum += cv::norm(b - a);
  }
  return sum;
}

/// Pixels that lie less than `depth` within the rectangle, or beyond it.
cv::Mat beyond(const Rectangle& r, const cv::Size& size, double depth) {
  cv::Mat out(size, CV_8U);
  const cv::Point2d u = r.axis(0), v = r.axis(1);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double a = u.dot(cv::Point2d(x, y)), b = v.dot(cv::Point2d(x, y));
      const double within = std::min({a - r.low[0], r.high[0] - a, b - r.low[1], r.high[1] - b});
      out.at<unsigned char>(y, x) = within < depth ? 255 : 0;
    }
  return out;
}

cv::Mat near_level(const cv::Mat& grey, int level) { return (grey >= level - kOneLevel) & (grey <= level + kOneLevel); }

struct Grounds {
  int first = 0;  ///< most frequent grey but the walls'
  int second = 0;
  bool two = false;  ///< the second one covers something
  bool have(int grey) const { return std::abs(grey - first) <= kOneLevel || std::abs(grey - second) <= kOneLevel; }
};

Grounds grounds_of(const cv::Mat& grey, const cv::Mat& picture, int walls) {
  Grounds out;
  const cv::Mat ground = picture & ~near_level(grey, walls);
  out.first = main_grey(grey, ground);
  const cv::Mat rest = ground & ~near_level(grey, out.first);
  out.second = main_grey(grey, rest);
  out.two = cv::countNonZero(rest & near_level(grey, out.second)) >= kSecondGround * cv::countNonZero(picture);
  return out;
}

/// The walls' grey, darker or lighter than all else, draws lines on the grounds. Blended ones have it half at the
/// least.
bool draws_lines(const cv::Mat& grey, const cv::Mat& picture, int walls, const Grounds& grounds) {
  const double least = kDrawn * cv::countNonZero(picture);
  const int darker = cv::countNonZero(picture & (grey < walls - kOneLevel));
  const int lighter = cv::countNonZero(picture & (grey > walls + kOneLevel));
  if (std::min(darker, lighter) > least) return false;
  int nearest = std::abs(grounds.first - walls);
  if (grounds.two) nearest = std::min(nearest, std::abs(grounds.second - walls));
  const cv::Mat drawn = picture & (grey > walls - nearest / 2) & (grey < walls + nearest / 2);
  cv::Mat padded, areas;
  cv::copyMakeBorder(drawn, padded, kLine, kLine, kLine, kLine, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::morphologyEx(padded, areas, cv::MORPH_OPEN, cv::Mat::ones(kLine, kLine, CV_8U));
  const double lines = cv::countNonZero(drawn);
  return lines >= least && cv::countNonZero(areas) <= (1.0 - kLines) * lines;
}

double share_of(const cv::Mat& grey, const cv::Mat& of, int level) {
  const int all = cv::countNonZero(of);
  return all == 0 ? 0.0 : cv::countNonZero(of & near_level(grey, level)) / static_cast<double>(all);
}

/// Through JPEG it is not: ripples may look like lines.
bool is_even(const cv::Mat& grey, const cv::Mat& canvas, int level) {
  constexpr double kOdd = 0.001;
  const cv::Mat odd = canvas & ((grey < level - 2) | (grey > level + 2));
  return cv::countNonZero(odd) <= kOdd * cv::countNonZero(canvas);
}

/// Most of the outermost pixels have the grey of a ground, and not mixtures of that and the canvas.
bool is_sharp(const cv::Mat& grey, const cv::Mat& rim, const Grounds& grounds) {
  const int level = main_grey(grey, rim);
  return grounds.have(level) && share_of(grey, rim, level) >= kSharp;
}

}  // namespace

TurnedCanvas canvas_of_the_walls_grey(const cv::Mat& grey) {
  const cv::Size size = grey.size();
  const cv::Mat outside = grey.empty() ? cv::Mat() : around(grey);
  if (outside.empty()) return {};
  const std::vector<cv::Point> hull = hull_within(outside);
  if (hull.size() < 4) return {};
  const Rectangle r = best_rectangle(hull, size);
  if (r.on_sides < kSides * outline(hull, size)) return {};
  const double length = std::max(r.high[0] - r.low[0], r.high[1] - r.low[1]);
  if (length * std::min(std::sin(r.angle), std::cos(r.angle)) < kLeastTilt) return {};

  const int canvas = grey.at<unsigned char>(0, 0);
  const cv::Mat none = beyond(r, size, 0.0), first = beyond(r, size, 1.0), next = beyond(r, size, 2.0);
  if (!is_even(grey, beyond(r, size, -3.0), canvas)) return {};
  const Grounds grounds = grounds_of(grey, ~none, canvas);
  if (!draws_lines(grey, ~none, canvas, grounds)) return {};
  const bool sharp = is_sharp(grey, first & ~none & ~outside, grounds);
  const cv::Mat beside = sharp ? first & ~beyond(r, size, 0.25) : next & ~first;
  const int ground = main_grey(grey, beside & ~near_level(grey, canvas));
  const bool is_free = std::abs(ground - grounds.first) <= kOneLevel;  // unless most of the map is unknown
  if (share_of(grey, beside, ground) >= kMargin && (grounds.two || !is_free))
    return {sharp ? beyond(r, size, 0.75) : next, ground};
  // Walls around free ground, which may be as dark as what is beyond them.
  if (is_free) return {beyond(r, size, -kWallAround), -1};
  return {sharp ? beyond(r, size, 0.75) : next, -1};
}

}  // namespace rubble::scoring
