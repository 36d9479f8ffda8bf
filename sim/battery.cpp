#include "sim/battery.h"

#include <algorithm>
#include <cmath>

namespace rubble::sim {
namespace {

constexpr double kDriving = 80.0;      ///< on a carpet [W at 1 m/s]
constexpr double kTurning = 60.0;      ///< skid steering drags its wheels sideways [W at 1 rad/s]
constexpr double kFull = 12.8;         ///< at rest [V]
constexpr double kNearlyEmpty = 11.4;  ///< at rest, at the end of its capacity [V]
constexpr double kResistance = 0.04;   ///< [ohm]
constexpr double kOff = 10.5;          ///< nothing left [V]

}  // namespace

void Battery::draw(const robot::Drive& drive, double dt) {
  power_ = kStanding + (empty() ? 0.0 : kDriving * std::abs(drive.v) + kTurning * std::abs(drive.w));
  left_ = std::max(0.0, left_ - power_ * dt);
}

double Battery::volts() const {
  if (empty()) return kOff;
  const double at_rest = kNearlyEmpty + (kFull - kNearlyEmpty) * left_ / capacity_;
  return at_rest - kResistance * power_ / at_rest;
}

}  // namespace rubble::sim
