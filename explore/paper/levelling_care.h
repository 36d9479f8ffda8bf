#pragma once

#include <string>

#include "base/stamp.h"
#include "robot/levelling_watch.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::explore {

/// What an explorer makes of a levelling unit that fails: it stands and waits for one that is silent, which may have
/// been unplugged for a moment, and then gives it up; one that is jammed it gives up at once.
class LevellingCare {
 public:
  explicit LevellingCare(const robot::RobotModel& model) : watch_(model) {}

  /// Takes in what arrived in a tick.
  void update(const robot::Inputs& inputs);

  /// Also where there is no levelling unit.
  bool works() const { return watch_.state() == robot::LevellingState::Works; }
  bool jammed() const { return watch_.state() == robot::LevellingState::Jammed; }
  /// It works, and has taken the tilt away.
  bool level() const { return watch_.level(); }
  /// It may come back: the robot stands.
  bool waits() const { return !works() && !given_up_; }
  /// For good.
  bool given_up() const { return given_up_; }
  /// What changed in the last tick, for people; empty: nothing.
  const std::string& news() const { return news_; }

 private:
  robot::LevellingWatch watch_;
  Stamp failed_ = Stamp::never();  ///< when it fell silent
  bool given_up_ = false;
  std::string news_;
};

}  // namespace rubble::explore
