#include "robot/drivers/pioneer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/planar.h"
#include "base/text/words.h"
#include "robot/hardware_units.h"
#include "robot/protocols/arcos_commands.h"

namespace rubble::robot {
namespace {

using arcos::command;

constexpr std::size_t kHead = 3;                                         ///< bytes of a packet before its payload
constexpr double kReply = 0.5;                                           ///< an echo comes within this time [s]
constexpr double kSlowestReply = 3.0;                                    ///< the same on a line that is slow [s]
constexpr std::array<int, 5> kBauds{9600, 38400, 19200, 115200, 57600};  ///< tried in turn on a serial line
constexpr int kTries = 3;                                                ///< questions before the next bit rate
constexpr double kConfigReply = 1.0;                                     ///< [s]
constexpr double kListenOnce = 0.4;  ///< for reports of a bit rate, which come ten times a second [s]
constexpr double kListenTcp = 1.2;   ///< where there is but one [s]
constexpr double kSpacing = 0.004;   ///< the firmware wants so much between two commands [s]
constexpr double kRefresh = 0.2;     ///< set points are sent again [s]; the firmware forgets them after 2 s
constexpr double kAskMotors = 0.5;   ///< [s]
constexpr double kStubborn = 2.0;    ///< motors that stay on for so long though switched off do not hear that order [s]
constexpr double kBrakes = 2.0;      ///< and so much more it may take to come to rest [s]
constexpr int kOnce = 1;             ///< of ENCODER
constexpr double kRefused = 5.0;     ///< a robot that cannot be read is asked again who it is [s]

/// Difference of two rolled-over coordinates; older firmware rolls over at 15 bits, so only these are compared [mm].
int rolled_difference(std::uint16_t to, std::uint16_t from) {
  const int low = (to - from) & 0x7FFF;
  return low >= 0x4000 ? low - 0x8000 : low;
}

int heading_difference(std::int16_t to, std::int16_t from) {
  const int low = (to - from) & 0x0FFF;
  return low >= 0x0800 ? low - 0x1000 : low;
}

}  // namespace

void Pioneer::go(Step step, Stamp now) {
  step_ = step;
  tries_ = 0;
  since_ = now;
}

void Pioneer::opened(Stamp now, LineKind line) {
  line_ = line;
  refusal_.clear();
  parser_.reset();
  clock_.reset();
  answer_timer_.reset();
  reply_ = closed_for_ = kReply;
  echo_late_ = 0.0;
  on_since_ = Stamp::never();
  queue_.clear();
  based_ = false;
  last_report_ = Stamp::never();
  v_due_ = w_due_ = false;
  listening_ = settings_.listen;
  go(listening_ ? Step::Listening : Step::Sync0, now);
  if (!listening_) ask(now);
}

void Pioneer::ask(Stamp now) {
  since_ = now;
  ++tries_;
  switch (step_) {
    case Step::Sync0:
      asked_ = now;
      return send(command(arcos::kSync0));
    case Step::Sync1:
      return send(command(arcos::kSync1));
    case Step::Sync2:
      return send(command(arcos::kSync2));
    default:
      return;
  }
}

int Pioneer::baud() const { return line_ != LineKind::Tcp ? kBauds[rate_ % kBauds.size()] : 0; }

void Pioneer::try_next_rate(Stamp now) {
  if (line_ != LineKind::Tcp) ++rate_;
  parser_.reset();
  go(Step::Sync0, now);
  ask(now);
}

/// So long reports are waited for that somebody else's connection brings [s].
double Pioneer::patience() const { return line_ == LineKind::Tcp ? kListenTcp : kListenOnce; }

/// Nobody was heard at this bit rate.
void Pioneer::listen_on(Stamp now) {
  parser_.reset();
  const bool all = line_ == LineKind::Tcp || tries_ + 1 >= static_cast<int>(kBauds.size());
  if (line_ != LineKind::Tcp) ++rate_;
  since_ = now;
  ++tries_;
  if (!all || overheard_) return;
  listening_ = false;  // nobody talks with it: it is spoken to
  go(Step::Sync0, now);
  ask(now);
}

void Pioneer::advance(Stamp now) {
  switch (step_) {
    case Step::Closed:
      return;
    case Step::Listening:
      if (now - since_ >= patience()) listen_on(now);
      return;
    case Step::Sync0:
    case Step::Sync1:
    case Step::Sync2:
      if (now - since_ < reply_) return;
      if (tries_ >= kTries) return try_next_rate(now);
      step_ = Step::Sync0;  // the firmware takes the three in their order only: a lost echo means all over again
      return ask(now);
    case Step::Closing:
      if (now - since_ < closed_for_) return;
      parser_.reset();
      go(Step::Sync0, now);
      return ask(now);
    case Step::Refused:
      if (now - since_ < kRefused) return;
      go(Step::Sync0, now);
      return ask(now);
    case Step::Opening:
      if (configured_ || now - since_ >= kConfigReply) return go(Step::Running, now);
      return;
    case Step::Running:
      break;
  }
  if (listening_) return mind_silence(now);
  if (now - heard() > settings_.silence) {
    // The robot was switched off and on, or somebody closed it: all over again.
    disconnect();
    closed_for_ = kReply;
    return go(Step::Closing, now);
  }
  if (stays_on(now)) return leave_to_its_watchdog(now);
  refresh(now);
}

/// Its motors were switched off, again and again, and it reports them on.
bool Pioneer::stays_on(Stamp now) {
  const bool stays = step_ == Step::Running && !listening_ && switched_off_ && motors_on();
  if (!stays) on_since_ = Stamp::never();
  if (stays && on_since_ == Stamp::never()) on_since_ = now;
  return stays && now - on_since_ > kStubborn;
}

/// CLOSE stops it, if it hears that, and else that nobody speaks to it.
void Pioneer::leave_to_its_watchdog(Stamp now) {
  on_since_ = Stamp::never();
  disconnect();
  queue_.push_front(command(arcos::kEnable, 0));
  queue_.push_front(command(arcos::kEmergencyStop));
  closed_for_ = left_alone();
  closed_at_ = now;
  go(Step::Closing, now);
}

/// The next connection begins with an odometry of zero.
void Pioneer::disconnect() {
  queue_.clear();
  send(command(arcos::kClose));
  last_report_ = Stamp::never();
  based_ = false;
  clock_.reset();
  answer_timer_.reset();
}

bool Pioneer::times_answers() const { return step_ == Step::Running && !listening_ && !settings_.passive; }

/// The robot has answered how far its wheels have turned. It does so behind its next report, which it is half a cycle
/// till in the mean.
void Pioneer::mind_answer(std::size_t bytes, Stamp now) {
  const double on_wire = static_cast<double>(command(arcos::kEncoder, kOnce).size() + report_bytes_ + bytes);
  answer_timer_.answered(now, time_on_line(line_, on_wire, baud()) + 0.5e-3 * configuration_.cycle_ms);
}

/// An echo that was not expected any more: the line is slower than thought. Once the line is empty again, echoes are
/// given as long as they take.
void Pioneer::mind_late_echo(Stamp now) {
  const double late = now - asked_;
  if (late < kReply / 2.0) return;  // one that was doubled on its way
  echo_late_ = late;
  reply_ = std::clamp(late + 2.0 * kReply, reply_, kSlowestReply);
}

Stamp Pioneer::heard() const { return last_report_ == Stamp::never() ? since_ : last_report_; }

/// Of who only listens.
void Pioneer::mind_silence(Stamp now) {
  if (!listening_ || step_ != Step::Running || now - heard() <= settings_.silence) return;
  based_ = false;  // whoever has it may open it anew, which sets its odometry to zero
  last_report_ = Stamp::never();
  clock_.reset();
  go(Step::Listening, now);
}

void Pioneer::receive(std::string_view bytes, Stamp now) {
  mind_silence(now);
  parser_.feed(bytes, now);
  std::vector<std::string> payloads;
  std::size_t reports = 0;
  while (auto payload = parser_.next(now)) {
    reports += arcos::parse_information(*payload) ? 1 : 0;
    payloads.push_back(std::move(*payload));
  }
  for (const std::string& payload : payloads) {
    if (arcos::parse_information(payload)) --reports;
    digest(payload, now, reports);
  }
}

/// `behind`: so many reports came with this packet and after it.
void Pioneer::digest(const std::string& payload, Stamp now, std::size_t behind) {
  const auto report = arcos::parse_information(payload);
  const auto is_syncing = [this] { return step_ == Step::Sync0 || step_ == Step::Sync1 || step_ == Step::Sync2; };
  // Who listens asks for the first time when nothing was heard: a report between is of somebody who opened it just now.
  const bool overtaken = is_syncing() && settings_.listen && !opened_;
  if ((step_ == Step::Listening || overtaken) && report) {
    listening_ = overheard_ = true;
    forget_questions();
    go(Step::Running, now);
  }
  if (is_syncing() && report) {
    // Open since a client that died: SYNC0 was a PULSE to it.
    send(command(arcos::kClose));
    return go(Step::Closing, now);
  }
  if (is_syncing()) {
    const auto echo = static_cast<std::uint8_t>(payload[0]);
    const int expected = step_ == Step::Sync0 ? 0 : step_ == Step::Sync1 ? 1 : 2;
    if (echo != expected) {
      if (echo == 0) mind_late_echo(now);
      return go(Step::Sync0, now);
    }
    if (step_ == Step::Sync2) {
      const auto identity = arcos::parse_identity(payload);
      if (!identity) return;
      const double bytes = static_cast<double>(command(arcos::kSync2).size() + payload.size() + 5);
      answer_timer_.assume(now - since_ - time_on_line(line_, bytes, baud()));  // no motor is on before that is known
      // What a device says of itself comes onto the terminal: no escapes in it.
      identity_ = {one_line(identity->name), one_line(identity->type), one_line(identity->subclass)};
      const auto factors = arcos::factors_of(identity_.subclass);
      if (!factors) {
        refusal_ = "is a '" + identity_.subclass + "', whose units are not known; known are " +
                   arcos::known_subclasses() + ", another needs a driver of its own";
        return go(Step::Refused, now);
      }
      factors_ = *factors;
      refusal_.clear();
      return open(now);
    }
    go(step_ == Step::Sync0 ? Step::Sync1 : Step::Sync2, now);
    return ask(now);
  }
  if (step_ == Step::Closing && closed_for_ > kReply && report && (report->flags & arcos::kMotorsOn) != 0) {
    since_ = now;  // its watchdog stops it only as long as nobody speaks
    const bool moves = report->moving || report->left != 0 || report->right != 0;
    if (moves && stands_ && now - closed_at_ < kBrakes) roused_ = true;
    stands_ = !moves;
    // Where that did not help either somebody else speaks to it; or it stands, and may hear again. One that obeys
    // nothing, but goes on when it is spoken to, is left standing.
    if (now - closed_at_ >= left_alone() + kBrakes && (moves || !roused_)) leave_to_its_watchdog(now);
  }
  if (step_ != Step::Opening && step_ != Step::Running) return;
  if (const auto configuration = arcos::parse_configuration(payload)) {
    configuration_ = *configuration;
    for (std::string* text : {&configuration_.type, &configuration_.subtype, &configuration_.serial,
                              &configuration_.name, &configuration_.firmware})
      *text = one_line(*text);
    configured_ = true;
    clock_.set_cycle(1e-3 * configuration_.cycle_ms);
  }
  if (static_cast<std::uint8_t>(payload[0]) == arcos::kEncoderPacket) mind_answer(payload.size() + 5, now);
  if (!report) return;
  report_bytes_ = payload.size() + 5;
  follow(*report, clock_.stamp(sampled(payload.size() + 5, now), behind));
  mind_hold();
  last_report_ = now;
}

/// When the robot took what it sent in so many bytes.
Stamp Pioneer::sampled(std::size_t bytes, Stamp received) const {
  return received - (time_on_line(line_, static_cast<double>(bytes), baud()) + settings_.delay);
}

void Pioneer::open(Stamp now) {
  go(Step::Opening, now);
  configured_ = false;
  based_ = false;
  opened_ = true;
  stands_ = roused_ = false;
  send(command(arcos::kOpen, 1));
  send(command(arcos::kConfig, 1));
  const int accel = rounded(settings_.max_accel / kMillimetre);
  const int turn_accel = rounded(rad_to_deg(settings_.max_turn_accel));
  send(command(arcos::kSetSpeed, rounded(settings_.max_v / kMillimetre)));
  send(command(arcos::kSetAcceleration, accel));
  send(command(arcos::kSetAcceleration, -accel));
  send(command(arcos::kSetTurnRate, rounded(rad_to_deg(settings_.max_w))));
  send(command(arcos::kSetTurnAcceleration, turn_accel));
  send(command(arcos::kSetTurnAcceleration, -turn_accel));
  v_due_ = w_due_ = !settings_.passive;  // whatever set points a former client left
  asked_motors_ = Stamp::never();
  obeyed_ = false;  // a robot that was restarted has its motors off
}

/// The buttons on the robot are above whatever is asked for here.
void Pioneer::mind_hold() {
  if (settings_.passive) return;
  if (emergency_button()) {
    hold_ = Hold::EmergencyButton;
  } else if (motors_ && obeyed_ && !motors_on() && hold_ == Hold::None) {
    hold_ = Hold::MotorsOff;
  }
  if (hold_ != Hold::None) enable(false);
  obeyed_ = motors_ && motors_on();
}

void Pioneer::rearm() {
  if (!emergency_button()) hold_ = Hold::None;
}

/// Adds the motion between two reports to the pose. A report that jumps farther than the robot can have moved comes
/// from an origin set anew (or a firmware that was restarted): it becomes the reference, and the wheels' speeds say
/// what happened meanwhile.
void Pioneer::follow(const arcos::StandardInformation& report, Stamp stamp) {
  const double half_track = settings_.track > 0.0 ? 0.5 * settings_.track : factors_.half_track();
  Odometry odometry;
  odometry.stamp = stamp;
  odometry.v = 0.5 * kMillimetre * (report.left + report.right) * settings_.distance_scale;
  odometry.w = kMillimetre * (report.right - report.left) / (2.0 * half_track) * settings_.turn_scale;
  odometry.stalled = (report.stall & (arcos::kLeftStall | arcos::kRightStall)) != 0;
  if (based_) {
    const double dx = kMillimetre * factors_.distance * rolled_difference(report.x, information_.x);
    const double dy = kMillimetre * factors_.distance * rolled_difference(report.y, information_.y);
    const double dphi = kArcosHeadingUnit * heading_difference(report.heading, information_.heading);
    const double dt = std::clamp(stamp - last_stamp_, 0.1, 2.0);
    const double before = kArcosHeadingUnit * information_.heading;
    double ahead = std::cos(before) * dx + std::sin(before) * dy;
    double aside = -std::sin(before) * dx + std::cos(before) * dy;
    double turn = dphi;
    const double v = 0.5 * kMillimetre *
                     std::max(std::abs(report.left + report.right), std::abs(information_.left + information_.right));
    const double w = kMillimetre / (2.0 * std::min(half_track, factors_.half_track())) *
                     std::max(std::abs(report.right - report.left), std::abs(information_.right - information_.left));
    const double farthest = 0.03 + 1.5 * v * dt + 0.5 * settings_.max_accel * dt * dt;
    const double widest = deg_to_rad(3.0) + 1.5 * w * dt + 0.5 * settings_.max_turn_accel * dt * dt;
    if (length(dx, dy) > farthest || std::abs(turn) > widest) {
      ++jumps_;
      turn = odometry.w / settings_.turn_scale * dt;
      ahead = odometry.v / settings_.distance_scale * dt;
      aside = 0.0;
    }
    ahead *= settings_.distance_scale;
    aside *= settings_.distance_scale;
    pose_.x += std::cos(pose_.phi) * ahead - std::sin(pose_.phi) * aside;
    pose_.y += std::sin(pose_.phi) * ahead + std::cos(pose_.phi) * aside;
    pose_.phi = wrap_angle(pose_.phi + turn * settings_.turn_scale);
  }
  based_ = true;
  information_ = report;
  last_stamp_ = stamp;
  odometry.pose = pose_;
  odometry_.push_back(odometry);
}

void Pioneer::drive(const Drive& drive) {
  if (settings_.passive) return;
  target_.v = motors_ ? std::clamp(drive.v, -settings_.max_v, settings_.max_v) : 0.0;
  target_.w = motors_ ? std::clamp(drive.w, -settings_.max_w, settings_.max_w) : 0.0;
  // An answer to what was just seen leaves at once; the dithering goes on at its own pace.
  if (rounded(target_.v / kMillimetre) != v_sent_) v_due_ = true;
  if (std::abs(rad_to_deg(target_.w) - w_sent_) >= 1.0 || (target_.w == 0.0 && w_sent_ != 0)) w_due_ = true;
}

/// ESTOP leaves the motors on, and ends with the next set point.
void Pioneer::brake() {
  drive({});
  if (settings_.passive || step_ != Step::Running) return;
  forget_motion();
  asked_motors_ = Stamp::never();
  turn_ = {};
  v_sent_ = w_sent_ = 0;
  v_due_ = w_due_ = false;
  refreshed_ = sent_;  // a set point right behind it would bring the ramp back
  queue_.push_front(command(arcos::kEmergencyStop));
}

void Pioneer::enable(bool on) {
  if (settings_.passive || hold_ != Hold::None) on = false;
  if (on != motors_) {
    asked_motors_ = Stamp::never();
    obeyed_ = false;
    switched_off_ = !on;
  }
  motors_ = on;
  if (!on) drive({});
}

/// What would set the robot in motion again behind a stop.
void Pioneer::forget_motion() {
  const auto moves = [](const std::string& packet) {
    const auto order = arcos::parse_order(std::string_view(packet).substr(kHead));
    return order &&
           (order->number == arcos::kEnable || order->number == arcos::kVelocity || order->number == arcos::kTurnRate);
  };
  queue_.erase(std::remove_if(queue_.begin(), queue_.end(), moves), queue_.end());
}

/// To one who opened the base meanwhile they would be a pulse.
void Pioneer::forget_questions() {
  const auto asks = [](const std::string& packet) {
    const auto order = arcos::parse_order(std::string_view(packet).substr(kHead));
    return order && order->number <= arcos::kSync2;
  };
  queue_.erase(std::remove_if(queue_.begin(), queue_.end(), asks), queue_.end());
}

void Pioneer::stop() {
  if (settings_.passive) return;
  enable(false);
  forget_motion();
  queue_.push_front(command(arcos::kEnable, 0));
  queue_.push_front(command(arcos::kStop));
}

void Pioneer::emergency_stop() {
  enable(false);
  forget_motion();
  queue_.push_front(command(arcos::kEnable, 0));
  queue_.push_front(command(arcos::kEmergencyStop));
}

/// Marks what must be said at `now`.
void Pioneer::refresh(Stamp now) {
  // Reports come without a pulse. It would keep the set points of another program, which came later, alive after its
  // end: the base's watchdog must not hear from who does not drive.
  if (settings_.passive) return;
  answer_timer_.advance(now);
  if (motors_ != motors_on() && (asked_motors_ == Stamp::never() || now - asked_motors_ >= kAskMotors)) {
    asked_motors_ = now;
    send(command(arcos::kEnable, motors_ ? 1 : 0));
  }
  if (turn_.restless() && now - turn_decided_ >= RateDither::kPeriod - 1e-4) w_due_ = true;
  if (refreshed_ == Stamp::never() || now - refreshed_ >= kRefresh) {
    refreshed_ = now;
    v_due_ = w_due_ = true;
  }
}

std::string Pioneer::take_output(Stamp now) {
  if (sent_ != Stamp::never() && now - sent_ < kSpacing && now >= sent_) return "";
  std::string out;
  if (!queue_.empty()) {
    out = std::move(queue_.front());
    queue_.pop_front();
  } else if (v_due_ && step_ == Step::Running) {
    v_sent_ = rounded(target_.v / kMillimetre);
    out = command(arcos::kVelocity, v_sent_);
    v_due_ = false;
  } else if (w_due_ && step_ == Step::Running) {
    w_sent_ = turn_.next(rad_to_deg(target_.w), now);
    turn_decided_ = now;
    out = command(arcos::kTurnRate, w_sent_);
    w_due_ = false;
  } else if (times_answers() && answer_timer_.due(now)) {
    out = command(arcos::kEncoder, kOnce);
    answer_timer_.asked(now);
  }
  if (!out.empty()) sent_ = now;
  return out;
}

std::vector<std::string> Pioneer::farewell() {
  if (step_ == Step::Closed || step_ == Step::Refused || listening_) return {};
  return {command(arcos::kStop), command(arcos::kEnable, 0), command(arcos::kClose)};
}

Stamp Pioneer::deadline() const {
  if (step_ == Step::Closed) return {since_.ns + 1'000'000'000};
  const bool waiting = !queue_.empty() || (step_ == Step::Running && (v_due_ || w_due_));
  if (waiting) return sent_ == Stamp::never() ? since_ : sent_ + kSpacing;
  if (step_ == Step::Refused) return since_ + kRefused;
  if (step_ == Step::Listening) return since_ + patience();
  if (step_ == Step::Opening) return since_ + (configured_ ? 0.0 : kReply);
  if (step_ != Step::Running) return since_ + (step_ == Step::Closing ? closed_for_ : reply_);
  if (listening_ || settings_.passive) return heard() + settings_.silence;
  Stamp next = refreshed_ == Stamp::never() ? since_ : refreshed_ + kRefresh;
  if (turn_.restless()) next = std::min(next, turn_decided_ + RateDither::kPeriod);
  if (times_answers())
    next = std::min(next, std::max(answer_timer_.next(), sent_ == Stamp::never() ? since_ : sent_ + kSpacing));
  return next;
}

std::string Pioneer::late_echoes() const {
  if (echo_late_ <= 0.0) return "";
  char text[80];
  std::snprintf(text, sizeof text, "; it answers %.1f s late, the line to it is too slow", echo_late_);
  return text;
}

std::string Pioneer::state() const {
  if (!refusal_.empty()) return refusal_;
  const std::string rate = line_ != LineKind::Tcp ? " at " + std::to_string(baud()) + " baud" : "";
  switch (step_) {
    case Step::Closed:
    case Step::Refused:
      return "closed";
    case Step::Listening:
      return (overheard_ ? "listens for whoever had it" : "listens whether somebody else has it") + rate;
    case Step::Sync0:
    case Step::Sync1:
    case Step::Sync2:
      return "asks who is there" + rate + late_echoes();
    case Step::Closing:
      if (closed_for_ > kReply) return "is left to its watchdog: its motors stay on though switched off" + rate;
      return "closes an old connection" + rate;
    case Step::Opening:
      return "opens " + identity_.subclass + late_echoes();
    case Step::Running:
      break;
  }
  if (listening_) return "listened to";
  return ready() ? identity_.subclass + " reports" : "waits for the first report of " + identity_.subclass;
}

std::string Pioneer::who() const {
  if (step_ != Step::Running || listening_ || !configured_) return "";
  return "'" + identity_.name + "', " + identity_.subclass + ", serial number '" + configuration_.serial +
         "', firmware '" + configuration_.firmware + "'";
}

Drive Pioneer::own_ramp() const {
  if (!configured_) return {};
  return {kMillimetre * configuration_.top_accel, deg_to_rad(configuration_.top_turn_accel)};
}

std::vector<Odometry> Pioneer::take_odometry() { return std::exchange(odometry_, {}); }

}  // namespace rubble::robot
