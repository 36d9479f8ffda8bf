#include "slam/calibration/laser_motions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.h"
#include "base/planar.h"
#include "slam/robust/matching/cloud.h"
#include "slam/robust/matching/scan_fit.h"
#include "slam/robust/matching/surfel_grid.h"
#include "slam/scan/level_scan.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kLongestGap = 0.5;  ///< between reports of the wheels; what happened in longer ones is not known [s]
constexpr CloudConfig kFine{0.03, 0.05};
constexpr double kSurfel = 0.06;        ///< [m]
constexpr double kPriorDistance = 0.1;  ///< how far the wheels may be wrong from scan to scan [m] ...
constexpr double kPriorTurn = 0.1;      ///< [rad]; both only matter where the scan leaves a direction open

/// The laser's way by the wheels.
class LaserTrack {
 public:
  LaserTrack(const WheelTrack& wheels, const RobotSetup& setup) : wheels_(wheels), setup_(setup) {}

  bool knows(const robot::LaserScan& scan) const {
    const Stamp first = scan.stamp - setup_.delay;
    const Stamp last = std::max(scan.stamp, scan.beam_stamp(scan.ranges.size())) - setup_.delay;
    return wheels_.covers(first) && wheels_.covers(last) && wheels_.gap_at(first) <= kLongestGap;
  }
  TPose2D pose(Stamp stamp) const { return wheels_.pose_at(stamp - setup_.delay) + setup_.T_base_laser; }
  TPose2D between(Stamp from, Stamp to) const { return pose(to) - pose(from); }
  SweepMotion sweep(const robot::LaserScan& scan) const {
    return {between(scan.middle(), scan.stamp), between(scan.middle(), scan.beam_stamp(scan.ranges.size() - 1))};
  }

 private:
  const WheelTrack& wheels_;
  const RobotSetup& setup_;
};

/// Points of a scan in the laser's frame at its middle.
std::vector<OrientedPoint> points_of(const robot::LaserScan& scan, const LaserTrack& track) {
  LevelScan level(mrpt::math::TPose3D{}, LevelScanConfig{});
  const SweepMotion motion = track.sweep(scan);
  return cloud_of(level.points(scan, &motion), kFine).points;
}

/// The first scan of a stretch, to be matched with.
class Target {
 public:
  explicit Target(const std::vector<OrientedPoint>& points) {
    TPoint2D low(0.0, 0.0);
    TPoint2D high(0.0, 0.0);
    for (const OrientedPoint& p : points) {
      low = {std::min(low.x, static_cast<double>(p.x)), std::min(low.y, static_cast<double>(p.y))};
      high = {std::max(high.x, static_cast<double>(p.x)), std::max(high.y, static_cast<double>(p.y))};
    }
    surfels_.begin(kSurfel, low, high);
    surfels_.add(points, TPose2D{});
    surfels_.finish();
  }

  ScanFit fit(const std::vector<OrientedPoint>& points, const TPose2D& foretold) const {
    PosePrior prior{foretold, Eigen::Matrix3d::Zero()};
    prior.information.diagonal() << 1.0 / (kPriorDistance * kPriorDistance), 1.0 / (kPriorDistance * kPriorDistance),
        1.0 / (kPriorTurn * kPriorTurn);
    ScanFitConfig config;
    config.first_radius = 0.2;
    config.last_radius = 0.08;
    config.iterations = 20;
    return fit_scan(surfels_, points, foretold, prior, config);
  }

 private:
  SurfelGrid surfels_;
};

}  // namespace

std::vector<LaserStretch> laser_motions(const std::vector<robot::LaserScan>& scans, WheelTrack& wheels,
                                        const RobotSetup& setup, const LaserMotionsConfig& config) {
  wheels.scale(setup.distance_scale, setup.turn_scale);
  const LaserTrack track(wheels, setup);
  std::vector<LaserStretch> stretches;
  std::optional<Target> target;
  Stamp last = Stamp::never();
  TPose2D T_first_last;
  const auto begin = [&](const robot::LaserScan& scan, const std::vector<OrientedPoint>& points) {
    target.emplace(points);
    stretches.push_back({scan.middle(), {}});
    last = scan.middle();
    T_first_last = {};
  };
  for (const robot::LaserScan& scan : scans) {
    if (scan.ranges.size() < 2 || !track.knows(scan)) {
      target.reset();
      continue;
    }
    const std::vector<OrientedPoint> points = points_of(scan, track);
    if (static_cast<int>(points.size()) < config.least_points) {
      target.reset();
      continue;
    }
    if (!target) {
      begin(scan, points);
      continue;
    }
    const TPose2D foretold = T_first_last + track.between(last, scan.middle());
    const TPose2D driven = wheels.between(stretches.back().first - setup.delay, scan.middle() - setup.delay);
    const bool arc = length(driven.x, driven.y) > config.arc_way && std::abs(driven.phi) > config.arc_turn;
    const ScanFit fit = target->fit(points, foretold);
    if (fit.inliers < config.least_inliers) {
      begin(scan, points);
      continue;
    }
    if (!arc) stretches.back().scans.push_back({scan.middle(), fit.pose, fit.information});
    last = scan.middle();
    T_first_last = fit.pose;
    // The last scan of a stretch begins the next one, so that no motion is lost in between.
    if (std::abs(fit.pose.phi) > config.longest_turn || length(fit.pose.x, fit.pose.y) > config.longest_way)
      begin(scan, points);
  }
  return stretches;
}

}  // namespace rubble::slam
