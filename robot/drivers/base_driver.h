#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/drivers/answer_timer.h"
#include "robot/drivers/device.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// How a base is driven and its dead reckoning read: `devices.base` of the robot file and the robot's limits.
struct BaseSettings {
  double max_v = 0.7;                         ///< no command exceeds it [m/s]
  double max_w = deg_to_rad(100.0);           ///< [rad/s]
  double max_accel = 0.3;                     ///< [m/s^2]
  double max_turn_accel = deg_to_rad(100.0);  ///< [rad/s^2]
  double distance_scale = 1.0;                ///< true distance per reckoned distance
  double turn_scale = 1.0;                    ///< true turn per reckoned turn
  double delay = 0.0;                         ///< age of a report when its first byte leaves the robot [s]
  /// The firmware's turn rate is the wheel speeds' difference over this; 0: what is usual for the robot [m].
  double track = 0.0;
  bool passive = false;  ///< reports are read, but somebody else drives
  /// Reports that come unasked, since somebody else talks with the base on this line, are read and nothing is said.
  bool listen = false;
  /// Without reports for so long the connection may be made anew [s]. Standing still meanwhile is the caller's
  /// business.
  double silence = 3.0;
};

/// A base as RealRobot drives it: bytes and time go in, bytes and odometry come out. One of one's own is a class of
/// this and a row in bases.cpp (docs/extending.md). All calls come from one thread at a time; none may wait.
class BaseDriver : public Device {
 public:
  /// Set points, which hold until replaced and are sent as often as the base needs them. The driver keeps them within
  /// the limits, and at zero while the motors are not to be on.
  virtual void drive(const Drive& drive) = 0;
  /// The set points are zero at once, without the ramp that the base keeps otherwise; the motors stay on.
  virtual void brake() { drive({}); }
  /// Motors on or off; asked for again until the base obeys. Called in every turn. Off also forgets the set points.
  virtual void enable(bool on) = 0;
  /// Stops with the base's own ramp and switches the motors off.
  virtual void stop() = 0;
  /// The same as hard as the base can.
  virtual void emergency_stop() { stop(); }

  /// Odometry since the last call: poses in one frame over all connections, stamps that rise.
  virtual std::vector<Odometry> take_odometry() = 0;
  /// Whether its motors have power, by its last report. A base without such a switch says whether enable(true) was
  /// asked for last: one whose motors stay on though switched off is held to disobey.
  virtual bool motors_on() const = 0;
  virtual double battery() const { return 0.0; }  ///< [V]; 0: it does not tell
  /// Name, serial number and firmware in words, as it tells them on each connection; empty: it has not told.
  virtual std::string who() const { return ""; }

  /// Somebody at the robot stopped it: its emergency button is pressed, or its motors went off though nobody here asked
  /// for it. It is not switched on again until rearm().
  enum class Hold { None, EmergencyButton, MotorsOff };
  virtual Hold hold() const { return Hold::None; }
  /// The operator lets the base go again. While the button is pressed it stays held.
  virtual void rearm() {}

  /// How its answers come; a driver that asks nothing leaves it at that.
  using Answers = robot::Answers;
  virtual Answers answers(Stamp /*now*/) const { return {}; }
  /// How hard it can gain or lose speed by its own account [m/s^2], [rad/s^2]; 0: it has not told.
  virtual Drive own_ramp() const { return {}; }
  /// It begins to stop by itself when it has heard nothing for so long [s].
  virtual double watchdog() const { return 2.0; }
  /// It does not report yet, and what it answers comes late.
  virtual bool slow() const { return false; }

  /// Damaged messages and reports that jumped, since the start.
  virtual std::size_t bad_sums() const { return 0; }
  virtual std::size_t jumps() const { return 0; }
};

/// In place of a base that nobody here is connected with: it reports nothing and takes no orders.
constexpr const char* kNoBase = "none";

/// The base drivers by name, as `devices.base.driver` has them.
struct BaseKind {
  std::string name;
  std::function<std::unique_ptr<BaseDriver>(const BaseSettings&)> make;
};
const std::vector<BaseKind>& base_kinds();
/// Throws InputError on a name that nobody has.
std::unique_ptr<BaseDriver> make_base(const std::string& name, const BaseSettings& settings);

}  // namespace rubble::robot
