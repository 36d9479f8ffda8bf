#include "robot/drivers/scip/scip_link.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {
namespace {

constexpr double kAnswerTime = 0.3;  // Hokuyo's own library waits 0.14 s; a busy USB hub may need more [s]
constexpr int kTries = 3;            // of a question whose answer got lost
constexpr double kLinger = 1.2;      // an answer that comes even later is not told from none [s]
constexpr std::size_t kMostGivenUp = 32;
constexpr int kTimeQuestions = 12;
constexpr double kAskAgain = 0.85;  // SCIP 1.1: share of a turn after which the next one is asked for
constexpr double kLost = 2.5;       // SCIP 1.1: turns without a byte after which an answer counts as lost
constexpr std::array<int, 4> kBauds{115200, 19200, 57600, 500000};

std::string four(int value) {
  char text[16];
  std::snprintf(text, sizeof text, "%04d", value);
  return text;
}

std::string three(int value) { return four(value).substr(1); }

std::string value_of(const Entries& entries, const std::string& key) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.first == key; });
  return found == entries.end() ? std::string() : found->second;
}

}  // namespace

std::pair<Stamp, Stamp> when_read(Stamp asked, Stamp answered, LineKind line, int baud) {
  constexpr double kQuestion = 4.0, kAnswer = 15.0;  // bytes of "TM1\n" and of "TM1\n00P\nTTTTS\n\n"
  const Stamp soonest = asked + time_on_line(line, kQuestion, baud);
  const Stamp latest = answered - time_on_line(line, kAnswer, baud);
  return {soonest, std::max(soonest, latest)};
}

Link::Link(std::unique_ptr<Port> port) : port_(std::move(port)) {}

/// Where answers came too late for their questions, the next ones were taken for something else: that is the trouble.
void Link::refuse(const std::string& what) const {
  if (late_ > 0) refuse_late();
  throw Refused(port_->name() + ": " + what);
}

void Link::send(const std::string& command) {
  const std::string line = command + "\n";
  asked_ = host_now();
  port_->write(reinterpret_cast<const std::uint8_t*>(line.data()), line.size(), asked_);
}

void Link::pull(double timeout) {
  std::array<std::uint8_t, 4096> bytes;
  const auto [size, stamp] = port_->read(bytes.data(), bytes.size(), timeout);
  if (size == 0) return;
  heard_ = stamp;
  receiver_.push(bytes.data(), size, stamp);
}

/// Throws away what comes until the line has been silent for so long, but for a second at most.
void Link::drain(double silence) {
  std::array<std::uint8_t, 4096> bytes;
  const Stamp end = host_now() + 1.0;
  while (host_now() < end && port_->read(bytes.data(), bytes.size(), silence).size > 0) {
  }
  receiver_.clear();
}

std::optional<Reply> Link::ask(const std::string& command, double timeout) {
  receiver_.expect_echo(command, command.size());
  send(command);
  const Stamp end = host_now() + timeout;
  for (;;) {
    while (auto reply = receiver_.next()) {
      if (reply->lines[0] == command && status_of(*reply)) {
        answered_ = true;
        // It may be to the same question asked before: then the answer to this one is still to come.
        for (auto& [question, asked] : given_up_)
          if (question == command) asked = asked_;
        return reply;
      }
      mind_late_answer(*reply);
      if (stream_.empty() || reply->lines[0].rfind(stream_, 0) != 0) ++damaged_;
    }
    const double left = end - host_now();
    if (left <= 0.0) {
      if (given_up_.size() == kMostGivenUp) given_up_.erase(given_up_.begin());
      given_up_.emplace_back(command, asked_);
      return std::nullopt;
    }
    pull(left);
  }
}

/// Takes note of an answer to a question that was given up. Of several the same the last one is taken to be meant: it
/// may be later than it seems, but one answer lost and another in time are never called a late one.
void Link::mind_late_answer(const Reply& reply) {
  const auto same = [&](const auto& question) { return question.first == reply.lines[0]; };
  const auto found = std::find_if(given_up_.rbegin(), given_up_.rend(), same);
  if (found == given_up_.rend() || !status_of(reply)) return;
  const double took = reply.ended - found->second;
  given_up_.erase(std::remove_if(given_up_.begin(), given_up_.end(), same), given_up_.end());
  if (took <= kAnswerTime) return;
  ++late_;
  latest_ = std::max(latest_, took);
}

void Link::refuse_late() const {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the scanner answers too late, %.1f s or more after it was asked (at most %.1f s); the line to it (radio, relay, "
      "serial server) is too slow",
      latest_, kAnswerTime);
  throw TooLate(port_->name() + ": " + text);
}

Reply Link::insist(const std::string& command) {
  for (int i = 0; i < kTries; ++i)
    if (auto reply = ask(command, kAnswerTime)) return *reply;
  refuse("the scanner does not answer '" + command + "'; unplug it and plug it in again");
}

bool Link::find_at(int baud) {
  if (port_->is_serial()) port_->set_baud(baud);
  baud_ = baud;
  send("");  // ends whatever half a command the device has got
  for (int i = 0; i < 2; ++i) {
    const auto reply = ask("QT", kAnswerTime);
    if (!reply) continue;
    const std::string status = *status_of(*reply);
    scip2_ = status.size() == 2;
    // 0E: the device was left in the mode in which its clock is asked.
    if (status == "0E") ask("TM2", kAnswerTime);
    return true;
  }
  return false;
}

bool Link::find_device() {
  if (!port_->is_serial()) return find_at(kBauds[0]);
  return std::any_of(kBauds.begin(), kBauds.end(), [this](int baud) { return find_at(baud); });
}

void Link::switch_to_scip2() {
  const auto reply = ask("SCIP2.0", kAnswerTime);
  scip2_ = reply && *status_of(*reply) == "0";
  // The answer may be lost though the device has switched: then it answers this in the new form.
  if (!reply) {
    const auto now = ask("QT", kAnswerTime);
    scip2_ = now && status_of(*now)->size() == 2;
  }
}

bool Link::knock() {
  drain(0.01);
  if (find_device()) return true;
  if (port_->is_serial()) return false;            // there the other bit rates were tried meanwhile
  if (heard_ != Stamp::never()) return late_ > 1;  // else what came was spoilt: nothing is on its way
  for (const Stamp end = host_now() + kLinger; late_ == 0 && host_now() < end;) {
    pull(end - host_now());
    while (const auto reply = receiver_.next()) mind_late_answer(*reply);
  }
  return late_ > 0;
}

void Link::shake_hands(bool only_scip1) {
  if (!knock())
    throw DeviceLost(
        port_->name() +
        ": no scanner answers; check its power and that no other program uses the port, or try another one");
  if (late_ > 0 && !answered_) refuse_late();
  if (!scip2_ && !only_scip1) switch_to_scip2();
  if (scip2_ && only_scip1) refuse("the scanner has been switched to SCIP 2.0; switch it off and on to speak SCIP 1.1");
  // A serial line at 19200 baud carries one scan a second; over USB the rate means nothing and costs nothing.
  if (scip2_ && baud_ != kBauds[0]) {
    const auto reply = ask("SS115200", kAnswerTime);
    if (reply && *status_of(*reply) == "00") {  // a device that refuses stays where it is
      baud_ = kBauds[0];
      port_->set_baud(baud_);
    }
  }
  if (scip2_) {
    identify();
  } else {
    identify_scip1();
  }
  if (late_ > 1) refuse_late();  // one: the computer or the line was held up for a moment
}

void Link::identify() {
  const auto ask_entries = [this](const std::string& command) {
    for (int i = 0; i < kTries; ++i) {
      const Reply reply = insist(command);
      const auto entries = entries_of(reply, true);
      if (*status_of(reply) == "00" && entries) return *entries;
      ++damaged_;
    }
    refuse("the scanner answers '" + command + "' with wrong sums; check the cable");
  };
  const Entries version = ask_entries("VV"), sensor = ask_entries("PP");
  const auto geometry = geometry_of(sensor);
  if (!geometry) refuse("the scanner's geometry (PP) makes no sense; is it a Hokuyo scanner of SCIP 2.0?");
  geometry_ = *geometry;
  info_ = {};
  info_.model = value_of(sensor, "MODL");
  info_.firmware = value_of(version, "FIRM");
  info_.serial = value_of(version, "SERI");
  info_.protocol = "SCIP 2.0";
  info_.laser = laser_of(geometry_, info_.model);
  info_.lines = version;
  info_.lines.insert(info_.lines.end(), sensor.begin(), sensor.end());
}

void Link::identify_scip1() {
  const Reply reply = insist("V");
  const auto version = entries_of(reply, false);
  const auto geometry = version ? geometry_of_firmware(value_of(*version, "FIRM")) : std::nullopt;
  if (!geometry) refuse("the scanner does not tell its geometry in SCIP 1.1; use SCIP 2.0");
  geometry_ = *geometry;
  info_ = {};
  info_.model = value_of(*version, "PROD");
  info_.firmware = value_of(*version, "FIRM");
  info_.serial = value_of(*version, "SERI");
  info_.protocol = "SCIP 1.1";
  info_.laser = laser_of(geometry_, info_.model);
  info_.lines = *version;
}

void Link::ask_time(WrappingClock& clock, ClockMap& map) {
  if (!scip2_) return;
  // What is lost on a spoilt line is asked again: without the device's clock stamps are off by milliseconds.
  std::optional<Reply> on;
  for (int i = 0; i < kTries && !on; ++i) on = ask("TM0", kAnswerTime);
  if (!on) ask("TM2", kAnswerTime);  // it may have heard the question all the same, and would refuse all that follows
  if (!on || (*status_of(*on) != "00" && *status_of(*on) != "02"))
    return;  // an old firmware: the usual delay has to do
  const bool is_spoilt_line = damaged() > 0;
  int told = 0, spoilt = 0, damaged_times = 0;
  for (int i = 0; i < kTimeQuestions && spoilt - told < kTries; ++i) {
    // The questions fall on different parts of the device's millisecond, which narrows the offset down further.
    sleep_until(host_now() + (i % 4) * 0.00027);
    const auto reply = ask("TM1", kAnswerTime);
    if (reply && *status_of(*reply) != "00") continue;
    const auto text = reply && reply->lines.size() > 2 ? checked(reply->lines[2]) : std::nullopt;
    const auto count = text && text->size() == 4 ? decode(*text) : std::nullopt;
    ++(count ? told : spoilt);
    damaged_times += reply && !count ? 1 : 0;
    if (!count) continue;
    const WrappingClock::Reading reading = clock.read(*count, reply->ended);
    if (reading.restarted) map.clear();
    const auto [soonest, latest] = when_read(asked_, reply->ended, port_->kind(), baud_);
    map.anchor(reading.time, soonest, latest);
  }
  insist("TM2");
  // Where nothing else is spoilt these are what its firmware sends; a spoilt line may do better the next time.
  if (is_spoilt_line && damaged_times > 0 && told == 0)
    refuse("the scanner's answers about its clock (TM1) come spoilt; check the cable");
}

void Link::start() {
  if (!scip2_) {
    ask("L1", kAnswerTime);  // on from power-up; a device that does not know the command needs none
    stream_ = "G" + three(geometry_.first_step) + three(geometry_.last_step) + "01";
    receiver_.expect_echo(stream_, stream_.size());
    send(stream_);
    ask_at_ = Stamp::never();
    return;
  }
  const std::string on = *status_of(insist("BM"));
  if (on != "00" && on != "02") refuse("the laser does not light up (BM: " + on + "); the scanner is broken");
  stream_ = "MD" + four(geometry_.first_step) + four(geometry_.last_step) + "010";
  const std::string command = stream_ + "00";
  const std::string status = *status_of(insist(command));
  if (status != "00" && status != "99")
    refuse("the scanner does not send scans (MD: " + status + "); switch it off and on");
  receiver_.expect_echo(stream_, command.size());
  late_ = 0;
}

std::string Link::state() {
  if (!scip2_) return "";
  const auto reply = ask("II", kAnswerTime);
  const auto entries = reply ? entries_of(*reply, true) : std::nullopt;
  return entries ? value_of(*entries, "STAT") : std::string();
}

std::optional<Sweep> Link::check_stream(const Reply& reply) {
  if (reply.lines[0].rfind(stream_, 0) != 0) {
    ++damaged_;
    return std::nullopt;
  }
  const auto status = status_of(reply);
  if (scip2_ && status && *status == "00" && reply.lines.size() == 2) return std::nullopt;  // the command's own answer
  std::optional<Sweep> sweep;
  if (status && *status == (scip2_ ? "99" : "0"))
    sweep = scip2_ ? sweep_of(reply, geometry_.steps()) : old_sweep_of(reply, geometry_.steps());
  if (status && scip2_ && *status != "99" && *status != "98")
    refuse("the scanner reports trouble (status " + *status + "); it is started anew");
  if (!sweep) {
    ++damaged_;
    return std::nullopt;
  }
  begun_ = reply.begun;
  ended_ = reply.ended;
  return sweep;
}

std::optional<Sweep> Link::next_sweep(double timeout) {
  const Stamp end = host_now() + timeout;
  for (;;) {
    while (const auto reply = receiver_.next()) {
      auto sweep = check_stream(*reply);
      // One question a turn: an emulator or a fast device would answer the same turn again and again. The next one is
      // asked in a later call, for nobody shall wait for that.
      if (!scip2_) ask_at_ = sweep ? begun_ + kAskAgain * geometry_.period() : host_now();
      if (sweep) return sweep;
    }
    if (!scip2_ && host_now() >= next_question()) {
      send(stream_);
      ask_at_ = Stamp::never();
    }
    const Stamp now = host_now();
    if (now >= end) return std::nullopt;
    pull((scip2_ ? end : std::min(end, next_question())) - now);
  }
}

/// SCIP 1.1: as planned, or when the answer to the last one seems to have got lost; a slow line still brings bytes of
/// it.
Stamp Link::next_question() const {
  return ask_at_ != Stamp::never() ? ask_at_ : std::max(asked_, heard_) + kLost * geometry_.period();
}

void Link::stop() {
  try {
    if (scip2_) ask("QT", kAnswerTime);
  } catch (const std::exception&) {
    // The device is gone; there is nothing to switch off.
  }
}

}  // namespace rubble::robot::scip
