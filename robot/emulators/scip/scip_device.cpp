#include "robot/emulators/scip/scip_device.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {
namespace {

constexpr std::size_t kLongestLine = 128;   // the longest command has 15 letters and a string of 16
constexpr std::size_t kLongestString = 16;  // of a client's own, behind ';'
constexpr std::size_t kMostWaiting = 4;     // single turns asked for and not yet answered
constexpr std::uint32_t kMostOfTwoCharacters = 4095;

std::string reply(const std::string& echo, const std::string& status) {
  return echo + "\n" + status + sum_of(status) + "\n\n";
}

std::string reply_scip1(const std::string& echo, const std::string& status, const std::string& data = "") {
  return echo + "\n" + status + "\n" + data + "\n";
}

std::string entry(const std::string& key, const std::string& value) {
  const std::string text = key + ":" + value;
  return text + ";" + sum_of(text) + "\n";
}

std::string two(int value) {
  char text[16];
  std::snprintf(text, sizeof text, "%02d", value);
  return text;
}

bool is_plain(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ' ' || c == '.' || c == '_' || c == '+' || c == '@';
  });
}

}  // namespace

DeviceIdentity identity_of(const LaserModel& laser) {
  DeviceIdentity identity;
  Geometry& g = identity.geometry;
  const double steps = 2.0 * kPi / laser.angle_step, before_front = -laser.angle_min / laser.angle_step;
  g.steps_per_turn = static_cast<int>(std::lround(steps));
  const int in_front = static_cast<int>(std::lround(before_front));
  if (std::abs(steps - g.steps_per_turn) > 0.01 || std::abs(before_front - in_front) > 0.01 || in_front < 0 ||
      in_front + laser.beams > 9999)
    throw InputError(
        "the scanner '" + laser.name +
        "' cannot be emulated: its beams do not lie on whole steps of a turn; take URG-04LX or UTM-30LX, or a "
        "field of view that is a multiple of the beams' distance");
  const bool is_urg = laser.name == "URG-04LX";
  identity.model = laser.name;
  g.front_step = is_urg ? identity.geometry.front_step : in_front;
  g.first_step = g.front_step - in_front;
  g.last_step = g.first_step + laser.beams - 1;
  identity.last_of_all = is_urg ? std::max(identity.last_of_all, g.last_step) : g.last_step;
  g.least_mm = std::max(static_cast<int>(kFirstRange), static_cast<int>(std::lround(1000.0 * laser.range_min)));
  if (!is_urg) g.most_mm = static_cast<int>(std::lround(1000.0 * laser.range_max));
  g.turns_per_minute = static_cast<int>(std::lround(60.0 / laser.scan_period));
  return identity;
}

Device::Device(const DeviceIdentity& identity) : identity_(identity) {}

std::vector<std::string> Device::receive(const std::uint8_t* bytes, std::size_t size, double time) {
  std::vector<std::string> replies;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(bytes[i]);
    if (c != '\n' && c != '\r') {
      if (line_.size() < kLongestLine)
        line_ += c;
      else
        line_too_long_ = true;
      continue;
    }
    const std::string line = std::exchange(line_, {});
    const bool too_long = std::exchange(line_too_long_, false);
    if (line.empty() || too_long) continue;  // an empty line is no command; so long a one is noise on the wire
    std::string text = answer(line, time);
    if (!text.empty()) replies.push_back(std::move(text));
  }
  return replies;
}

std::string Device::answer(const std::string& line, double time) {
  return scip2_ ? answer_scip2(line, time) : answer_scip1(line, time);
}

std::string Device::answer_scip1(const std::string& line, double time) {
  if (line == "SCIP2.0") {
    scip2_ = true;
    set_laser(false, time);
    return reply_scip1(line, "0");
  }
  if (line == "V") {
    const Geometry& g = identity_.geometry;
    const int degrees = static_cast<int>(std::lround(360.0 * (g.last_step - g.first_step + 1) / g.steps_per_turn));
    char firmware[128];
    std::snprintf(firmware, sizeof firmware, "FIRM:3.3.00,20/10/08(%d-%d[mm],%d[deg],%d-%d[step],%d[rpm])", g.least_mm,
                  std::min(g.most_mm, static_cast<int>(kMostOfTwoCharacters)), degrees, g.first_step, g.last_step,
                  g.turns_per_minute);
    return reply_scip1(line, "0",
                       "VEND:Hokuyo Automatic Co.,Ltd.\nPROD:SOKUIKI Sensor " + identity_.model + "\n" + firmware +
                           "\nPROT:00003,(SCIP 1.1)\nSERI:" + identity_.serial + "\n");
  }
  if (line == "L0" || line == "L1") {
    set_laser(line == "L1", time);
    return reply_scip1(line, "0");
  }
  if (line[0] == 'S' && line.size() == 14 && number(line.substr(1, 6))) {
    baud_ = *number(line.substr(1, 6));
    return reply_scip1(line, "0");
  }
  if (line[0] == 'G') return ask_scip1(line, time);
  return reply_scip1(line, "E");
}

std::string Device::ask_scip1(const std::string& line, double time) {
  if (line.size() != 9) return reply_scip1(line, "E");
  const auto first = number(line.substr(1, 3)), last = number(line.substr(4, 3)), cluster = number(line.substr(7, 2));
  if (!first || !last || !cluster || *last < *first || *last > identity_.last_of_all) return reply_scip1(line, "E");
  if (!laser_) return reply_scip1(line, "1");
  Question question;
  question.echo = line;
  question.first = *first;
  question.last = *last;
  question.cluster = std::max(1, *cluster);
  question.characters = 2;
  question.since = std::max(laser_since_, time - 2.0 * identity_.geometry.period());
  return once(std::move(question));
}

std::string Device::answer_scip2(const std::string& line, double time) {
  const std::size_t semicolon = line.find(';');
  const std::string command = line.substr(0, semicolon);
  const std::string name = command.substr(0, 2), digits = command.size() > 2 ? command.substr(2) : "";
  if (asking_time_ && name != "TM") return reply(line, "0E");
  if (semicolon != std::string::npos) {
    const std::string own = line.substr(semicolon + 1);
    if (own.size() > kLongestString) return reply(line, "0G");
    if (!is_plain(own)) return reply(line, "0H");
  }
  if (name == "TM") return clock_mode(line, digits, time);
  if (name == "MD" || name == "MS") return ask_stream(line, digits, time);
  if (name == "GD" || name == "GS") return ask_once(line, digits, time);
  if (name == "SS") return bit_rate(line, digits);
  if (name == "CR") return motor(line, digits);
  if (name == "HS") return sensitivity(line, digits);
  if (command == "BM") return laser_on(line, time);
  if (command == "VV") return versions(line);
  if (command == "PP") return parameters(line);
  if (command == "II") return state(line, time);
  if (command == "QT") {
    set_laser(false, time);
    return reply(line, "00");
  }
  if (command == "RS") {
    reset(time);
    return reply(line, "00");
  }
  return reply(line, "0E");  // among them SCIP2.0: the device speaks it already
}

std::string Device::laser_on(const std::string& line, double time) {
  if (laser_) return reply(line, "02");
  set_laser(true, time);
  return reply(line, "00");
}

void Device::set_laser(bool on, double time) {
  if (on && !laser_) laser_since_ = time;
  laser_ = on;
  if (on) return;
  stream_.reset();
  waiting_.clear();
  latest_.reset();
}

void Device::reset(double time) {
  set_laser(false, time);
  asking_time_ = false;
  high_sensitivity_ = false;
  motor_level_ = 0;
  baud_ = 19200;
  clock_zero_ = time;
}

void Device::cycle_power(double time) {
  reset(time);
  line_.clear();
  scip2_ = false;
  set_laser(true, time);
}

void Device::client_left() {
  line_.clear();
  stream_.reset();
  waiting_.clear();
  asking_time_ = false;
  if (scip2_) laser_ = false;
  latest_.reset();
}

std::uint32_t Device::clock(double time) const {
  const double milliseconds = std::floor((time - clock_zero_) * 1000.0);
  const double turns = std::floor(milliseconds / kClockWrap);
  return static_cast<std::uint32_t>(milliseconds - turns * kClockWrap);
}

void Device::set_clock(double time, std::uint32_t milliseconds) { clock_zero_ = time - 0.001 * milliseconds; }

std::string Device::clock_mode(const std::string& line, const std::string& digits, double time) {
  if (digits == "0") {
    if (asking_time_) return reply(line, "02");
    set_laser(false, time);
    asking_time_ = true;
    return reply(line, "00");
  }
  if (digits == "1") {
    if (!asking_time_) return reply(line, "04");
    const std::string now = encode(clock(time), 4);
    return line + "\n00P\n" + now + sum_of(now) + "\n\n";
  }
  if (digits == "2") {
    if (!asking_time_) return reply(line, "03");
    asking_time_ = false;
    return reply(line, "00");
  }
  return reply(line, "01");
}

std::string Device::bit_rate(const std::string& line, const std::string& digits) {
  if (digits.size() < 6) return reply(line, "0C");
  if (digits.size() > 6) return reply(line, "0E");
  const auto rate = number(digits);
  if (!rate) return reply(line, "01");
  if (*rate == 38400) return reply(line, "04");
  const auto known = {19200, 57600, 115200, 250000, 500000, 750000};
  if (std::find(known.begin(), known.end(), *rate) == known.end()) return reply(line, "02");
  if (*rate == baud_) return reply(line, "03");
  baud_ = *rate;
  return reply(line, "00");
}

std::string Device::motor(const std::string& line, const std::string& digits) {
  if (digits.size() < 2) return reply(line, "0C");
  const auto level = number(digits);
  if (!level || digits.size() > 2) return reply(line, "01");
  if (*level > 10 && *level != 99) return reply(line, "02");
  const int wanted = *level == 99 ? 0 : *level;
  if (wanted == motor_level_) return reply(line, "03");
  motor_level_ = wanted;
  return reply(line, "00");
}

std::string Device::sensitivity(const std::string& line, const std::string& digits) {
  if (digits.empty()) return reply(line, "0C");
  if (digits != "0" && digits != "1") return reply(line, "01");
  const bool high = digits == "1";
  if (high == high_sensitivity_) return reply(line, "02");
  high_sensitivity_ = high;
  return reply(line, "00");
}

std::string Device::versions(const std::string& line) const {
  return line + "\n00P\n" + entry("VEND", "Hokuyo Automatic Co.,Ltd.") +
         entry("PROD", "SOKUIKI Sensor " + identity_.model) + entry("FIRM", "3.3.00(20/Oct./2008)") +
         entry("PROT", "SCIP 2.0") + entry("SERI", identity_.serial) + "\n";
}

std::string Device::parameters(const std::string& line) const {
  const Geometry& g = identity_.geometry;
  const auto text = [](int value) { return std::to_string(value); };
  return line + "\n00P\n" + entry("MODL", identity_.model + "(Hokuyo Automatic Co.,Ltd.)") +
         entry("DMIN", text(g.least_mm)) + entry("DMAX", text(g.most_mm)) + entry("ARES", text(g.steps_per_turn)) +
         entry("AMIN", text(g.first_step)) + entry("AMAX", text(g.last_step)) + entry("AFRT", text(g.front_step)) +
         entry("SCAN", text(g.turns_per_minute)) + "\n";
}

std::string Device::state(const std::string& line, double time) const {
  char now[16];
  std::snprintf(now, sizeof now, "%06X", clock(time));
  const std::string rpm = std::to_string(identity_.geometry.turns_per_minute * (100 - motor_level_) / 100);
  const std::string initial = "Initial(" + rpm + "[rpm])<-Default setting by user";
  return line + "\n00P\n" + entry("MODL", identity_.model + "(Hokuyo Automatic Co.,Ltd.)") +
         entry("LASR", laser_ ? "ON" : "OFF") + entry("SCSP", motor_level_ == 0 ? initial : rpm + "[rpm]") +
         entry("MESM", stream_ ? "Measuring by Normal Mode" : "IDLE") +
         entry("SBPS", std::to_string(baud_) + "[bps]<-Default setting by user") + entry("TIME", now) +
         entry("STAT", "Sensor works well.") + "\n";
}

/// Reads ssss eeee cc into the question; the status that refuses them, or an empty text.
std::string Device::range_trouble(std::string_view digits, Question& question) const {
  const auto first = number(digits.substr(0, 4)), last = number(digits.substr(4, 4)),
             cluster = number(digits.substr(8, 2));
  if (!first) return "01";
  if (!last) return "02";
  if (!cluster) return "03";
  if (*last > identity_.last_of_all) return "04";
  if (*last < *first) return "05";
  question.first = *first;
  question.last = *last;
  question.cluster = std::max(1, *cluster);
  return "";
}

std::string Device::ask_once(const std::string& line, const std::string& digits, double time) {
  if (digits.size() < 10) return reply(line, "0C");
  if (digits.size() > 10) return reply(line, "0E");
  Question question;
  question.echo = line;
  question.characters = line[1] == 'D' ? 3 : 2;
  const std::string trouble = range_trouble(digits, question);
  if (!trouble.empty()) return reply(line, trouble);
  if (!laser_) return reply(line, "10");
  question.since = std::max(laser_since_, time - 2.0 * identity_.geometry.period());
  return once(std::move(question));
}

/// The latest turn if nobody has had it yet, else the next one: one answer a turn.
std::string Device::once(Question question) {
  if (latest_ && !latest_->asked_for && latest_->began >= question.since) {
    latest_->asked_for = true;
    return block(question, *latest_, "00");
  }
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back(std::move(question));
  return "";
}

std::string Device::ask_stream(const std::string& line, const std::string& digits, double time) {
  if (digits.size() < 13) return reply(line, "0C");
  if (digits.size() > 13) return reply(line, "0E");
  Question question;
  question.echo = line;
  question.characters = line[1] == 'D' ? 3 : 2;
  const std::string trouble = range_trouble(digits, question);
  if (!trouble.empty()) return reply(line, trouble);
  const auto skip = number(digits.substr(10, 1)), count = number(digits.substr(11, 2));
  if (!skip) return reply(line, "06");
  if (!count) return reply(line, "07");
  question.skip = *skip;
  question.passed = *skip;  // the first turn is sent at once
  question.left = *count == 0 ? -1 : *count;
  question.since = time;
  set_laser(true, time);
  stream_ = std::move(question);
  return reply(line, "00");
}

std::vector<std::string> Device::turn(double began, const std::vector<std::uint32_t>& values) {
  std::vector<std::string> sent;
  if (!laser_ || asking_time_) return sent;
  latest_ = Turn{began, values, false};
  latest_->values.resize(static_cast<std::size_t>(identity_.last_of_all) + 1, kNotMeasurable);
  while (!waiting_.empty() && began >= waiting_.front().since) {
    sent.push_back(block(waiting_.front(), *latest_, "00"));
    waiting_.pop_front();
    latest_->asked_for = true;
  }
  if (auto text = stream_block(*latest_)) sent.push_back(std::move(*text));
  return sent;
}

std::optional<std::string> Device::stream_block(const Turn& turn) {
  if (!stream_ || turn.began < stream_->since) return std::nullopt;
  if (stream_->passed < stream_->skip) {
    ++stream_->passed;
    return std::nullopt;
  }
  stream_->passed = 0;
  if (stream_->left > 0) --stream_->left;
  // The number of scans at the end of the echo counts down.
  if (stream_->left >= 0) stream_->echo.replace(13, 2, two(stream_->left));
  std::string text = block(*stream_, turn, "99");
  if (stream_->left == 0) {
    stream_.reset();
    laser_ = false;
    latest_.reset();
  }
  return text;
}

std::string Device::block(const Question& question, const Turn& turn, const std::string& status) const {
  std::string data;
  const auto group = static_cast<std::size_t>(question.cluster);
  for (auto at = static_cast<std::size_t>(question.first); at <= static_cast<std::size_t>(question.last); at += group) {
    std::uint32_t value = turn.values[at];
    for (std::size_t i = at; i < at + group && i <= static_cast<std::size_t>(question.last); ++i) {
      const std::uint32_t other = turn.values[i];
      if (other >= kFirstRange && (value < kFirstRange || other < value)) value = other;
    }
    const std::uint32_t most = question.characters == 2 ? kMostOfTwoCharacters : (1u << 18) - 1;
    data += encode(std::min(value, most), question.characters);
  }
  if (!scip2_) return reply_scip1(question.echo, "0", cut_into_lines(data, false));
  const std::string time = encode(clock(turn.began), 4);
  return question.echo + "\n" + status + sum_of(status) + "\n" + time + sum_of(time) + "\n" +
         cut_into_lines(data, true) + "\n";
}

}  // namespace rubble::robot::scip
