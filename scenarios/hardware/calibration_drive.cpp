#include "scenarios/hardware/calibration_drive.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::scenarios {
namespace {

constexpr double kArrived = 0.004;      ///< [m]
constexpr double kTurned = 0.01;        ///< [rad]
constexpr double kBraking = 0.7;        ///< of the greatest deceleration: the firmware lags behind
constexpr double kSlowest = 0.03;       ///< [m/s]; slower set points are lost in the firmware's whole numbers
constexpr double kSlowestTurn = 0.08;   ///< [rad/s]
constexpr double kStandsStill = 0.005;  ///< [m/s]
constexpr double kGoodHeading = deg_to_rad(3.0);
constexpr int kMostTries = 3;              ///< of a turn
constexpr double kLongestLeg = 60.0;       ///< [s]
constexpr std::size_t kBeamsInTheWay = 3;  ///< fewer are noise

}  // namespace

CalibrationDrive::CalibrationDrive(const robot::RobotModel& model, const CalibrationDriveConfig& config)
    : model_(model), config_(config) {
  double heading = 0.0;
  const auto straight = [&] { legs_.push_back({config_.side, 0.0, heading}); };
  const auto turn = [&](double degrees) {
    heading = wrap_angle(heading + deg_to_rad(degrees));
    legs_.push_back({0.0, deg_to_rad(degrees), heading});
  };
  for (int i = 0; i < 4; ++i) {
    straight();
    turn(90.0);
  }
  turn(360.0);
  turn(90.0);
  for (int i = 0; i < 4; ++i) {
    straight();
    turn(-90.0);
  }
  turn(-360.0);
}

/// Whether something stands where the leg leads, as far as the scan tells.
bool CalibrationDrive::is_blocked(const robot::LaserScan& scan, const Leg& leg) const {
  const mrpt::math::TPose2D mount{model_.T_base_laser.x, model_.T_base_laser.y, model_.T_base_laser.yaw};
  const double v = last_ ? std::max(0.0, last_->v) : 0.0;
  const double ahead = 0.5 * model_.length + config_.clearance + v * v / (2.0 * kBraking * model_.max_accel);
  std::size_t count = 0;
  for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
    const auto range = static_cast<double>(scan.ranges[beam]);
    if (!std::isfinite(range) || range < scan.range_min) continue;
    const double bearing = scan.bearing(beam);
    const mrpt::math::TPoint2D p = mount + mrpt::math::TPoint2D(range * std::cos(bearing), range * std::sin(bearing));
    const bool in_the_way = leg.turn != 0.0
                                ? length(p) < model_.swing_radius() + 0.5 * config_.clearance
                                : p.x > 0.0 && p.x < ahead && std::abs(p.y) < 0.5 * (model_.width + config_.clearance);
    count += in_the_way ? 1 : 0;
  }
  return count >= kBeamsInTheWay;
}

/// Speeds from which the robot can still stop in time.
robot::Drive CalibrationDrive::towards(const Leg& leg) const {
  const bool turns = leg.turn != 0.0;
  const double left = wanted_ - done_;
  const double accel = kBraking * (turns ? model_.max_turn_accel : model_.max_accel);
  const double fastest = turns ? std::min(config_.turn_rate, model_.max_w) : std::min(config_.speed, model_.max_v);
  const double speed = std::clamp(std::sqrt(2.0 * accel * std::abs(left)), turns ? kSlowestTurn : kSlowest, fastest);
  return turns ? robot::Drive{0.0, std::copysign(speed, left)} : robot::Drive{std::copysign(speed, left), 0.0};
}

void CalibrationDrive::follow(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) {
    if (last_ && leg_ < legs_.size()) {
      const mrpt::math::TPose2D step = odometry.pose - last_->pose;
      done_ += legs_[leg_].turn != 0.0 ? wrap_angle(step.phi) : step.x;
    }
    last_ = odometry;
  }
}

/// A turn begins as it stands in the plan; what the map says is missing at its end is turned after it.
void CalibrationDrive::begin_leg(double heading) {
  const Leg& leg = legs_[leg_];
  const double missing = wrap_angle(*first_heading_ + leg.heading - heading);
  wanted_ = leg.turn == 0.0 ? leg.way : tries_ > 0 ? missing : leg.turn;
  done_ = 0.0;
  ++tries_;
}

std::optional<robot::Drive> CalibrationDrive::next(const robot::Inputs& inputs, double heading) {
  follow(inputs);
  if (!last_) return robot::Drive{};
  if (!driving_) {
    const bool moves = std::abs(last_->v) > kStandsStill || std::abs(last_->w) > kStandsStill;
    if (moves || since_ == Stamp::never()) since_ = inputs.now;
    if (inputs.now - since_ < config_.rest) return robot::Drive{};
    if (!first_heading_) first_heading_ = heading;
    if (leg_ < legs_.size() && tries_ > 0) {
      const double missing = wrap_angle(*first_heading_ + legs_[leg_].heading - heading);
      if (legs_[leg_].turn == 0.0 || tries_ >= kMostTries || std::abs(missing) < kGoodHeading) {
        ++leg_;
        tries_ = 0;
      }
    }
    if (leg_ == legs_.size()) return std::nullopt;
    driving_ = true;
    since_ = inputs.now;
    begin_leg(heading);
  }
  const Leg& leg = legs_[leg_];
  const bool turns = leg.turn != 0.0;
  for (const robot::LaserScan& scan : inputs.scans) {
    if (!is_blocked(scan, leg)) continue;
    char text[200];
    const double room = 0.1 * std::ceil(10.0 * (config_.side + 2.0 * model_.swing_radius() + 0.2));
    std::snprintf(text, sizeof text,
                  "something stands in the way; a calibration needs %.1f x %.1f m of flat, free floor ahead of the "
                  "robot and to its left",
                  room, room);
    trouble_ = text;
    return std::nullopt;
  }
  if (std::copysign(1.0, wanted_) * (wanted_ - done_) < (turns ? kTurned : kArrived)) {
    driving_ = false;
    since_ = Stamp::never();
    return robot::Drive{};
  }
  if (inputs.now - since_ > kLongestLeg) {
    trouble_ = "the wheels do not follow; is the emergency button pressed, are the motors on, does a wheel hang?";
    return std::nullopt;
  }
  return towards(leg);
}

}  // namespace rubble::scenarios
