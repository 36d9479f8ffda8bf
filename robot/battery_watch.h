#pragma once

#include "base/stamp.h"

namespace rubble::robot {

/// Whether a battery is low, or so empty that it must not be driven with. Motors that start pull it down for a moment:
/// only what lasts counts, and what recovers a little is no better.
class BatteryWatch {
 public:
  static constexpr double kLasts = 10.0;    ///< [s]
  static constexpr double kRecovers = 0.3;  ///< by so much it must rise again [V]

  /// Below `low` it is low, below `empty` empty; 0: never [V].
  BatteryWatch(double low, double empty) : low_{low}, empty_{empty} {}

  /// `volts`: 0, not known [V].
  void look(double volts, Stamp now) {
    volts_ = volts;
    low_.look(volts, now);
    empty_.look(volts, now);
  }
  bool low() const { return low_.below; }
  bool empty() const { return empty_.below && !pardoned_; }
  /// The operator drives on with an empty one.
  void pardon() { pardoned_ = pardoned_ || empty_.below; }
  double volts() const { return volts_; }

 private:
  struct Limit {
    double volts;
    Stamp since = Stamp::never();
    bool below = false;

    void look(double seen, Stamp now) {
      if (seen <= 0.0) return;
      if (seen >= volts) since = Stamp::never();
      if (seen < volts && since == Stamp::never()) since = now;
      if (since != Stamp::never() && now - since >= kLasts) below = true;
      if (seen >= volts + kRecovers) below = false;
    }
  };

  Limit low_, empty_;
  bool pardoned_ = false;
  double volts_ = 0.0;
};

}  // namespace rubble::robot
