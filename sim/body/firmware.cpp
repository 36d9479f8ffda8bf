#include "sim/body/firmware.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "robot/hardware_units.h"

namespace rubble::sim {
namespace {

constexpr double kTicksPerMetre = 138e3;  ///< ARCOS ticksMM of the P3-AT
constexpr double kStallTime = 0.2;        ///< pushing so long without turning is a stall [s]
constexpr double kRelaxTime = 0.2;        ///< motors rest so long after a stall [s]
constexpr double kStallMemory = 0.5;      ///< the flag falls after so long without pushing in vain [s]
constexpr double kStallSpeed = 0.02;      ///< slower set points do not stall [m/s]

double round_to(double value, double unit) { return std::round(value / unit) * unit; }

std::int64_t ticks(double travel) { return static_cast<std::int64_t>(std::floor(travel * kTicksPerMetre + 0.5)); }

bool in_vain(double wanted, const Side& side) {
  return side.saturated && std::abs(wanted) > kStallSpeed && side.speed * wanted < 0.25 * wanted * wanted;
}

}  // namespace

void Firmware::command(const robot::Drive& drive) {
  target_.v = std::clamp(drive.v, -model_.max_v, model_.max_v);
  target_.w = std::clamp(drive.w, -model_.max_w, model_.max_w);
  silence_ = 0.0;
}

void Firmware::brake() {
  target_ = {};
  v_ = w_ = 0.0;
}

SideDemand Firmware::demand(double dt) {
  silence_ += dt;
  if (silence_ > model_.command_timeout) target_ = {};
  if (relax_ > 0.0) {
    relax_ -= dt;
    v_ = 0.0;
    w_ = 0.0;
    demand_ = {0.0, 0.0, true};
    return demand_;
  }
  v_ = robot::approach(v_, target_.v, model_.max_accel * dt);
  w_ = robot::approach(w_, target_.w, model_.max_turn_accel * dt);
  const double half = 0.5 * model_.effective_track * w_;
  demand_ = {v_ - half, v_ + half, false};
  return demand_;
}

void Firmware::observe(const Side& left, const Side& right, double dt) {
  left_speed_ = left.speed;
  right_speed_ = right.speed;
  left_ticks_ = ticks(left.travel);
  right_ticks_ = ticks(right.travel);

  const bool vain = in_vain(demand_.left, left) || in_vain(demand_.right, right);
  pushing_ = vain ? pushing_ + dt : 0.0;
  since_push_ = vain || demand_.relaxed ? 0.0 : since_push_ + dt;
  if (pushing_ >= kStallTime) {
    stalled_ = true;
    relax_ = kRelaxTime;
    pushing_ = 0.0;
  }
  const bool wanted = target_.v != 0.0 || target_.w != 0.0;
  if (stalled_ && (since_push_ > kStallMemory || (!wanted && !demand_.relaxed))) stalled_ = false;
}

robot::Odometry Firmware::reckon(Stamp stamp) {
  const double left = static_cast<double>(left_ticks_ - last_left_ticks_) / kTicksPerMetre;
  const double right = static_cast<double>(right_ticks_ - last_right_ticks_) / kTicksPerMetre;
  last_left_ticks_ = left_ticks_;
  last_right_ticks_ = right_ticks_;
  const double turn = (right - left) / model_.effective_track;
  const double heading = reckoned_.phi + 0.5 * turn;
  reckoned_.x += 0.5 * (left + right) * std::cos(heading);
  reckoned_.y += 0.5 * (left + right) * std::sin(heading);
  reckoned_.phi = wrap_angle(reckoned_.phi + turn);

  robot::Odometry odometry;
  odometry.stamp = stamp;
  odometry.pose = {round_to(reckoned_.x, 1e-3), round_to(reckoned_.y, 1e-3),
                   wrap_angle(round_to(reckoned_.phi, robot::kArcosHeadingUnit))};
  const double l = round_to(left_speed_, 1e-3);
  const double r = round_to(right_speed_, 1e-3);
  odometry.v = 0.5 * (l + r);
  odometry.w = (r - l) / model_.effective_track;
  odometry.stalled = stalled_;
  return odometry;
}

}  // namespace rubble::sim
