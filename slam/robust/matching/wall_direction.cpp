#include "slam/robust/matching/wall_direction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.h"

namespace rubble::slam {

namespace {

constexpr double kLineGap = 0.5;         ///< neighbouring points of one wall lie no farther apart [m] ...
constexpr double kLineGapShare = 0.1;    ///< ... or by this share of their range
constexpr double kOffLine = 0.04;        ///< [m]
constexpr double kStraight = 0.015;      ///< RMS of a line's points [m]
constexpr std::size_t kMostLines = 400;  ///< more no scan of a building has
constexpr std::size_t kLeastLinePoints = 5;
constexpr double kLeastLine = 0.5;          ///< [m]
constexpr double kPointSigma = 0.012;       ///< of a point across its wall [m]
const double kWallSigma = deg_to_rad(0.4);  ///< walls of one building are parallel to this
const double kParallel = deg_to_rad(3.0);   ///< lines that vote for the same direction
constexpr double kLeastVotes = 1.5;         ///< [m] of wall
constexpr double kMajority = 0.6;           ///< of all metres of wall

/// A line that grows point by point: sums about its first point.
class GrowingLine {
 public:
  explicit GrowingLine(const OrientedPoint& first)
      : x0_(static_cast<double>(first.x)), y0_(static_cast<double>(first.y)) {
    add(first);
  }
  void add(const OrientedPoint& p) {
    const double x = static_cast<double>(p.x) - x0_;
    const double y = static_cast<double>(p.y) - y0_;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
    last_x_ = x;
    last_y_ = y;
    ++count_;
  }
  std::size_t count() const { return count_; }
  double length() const { return std::sqrt(last_x_ * last_x_ + last_y_ * last_y_); }
  double gap_to(const OrientedPoint& p) const {
    const double x = static_cast<double>(p.x) - x0_ - last_x_;
    const double y = static_cast<double>(p.y) - y0_ - last_y_;
    return std::sqrt(x * x + y * y);
  }
  double angle() const { return 0.5 * std::atan2(2.0 * scatter_xy(), scatter_xx() - scatter_yy()); }
  /// Sum of squares along and across.
  double along() const { return 0.5 * (scatter_xx() + scatter_yy()) + root(); }
  double across() const { return std::max(0.0, 0.5 * (scatter_xx() + scatter_yy()) - root()); }
  double distance_to(const OrientedPoint& p) const {
    const double n = static_cast<double>(count_);
    const double dx = static_cast<double>(p.x) - x0_ - x_ / n;
    const double dy = static_cast<double>(p.y) - y0_ - y_ / n;
    const double phi = angle();
    return std::abs(std::cos(phi) * dy - std::sin(phi) * dx);
  }

 private:
  double scatter_xx() const { return xx_ - x_ * x_ / static_cast<double>(count_); }
  double scatter_xy() const { return xy_ - x_ * y_ / static_cast<double>(count_); }
  double scatter_yy() const { return yy_ - y_ * y_ / static_cast<double>(count_); }
  double root() const {
    const double half = 0.5 * (scatter_xx() - scatter_yy());
    return std::sqrt(half * half + scatter_xy() * scatter_xy());
  }

  double x0_, y0_;
  double x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
  double last_x_ = 0.0, last_y_ = 0.0;
  std::size_t count_ = 0;
};

struct Vote {
  double angle;   ///< within a quarter turn
  double length;  ///< [m]
  double weight;  ///< 1 / variance of the angle
};

std::vector<Vote> votes_of(const Cloud& cloud) {
  std::vector<Vote> votes;
  const std::vector<OrientedPoint>& points = cloud.points;
  std::size_t i = 0;
  while (i + kLeastLinePoints <= points.size() && votes.size() < kMostLines) {
    GrowingLine line(points[i]);
    std::size_t next = i + 1;
    for (; next < points.size(); ++next) {
      const OrientedPoint& p = points[next];
      const double range =
          std::hypot(static_cast<double>(p.x) - cloud.laser.x, static_cast<double>(p.y) - cloud.laser.y);
      if (line.gap_to(p) > std::max(kLineGap, kLineGapShare * range)) break;
      if (line.count() >= 3 && line.distance_to(p) > kOffLine) break;
      line.add(p);
    }
    const double count = static_cast<double>(line.count());
    if (line.count() >= kLeastLinePoints && line.length() >= kLeastLine &&
        line.across() < count * kStraight * kStraight) {
      const double variance = kPointSigma * kPointSigma / line.along() + kWallSigma * kWallSigma;
      votes.push_back({wrap_quarter(line.angle()), line.length(), 1.0 / variance});
    }
    i = std::max(i + 1, next - 1);
  }
  return votes;
}

}  // namespace

double wrap_quarter(double angle) {
  angle = std::remainder(angle, 0.5 * kPi);
  return angle <= -0.25 * kPi ? angle + 0.5 * kPi : angle;
}

std::optional<WallDirection> wall_direction(const Cloud& cloud) {
  const std::vector<Vote> votes = votes_of(cloud);
  double all = 0.0;
  for (const Vote& vote : votes) all += vote.length;
  double most = 0.0;
  WallDirection direction;
  for (const Vote& middle : votes) {
    double length = 0.0, weight = 0.0, sum = 0.0;
    for (const Vote& vote : votes) {
      const double off = wrap_quarter(vote.angle - middle.angle);
      if (std::abs(off) > kParallel) continue;
      length += vote.length;
      weight += vote.weight;
      sum += vote.weight * off;
    }
    if (length <= most) continue;
    most = length;
    direction = {wrap_quarter(middle.angle + sum / weight), 1.0 / std::sqrt(weight)};
  }
  if (most < kLeastVotes || most < kMajority * all) return std::nullopt;
  return direction;
}

}  // namespace rubble::slam
