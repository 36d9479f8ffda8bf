#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/rng.h"
#include "base/trajectory.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/grid/count_map.h"

namespace rubble::slam_test {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

struct Segment {
  TPoint2D a, b;
};
using World = std::vector<Segment>;

/// Adds the four sides of an axis-parallel box.
inline void add_box(World& world, double x0, double y0, double x1, double y1) {
  world.push_back({{x0, y0}, {x1, y0}});
  world.push_back({{x1, y0}, {x1, y1}});
  world.push_back({{x1, y1}, {x0, y1}});
  world.push_back({{x0, y1}, {x0, y0}});
}

/// A room of 6 x 4 m around the origin with two boxes and a thin post: features in all directions.
inline World furnished_room() {
  World world;
  add_box(world, -2.0, -1.5, 4.0, 2.5);
  add_box(world, 2.2, 1.2, 2.8, 1.7);
  add_box(world, -1.2, 1.0, -0.8, 1.9);
  add_box(world, 1.5, -1.1, 1.6, -1.0);
  return world;
}

/// Distance to the nearest segment along a ray; infinite when there is none.
inline double cast(const World& world, const TPoint2D& from, double bearing) {
  const double dx = std::cos(bearing);
  const double dy = std::sin(bearing);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& s : world) {
    const double ex = s.b.x - s.a.x;
    const double ey = s.b.y - s.a.y;
    const double det = dx * ey - dy * ex;
    if (std::abs(det) < 1e-12) continue;
    const double ax = s.a.x - from.x;
    const double ay = s.a.y - from.y;
    const double range = (ax * ey - ay * ex) / det;
    const double u = (ax * dy - ay * dx) / det;
    if (range > 0.0 && u >= 0.0 && u <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// One scan of `model`'s laser taken at T_world_base as an instant, with Gaussian range noise of `sigma` [m].
inline robot::LaserScan scan_at(const World& world, const TPose2D& T_world_base, const robot::RobotModel& model,
                                Stamp stamp, double sigma, Rng& noise) {
  const robot::LaserModel& laser = model.laser;
  robot::LaserScan scan;
  scan.stamp = stamp;
  robot::set_geometry(scan, laser);
  scan.beam_period = 0.0;
  const TPose2D T_base_laser{model.T_base_laser.x, model.T_base_laser.y, model.T_base_laser.yaw};
  const TPose2D T_world_laser = T_world_base + T_base_laser;
  for (int beam = 0; beam < laser.beams; ++beam) {
    const double bearing = T_world_laser.phi + scan.bearing(static_cast<std::size_t>(beam));
    const double error = noise.gaussian(sigma);
    const double range = cast(world, {T_world_laser.x, T_world_laser.y}, bearing) + error;
    scan.ranges.push_back(range <= laser.range_max ? static_cast<float>(range)
                                                   : std::numeric_limits<float>::infinity());
  }
  return scan;
}

/// A drive sampled every `tick` seconds.
struct Drive {
  Trajectory truth;
  double tick = 0.1;
};

/// Drives straight from point to point at 0.3 m/s and turns on the spot in between, by default at 45 deg/s.
inline Drive drive_through(const std::vector<TPoint2D>& points, double heading, double turn_rate = deg_to_rad(45.0)) {
  Drive drive;
  TPose2D pose{points.front().x, points.front().y, heading};
  std::int64_t step = 0;
  const auto keep = [&] { drive.truth.push_back({Stamp{step++ * 100000000}, pose}); };
  keep();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double bearing = std::atan2(points[i].y - pose.y, points[i].x - pose.x);
    const double turn = wrap_angle(bearing - pose.phi);
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / (turn_rate * 0.1)));
    for (int k = 0; k < turns; ++k) {
      pose.phi = wrap_angle(pose.phi + turn / turns);
      keep();
    }
    const TPose2D from = pose;
    const double length = std::hypot(points[i].x - from.x, points[i].y - from.y);
    const int pieces = static_cast<int>(std::ceil(length / 0.03));
    for (int k = 1; k <= pieces; ++k) {
      pose.x = from.x + (points[i].x - from.x) * k / pieces;
      pose.y = from.y + (points[i].y - from.y) * k / pieces;
      keep();
    }
  }
  return drive;
}

/// The same drive, sampled every `tick` seconds.
inline Drive finer(const Drive& drive, double tick) {
  Drive out;
  out.tick = tick;
  const Stamp first = drive.truth.front().stamp;
  const auto n = static_cast<std::int64_t>((drive.truth.back().stamp - first) / tick + 1e-6);
  for (std::int64_t i = 0; i <= n; ++i) {
    const Stamp stamp{first.ns + i * std::llround(tick * 1e9)};
    out.truth.push_back({stamp, *pose_at(drive.truth, stamp)});
  }
  return out;
}

/// Odometry with the three errors of the paper, each draw held for half a metre or one radian: drawn at every step they
/// would average out.
inline std::vector<robot::Odometry> noisy_odometry(const Trajectory& truth, double share, Rng& rng) {
  std::vector<robot::Odometry> odometry;
  TPose2D pose;
  double scale = 1.0, heading_per_m = 0.0, turn_scale = 1.0;
  double since = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) {
      const TPose2D step = truth[i].pose - truth[i - 1].pose;
      const double distance = std::hypot(step.x, step.y);
      since += distance / 0.5 + std::abs(step.phi);
      if (since > 1.0) {
        since = 0.0;
        scale = 1.0 + rng.gaussian(0.15 * share);
        heading_per_m = rng.gaussian(deg_to_rad(5.0) * share);
        turn_scale = 1.0 + rng.gaussian(0.05 * share);
      }
      pose = pose + TPose2D{scale * step.x, scale * step.y, turn_scale * step.phi + heading_per_m * distance};
    }
    odometry.push_back({truth[i].stamp, pose, 0.0, 0.0, false});
  }
  return odometry;
}

/// Plays a drive as ticks of inputs: one odometry and one scan each.
inline std::vector<robot::Inputs> record(const World& world, const Drive& drive, const robot::RobotModel& model,
                                         double odometry_error, double range_sigma, std::uint64_t seed) {
  Rng odometry_rng(seed, "odometry");
  Rng scan_rng(seed, "scan");
  const std::vector<robot::Odometry> odometry = noisy_odometry(drive.truth, odometry_error, odometry_rng);
  std::vector<robot::Inputs> ticks;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    robot::Inputs inputs;
    inputs.now = drive.truth[i].stamp;
    inputs.odometry.push_back(odometry[i]);
    inputs.scans.push_back(scan_at(world, drive.truth[i].pose, model, inputs.now, range_sigma, scan_rng));
    ticks.push_back(std::move(inputs));
  }
  return ticks;
}

/// The same with a laser that takes `sweep` seconds for a scan: beams leave one after the other while the base moves,
/// and a scan arrives with the tick after its last beam.
inline std::vector<robot::Inputs> record_sweeping(const World& world, const Drive& drive,
                                                  const robot::RobotModel& model, double odometry_error,
                                                  double range_sigma, double sweep, std::uint64_t seed) {
  std::vector<robot::Inputs> ticks = record(world, drive, model, odometry_error, range_sigma, seed);
  Rng noise(seed, "sweep");
  const TPose2D T_base_laser{model.T_base_laser.x, model.T_base_laser.y, model.T_base_laser.yaw};
  for (std::size_t i = ticks.size() - 1; i > 0; --i) {
    robot::LaserScan scan = ticks[i - 1].scans.front();
    scan.beam_period = sweep / static_cast<double>(scan.ranges.size());
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
      const auto base = pose_at(drive.truth, scan.beam_stamp(beam));
      const TPose2D laser = *base + T_base_laser;
      const double range =
          cast(world, {laser.x, laser.y}, laser.phi + scan.bearing(beam)) + noise.gaussian(range_sigma);
      scan.ranges[beam] = range <= scan.range_max ? static_cast<float>(range) : std::numeric_limits<float>::infinity();
    }
    ticks[i].scans.front() = std::move(scan);
  }
  ticks.front().scans.clear();
  return ticks;
}

/// Root mean square position error with the first poses laid on each other [m].
inline double first_pose_rmse(const Trajectory& estimate, const Trajectory& truth) {
  double sum = 0.0;
  std::size_t n = 0;
  const TPose2D T_truth_first = truth.front().pose;
  for (const StampedPose& e : estimate) {
    const auto t = pose_at(truth, e.stamp);
    if (!t) continue;
    const TPose2D relative = *t - T_truth_first;
    sum += std::pow(relative.x - e.pose.x, 2) + std::pow(relative.y - e.pose.y, 2);
    ++n;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, n)));
}

/// p_occ of all cells in 1/255, row by row.
inline std::vector<std::uint8_t> p_occ_of(const slam::CountMap& map) {
  std::vector<std::uint8_t> plane;
  plane.reserve(map.frame().size());
  for (int y = 0; y < map.frame().height; ++y)
    for (int x = 0; x < map.frame().width; ++x) plane.push_back(map.p_occ_255({x, y}));
  return plane;
}

}  // namespace rubble::slam_test
