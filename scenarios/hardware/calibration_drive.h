#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <vector>

#include "robot/commands.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::scenarios {

struct CalibrationDriveConfig {
  double side = 0.8;        ///< of the squares [m]
  double speed = 0.25;      ///< [m/s]
  double turn_rate = 0.7;   ///< [rad/s]
  double rest = 1.5;        ///< stands so long between two legs [s]
  double clearance = 0.08;  ///< nothing may come nearer to the robot [m]
};

/// Drives what a calibration needs: a square, the same one back the other way round, and a turn on the spot either way,
/// with a rest after each leg. Ways are measured by the wheels; turns, whose scale may be far off, also by the map:
/// what is left of one at its end is turned after it.
class CalibrationDrive {
 public:
  CalibrationDrive(const robot::RobotModel& model, const CalibrationDriveConfig& config);

  /// What to do until the next tick; nothing: it is over, see trouble(). `heading`: by the map, at the last scan [rad].
  std::optional<robot::Drive> next(const robot::Inputs& inputs, double heading);
  /// Why it ended early, and the remedy; empty: it did not.
  const std::string& trouble() const { return trouble_; }
  /// 0..1, of the legs.
  double progress() const { return static_cast<double>(leg_) / static_cast<double>(legs_.size()); }

 private:
  struct Leg {
    double way = 0.0;      ///< [m]; or
    double turn = 0.0;     ///< [rad]
    double heading = 0.0;  ///< where the turn leads, from where the drive began [rad]
  };
  void follow(const robot::Inputs& inputs);
  void begin_leg(double heading);
  bool is_blocked(const robot::LaserScan& scan, const Leg& leg) const;
  robot::Drive towards(const Leg& leg) const;

  robot::RobotModel model_;
  CalibrationDriveConfig config_;
  std::vector<Leg> legs_;
  std::size_t leg_ = 0;
  std::optional<robot::Odometry> last_;
  std::optional<double> first_heading_;
  double wanted_ = 0.0;           ///< of the leg, or of what is left of it [m or rad]
  int tries_ = 0;                 ///< of the leg
  double done_ = 0.0;             ///< of the leg, forward or to the left [m or rad]
  bool driving_ = false;          ///< else it rests
  Stamp since_ = Stamp::never();  ///< the leg or the rest began
  std::string trouble_;
};

}  // namespace rubble::scenarios
