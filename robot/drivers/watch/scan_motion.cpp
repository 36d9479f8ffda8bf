#include "robot/drivers/watch/scan_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.h"

namespace rubble::robot {
namespace {

constexpr std::size_t kPoints = 128;                              ///< of a scan are enough
constexpr std::size_t kFewest = 24;                               ///< fewer tell nothing
constexpr double kNear = 0.03;                                    ///< so far off is where it should be [m] ...
constexpr double kNearShare = 0.02;                               ///< ... and by so much of the range
constexpr double kFarthest = 0.7;                                 ///< [m]
constexpr double kWidest = deg_to_rad(66.0);                      ///< [rad]
constexpr double kStepAhead = 0.08, kStepTurn = deg_to_rad(4.0);  ///< of the first search
constexpr double kSeen = 0.1, kSeenTurn = deg_to_rad(8.0);        ///< less is not told from rest
constexpr double kExplains = 0.55;                                ///< share of the points
constexpr double kBetter = 0.15;  ///< than the other explanation, by so much of the points

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

std::vector<TPoint2D> points_of(const LaserScan& scan, const TPose2D& T_base_laser) {
  std::vector<TPoint2D> points;
  if (!(scan.angle_step > 0.0)) return points;
  const std::size_t step = std::max<std::size_t>(1, scan.ranges.size() / kPoints);
  for (std::size_t i = 0; i < scan.ranges.size(); i += step) {
    const double range = scan.ranges[i];
    if (!std::isfinite(range) || range < scan.range_min) continue;
    const double bearing = scan.bearing(i);
    points.push_back(T_base_laser.composePoint({range * std::cos(bearing), range * std::sin(bearing)}));
  }
  return points;
}

/// Share of the points (of the base where it was) that `after` has, had the base moved so; of those that it could have.
double fit_of(const std::vector<TPoint2D>& points, const LaserScan& after, const TPose2D& T_base_laser,
              const TPose2D& T_before_after) {
  const TPose2D laser = T_before_after + T_base_laser;
  const double c = std::cos(laser.phi), s = std::sin(laser.phi);
  const double last = static_cast<double>(after.ranges.size()) - 1.0;
  std::size_t asked = 0, found = 0;
  for (const TPoint2D& p : points) {
    const double dx = p.x - laser.x, dy = p.y - laser.y;
    const double x = c * dx + s * dy, y = -s * dx + c * dy;
    const double beam =
        std::round(wrap_angle(std::atan2(y, x) - after.angle_min - kPi) / after.angle_step + kPi / after.angle_step);
    if (beam < 1.0 || beam > last - 1.0) continue;
    const double range = std::hypot(x, y);
    if (after.range_max > 0.0 && range > 0.97 * after.range_max) continue;
    const auto middle = static_cast<std::size_t>(beam);
    bool known = false, near = false;
    for (std::size_t i = middle - 1; i <= middle + 1; ++i) {
      const double there = after.ranges[i];
      if (std::isnan(there)) continue;
      known = true;
      near = near || std::abs(there - range) < kNear + kNearShare * range;
    }
    asked += known ? 1 : 0;
    found += near ? 1 : 0;
  }
  return asked < kFewest ? 0.0 : static_cast<double>(found) / static_cast<double>(asked);
}

/// The same of an arc that begins `aside` from ahead [rad].
double fit_of(const std::vector<TPoint2D>& points, const LaserScan& after, const TPose2D& T_base_laser, double way,
              double turn, double aside = 0.0) {
  const double direction = aside + 0.5 * turn;
  return fit_of(points, after, T_base_laser, {way * std::cos(direction), way * std::sin(direction), turn});
}

}  // namespace

bool ScanMotion::moved() const {
  return (std::abs(ahead) >= kSeen || std::abs(turn) >= kSeenTurn) && fit >= kExplains && fit >= still + kBetter;
}

bool ScanMotion::stood() const { return still >= kExplains && still > fit - 0.5 * kBetter; }

ScanMotion motion_between(const LaserScan& before, const LaserScan& after, const TPose2D& T_base_laser) {
  const std::vector<TPoint2D> points = points_of(before, T_base_laser);
  ScanMotion best;
  best.still = best.fit = fit_of(points, after, T_base_laser, 0.0, 0.0);
  const auto search = [&](double ahead, double turn, double step_ahead, double step_turn, int most_ahead,
                          int most_turn) {
    for (int i = -most_ahead; i <= most_ahead; ++i) {
      for (int j = -most_turn; j <= most_turn; ++j) {
        const double a = ahead + i * step_ahead, t = turn + j * step_turn;
        const double fit = fit_of(points, after, T_base_laser, a, t);
        if (fit <= best.fit) continue;
        best.ahead = a;
        best.turn = t;
        best.fit = fit;
      }
    }
  };
  search(0.0, 0.0, kStepAhead, kStepTurn, static_cast<int>(kFarthest / kStepAhead),
         static_cast<int>(kWidest / kStepTurn));
  for (double part = 0.5; part > 0.2; part *= 0.5)
    search(best.ahead, best.turn, part * kStepAhead, part * kStepTurn, 1, 1);
  return best;
}

ScanWay way_between(const LaserScan& before, const LaserScan& after, const TPose2D& T_base_laser, double turn,
                    bool backwards) {
  constexpr int kWays = 24;   // 15 deg apart
  constexpr int kAsTold = 2;  // so many to either side are the way that wheels say still: 30 deg
  constexpr int kTurnsAsTold = 6;
  constexpr double kStepWay = 0.06, kStepHeading = deg_to_rad(3.0);
  const std::vector<TPoint2D> points = points_of(before, T_base_laser);
  ScanWay best;
  for (int i = 0; i < kWays; ++i) {
    const double aside = wrap_angle(2.0 * kPi * i / kWays);
    const double direction = wrap_angle(aside + (backwards ? kPi : 0.0));
    const bool as_told = std::min(i, kWays - i) <= kAsTold;
    for (double way = as_told ? 0.0 : kSeen; way <= kFarthest; way += kStepWay) {
      const int turns = as_told ? kTurnsAsTold : 2;  // wheels that slip tell another turn
      for (int j = -turns; j <= turns; ++j) {
        const double fit = fit_of(points, after, T_base_laser, way, turn + j * kStepHeading, direction);
        if (as_told) best.as_told = std::max(best.as_told, fit);
        if (fit > best.fit) best = {way, aside, fit, best.as_told};
      }
    }
  }
  return best;
}

}  // namespace rubble::robot
