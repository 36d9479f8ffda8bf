#include "robot/emulators/levelling_emulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot/hardware_units.h"

namespace rubble::robot {
namespace {

constexpr double kSensorFault = 1.0;  ///< [s]
constexpr double kSettledUs = 3.0;    ///< of the pulse: at its target

long ticks(double force, double zero, double sensitivity, double period) {
  return std::lround(std::clamp(zero + sensitivity * force / kGravity, 0.0, 1.0) * period);
}

}  // namespace

LevellingEmulator::LevellingEmulator(const LevellingEmulatorSettings& settings) : settings_(settings) {}

/// As after power on; the servos keep their last pulse, for their gears hold.
void LevellingEmulator::start_anew(Stamp now) {
  rate_ = settings_.identity.rate;
  watchdog_ms_ = settings_.identity.watchdog_ms;
  slew_ = 0.0;
  servos_on_ = tripped_ = clipped_ = false;
  started_ = heard_ = now;
  next_report_ = now + 1.0 / rate_;
  sequence_ = 0;
  say(body(settings_.identity));
}

void LevellingEmulator::client_came(Stamp now) {
  lines_.reset();
  output_.clear();
  start_anew(now);  // opening the port resets the controller
}

void LevellingEmulator::receive(std::string_view bytes, Stamp now) {
  const std::size_t bad = lines_.bad_lines();
  lines_.feed(bytes);
  while (const auto fields = lines_.next()) obey(*fields, now);
  for (std::size_t i = bad; i < lines_.bad_lines(); ++i) say("N,BADSUM");
}

void LevellingEmulator::obey(const std::vector<std::string>& fields, Stamp now) {
  heard_ = now;
  tripped_ = false;
  const std::string& kind = fields[0];
  const bool one = fields.size() == 2;
  if (kind == "V" && fields.size() == 1) return say(body(settings_.identity));
  if (kind == "S" && fields.size() == 3) return set_pulses(fields);
  if (kind == "E" && one && (fields[1] == "0" || fields[1] == "1")) {
    servos_on_ = fields[1] == "1";
    return say("E,OK");
  }
  const long value = one ? whole_number(fields[1], 0, 100000).value_or(-1) : -1;
  if (kind == "R" && value >= 0) {
    rate_ = static_cast<int>(std::clamp<long>(value, 1, settings_.most_rate));
    next_report_ = now + 1.0 / rate_;
    return say(rate_ == value ? "R,OK" : "N,RANGE");
  }
  if (kind == "W" && value >= 0) {
    watchdog_ms_ = static_cast<int>(value);
    return say("W,OK");
  }
  if (kind == "C" && value >= 0) {
    slew_ = deg_to_rad(static_cast<double>(value)) / settings_.radians_per_us;
    return say("C,OK");
  }
  say("N,UNKNOWN");
}

void LevellingEmulator::set_pulses(const std::vector<std::string>& fields) {
  bool in_range = true;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto value = whole_number(fields[i + 1], 0, 100000);
    if (!value) return say("N,UNKNOWN");
    if (*value == 0) continue;  // left as it is
    const long kept = std::clamp<long>(*value, settings_.identity.us_min, settings_.identity.us_max);
    in_range = in_range && kept == *value;
    wanted_us_[i] = static_cast<double>(kept);
  }
  clipped_ = !in_range;
  if (!in_range) say("N,RANGE");
}

void LevellingEmulator::advance(Stamp now) {
  if (started_ == Stamp::never()) start_anew(now);
  const double dt = advanced_ == Stamp::never() ? 0.0 : std::max(0.0, now - advanced_);
  advanced_ = now;
  if (watchdog_ms_ > 0 && now - heard_ > 1e-3 * watchdog_ms_) tripped_ = true;
  if (!servos_on_ || tripped_) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const double most = slew_ > 0.0 ? slew_ * dt : 1e9;
    pulse_us_[i] += std::clamp(wanted_us_[i] - pulse_us_[i], -most, most);
  }
}

void LevellingEmulator::measure(const Acceleration& acceleration, const AimState& aim, Stamp now) {
  if (started_ == Stamp::never()) start_anew(now);
  const double since = measured_ == Stamp::never() ? 0.0 : now - measured_;
  // The sensor pulses on whether or not anybody listens; the sums cover the time since the last measurement.
  const double periods =
      std::max(1.0, std::round(since * settings_.identity.tick_hz / settings_.identity.period_ticks));
  const double period = periods * settings_.identity.period_ticks;
  if (t2_ == 0) window_ = now - period / settings_.identity.tick_hz;
  t1x_ += ticks(acceleration.x, settings_.zero_x, settings_.sensitivity, period);
  t1y_ += ticks(acceleration.y, settings_.zero_y, settings_.sensitivity, period);
  t2_ += std::lround(period);
  measured_ = now;
  last_aim_ = aim;
  // A report is due within a millisecond of a measurement or waits for the next.
  if (now < next_report_ - 1e-3) return;
  report(now);
  next_report_ = next_report_ + 1.0 / rate_;
  if (now - next_report_ > 1.0 / rate_) next_report_ = now + 1.0 / rate_;
}

void LevellingEmulator::report(Stamp now) {
  LevellingReport report;
  report.sequence = sequence_;
  sequence_ = (sequence_ + 1) & 0xFFFF;
  const double middle = 0.5 * ((now - started_) + (window_ - started_));
  report.time_us = static_cast<std::uint32_t>(std::llround(middle * 1e6));
  report.t1x = t1x_;
  report.t1y = t1y_;
  report.t2 = t2_;
  report.pitch_us = static_cast<int>(std::lround(1500.0 + last_aim_.pitch / settings_.radians_per_us));
  report.roll_us = static_cast<int>(std::lround(1500.0 + last_aim_.roll / settings_.radians_per_us));
  const bool settled =
      std::abs(report.pitch_us - wanted_us_[0]) <= kSettledUs && std::abs(report.roll_us - wanted_us_[1]) <= kSettledUs;
  if (servos_on_) report.flags |= LevellingReport::kServosOn;
  if (settled) report.flags |= LevellingReport::kSettled;
  if (tripped_) report.flags |= LevellingReport::kWatchdog;
  if (now < dead_sensor_until_) report.flags |= LevellingReport::kSensorFault;
  if (clipped_) report.flags |= LevellingReport::kClipped;
  t1x_ = t1y_ = t2_ = 0;
  say(body(report));
}

LaserAim LevellingEmulator::aim() const { return {angle(pulse_us_[0]), angle(pulse_us_[1])}; }

bool LevellingEmulator::fail(DeviceFault fault, Stamp now) {
  if (fault == DeviceFault::Reset) {
    start_anew(now);
  } else if (fault == DeviceFault::Sensor) {
    dead_sensor_until_ = now + kSensorFault;
  } else {
    return false;
  }
  return true;
}

std::string LevellingEmulator::take_output() { return std::exchange(output_, ""); }

}  // namespace rubble::robot
