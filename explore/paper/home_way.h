#pragma once

#include "base/stamp.h"

namespace rubble::explore {

/// Knows when it is time to drive home: from the length of the way and how fast the robot has come along so far.
class HomeWay {
 public:
  /// `time_limit` [s] from the first tick; 0: none.
  explicit HomeWay(double time_limit) : time_limit_(time_limit) {}

  /// What is kept of a mission's time beside what the way takes: less of a short one [s].
  double spare_time() const;
  /// A tick: the first one begins the mission.
  void begin(Stamp now) {
    if (start_ == Stamp::never()) start_ = now;
  }
  /// One tick of `dt` [s] in which the robot moved by `way` [m]; `driving`: on its way or getting free on it, not
  /// searching or turning.
  void moved(double way, double dt, bool driving);
  /// Whether the way home should be measured now.
  bool due(Stamp now);
  /// Whether a robot whose way home is so long [m] must turn back now.
  bool must_turn_back(double way_home, Stamp now) const;
  /// Whether a robot on its way home, with so much of it left [m], has no time for anything else.
  bool hurries(double way_left, Stamp now) const;
  /// How fast the robot has come along so far, turns and stops included [m/s].
  double speed() const;
  /// Time left of the mission [s].
  double left(Stamp now) const;

 private:
  double time_limit_;
  Stamp start_ = Stamp::never();
  Stamp next_ = Stamp::never();
  double way_ = 0.0;   ///< [m]
  double time_ = 0.0;  ///< [s]
};

}  // namespace rubble::explore
