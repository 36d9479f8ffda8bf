#pragma once

#include <termios.h>

#include <atomic>

#include "base/stamp.h"
#include "robot/commands.h"

namespace rubble::app {

/// The keys of the terminal, one by one and without echo. Without a terminal nothing is ever pressed.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Whether any key was pressed since the last call.
  bool pressed();
  /// Teleoperation: arrow keys or W, A, S, D drive as long as they are held, space and every other key stops, Q ends.
  /// To be asked each tick.
  robot::Drive drive(double v, double w);
  bool quit() const { return quit_; }

 private:
  int next();

  bool active_ = false;
  bool quit_ = false;
  termios before_{};
  robot::Drive drive_;
  double until_ = 0.0;  ///< a key counts as held up to here, by the monotonic clock [s]
};

}  // namespace rubble::app
