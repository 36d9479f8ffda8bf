#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "robot/drivers/base_driver.h"
#include "robot/drivers/black_box.h"
#include "robot/drivers/hindrance.h"
#include "robot/drivers/levelling_unit.h"
#include "robot/drivers/scanner.h"
#include "robot/drivers/watch/scan_watch.h"
#include "robot/robot.h"

namespace rubble::robot {

/// When the robot stands still, and when it is given up.
struct SafetySettings {
  double lidar_silence = 0.3;      ///< no scan for so long: stop [s]
  double lidar_age = 0.6;          ///< the newest scan is older than this: stop. A scan of 115200 baud may take 0.5 [s]
  double base_silence = 1.0;       ///< no report of the base [s]
  double base_answer = 0.3;        ///< the base answers later than this: an order to stop would be as late [s]
  double levelling_silence = 0.5;  ///< no report of the levelling unit [s]
  double levelling_answer = 0.25;  ///< the unit answers later than this: the platform swings instead of levelling [s]
  double core_silence = 1.0;       ///< no command of the core [s]
  double operator_silence = 1.0;   ///< no heartbeat, if one is asked for [s]
  double start = 30.0;             ///< all devices must report within [s]
  double give_up = 60.0;           ///< a lost device must be back within [s]
  bool mount_check = true;         ///< scans that show another mount or scale than the robot file says hold it
  ScanWatch::Settings scans;       ///< when a scanner that sees nothing holds it
  double battery_low = 11.5;       ///< below it a battery is called low; 0: never [V]
  double battery_empty = 11.0;     ///< below it the robot is held; 0: never [V]
};

struct RealRobotSettings {
  RobotModel model;
  std::string base_driver = "arcos";  ///< one of base_kinds()
  /// A program's own base, in place of base_driver; empty: none.
  std::function<std::unique_ptr<BaseDriver>(const BaseSettings&)> own_base;
  BaseSettings base;
  LevellingUnitSettings levelling;
  std::string base_port;       ///< empty: there is none, somebody else drives
  std::string levelling_port;  ///< empty: there is none
  SafetySettings safety;
  std::string heartbeat;    ///< file or pipe that must be touched; empty: none
  double time_limit = 0.0;  ///< from the first tick on; 0: none [s]
};

/// What the operator asks for at any time.
enum class OperatorWish {
  None,
  Stop,           ///< the robot stands from now on, its motors are off
  EmergencyStop,  ///< the same, as hard as it can
  Leave,          ///< the farewell is said to the base at once; the program is about to end
};

/// How the robot is doing, for people.
struct RobotStatus {
  std::vector<Hindrance> silent;    ///< what holds the robot
  bool held = false;                ///< stopped at the robot itself, or taken: only rearm() lets it go
  bool blind = false;               ///< held since scans, or what levels the scanner, show that it must not drive so
  std::string mend;                 ///< what to do before it is let go, in words; empty: what the hold itself says
  std::string refusal;              ///< why rearm() does not let it go, of the base, in words; empty: it may
  bool doubted = false;             ///< let go after it had moved otherwise than told, and not seen to obey since
  bool taken = false;               ///< another program seemed to have the base while it was away, or to drive it
  std::vector<Hindrance> troubles;  ///< what does not work but holds nothing
  bool motors_on = false;
  bool begun = false;          ///< all devices have reported: the base may have been driven
  bool reported = false;       ///< the base has, since it was stopped for good
  bool moves = false;          ///< its wheels turn, by its last report
  mrpt::math::TPose2D unread;  ///< how far its wheels went since the report that read() returned last
  bool motors_stay =
      false;  ///< its motors are on, long after they were switched off; what it does in silence nobody knows
  bool emergency = false;
  double battery = 0.0;     ///< [V]
  std::uint64_t scans = 0;  ///< since the start
  std::uint64_t odometry = 0;
  std::uint64_t accelerations = 0;
  std::size_t bad_packets = 0;  ///< with wrong sums, of the base and the levelling unit
  std::size_t jumps = 0;        ///< of the base's odometry
  std::uint64_t scans_damaged = 0;
  std::uint64_t scans_missed = 0;
};

/// The real robot: a scanner, a Pioneer base and a levelling unit behind the one interface.
///
/// A tick ends after model().tick, or as soon as a scan is there, so that the answer to it is not kept waiting. Until
/// all devices report, and while one is silent, the motors stand and read() waits; what the core commands can never
/// exceed the limits nor outlive the core.
class RealRobot : public Robot {
 public:
  /// `box` may be null. Both must outlive the robot. Throws InputError on a bad port word.
  RealRobot(const RealRobotSettings& settings, Scanner& lidar, BlackBox* box);
  /// Stops, switches the motors off and closes the connection.
  ~RealRobot() override;

  const RobotModel& model() const override;
  /// Throws DeviceLost when a device does not come (back) in time, or another program seemed to have one before the
  /// first tick.
  std::optional<Inputs> read() override;
  void command(const Commands& commands) override;

  /// Stops hard and for good; read() ends. May be called from any thread.
  void emergency_stop();
  /// Set points to zero and motors off, for good; read() goes on. May be called from any thread.
  void stop();
  /// After somebody stopped the robot at the robot itself (its emergency button, its motors' button), or another
  /// program had its base while it was away, or it moved though told otherwise: lets it drive again. False: it stays
  /// held, see RobotStatus::refusal.
  bool rearm();
  /// `ask` is called in a thread of its own about fifty times a second, whatever the core is at; its wish is granted at
  /// once. After Leave `left` is called in that thread. Empty: nobody is asked any more.
  void listen(std::function<OperatorWish()> ask, std::function<void()> left = {});
  /// `hand` is asked as often and in the same thread for what the operator wants to drive; it takes the place of what
  /// the core commands, while the core answers. Empty: nobody drives by hand.
  void steer_by_hand(std::function<Drive()> hand);
  /// Called about twenty times a second while read() waits for devices; false ends the run.
  void while_waiting(std::function<bool(const RobotStatus&)> ask);
  RobotStatus status() const;
  /// Delays from the arrival of a scan's last byte to the moment its answer has left for the base [s].
  std::vector<double> answer_delays() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::robot
