#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "robot/measurements.h"
#include "slam/calibration/robot_setup.h"
#include "tests/support/slam_world.h"

namespace rubble::slam_test {

/// What a recording is made of, besides the truth that is planted.
struct RecordingPlan {
  slam::RobotSetup truth;      ///< planted
  double range_sigma = 0.008;  ///< [m]
  double slip = 0.005;         ///< relative error of each step of the wheels
  double turn_to = 2.0 * kPi;  ///< of the turns on the spot; 0: none
  double side = 0.8;           ///< of the squares [m]
  int squares = 2;             ///< the second the other way round
  double seconds = 1e9;        ///< cut off then
  double zero_pitch = 0.0;     ///< planted [rad]
  double zero_roll = 0.0;
  double slope = 0.0;  ///< of the floor, rising along the world's x [rad]
  std::uint64_t seed = 1;
};

/// The true way of a robot that drives squares and turns with trapezoids of speed, every millisecond from time 0 on.
inline std::vector<TPose2D> calibration_way(const RecordingPlan& plan) {
  std::vector<TPose2D> way{TPose2D{}};
  const auto stand = [&](double seconds) {
    way.insert(way.end(), static_cast<std::size_t>(1e3 * seconds), way.back());
  };
  // A leg of `length` [m or rad] with its own greatest speed and acceleration.
  const auto leg = [&](double length, double speed, double accel, bool turn) {
    const double sign = length < 0.0 ? -1.0 : 1.0;
    double done = 0.0;
    double v = 0.0;
    while (done < std::abs(length)) {
      const double braking = std::sqrt(2.0 * accel * (std::abs(length) - done));
      v = std::min({v + 1e-3 * accel, speed, std::max(braking, 1e-3)});
      done += 1e-3 * v;
      const double step = 1e-3 * v * sign;
      way.push_back(way.back() + (turn ? TPose2D{0.0, 0.0, step} : TPose2D{step, 0.0, 0.0}));
    }
    stand(1.0);
  };
  stand(1.5);
  for (int square = 0; square < plan.squares; ++square) {
    const double way_round = square % 2 == 0 ? 1.0 : -1.0;
    for (int corner = 0; corner < 4; ++corner) {
      if (plan.side > 0.0) leg(plan.side, 0.25, 0.3, false);
      if (plan.turn_to > 0.0) leg(way_round * 0.5 * kPi, 0.7, 1.7, true);
    }
    if (plan.turn_to > 0.0) leg(way_round * plan.turn_to, 0.7, 1.7, true);
  }
  if (1e3 * plan.seconds < static_cast<double>(way.size())) way.resize(static_cast<std::size_t>(1e3 * plan.seconds));
  return way;
}

/// The recording of that drive in a world around the origin: sweeping scans ten times a second under wrong stamps,
/// wheels that count wrong, an accelerometer with a wrong zero. An empty world: empty scans.
inline std::vector<robot::Inputs> calibration_recording(const World& world, const RecordingPlan& plan) {
  const std::vector<TPose2D> way = calibration_way(plan);
  const auto at = [&](double t) {
    const double ms = std::clamp(1e3 * t, 0.0, static_cast<double>(way.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(ms), way.size() - 2);
    return interpolate(way[i], way[i + 1], ms - static_cast<double>(i));
  };
  Rng noise(plan.seed, "scan");
  Rng slip(plan.seed, "slip");
  Rng feel(plan.seed, "feel");
  const robot::LaserModel laser;
  const double end = 1e-3 * static_cast<double>(way.size());
  TPose2D recorded;
  double last_report = 0.0;
  std::vector<robot::Inputs> ticks;
  for (double t = 0.1; t < end - 0.2; t += 0.1) {
    robot::Inputs tick;
    tick.now = Stamp::from_seconds(t + 0.1);

    const double reported = t + 0.033;  // the wheels' cycle is not the scanner's
    const TPose2D step = at(reported) - at(last_report);
    last_report = reported;
    const double s = (1.0 + slip.gaussian(plan.slip)) / plan.truth.distance_scale;
    const double u = (1.0 + slip.gaussian(plan.slip)) / plan.truth.turn_scale;
    recorded = recorded + TPose2D{s * step.x, s * step.y, u * step.phi};
    tick.odometry.push_back({Stamp::from_seconds(reported), recorded, 0.0, 0.0, false});

    robot::LaserScan scan;
    scan.stamp = Stamp::from_seconds(t) + plan.truth.delay;
    robot::set_geometry(scan, laser);
    for (int beam = 0; !world.empty() && beam < laser.beams; ++beam) {
      const auto i = static_cast<std::size_t>(beam);
      const TPose2D T_world_laser = at(t + beam * laser.beam_period) + plan.truth.T_base_laser;
      const double error = noise.gaussian(plan.range_sigma);
      const double range = cast(world, {T_world_laser.x, T_world_laser.y}, T_world_laser.phi + scan.bearing(i)) + error;
      scan.ranges.push_back(range <= laser.range_max ? static_cast<float>(0.001 * std::round(1e3 * range))
                                                     : std::numeric_limits<float>::infinity());
    }
    tick.scans.push_back(std::move(scan));

    for (int k = 0; k < 5; ++k) {
      const double felt = t + 0.02 * k;
      const double heading = at(felt).phi;
      const double g = 9.80665;
      const double x = feel.gaussian(4e-3);
      const double y = feel.gaussian(4e-3);
      tick.accelerations.push_back({Stamp::from_seconds(felt),
                                    g * (std::sin(plan.zero_pitch + plan.slope * std::cos(heading)) + x),
                                    g * (std::sin(plan.zero_roll - plan.slope * std::sin(heading)) + y)});
    }
    ticks.push_back(std::move(tick));
  }
  return ticks;
}

}  // namespace rubble::slam_test
