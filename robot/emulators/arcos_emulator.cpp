#include "robot/emulators/arcos_emulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/planar.h"
#include "robot/hardware_units.h"

namespace rubble::robot {
namespace {

using namespace arcos;

constexpr double kWheelSpeedStep = 0.02;        // of kWheelSpeeds [m/s]
constexpr double kStillSpeed = 1e-3;            // slower counts as standing [m/s]
constexpr double kStillTurn = deg_to_rad(0.5);  // [rad/s]
constexpr double kReached = 0.002;              // a commanded way is done [m]
constexpr double kHeadingReached = deg_to_rad(0.2);
constexpr double kLastPart = 0.1;         // time constant of the end of a commanded way [s]
constexpr double kSettled = 0.3;          // standing for so long, what was measured is where the robot is [s]
constexpr double kOldestMeasure = 0.2;    // what is older says nothing of where the robot is now [s]
constexpr double kStallFault = 1.0;       // [s]
constexpr double kDeafFault = 3.0;        // [s]
constexpr double kButtonFault = 2.0;      // [s]
constexpr double kStuckFault = 6.0;       // [s]
constexpr double kEncodersFault = 4.0;    // [s]
constexpr double kRunawaySpeed = 0.2;     // [m/s]
constexpr double kFullBattery = 12.8;     // [V]
constexpr double kEmptyBattery = 10.5;    // [V]
constexpr double kFinestLaserStep = 0.1;  // [deg]
constexpr int kNothingInRange = 32000;    // as far as the scanners of ARIA's simulators see [mm]

double ramped(double from, double to, double accel, double decel, double dt) {
  const bool faster = std::abs(to) > std::abs(from) && to * from >= 0.0;
  return approach(from, to, (faster ? accel : decel) * dt);
}

/// The speed from which `left` is just enough to stop, and close to the end one that falls with what is left.
double stopping_speed(double left, double decel, double top) {
  const double most = std::min(std::sqrt(2.0 * decel * std::abs(left)), std::abs(left) / kLastPart);
  return std::copysign(std::min(top, most), left);
}

}  // namespace

void play_hardware(ArcosEmulatorSettings& settings) {
  settings.identity.name = "rubble";
  settings.configuration.serial = "EMULATED1";
  settings.configuration.firmware = "2.6";
  settings.is_simulator = false;
}

ArcosEmulator::ArcosEmulator(const ArcosEmulatorSettings& settings) : settings_(settings), limits_(flash()) {
  settings_.configuration.name = settings_.identity.name;
}

ArcosEmulator::Limits ArcosEmulator::flash() const {
  const Configuration& c = settings_.configuration;
  Limits limits;
  limits.v = kMillimetre * c.max_speed;
  limits.w = deg_to_rad(c.max_turn_rate);
  limits.accel = limits.decel = kMillimetre * c.accel;
  limits.turn_accel = limits.turn_decel = deg_to_rad(c.turn_accel);
  return limits;
}

/// Back to where a client must synchronise; the settings of the flash return. A robot that drives comes to rest by its
/// ramp, as when the watchdog stops it: a cable that was pulled out is no blow.
void ArcosEmulator::start_anew() {
  session_ = Session::Sync0;
  limits_ = flash();
  mode_ = Mode::Speed;
  target_ = {};
  motors_ = held_ = false;
  runaway_.reset();
  encoders_ = status_ = 0;
  laser_ = {};
}

void ArcosEmulator::client_came(Stamp /*now*/) {
  start_anew();
  parser_.reset();
  output_.clear();
}

void ArcosEmulator::client_left(Stamp /*now*/) { start_anew(); }

void ArcosEmulator::receive(std::string_view bytes, Stamp now) {
  if (now < deaf_until_) return;
  parser_.feed(bytes, now);
  hear(now);
}

void ArcosEmulator::hear(Stamp now) {
  while (const auto payload = parser_.next(now)) {
    heard_ = now;
    held_ = false;
    if (const auto order = parse_order(*payload)) obey(*order, now);
  }
}

void ArcosEmulator::synchronise(std::uint8_t number) {
  const bool in_order = number == kSync0 || (number == kSync1 && session_ == Session::Sync1) ||
                        (number == kSync2 && session_ == Session::Sync2);
  if (!in_order) {
    session_ = Session::Sync0;
    return;
  }
  if (number == kSync2) {
    send(encode(settings_.identity));
  } else {
    send(std::string(1, static_cast<char>(number)));
  }
  session_ = number == kSync0 ? Session::Sync1 : number == kSync1 ? Session::Sync2 : Session::Synchronised;
}

void ArcosEmulator::open_session(Stamp now) {
  session_ = Session::Open;
  heard_ = now;
  set_origin(settings_.odometry_start);
}

void ArcosEmulator::obey(const Order& order, Stamp now) {
  if (session_ != Session::Open) {
    // OPEN and the second SYNC have the same number; which it is depends on what came before.
    if (session_ == Session::Synchronised && order.number == kOpen) return open_session(now);
    if (order.number <= kSync2) return synchronise(order.number);
    return;
  }
  switch (order.number) {
    case kPulse:
    case kOpen:
      return;
    case kClose:
    case kReset:
    case kMaintenance:
      return start_anew();
    case kEnable:
      return switch_motors(order.value.value_or(0) != 0 && now >= pressed_until_);
    case kSetOrigin:
      return set_origin(settings_.odometry_start);
    case kConfig:
      return send(encode(settings_.configuration));
    case kEncoder:
      encoders_ = order.value.value_or(0);
      return;
    case kStop:
    case kEmergencyStop:
      mode_ = Mode::Speed;
      target_ = {};
      braking_ = order.number == kEmergencyStop || !motors_;
      return;
    case kSetAcceleration:
    case kSetSpeed:
    case kSetTurnRate:
    case kSetTurnAcceleration:
      return set_limit(order);
    case kMove:
    case kRotate:
    case kVelocity:
    case kHead:
    case kTurnBy:
    case kTurnRate:
    case kWheelSpeeds:
      return move_by(order, now);
    default:
      return simulate(order);
  }
}

void ArcosEmulator::switch_motors(bool on) {
  motors_ = on;
  braking_ = !on;
  if (on) return;
  runaway_.reset();
  target_ = {};
  mode_ = Mode::Speed;
}

void ArcosEmulator::set_limit(const Order& order) {
  const int value = order.value.value_or(0);
  if (value == 0) return;  // nothing moves at such a limit
  const Configuration& top = settings_.configuration;
  const double magnitude = std::abs(value);
  switch (order.number) {
    case kSetSpeed:
      limits_.v = kMillimetre * std::min<double>(magnitude, top.top_speed);
      return;
    case kSetTurnRate:
      limits_.w = deg_to_rad(std::min<double>(magnitude, top.top_turn_rate));
      return;
    case kSetAcceleration:
      (value > 0 ? limits_.accel : limits_.decel) = kMillimetre * std::min<double>(magnitude, top.top_accel);
      return;
    default:
      (value > 0 ? limits_.turn_accel : limits_.turn_decel) =
          deg_to_rad(std::min<double>(magnitude, top.top_turn_accel));
  }
}

void ArcosEmulator::move_by(const Order& order, Stamp now) {
  if (!order.value || !motors_) return;
  const int value = *order.value;
  braking_ = false;
  // Orders to the two sides and orders to the whole end each other.
  if (mode_ == Mode::Wheels && order.number != kWheelSpeeds) target_ = {};
  switch (order.number) {
    case kMove:
      move_target_ = kMillimetre * value;
      target_ = {};
      aim_for(Mode::Move, now);
      return;
    case kHead:
    case kTurnBy:
      if (mode_ == Mode::Move) target_ = {};
      heading_target_ = wrap_angle(deg_to_rad(value) + (order.number == kTurnBy ? reckoned().phi + gone(now).w : 0.0));
      aim_for(Mode::Head, now);
      return;
    case kWheelSpeeds: {
      const WheelSpeeds wheels = wheel_speeds(value);
      const double left = kWheelSpeedStep * wheels.left;
      const double right = kWheelSpeedStep * wheels.right;
      mode_ = Mode::Wheels;
      target_ = {0.5 * (left + right), 0.5 * (right - left) / settings_.half_track};
      return;
    }
    case kVelocity:
      if (mode_ != Mode::Head) mode_ = Mode::Speed;
      target_.v = kMillimetre * value;
      return;
    default:  // kTurnRate, kRotate
      if (mode_ == Mode::Move) target_.v = 0.0;
      mode_ = Mode::Speed;
      target_.w = deg_to_rad(value);
  }
}

/// What only simulators understand; unknown numbers are passed over in silence.
void ArcosEmulator::simulate(const Order& order) {
  if (!settings_.is_simulator) return;
  switch (order.number) {
    case kSimSetPose: {
      Fields fields(order.rest, 1);
      const double x = kMillimetre * fields.i32();
      const double y = kMillimetre * fields.i32();
      return place({x, y, deg_to_rad(fields.i32())});
    }
    case kSimReset:
      place(settings_.true_start);
      mode_ = Mode::Speed;
      target_ = {};
      return set_origin({});
    case kSimLaserEnable:
    case kSimLaserStart:
    case kSimLaserEnd:
    case kSimLaserStep:
    case kOldLaserEnable:
    case kOldLaserStart:
    case kOldLaserEnd:
    case kOldLaserStep:
      return set_laser(order);
    case kSimControl:
      if (order.value.value_or(0) == kSimTellInfo)
        send(encode(SimInfo{settings_.identity.name, settings_.configuration.firmware, {{"laser", "laser"}}}));
      return;
    case kSimStat:
      status_ = order.value.value_or(1);
      return;
    case kBatteryTest: {
      const int tenths = order.value.value_or(0);
      battery_ = tenths > 0 ? 0.1 * std::min(tenths, 255) : kFullBattery;
      return;
    }
    default:
      return;
  }
}

void ArcosEmulator::place(const mrpt::math::TPose2D& T_arena_base) { placed_ = T_arena_base; }

void ArcosEmulator::set_laser(const Order& order) {
  if (!order.value) return;
  const double value = *order.value;
  switch (order.number) {
    case kSimLaserEnable:
    case kOldLaserEnable:
      laser_.mode = std::clamp(*order.value, 0, 2);
      return;
    case kSimLaserStart:
    case kOldLaserStart:
      laser_.start = std::clamp(value, -180.0, 180.0);
      return;
    case kSimLaserEnd:
    case kOldLaserEnd:
      laser_.end = std::clamp(value, -180.0, 180.0);
      return;
    default:
      laser_.step = std::clamp(0.01 * std::abs(value), kFinestLaserStep, 180.0);
  }
}

/// The readings that were asked for, each from the beam closest to its bearing. The first may lie on either side.
void ArcosEmulator::send_scan() {
  const LaserScan& scan = *scan_;
  const mrpt::math::TPose2D pose = reckoned();
  SimLaser laser;
  laser.extended = laser_.mode == 2;
  laser.x_mm = rounded(pose.x / kMillimetre);
  laser.y_mm = rounded(pose.y / kMillimetre);
  laser.heading_deg = rounded(rad_to_deg(pose.phi));
  const double span = laser_.end - laser_.start;
  const int steps = static_cast<int>(std::floor(std::abs(span) / laser_.step + 1e-6));
  for (int i = 0; i <= steps; ++i) {
    const double bearing = deg_to_rad(laser_.start + std::copysign(i * laser_.step, span));
    const long beam = std::lround((bearing - scan.angle_min) / scan.angle_step);
    const bool seen = beam >= 0 && beam < static_cast<long>(scan.ranges.size()) &&
                      std::isfinite(scan.ranges[static_cast<std::size_t>(beam)]);
    laser.ranges.push_back(seen
                               ? rounded(static_cast<double>(scan.ranges[static_cast<std::size_t>(beam)]) / kMillimetre)
                               : kNothingInRange);
  }
  for (const std::string& payload : encode(laser)) send(payload);
}

void ArcosEmulator::set_origin(const mrpt::math::TPose2D& start) {
  const double phi = odometry_.pose.phi - start.phi;
  const mrpt::math::TPoint2D back = PlanarTransform({0.0, 0.0, phi})({start.x, start.y});
  origin_ = {odometry_.pose.x - back.x, odometry_.pose.y - back.y, phi};
}

mrpt::math::TPose2D ArcosEmulator::reckoned() const {
  const double dx = odometry_.pose.x - origin_.x;
  const double dy = odometry_.pose.y - origin_.y;
  const double c = std::cos(origin_.phi);
  const double s = std::sin(origin_.phi);
  return {c * dx + s * dy, -s * dx + c * dy, wrap_angle(odometry_.pose.phi - origin_.phi)};
}

/// What the wheels have gone by since they were measured last [m], [rad].
Drive ArcosEmulator::gone(Stamp now) const {
  const double since = measured_at_ == Stamp::never() ? 0.0 : std::clamp(now - measured_at_, 0.0, kOldestMeasure);
  return {odometry_.v * since, odometry_.w * since};
}

/// A commanded way is a profile of set points. What is measured comes late, and would make it hunt; so it is looked at
/// where the way begins, and again once the robot stands.
void ArcosEmulator::aim_for(Mode mode, Stamp now) {
  mode_ = mode;
  const Drive since = gone(now);
  if (mode == Mode::Move) {
    move_start_ = odometry_.pose;
    move_start_.x += since.v * std::cos(odometry_.pose.phi);
    move_start_.y += since.v * std::sin(odometry_.pose.phi);
    planned_left_ = move_target_;
  } else {
    planned_left_ = wrap_angle(still_to_go() - since.w);
  }
  rest_ = 0.0;
  // At a wall the set points may be ahead of wheels that stand, though no stall is told yet. Wheels that have only just
  // been told to turn stand as well: a way that is ordered again and again must not take their speed every time.
  const auto yield = [](double& ahead, double then, double measured, double still, double way) {
    if (std::abs(measured) < still && std::abs(then) >= still && ahead * way <= 0.0) ahead = 0.0;
  };
  yield(motion_.v, motion_then_.v, odometry_.v, kStillSpeed, mode == Mode::Move ? planned_left_ : target_.v);
  yield(motion_.w, motion_then_.w, odometry_.w, kStillTurn, mode == Mode::Head ? planned_left_ : target_.w);
}

/// By what was measured last [rad] or [m].
double ArcosEmulator::still_to_go() const {
  if (mode_ == Mode::Head) return wrap_angle(heading_target_ - reckoned().phi);
  const double dx = odometry_.pose.x - move_start_.x;
  const double dy = odometry_.pose.y - move_start_.y;
  return move_target_ - (std::cos(odometry_.pose.phi) * dx + std::sin(odometry_.pose.phi) * dy);
}

void ArcosEmulator::look_again(double dt) {
  const bool turns = mode_ == Mode::Head;
  const double reached = turns ? kHeadingReached : kReached;
  planned_left_ -= (turns ? motion_.w : motion_.v) * dt;
  const bool stands = std::abs(odometry_.v) < kStillSpeed && std::abs(odometry_.w) < kStillTurn;
  rest_ = stands && std::abs(planned_left_) < reached ? rest_ + dt : 0.0;
  if (rest_ < kSettled) return;
  rest_ = 0.0;
  if (std::abs(still_to_go()) > reached) planned_left_ = still_to_go();
}

/// The wheels are blocked: a profile that ran on without them would have to be run back before they turn the other way.
void ArcosEmulator::give_way() {
  (mode_ == Mode::Head ? motion_.w : motion_.v) = mode_ == Mode::Head ? odometry_.w : odometry_.v;
  planned_left_ = still_to_go();
  rest_ = 0.0;
}

Drive ArcosEmulator::wanted() const {
  if (!motors_ || held_ || session_ != Session::Open || advanced_ < stuck_until_) return {};
  if (runaway_) return *runaway_;
  Drive drive = target_;
  if (mode_ == Mode::Head) drive.w = stopping_speed(planned_left_, limits_.turn_decel, limits_.w);
  if (mode_ == Mode::Move) drive.v = stopping_speed(planned_left_, limits_.decel, limits_.v);
  drive.v = std::clamp(drive.v, -limits_.v, limits_.v);
  drive.w = std::clamp(drive.w, -limits_.w, limits_.w);
  return drive;
}

void ArcosEmulator::advance(Stamp now) {
  const double dt = advanced_ == Stamp::never() ? 0.0 : std::max(0.0, now - advanced_);
  advanced_ = now;
  if (now >= deaf_until_) hear(now);  // what lay behind junk that looked like a head
  if (scan_ && now >= scan_->beam_stamp(scan_->ranges.size())) {
    if (session_ == Session::Open && laser_.mode > 0) send_scan();
    scan_.reset();
  }
  const double watchdog = 1e-3 * settings_.configuration.watchdog_ms;
  if (session_ == Session::Open && watchdog > 0.0 && heard_ != Stamp::never() && now - heard_ > watchdog) held_ = true;
  const Drive drive = wanted();
  if (braking_) {
    motion_ = drive;
    return;
  }
  motion_.v = ramped(motion_.v, drive.v, limits_.accel, limits_.decel, dt);
  motion_.w = ramped(motion_.w, drive.w, limits_.turn_accel, limits_.turn_decel, dt);
  if (mode_ == Mode::Head || mode_ == Mode::Move) look_again(dt);
}

void ArcosEmulator::measure(const Odometry& odometry, Stamp now) {
  const double dt = odometry.stamp > odometry_.stamp ? odometry.stamp - odometry_.stamp : 0.0;
  const bool counts = now >= uncounted_until_;
  // What was not counted stays so when the encoders work again.
  if (!counts) uncounted_ = odometry_.pose + (mrpt::math::TPose2D() - odometry.pose);
  odometry_ = odometry;
  if (!counts) odometry_.v = odometry_.w = 0.0;
  if (uncounted_) odometry_.pose = *uncounted_ + odometry.pose;
  measured_at_ = now;
  motion_then_ = motion_;
  if (odometry.stalled && (mode_ == Mode::Head || mode_ == Mode::Move)) give_way();
  if (now < stalled_until_) odometry_.stalled = true;
  left_travel_ += left_speed() * dt;
  right_travel_ += right_speed() * dt;
  if (session_ == Session::Open) report();
}

void ArcosEmulator::report() {
  const mrpt::math::TPose2D pose = reckoned();
  StandardInformation s;
  s.moving = std::abs(odometry_.v) > kStillSpeed || std::abs(odometry_.w) > kStillTurn;
  s.x = static_cast<std::uint16_t>(rounded(pose.x / kMillimetre) & 0xFFFF);
  s.y = static_cast<std::uint16_t>(rounded(pose.y / kMillimetre) & 0xFFFF);
  const auto units = [](double angle) {
    const int whole = rounded(angle / kArcosHeadingUnit);
    return static_cast<std::int16_t>(whole >= 2048 ? whole - 4096 : whole);
  };
  s.heading = units(pose.phi);
  s.left = static_cast<std::int16_t>(rounded(left_speed() / kMillimetre));
  s.right = static_cast<std::int16_t>(rounded(right_speed() / kMillimetre));
  s.battery = battery_;
  s.stall = odometry_.stalled ? kLeftStall | kRightStall : 0;
  s.control = units(mode_ == Mode::Head ? heading_target_ : pose.phi);
  s.flags = (motors_ ? kMotorsOn : 0) | (advanced_ < pressed_until_ ? kEmergencyButton : 0);
  s.turn_rate = rad_to_deg(odometry_.w);
  if (status_ > 0)
    send(encode(SimStatus{settings_.configuration.cycle_ms, rounded(truth_.x / kMillimetre),
                          rounded(truth_.y / kMillimetre), rounded(rad_to_deg(truth_.phi))}));
  if (status_ == 1) status_ = 0;
  send(encode(s));
  if (encoders_ > 0) {
    const double ticks = settings_.configuration.ticks_mm / kMillimetre;
    send(encode_encoders(static_cast<std::int32_t>(std::llround(left_travel_ * ticks)),
                         static_cast<std::int32_t>(std::llround(right_travel_ * ticks))));
  }
  if (encoders_ == 1) encoders_ = 0;
}

bool ArcosEmulator::fail(DeviceFault fault, Stamp now) {
  switch (fault) {
    case DeviceFault::SetOrigin:
      set_origin(settings_.odometry_start);
      return true;
    case DeviceFault::Stall:
      stalled_until_ = now + kStallFault;
      return true;
    case DeviceFault::Reset:
      start_anew();
      return true;
    case DeviceFault::Watchdog:
      deaf_until_ = now + kDeafFault;
      return true;
    case DeviceFault::Button:
      switch_motors(false);
      pressed_until_ = now + kButtonFault;
      return true;
    case DeviceFault::Motors:
      switch_motors(false);
      return true;
    case DeviceFault::Stuck:
      stuck_until_ = now + kStuckFault;
      return true;
    case DeviceFault::Runaway:
      runaway_ = std::abs(motion_.v) > kStillSpeed ? motion_ : Drive{kRunawaySpeed, 0.0};
      return true;
    case DeviceFault::Encoders:
      uncounted_until_ = now + kEncodersFault;
      return true;
    case DeviceFault::Battery:
      battery_ = kEmptyBattery;
      return true;
    case DeviceFault::ClockWrap:
    case DeviceFault::Sensor:
      break;
  }
  return false;
}

std::optional<mrpt::math::TPose2D> ArcosEmulator::take_placed() { return std::exchange(placed_, std::nullopt); }

std::string ArcosEmulator::take_output() { return std::exchange(output_, ""); }

}  // namespace rubble::robot
