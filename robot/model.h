#pragma once

#include <mrpt/math/TPose3D.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// A scanner's geometry and timing.
struct LaserModel {
  std::string name = "URG-04LX";
  int beams = 682;                                     ///< steps 44..725
  double angle_step = 2.0 * kPi / 1024.0;              ///< [rad]
  double angle_min = (44 - 384) * 2.0 * kPi / 1024.0;  ///< bearing of beam 0 [rad]
  double range_min = 0.02;                             ///< [m]
  double range_max = 4.0;                              ///< [m]
  double scan_period = 0.1;                            ///< one revolution [s]
  double beam_period = 0.1 / 1024.0;                   ///< 97.656 us [s]
  // Only the simulator asks for what follows. The data sheet's accuracy: a range is off by at most so much.
  double accuracy_near = 0.01;       ///< below accuracy_near_to [m]
  double accuracy_near_to = 1.0;     ///< [m]
  double accuracy_far = 0.0;         ///< beyond: accuracy_far + accuracy_far_share * range [m]
  double accuracy_far_share = 0.01;  ///< share of the range
  bool has_codes = true;             ///< it says of a beam without a range why there is none

  /// Angle between the first and the last beam [rad].
  double field_of_view() const { return (beams - 1) * angle_step; }
};

/// Name of the scanner that has nothing usual: its numbers are the user's.
constexpr const char* kGenericLaser = "generic";

/// The scanners known by name, the default first: URG-04LX, UTM-30LX, generic.
const std::vector<std::string>& laser_names();

/// The scanner of that name, the default for one that is not among laser_names() (a log's).
LaserModel laser_model(const std::string& name);

/// Where and when the beams of a scan of this scanner leave, and how far they reach.
void set_geometry(LaserScan& scan, const LaserModel& laser);

/// Spreads the beams over `field_of_view` [deg], symmetrically about the front, and over `sweep` [s].
void spread_beams(LaserModel& laser, double field_of_view_deg, double sweep);

/// Where the accelerometer sits: on the levelled platform (closed loop) or on the robot's body (open loop).
enum class AccelerometerMount { Platform, Body };

/// "platform", "body": as files call them, in the order of AccelerometerMount.
inline const std::vector<std::string>& mount_names() {
  static const std::vector<std::string> names = {"platform", "body"};
  return names;
}

/// What the core knows about the robot it drives: the same for the simulated and the real one.
/// Defaults: Pioneer 3-AT with a servo-levelled URG-04LX.
struct RobotModel {
  std::string name = "p3at";
  double length = 0.508;             ///< body [m] (data sheet)
  double width = 0.497;              ///< body with wheels [m]
  double wheel_radius = 0.111;       ///< [m]
  double wheelbase = 0.268;          ///< front to rear axle [m]
  double track = 0.394;              ///< left to right wheel [m]
  double effective_track = 0.588;    ///< what the firmware divides by: 2 / 0.0034 mm, skid steer on hard floor [m]
  double ground_clearance = 0.065;   ///< [m]
  double climbable_step = 0.10;      ///< [m] (data sheet)
  double mass = 14.0;                ///< with lidar and laptop [kg]
  double max_v = 0.7;                ///< [m/s]
  double max_w = deg_to_rad(100.0);  ///< [rad/s]
  double max_accel = 0.3;            ///< [m/s^2]
  double max_turn_accel = deg_to_rad(100.0);  ///< [rad/s^2]
  double command_timeout = 2.0;               ///< the watchdog stops the motors after this silence [s]
  double odometry_period = 0.1;               ///< [s]
  double acceleration_period = 0.02;          ///< [s]
  double tick = 0.02;                         ///< Robot::read covers this much time [s]
  bool has_levelling_unit = true;
  AccelerometerMount accelerometer_mount = AccelerometerMount::Platform;
  double max_aim = deg_to_rad(30.0);  ///< servo travel either way [rad]
  /// Where the laser sits: T_base_laser with servos at zero. Base: ground point below the turn centre, x forward, z up.
  mrpt::math::TPose3D T_base_laser{0.145, 0.0, 0.35, 0.0, 0.0, 0.0};
  LaserModel laser;

  /// Radius of the circle around the base origin that holds the body while it turns on the spot [m].
  double swing_radius() const { return 0.5 * std::sqrt(length * length + width * width); }
};

}  // namespace rubble::robot
