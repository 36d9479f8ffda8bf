#pragma once

#include <deque>

#include "base/stamp.h"
#include "explore/stuck/rest.h"
#include "robot/measurements.h"

namespace rubble::explore {

struct JoltWatchConfig {
  double peak = 3.0;      ///< harder than any braking [m/s^2]
  double window = 0.12;   ///< a blow lasts no longer [s]
  double share = 0.8;     ///< of the speed that it takes away
  double weak = 0.4;      ///< the same of one that may be the edge of a ramp as well
  double slowest = 0.08;  ///< slower wheels make no jolt that could be told [m/s]
  double settling = 0.5;  ///< time constant of what counts as rest: a slope's or the levelling's share of gravity [s]
};

/// Finds out from the accelerometer that something stopped the body at a blow. Its wheels may go on turning, on the
/// floor or up the edge of a step, and where the walls look the same all along a mapper believes them: this is the only
/// sign then.
class JoltWatch {
 public:
  explicit JoltWatch(const JoltWatchConfig& config = {}) : config_(config), rest_(config.settling) {}

  /// Takes in what was felt in one tick.
  void update(const robot::Inputs& inputs);
  /// Its own brake stops the body about now.
  void braked(Stamp now);
  /// A blow against the way the wheels turn ended in this tick; it is told once.
  bool struck() const { return struck_; }
  /// One that took less of the speed, likewise.
  bool shaken() const { return shaken_; }
  /// It came from ahead, else from behind.
  bool from_ahead() const { return speed_ > 0.0; }

 private:
  struct Felt {
    Stamp stamp;
    double x;  ///< along the body, less what it feels at rest [m/s^2]
  };

  JoltWatchConfig config_;
  std::deque<Felt> felt_;  ///< within the window
  Rest rest_;
  double speed_ = 0.0;                 ///< of the wheels [m/s]
  Stamp deaf_until_ = Stamp::never();  ///< one blow is told once
  bool struck_ = false;
  bool shaken_ = false;
};

}  // namespace rubble::explore
