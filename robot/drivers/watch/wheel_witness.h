#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "robot/commands.h"
#include "robot/drivers/watch/scan_motion.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// Holds what wheels report against what scans show, where it can be told: a base is told to go some way, its reports
/// say that its wheels stand, by their places or by their speeds, and scans show that it moves. Then its encoders are
/// dead, or its reports frozen, and whoever drives by them drives blind.
///
/// Wheels that turn while the robot stays (slip), that stand with the robot (blocked, stalled, unpowered), and a robot
/// that is pushed or carried while it is told to stand, are none of it: its wheels deny nothing that scans show.
class WheelWitness {
 public:
  /// `T_base_laser`: where the scanner sits on the robot.
  explicit WheelWitness(const mrpt::math::TPose2D& T_base_laser) : T_base_laser_(T_base_laser) {}

  /// What it is told does not reach it, or its motors are off.
  void pause();
  /// It is told to do `told`, with a ramp of so much [m/s^2], [rad/s^2]. To be called about fifty times a second.
  void tell(const Drive& told, const Drive& ramp, Stamp now);
  /// A report that came at `now`.
  void look(const Odometry& odometry, Stamp now);
  /// A scan that came at `now`. One in several is compared, and only while the wheels deny what they are told.
  void see(const LaserScan& scan, Stamp now);

  /// What the wheels deny, in words; empty: nothing. Stays until pause().
  const std::string& denial() const { return denial_; }

 private:
  /// What happened since the scan that the next one is compared with.
  struct Since {
    Since(const LaserScan& first, Stamp now) : scan(first), when(now) {}
    LaserScan scan;
    Stamp when;
    Drive told;             ///< so far it was told to go, there and back cancelling out [m], [rad]
    Drive gone;             ///< so far its wheels went, by their places
    double fastest = 0.0;   ///< of its wheels, by their speeds [m/s]
    double quickest = 0.0;  ///< the same [rad/s]
    int reports = 0;
  };

  void start(const LaserScan& scan, Stamp now);
  void judge(const Since& since, const LaserScan& scan, Stamp now);

  mrpt::math::TPose2D T_base_laser_;
  std::optional<Since> since_;
  Drive expected_;                ///< what the base does by now
  Stamp told_ = Stamp::never();   ///< last
  std::optional<Odometry> last_;  ///< report
  Stamp looked_ = Stamp::never();
  bool tells_speeds_ = false;  ///< some drivers of bases know none
  int denied_ = 0;             ///< so many times in a row
  std::string denial_;
};

}  // namespace rubble::robot
