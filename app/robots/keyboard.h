#pragma once

#include <termios.h>

#include <mutex>
#include <optional>

#include "robot/commands.h"

namespace rubble::app {

/// The keys of the terminal, one by one and without echo. Without a terminal nothing is ever pressed.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Takes the keys that wait; from then on they count as pressed. May be called from any thread, as all here.
  void look();
  /// Whether any key was pressed since the last call.
  bool pressed();
  /// Whether R was pressed since the last call, which is one of many while that is waited for.
  bool rearmed();
  /// What was pressed up to now drives nothing.
  void forget();
  /// The terminal is as it was before.
  void restore();
  /// Teleoperation: arrow keys or W, A, S, D drive as long as they are held, space and every other key stops, Q ends.
  /// To be asked each tick.
  robot::Drive drive(double v, double w);
  bool quit();
  /// Whether there is a terminal whose keys can be taken.
  bool active() const { return active_; }

 private:
  std::optional<int> next();
  void take(int key);
  std::optional<int> decoded(int byte);

  std::mutex mutex_;
  double v_ = 0.0, w_ = 0.0;  ///< of a held key, in units of what drive() is asked with
  bool any_ = false;
  bool rearmed_ = false;
  double rearm_until_ = 0.0;  ///< R is waited for up to here
  bool active_ = false;
  enum class Sequence { None, Escape, Inside } sequence_ = Sequence::None;  ///< of a key that sends several bytes
  bool alone_ = false;    ///< the ESC that came last was a key of its own
  double byte_at_ = 0.0;  ///< when the last byte came [s]
  bool quit_ = false;
  termios before_{};
  double until_ = 0.0;  ///< a key counts as held up to here, by the monotonic clock [s]
};

}  // namespace rubble::app
