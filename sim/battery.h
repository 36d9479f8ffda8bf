#pragma once

#include "robot/commands.h"

namespace rubble::sim {

/// A 12 V lead-acid battery and what a Pioneer 3-AT with laser and computer takes out of it. Voltages of the Pioneer's
/// manual (12.8 V full, alarm at 11.5 V, off at 11.0 V); powers and resistance are round figures of ours.
class Battery {
 public:
  static constexpr double kLow = 11.5;  ///< the Pioneer's alarm [V]

  static constexpr double kStanding = 35.0;  ///< electronics, laser, computer [W]

  explicit Battery(double capacity_wh) : capacity_(capacity_wh * 3600.0), left_(capacity_) {}

  /// Drives as it is told to for `dt` [s].
  void draw(const robot::Drive& drive, double dt);
  /// At its poles, under the load of the last draw [V].
  double volts() const;
  /// Nothing more comes out of it: the motors stand.
  bool empty() const { return left_ <= 0.0; }

 private:
  double capacity_;     ///< [J]
  double left_;         ///< [J]
  double power_ = 0.0;  ///< [W]
};

}  // namespace rubble::sim
