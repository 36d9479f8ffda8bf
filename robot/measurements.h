#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/stamp.h"
#include "robot/commands.h"

namespace rubble::robot {

/// One revolution of a 2D laser scanner, counter-clockwise. Beam i leaves at stamp + i * beam_period
/// with bearing angle_min + i * angle_step in the laser frame.
struct LaserScan {
  static constexpr float kMiss = std::numeric_limits<float>::infinity();
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  Stamp stamp;                ///< of beam 0; sweeps that run clockwise end with it
  double angle_min = 0.0;     ///< bearing of beam 0 [rad]
  double angle_step = 0.0;    ///< [rad], > 0
  double beam_period = 0.0;   ///< time between two beams [s]; 0: unknown or all at once; < 0: beam 0 was the last
  double range_min = 0.0;     ///< [m]
  double range_max = 0.0;     ///< [m]
  std::vector<float> ranges;  ///< [m]; kMiss: nothing in range, kUnknown: no measurement
  /// The scanner's own code of each beam, 0 where it gave a range or saw nothing up to its greatest distance (URG-04LX:
  /// 1..19, see docs/hardware.md); empty: the scanner has none. A miss whose code is 0 came without any echo, which a
  /// dark or grazing surface close by can be too.
  std::vector<std::uint8_t> codes;

  double bearing(std::size_t beam) const { return angle_min + static_cast<double>(beam) * angle_step; }
  Stamp beam_stamp(std::size_t beam) const { return stamp + static_cast<double>(beam) * beam_period; }
  /// The middle of the sweep: the reference time of the scan as a whole.
  Stamp middle() const { return ranges.empty() ? stamp : beam_stamp(ranges.size() / 2); }
};

/// Dead reckoning by the robot's firmware, in its own frame that starts at zero.
struct Odometry {
  Stamp stamp;
  mrpt::math::TPose2D pose;  ///< T_odom_base [m, rad]
  double v = 0.0;            ///< forward speed [m/s], of the wheels
  double w = 0.0;            ///< turn rate [rad/s], of the wheels
  bool stalled = false;      ///< the motors push without moving
};

/// What the two-axis accelerometer feels: specific force, not tilt (gravity and motion together).
/// At rest x = g sin(nose-up pitch), y = g sin(roll, left side up) cos(pitch), as in `levelling`.
struct Acceleration {
  Stamp stamp;
  double x = 0.0;  ///< along the sensor's forward axis [m/s^2]
  double y = 0.0;  ///< along the sensor's left axis [m/s^2]
};

/// Angles at which the two servos hold the laser relative to the robot (the pulses being output).
struct AimState {
  Stamp stamp;
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

enum class CueKind : std::uint8_t { Appearance = 0, Heat = 1, Sound = 2, Co2 = 3 };

/// A victim sensor reports something that may be a victim.
struct VictimCue {
  Stamp stamp;
  CueKind kind = CueKind::Appearance;
  double bearing = 0.0;     ///< in the base frame [rad]
  double range = 0.0;       ///< from the base origin, along the floor [m]
  double confidence = 1.0;  ///< 0..1
};

/// What a base tells of its battery.
struct BatteryState {
  double volts = 0.0;
  double low = 0.0;  ///< below it the robot's own battery is low; 0: nobody says so [V]
  bool operator==(const BatteryState& other) const { return volts == other.volts && low == other.low; }
};

/// Everything that arrived during one tick; each list is sorted by stamp.
/// A stamp may lie before the tick (transport latency), never after `now`.
struct Inputs {
  Stamp now;  ///< end of the tick
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
  std::vector<Acceleration> accelerations;
  std::vector<AimState> aims;
  std::vector<VictimCue> cues;
  std::optional<BatteryState> battery;  ///< where it was told in the tick
  /// In force during the tick: what the motors and servos were last told before it. Nothing: not known (foreign logs).
  std::optional<Commands> command;
};

}  // namespace rubble::robot
