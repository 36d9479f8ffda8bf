#include "robot/drivers/levelling_unit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text/words.h"
#include "robot/hardware_units.h"

namespace rubble::robot {
namespace {

/// A port that is opened may reset the controller, which then takes up to two seconds.
constexpr double kAskAgain = 0.5;      ///< [s]
constexpr double kReportBytes = 50.0;  ///< of a report on the line
constexpr double kQuestionBytes = 9.0, kAnswerBytes = 10.0;
constexpr double kPulseRefresh = 0.1;  ///< of the servo pulses: well within the unit's watchdog [s]

constexpr double kMostFelt = 2.5 * kGravity;  ///< the sensor ends at 2 g [m/s^2]
constexpr double kMostBehind = 3.0;           ///< no line that is driven with takes so long [s]

double specific_force(long t1, long t2, const AxisCalibration& axis) {
  const double duty = static_cast<double>(t1) / static_cast<double>(t2);
  return kGravity * (duty - axis.zero) / axis.sensitivity;
}

double angle(int pulse_us, const ServoCalibration& servo) {
  return (pulse_us - servo.centre_us) * servo.radians_per_us;
}

}  // namespace

void LevellingUnit::opened(Stamp now, LineKind line) {
  line_ = line;
  lines_.reset();
  restart_clock();
  identified_ = false;
  last_report_ = Stamp::never();
  answer_timer_.reset();
  unanswered_ = Stamp::never();
  sequence_ = -1;
  output_ = levelling_line("V");
  asked_ = now;
}

void LevellingUnit::advance(Stamp now) {
  if (asked_ == Stamp::never()) return;
  if (identified_ && last_report_ != Stamp::never() && now - last_report_ > settings_.silence) {
    identified_ = false;
    last_report_ = Stamp::never();
    answer_timer_.reset();
    unanswered_ = Stamp::never();
  }
  if (!reports() && now - asked_ >= kAskAgain) {
    asked_ = now;
    output_ = levelling_line("V");
  }
  answer_timer_.advance(now);
  if (ready() && aimed_ && (aim_sent_ == Stamp::never() || now - aim_sent_ >= kPulseRefresh)) aim_due_ = true;
}

void LevellingUnit::receive(std::string_view bytes, Stamp now) {
  lines_.feed(bytes);
  while (const auto fields = lines_.next()) digest(*fields, now);
}

void LevellingUnit::digest(const std::vector<std::string>& fields, Stamp now) {
  if (const auto identity = parse_identity(fields)) {
    // Also when it was reset on its own: all settings are gone then.
    identity_ = *identity;
    identity_.model = one_line(identity_.model);  // they come onto the terminal
    identity_.sensor = one_line(identity_.sensor);
    identified_ = true;
    restart_clock();
    if (settings_.passive) return;
    output_ += levelling_line("R," + std::to_string(settings_.rate));
    output_ += levelling_line("W," + std::to_string(settings_.watchdog_ms));
    output_ += levelling_line("E,1");
    // It may identify itself several times over a slow line: all of these questions will be answered.
    if (unanswered_ == Stamp::never()) unanswered_ = now;
    answer_timer_.asked(now);
    return;
  }
  if (fields == std::vector<std::string>{"E", "OK"}) {
    unanswered_ = Stamp::never();
    answer_timer_.answered(now, time_on_line(line_, kQuestionBytes + kAnswerBytes, baud()));
  }
  const auto report = parse_report(fields);
  if (!report || !identified_) return;
  if (is_sound(*report)) {
    follow(*report, now);
  } else {
    ++unsound_;
  }
}

/// Whether the numbers can be true. The line's sum is an exclusive or: two figures that are doubled, or lost, pass it
/// when they are the same, and a period of 200 s instead of 20 ms would set the clock forward for minutes.
bool LevellingUnit::is_sound(const LevellingReport& report) const {
  const int rate = settings_.passive ? 1 : std::max(1, std::min(settings_.rate, identity_.rate));
  const double longest = 2.0 * std::max<double>(identity_.period_ticks, identity_.tick_hz / rate);
  if (2.0 * static_cast<double>(report.t2) < identity_.period_ticks || static_cast<double>(report.t2) > longest)
    return false;
  for (const int us : {report.pitch_us, report.roll_us})
    if (us != 0 && (us < identity_.us_min || us > identity_.us_max)) return false;
  if ((report.flags & LevellingReport::kSensorFault) != 0) return true;
  if (report.t1x > report.t2 || report.t1y > report.t2) return false;
  return std::abs(specific_force(report.t1x, report.t2, settings_.x)) <= kMostFelt &&
         std::abs(specific_force(report.t1y, report.t2, settings_.y)) <= kMostFelt;
}

void LevellingUnit::follow(const LevellingReport& report, Stamp now) {
  if (sequence_ >= 0) missing_ += static_cast<std::size_t>((report.sequence - sequence_ - 1) & 0xFFFF);
  sequence_ = report.sequence;
  flags_ = report.flags;
  last_report_ = now;
  const Stamp stamp = stamp_of(report, now);
  if (!sensor_fault()) {
    accelerations_.push_back({stamp, specific_force(report.t1x, report.t2, settings_.x),
                              specific_force(report.t1y, report.t2, settings_.y)});
  }
  aims_.push_back({stamp, angle(report.pitch_us, settings_.pitch), angle(report.roll_us, settings_.roll)});
}

void LevellingUnit::restart_clock() {
  ClockMapConfig config;
  config.resolution = 2e-6;
  config.usual_delay = settings_.delay + time_on_line(line_, kReportBytes, baud());
  clock_ = ClockMap(config);
  counter_.clear();
}

/// The end of the measurement, by the unit's own clock: it tells the middle, and the sums how long it took.
Stamp LevellingUnit::stamp_of(const LevellingReport& report, Stamp now) {
  const WrappingClock::Reading reading = counter_.read(report.time_us >> 1, now);
  if (reading.restarted) restart_clock();
  const double end = reading.time + 0.5 * static_cast<double>(report.t2) / identity_.tick_hz;
  clock_.add(end, now);
  if (now - clock_.host(end) > kMostBehind) {
    restart_clock();
    counter_.read(report.time_us >> 1, now);
    clock_.add(end, now);
  }
  Stamp stamp = std::min(clock_.host(end), now);
  if (last_stamp_ != Stamp::never() && stamp <= last_stamp_) stamp = {last_stamp_.ns + 1};
  last_stamp_ = stamp;
  return stamp;
}

void LevellingUnit::aim(const LaserAim& aim) {
  if (aimed_ && sensor_fault()) return;
  const bool changed = pulse(aim.pitch, settings_.pitch) != pulse(aim_.pitch, settings_.pitch) ||
                       pulse(aim.roll, settings_.roll) != pulse(aim_.roll, settings_.roll);
  if (changed || !aimed_) aim_due_ = true;
  aim_ = aim;
  aimed_ = true;
}

int LevellingUnit::pulse(double angle, const ServoCalibration& servo) const {
  const long us = std::lround(servo.centre_us + angle / servo.radians_per_us);
  return static_cast<int>(std::clamp<long>(us, identity_.us_min, identity_.us_max));
}

std::string LevellingUnit::take_output(Stamp now) {
  std::string out = std::exchange(output_, "");
  if (aim_due_ && ready()) {
    out += levelling_line("S," + std::to_string(pulse(aim_.pitch, settings_.pitch)) + "," +
                          std::to_string(pulse(aim_.roll, settings_.roll)));
    aim_due_ = false;
    aim_sent_ = now;
  }
  if (reports() && !settings_.passive && answer_timer_.due(now)) {
    out += levelling_line("E,1");
    answer_timer_.asked(now);
  }
  return out;
}

Answers LevellingUnit::answers(Stamp now) const {
  // A unit that has not answered yet does not know the question, or is as late as that.
  const double waited = unanswered_ == Stamp::never() ? 0.0 : now - unanswered_;
  if (waited <= AnswerTimer::kUnable && waited > answer_timer_.late(now)) return {waited, true};
  return {answer_timer_.late(now), answer_timer_.missing(now)};
}

Stamp LevellingUnit::deadline() const {
  if (asked_ == Stamp::never()) return {};
  if (!reports()) return asked_ + kAskAgain;
  return aimed_ && aim_sent_ != Stamp::never() ? aim_sent_ + kPulseRefresh : last_report_ + settings_.silence;
}

std::string LevellingUnit::state() const {
  if (!identified_) return "asks who is there";
  if (!reports()) return "waits for the first report of " + identity_.model;
  return identity_.model + (ready() ? " reports" : " reports, but how late it answers is not known yet");
}

std::vector<Acceleration> LevellingUnit::take_accelerations() { return std::exchange(accelerations_, {}); }

std::vector<AimState> LevellingUnit::take_aims() { return std::exchange(aims_, {}); }

}  // namespace rubble::robot
