#include "scoring/maps/victim_symbols.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <tuple>

#include "base/angle.h"
#include "scoring/maps/colours/league_palette.h"

namespace rubble::scoring {
namespace {

constexpr double kRadius = league::kVictimRadius;
constexpr double kLeastRadius = 0.10;   // of a single circle of another size [m]
constexpr double kMostRadius = 0.30;    // [m]
constexpr double kDiscLike = 0.78;      // area over that of the circle around: a disc has 1, a square 0.64
constexpr double kSquareLike = 0.90;    // area over that of the upright or turned box: a disc has 0.785, a square 1
constexpr double kLeastInk = 0.40;      // of the disc's area that no other circle has: the rest is lettering or overlap
constexpr double kLeastCovered = 0.80;  // ink and lettering together
constexpr double kLeastRim = 0.75;      // of eight sectors in which the rim is drawn: lettering cuts it here and there
constexpr double kMostAround = 0.7;     // of the directions in which the drawing goes on: more is an area, no circle
constexpr double kSolid = 1.4;          // radius of a disc that fits into the drawing, in radii: then it is an area
constexpr double kMostDiscs = 60.0;     // drawings larger than so many circles are none
constexpr double kNear = 0.06;          // pieces of one circle that its lettering cuts lie nearer than this [m]
constexpr unsigned char kInk = 1;
constexpr unsigned char kLettering = 2;

struct PixelColour {
  int r, g, b;
};

/// Red or orange, or such a colour mixed with up to half of another: yellow (arrow) and violet (path) are not.
bool is_ink(const PixelColour& c) {
  const int rb = c.r - c.b;
  const int gb = c.g - c.b;
  return rb >= 95 && c.r - c.g >= 43 && 100 * gb <= 55 * rb;
}

/// White, or white mixed with ink.
bool is_lettering(const PixelColour& c) { return c.r >= 190 && std::abs(c.g - c.b) <= 60 && std::min(c.g, c.b) >= 60; }

/// kInk and kLettering of the part of the image that has ink, and where that part lies.
struct Drawing {
  cv::Mat marks;
  cv::Point corner;
};

Drawing drawing_of(const RgbImage& image, int margin) {
  const auto colour = [&](int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    return PixelColour{p[0], p[1], p[2]};
  };
  cv::Point low(image.width, image.height);
  cv::Point high(-1, -1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is_ink(colour(x, y))) {
        low = {std::min(low.x, x), std::min(low.y, y)};
        high = {std::max(high.x, x), std::max(high.y, y)};
      }
  Drawing out;
  if (high.x < 0) return out;
  out.corner = low - cv::Point(margin, margin);
  out.marks = cv::Mat::zeros(high.y - low.y + 1 + 2 * margin, high.x - low.x + 1 + 2 * margin, CV_8U);
  for (int y = 0; y < out.marks.rows; ++y)
    for (int x = 0; x < out.marks.cols; ++x) {
      const cv::Point p = out.corner + cv::Point(x, y);
      if (p.x < 0 || p.y < 0 || p.x >= image.width || p.y >= image.height) continue;
      const PixelColour c = colour(p.x, p.y);
      if (is_ink(c))
        out.marks.at<unsigned char>(y, x) = kInk;
      else if (is_lettering(c))
        out.marks.at<unsigned char>(y, x) = kLettering;
    }
  return out;
}

/// Lettering that is closed in by ink becomes ink.
void fill_lettering(cv::Mat& marks, double most_area) {
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(marks != static_cast<int>(kInk), labels, stats, centres, 4);
  std::vector<int> lettering(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (marks.at<unsigned char>(y, x) == kLettering) ++lettering[static_cast<std::size_t>(labels.at<int>(y, x))];
  std::vector<bool> is_hole(static_cast<std::size_t>(count), false);
  for (int i = 1; i < count; ++i) {
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    is_hole[static_cast<std::size_t>(i)] = area <= most_area && lettering[static_cast<std::size_t>(i)] >= 0.7 * area;
  }
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (is_hole[static_cast<std::size_t>(labels.at<int>(y, x))]) marks.at<unsigned char>(y, x) = kInk;
}

/// A connected piece of ink.
struct Piece {
  std::vector<cv::Point> pixels;
  cv::Point2d centre() const {
    cv::Point2d sum;
    for (const cv::Point& p : pixels) sum += cv::Point2d(p);
    return sum * (1.0 / static_cast<double>(pixels.size()));
  }
  double area() const { return static_cast<double>(pixels.size()); }
  double radius() const { return std::sqrt(area() / kPi); }
  double disc_likeness() const {
    const cv::Point2d c = centre();
    double most = 0.5;
    for (const cv::Point& p : pixels) most = std::max(most, std::hypot(p.x - c.x, p.y - c.y));
    return area() / (kPi * most * most);
  }
  bool is_square() const {
    constexpr double kLeastPixels = 3.0;  // smaller discs are squares
    if (radius() < kLeastPixels) return false;
    const cv::RotatedRect box = cv::minAreaRect(pixels);
    const double w = box.size.width + 1.0;
    const double h = box.size.height + 1.0;
    return area() >= kSquareLike * w * h && std::max(w, h) <= 1.3 * std::min(w, h);
  }
};

/// Radius of the largest disc that fits into it [pixels].
double inner_radius(const Piece& piece) {
  const cv::Rect box = cv::boundingRect(piece.pixels);
  cv::Mat mask = cv::Mat::zeros(box.height + 2, box.width + 2, CV_8U);
  for (const cv::Point& p : piece.pixels) mask.at<unsigned char>(p - box.tl() + cv::Point(1, 1)) = 255;
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L2, 5);
  double most = 0.0;
  cv::minMaxLoc(distance, nullptr, &most);
  return most;
}

/// `most`: pixels of a piece that is of use; larger ones are left out.
std::vector<Piece> pieces_of(const cv::Mat& ink, double most = std::numeric_limits<double>::infinity()) {
  cv::Mat labels;
  const auto count = static_cast<std::size_t>(cv::connectedComponents(ink, labels, 8, CV_32S));
  std::vector<int> sizes(count, 0);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) ++sizes[static_cast<std::size_t>(labels.at<int>(y, x))];
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place(count, kNone);
  std::vector<Piece> out;
  for (std::size_t i = 1; i < count; ++i) {
    if (sizes[i] > most) continue;
    place[i] = out.size();
    out.emplace_back().pixels.reserve(static_cast<std::size_t>(sizes[i]));
  }
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const std::size_t i = place[static_cast<std::size_t>(labels.at<int>(y, x))]; i != kNone)
        out[i].pixels.push_back({x, y});
  return out;
}

/// Counts marked pixels in discs.
class DiscSum {
 public:
  DiscSum(const cv::Mat& marks, unsigned char kind) : sums_(marks.rows, marks.cols + 1, CV_32S) {
    for (int y = 0; y < marks.rows; ++y) {
      int sum = 0;
      sums_.at<int>(y, 0) = 0;
      for (int x = 0; x < marks.cols; ++x) {
        sum += marks.at<unsigned char>(y, x) == kind ? 1 : 0;
        sums_.at<int>(y, x + 1) = sum;
      }
    }
  }
  /// Of the pixels whose centres are within `radius` of `c`.
  int at(const cv::Point2d& c, double radius) const {
    int sum = 0;
    const int low = std::max(0, static_cast<int>(std::ceil(c.y - radius)));
    const int high = std::min(sums_.rows - 1, static_cast<int>(std::floor(c.y + radius)));
    for (int y = low; y <= high; ++y) {
      const double half = std::sqrt(std::max(0.0, radius * radius - (y - c.y) * (y - c.y)));
      const int west = std::max(0, static_cast<int>(std::ceil(c.x - half)));
      const int east = std::min(sums_.cols - 2, static_cast<int>(std::floor(c.x + half)));
      if (east >= west) sum += sums_.at<int>(y, east + 1) - sums_.at<int>(y, west);
    }
    return sum;
  }

 private:
  cv::Mat sums_;
};

/// Share of the sectors around `c` with ink at a distance of `from` to `to`; 32 rays are asked.
double drawn_around(const cv::Mat& marks, const cv::Point2d& c, double from, double to, int sectors) {
  constexpr int kDirections = 32;
  std::vector<bool> drawn(static_cast<std::size_t>(sectors), false);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections;
    for (double r = from; r <= to; r += 0.5) {
      const cv::Point p(static_cast<int>(std::lround(c.x + r * std::cos(angle))),
                        static_cast<int>(std::lround(c.y + r * std::sin(angle))));
      if (p.x >= 0 && p.y >= 0 && p.x < marks.cols && p.y < marks.rows && marks.at<unsigned char>(p) == kInk)
        drawn[static_cast<std::size_t>(i * sectors / kDirections)] = true;
    }
  }
  return static_cast<double>(std::count(drawn.begin(), drawn.end(), true)) / sectors;
}

/// Finds circles of one radius in ink that is no single disc, best first.
class DiscSearch {
 public:
  DiscSearch(const cv::Mat& marks, double radius)
      : marks_(marks), left_(marks == static_cast<int>(kInk)), radius_(radius), reach_(radius + 0.25) {
    left_ /= 255;
  }

  std::vector<cv::Point2d> find() {
    std::vector<cv::Point2d> found;
    const DiscSum ink(marks_, kInk);
    const DiscSum lettering(marks_, kLettering);
    const double area = kPi * radius_ * radius_;
    for (;;) {
      const DiscSum left(left_, 1);
      const std::optional<cv::Point2d> best = best_of(ink, lettering, left, area);
      if (!best) return found;
      found.push_back(*best);
      for (int y = 0; y < left_.rows; ++y)
        for (int x = 0; x < left_.cols; ++x)
          if (std::hypot(x - best->x, y - best->y) <= radius_ + 1.0) left_.at<unsigned char>(y, x) = 0;
    }
  }

 private:
  std::optional<cv::Point2d> best_of(const DiscSum& ink, const DiscSum& lettering, const DiscSum& left,
                                     double area) const {
    constexpr double kStep = 0.5;
    double most = 0.0;
    std::vector<cv::Point2d> best;
    for (double y = 0.0; y < marks_.rows; y += kStep)
      for (double x = 0.0; x < marks_.cols; x += kStep) {
        const cv::Point2d c(x, y);
        const int own = left.at(c, reach_);
        if (own < kLeastInk * area) continue;
        const int inside = ink.at(c, reach_);
        if (inside + lettering.at(c, reach_) < kLeastCovered * area) continue;
        const int around = ink.at(c, reach_ + 2.0) - ink.at(c, reach_ + 0.5);
        const double value = inside + own - 0.7 * around;
        if (value < most - 1e-9 || !is_circle(c)) continue;
        if (value > most + 1e-9) best.clear();
        most = value;
        best.push_back(c);
      }
    if (best.empty()) return std::nullopt;
    // Lettering and pixels leave some play: the middle of it.
    cv::Point2d sum;
    int count = 0;
    for (const cv::Point2d& c : best)
      if (std::hypot(c.x - best.front().x, c.y - best.front().y) <= radius_) {
        sum += c;
        ++count;
      }
    return sum * (1.0 / count);
  }

  bool is_circle(const cv::Point2d& c) const {
    return drawn_around(marks_, c, 0.75 * radius_, radius_, 8) >= kLeastRim &&
           drawn_around(marks_, c, reach_ + 1.25, reach_ + 1.75, 32) <= kMostAround;
  }

  const cv::Mat& marks_;
  cv::Mat left_;  // ink that no circle has yet: 1
  double radius_;
  double reach_;  // of pixel centres
};

enum class Kind { Victim, Unconfirmed, Hazard };

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

constexpr double kRedness = league::kVictim[0] - league::kVictim[2];
constexpr double kHazardRedder = league::kHazard[0] - league::kVictim[0];

/// By the colour of the ink around a centre, and by how much of it lies beyond the circle: a diamond has corners. Mixed
/// with white, the green share g - b / r - b stays: 0 for a victim, 0.39 for an unconfirmed one, 0.31 for a hazard; the
/// red of a hazard is 255, that of the others nears it from 240.
Kind kind_of(const RgbImage& image, const cv::Point2d& centre, double radius) {
  std::vector<double> green_share;
  std::vector<double> redness;
  double beyond = 0.0;
  const double corner = 1.45 * radius + 0.5;
  for (int y = static_cast<int>(centre.y - corner); y <= centre.y + corner; ++y)
    for (int x = static_cast<int>(centre.x - corner); x <= centre.x + corner; ++x) {
      const double r = std::hypot(x - centre.x, y - centre.y);
      if (x < 0 || y < 0 || x >= image.width || y >= image.height || r > corner) continue;
      const std::uint8_t* p = image.pixel(x, y);
      if (!is_ink({p[0], p[1], p[2]})) continue;
      if (r > radius + 0.75) ++beyond;
      if (r > radius) continue;
      const double purity = std::min(1.0, (p[0] - p[2]) / kRedness);
      green_share.push_back(static_cast<double>(p[1] - p[2]) / (p[0] - p[2]));
      redness.push_back((p[0] - league::kVictim[0] - kHazardRedder * (1.0 - purity)) /
                        (kHazardRedder * purity));  // 0: victim, 1: hazard
    }
  if (green_share.empty()) return Kind::Hazard;
  const double green = median(green_share);
  if (green < 0.2) return Kind::Victim;
  const double corners = beyond / (kPi * radius * radius);
  const double hazard = median(redness) - 0.5 + (0.351 - green) / 0.08 + (corners - 0.1) / 0.1;
  return hazard > 0.0 ? Kind::Hazard : Kind::Unconfirmed;
}

}  // namespace

std::vector<VictimSymbol> find_victim_symbols(const RgbImage& image, double resolution) {
  const double radius = kRadius / resolution;
  if (radius < 1.5) return {};
  const double area = kPi * radius * radius;
  const int margin = static_cast<int>(std::ceil(radius)) + 3;
  Drawing drawing = drawing_of(image, margin);
  if (drawing.marks.empty()) return {};
  fill_lettering(drawing.marks, area);

  std::vector<cv::Point2d> centres;
  cv::Mat rest = cv::Mat::zeros(drawing.marks.size(), CV_8U);
  for (const Piece& piece : pieces_of(drawing.marks == static_cast<int>(kInk), kMostDiscs * area)) {
    const double r = piece.radius() * resolution;
    if (r > kLeastRadius && r < kMostRadius && piece.disc_likeness() >= kDiscLike) {
      centres.push_back(piece.centre());
    } else if (!piece.is_square() && inner_radius(piece) <= kSolid * radius + 1.0) {
      for (const cv::Point& p : piece.pixels) rest.at<unsigned char>(p) = 1;
    }
  }
  // What is no single disc is searched group by group: pieces that may belong to one circle are near each other.
  cv::Mat near;
  const int reach = std::max(1, static_cast<int>(std::lround(0.5 * kNear / resolution)) + 1);
  cv::dilate(rest, near, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  for (const Piece& group : pieces_of(near)) {
    cv::Rect box = cv::boundingRect(group.pixels);
    box = (box + cv::Size(2 * margin, 2 * margin)) - cv::Point(margin, margin);
    box &= cv::Rect({0, 0}, drawing.marks.size());
    cv::Mat marks = cv::Mat::zeros(box.size(), CV_8U);
    double ink = 0.0;
    for (const cv::Point& p : group.pixels)
      if (rest.at<unsigned char>(p) != 0) ++ink;
    if (ink < kLeastInk * area || ink > kMostDiscs * area) continue;
    cv::Mat(drawing.marks, box).copyTo(marks);
    cv::Mat members = cv::Mat::zeros(box.size(), CV_8U);
    for (const cv::Point& p : group.pixels)
      if (rest.at<unsigned char>(p) != 0) members.at<unsigned char>(p - box.tl()) = 1;
    marks.setTo(0, (marks == static_cast<int>(kInk)) & (members == 0));
    for (const cv::Point2d& c : DiscSearch(marks, radius).find()) centres.push_back(c + cv::Point2d(box.tl()));
  }

  std::vector<VictimSymbol> out;
  for (const cv::Point2d& c : centres) {
    const cv::Point2d on_image = c + cv::Point2d(drawing.corner);
    const Kind kind = kind_of(image, on_image, radius);
    if (kind != Kind::Hazard) out.push_back({on_image.x + 0.5, on_image.y + 0.5, kind == Kind::Victim});
  }
  std::sort(out.begin(), out.end(), [](const VictimSymbol& a, const VictimSymbol& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });
  return out;
}

}  // namespace rubble::scoring
