#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "base/stamp.h"
#include "robot/drivers/base_driver.h"
#include "robot/drivers/hindrance.h"
#include "robot/drivers/watch/mount_witness.h"
#include "robot/drivers/watch/obedience.h"
#include "robot/drivers/watch/wheel_witness.h"
#include "robot/measurements.h"

namespace rubble::robot {

constexpr const char* kMotorsStay =
    "its motors stay on though switched off, so it may still move; press its emergency button or cut its power";

/// What is known of a base in one turn of its thread, and what is asked of it.
struct BaseTurn {
  Drive wanted;           ///< its set point before any limit
  bool asked = false;     ///< its motors are asked for, and what it is told reaches it in time
  bool off = false;       ///< they were switched off by us
  bool deaf = false;      ///< they are asked for, but what it is told comes late or not at all; it is told to stand
  double late = 0.0;      ///< so late an order that is on its way, or a report, may come then [s]
  double watchdog = 2.0;  ///< BaseDriver::watchdog() [s]
  bool ready = false;
  bool motors_on = false;
  bool held = false;          ///< by somebody at the robot
  Drive own_ramp = {};        ///< BaseDriver::own_ramp()
  std::size_t jumps = 0;      ///< of its odometry, since the start
  std::string identity = {};  ///< BaseDriver::who()
};

/// Holds what a base reports against what was asked of it, and against what scans show: its motors, its wheels, its
/// odometry.
///
/// A base that runs away, that is faster than robot.max_v and max_w allow it, or whose wheels deny motion that scans
/// show, is held from then on, until the operator lets it go; whether it obeys then is in doubt until nothing was seen
/// against it for a while. A robot that scans show to be mounted otherwise than its file says (MountWitness) is held as
/// well, and so is one whose base is another one after its line broke: that one is let go only behind another break.
class BaseWatch {
 public:
  static constexpr double kMotorsOn = 3.0;   ///< so soon they are on when asked for [s]
  static constexpr double kMotorsOff = 1.0;  ///< so soon they are off when switched off [s]
  static constexpr double kTooFast = 1.0;    ///< so long it may be faster than its limit [s]
  static constexpr double kObeys = 3.0;      ///< who ran away does so again, if ever, within this time [s]

  static constexpr double kHeldStill = 1.5;  ///< so soon a robot that is held stands [s]

  /// `T_base_laser`: where the scanner sits on the robot. `mount`: scans are held against the wheels' way and scale.
  BaseWatch(const BaseSettings& settings, const mrpt::math::TPose2D& T_base_laser, bool mount = true);

  /// One turn with the reports that came in it. True: it must be stopped hard, now.
  bool look(const BaseTurn& turn, const std::vector<Odometry>& reports, Stamp now);
  /// A scan that came at `now`; some take milliseconds.
  void see(const LaserScan& scan, Stamp now);
  /// The operator lets it go. False: not here and now, see refusal().
  bool rearm();

  /// Why nothing but the operator lets it go, in words; empty: it is not held.
  const std::string& held() const { return held_; }
  /// Of which device that is told.
  const std::string& held_name() const { return held_name_; }
  /// It is held since scans show another motion than its wheels, or since it is another base: the drive makes no sense.
  bool blind() const { return blind_; }
  /// What is to be done before it is let go, in words; empty: nothing but to see who drives it.
  const std::string& mend() const { return mend_; }
  /// Why the operator cannot let it go, in words; empty: he can. Another robot's base, which nobody here sees, is
  /// driven by no drive that began with this one.
  std::string refusal() const;
  /// It was let go after it had moved otherwise than told, and has not been seen to obey since.
  bool doubted() const { return doubted_; }
  /// It is held, by whomever, and its wheels turn all the same.
  bool moves_though_held() const { return moves_though_held_; }
  /// Its motors are on, long after they were switched off.
  bool motors_stay() const { return motors_stay_; }
  /// Its wheels turn, by the last report.
  bool moves() const { return moves_; }
  /// What does not work but holds nothing.
  std::vector<Hindrance> troubles() const;

 private:
  void pause();
  void mind_jumps(std::size_t jumps, Stamp now);
  void mind_motors(const BaseTurn& turn, Stamp now);
  void mind_obedience(const BaseTurn& turn, const std::vector<Odometry>& reports, Stamp now);
  void mind_limit(Stamp now);
  void mind_mount(const std::vector<Odometry>& reports, Stamp now);
  void mind_identity(const BaseTurn& turn, Stamp now);
  enum class Sort { Disobeys, Blind, Mount, Other };
  bool hold(Sort sort, const std::string& name, const std::string& why, const std::string& mend);
  bool had_time_to_stop(const BaseTurn& turn, Stamp now);
  void mind_doubt(bool obeys, Stamp now);

  BaseSettings settings_;
  Obedience obedience_;
  WheelWitness witness_;
  const bool mount_;
  MountWitness mount_witness_;
  std::string held_, held_name_, mend_;
  bool blind_ = false;
  bool other_ = false;      ///< it is held since it seems to be another robot's base; its line has not broken since
  bool doubt_who_ = false;  ///< it was, and was let go: its wheels are looked at again
  bool was_ready_ = false;
  bool ever_ready_ = false;   ///< so that its line broke when it is not
  std::string identity_;      ///< of the base that is driven
  std::string identity_now_;  ///< of the one that answers
  Stamp held_moves_since_ = Stamp::never();
  bool moves_though_held_ = false;
  Stamp too_fast_since_ = Stamp::never();
  std::string too_fast_;  ///< in words; empty: it keeps its limit
  Stamp deaf_since_ = Stamp::never();
  bool doubted_ = false;                  ///< it was held, and has not been seen to obey since
  Stamp obeys_since_ = Stamp::never();    ///< its motors are on and nothing is wrong with what it does
  Stamp motors_missed_ = Stamp::never();  ///< since then they are asked for and off
  bool no_motors_ = false;                ///< for long
  Stamp off_since_ = Stamp::never();      ///< since then they are switched off and on
  bool motors_stay_ = false;              ///< for long
  bool moves_ = false;
  std::size_t jumps_ = 0;     ///< up to now
  std::deque<Stamp> jumped_;  ///< when it did, lately
};

}  // namespace rubble::robot
