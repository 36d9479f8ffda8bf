#include "robot/drivers/watch/base_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/angle.h"

namespace rubble::robot {
namespace {

constexpr Drive kStands{0.03, 0.05};           ///< slower wheels stand [m/s], [rad/s]
constexpr double kOverShare = 0.1;             ///< a limit is kept within so much of it ...
constexpr Drive kOver{0.03, deg_to_rad(5.0)};  ///< ... and so much more [m/s], [rad/s]
constexpr double kJumpsLast = 5.0;             ///< of an odometry are remembered for so long [s]
constexpr std::size_t kManyJumps = 3;          ///< within that time: an origin is set anew once

constexpr const char* kLeadBack =
    "lead its line back to this robot's base, or end this drive and start anew with that one";

using Cause = Hindrance::Cause;

/// Whether `state` has held for `seconds`; `since` remembers from when on.
bool lasts(bool state, double seconds, Stamp& since, Stamp now) {
  if (!state) since = Stamp::never();
  if (state && since == Stamp::never()) since = now;
  return state && now - since > seconds;
}

}  // namespace

BaseWatch::BaseWatch(const BaseSettings& settings, const mrpt::math::TPose2D& T_base_laser, bool mount)
    : settings_(settings),
      obedience_(settings.max_accel, settings.max_turn_accel),
      witness_(T_base_laser),
      mount_(mount),
      mount_witness_(T_base_laser) {}

void BaseWatch::see(const LaserScan& scan, Stamp now) {
  witness_.see(scan, now);
  if (mount_) mount_witness_.see(scan, now);
}

bool BaseWatch::look(const BaseTurn& turn, const std::vector<Odometry>& reports, Stamp now) {
  if (!reports.empty()) moves_ = std::abs(reports.back().v) > kStands.v || std::abs(reports.back().w) > kStands.w;
  mind_jumps(turn.jumps, now);
  mind_motors(turn, now);
  mind_obedience(turn, reports, now);
  mind_identity(turn, now);
  mind_mount(reports, now);
  moves_though_held_ = lasts((turn.held || turn.off) && moves_, kHeldStill, held_moves_since_, now);
  if (!held_.empty() || settings_.passive) return false;
  if (obedience_.runs_away()) return hold(Sort::Disobeys, "base", obedience_.trouble(), "");
  if (!too_fast_.empty()) return hold(Sort::Disobeys, "base", too_fast_, "");
  if (!witness_.denial().empty())
    return hold(Sort::Blind, "base", witness_.denial(), "see to its encoders and their cables");
  if (identity_now_ != identity_)
    return hold(Sort::Other, "base", "another robot's base answers: " + identity_now_ + "; it was " + identity_,
                kLeadBack);
  if (const auto& found = mount_witness_.finding())
    return mount_witness_.is_other() ? hold(Sort::Other, found->name, found->what, kLeadBack)
                                     : hold(Sort::Mount, found->name, found->what,
                                            "mend the robot file and start again, or see that it is right");
  return false;
}

bool BaseWatch::hold(Sort sort, const std::string& name, const std::string& why, const std::string& mend) {
  held_name_ = name;
  held_ = why;
  mend_ = mend;
  blind_ = sort != Sort::Disobeys;
  other_ = sort == Sort::Other;
  doubted_ = sort == Sort::Disobeys || sort == Sort::Blind;
  return true;
}

std::string BaseWatch::refusal() const {
  if (identity_now_ != identity_)
    return "is another robot's (" + identity_now_ + "), so it stays held; lead its line back to " + identity_ +
           ", or end this drive and start anew";
  if (other_)
    return "may be another robot's, so it stays held; unplug it, see that its line leads to this robot, plug it in, "
           "then "
           "press R; or end this drive and start anew";
  return "";
}

/// Whoever answers after a break must be who answered before; and be moved by the same wheels, where he does not say.
void BaseWatch::mind_identity(const BaseTurn& turn, Stamp now) {
  if (turn.ready && !was_ready_ && ever_ready_) {
    mount_witness_.broke(now);
    other_ = false;
  }
  if (std::exchange(doubt_who_, false)) mount_witness_.broke(now);
  was_ready_ = turn.ready;
  ever_ready_ = ever_ready_ || turn.ready;
  if (!turn.ready || turn.identity.empty()) return;
  identity_now_ = turn.identity;
  if (identity_.empty()) identity_ = turn.identity;
}

/// Whoever drives it: by hand, too, wheels and scans must tell of the same motion.
void BaseWatch::mind_mount(const std::vector<Odometry>& reports, Stamp now) {
  if (!mount_) return;
  for (const Odometry& report : reports) mount_witness_.look(report, now);
}

void BaseWatch::mind_jumps(std::size_t jumps, Stamp now) {
  for (; jumps_ < jumps; ++jumps_) jumped_.push_back(now);
  while (!jumped_.empty() && now - jumped_.front() > kJumpsLast) jumped_.pop_front();
}

void BaseWatch::mind_motors(const BaseTurn& turn, Stamp now) {
  const bool missed = turn.asked && !settings_.passive && !turn.motors_on && !turn.held && turn.ready;
  no_motors_ = lasts(missed, kMotorsOn, motors_missed_, now);
  const bool stay = turn.off && !settings_.passive && turn.motors_on;
  // What a base that is silent does nobody knows.
  if (stay || turn.ready) lasts(stay, kMotorsOff, off_since_, now);
  motors_stay_ = off_since_ != Stamp::never() && now - off_since_ > kMotorsOff;
}

/// A base that does not hear stops by its watchdog, one on a slow line when it hears at last. Who goes on beyond that,
/// or sets off anew, is driven by somebody else or runs away.
bool BaseWatch::had_time_to_stop(const BaseTurn& turn, Stamp now) {
  return lasts(turn.deaf && !settings_.passive && turn.motors_on, turn.watchdog + turn.late, deaf_since_, now);
}

/// Its motors are off, or what it was told may be on its way still.
void BaseWatch::pause() {
  obedience_.pause();
  witness_.pause();
  too_fast_since_ = Stamp::never();
  too_fast_.clear();
}

void BaseWatch::mind_obedience(const BaseTurn& turn, const std::vector<Odometry>& reports, Stamp now) {
  const bool asked = turn.asked && !settings_.passive && turn.motors_on;
  const bool told_to_stand = had_time_to_stop(turn, now);
  if (!asked && !told_to_stand) {
    pause();
  } else {
    const auto least = [](double asked, double own) { return own > 0.0 ? std::min(asked, own) : asked; };
    const Drive ramp{least(settings_.max_accel, turn.own_ramp.v), least(settings_.max_turn_accel, turn.own_ramp.w)};
    // Beyond its limits it is not told.
    const Drive told{std::clamp(turn.wanted.v, -settings_.max_v, settings_.max_v) * settings_.distance_scale,
                     std::clamp(turn.wanted.w, -settings_.max_w, settings_.max_w) * settings_.turn_scale};
    obedience_.keep_ramp(ramp);
    obedience_.tell(told, now);
    witness_.tell(told, ramp, now);
    for (const Odometry& report : reports) {
      obedience_.look(report, now);
      witness_.look(report, now);
      mind_limit(now);
    }
  }
  mind_doubt(asked && obedience_.trouble().empty(), now);
}

/// Whatever it is told: its limit is that of whoever stands beside it.
void BaseWatch::mind_limit(Stamp now) {
  const Drive moves = obedience_.motion();
  const double most_v = settings_.max_v * std::max(1.0, settings_.distance_scale);
  const double most_w = settings_.max_w * std::max(1.0, settings_.turn_scale);
  const bool over = std::abs(moves.v) > (1.0 + kOverShare) * most_v + kOver.v ||
                    std::abs(moves.w) > (1.0 + kOverShare) * most_w + kOver.w;
  if (!lasts(over, kTooFast, too_fast_since_, now)) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "is faster than its limit: moves at %.2f m/s and %.0f deg/s of at most %.2f m/s and %.0f deg/s; its "
                "motors are being switched off",
                moves.v, rad_to_deg(moves.w), most_v, rad_to_deg(most_w));
  too_fast_ = text;
}

void BaseWatch::mind_doubt(bool obeys, Stamp now) {
  if (!obeys) obeys_since_ = Stamp::never();
  if (obeys && obeys_since_ == Stamp::never()) obeys_since_ = now;
  if (obeys && now - obeys_since_ >= kObeys) doubted_ = false;
}

bool BaseWatch::rearm() {
  if (!refusal().empty()) return false;
  doubt_who_ = mount_witness_.is_other();
  held_.clear();
  held_name_.clear();
  mend_.clear();
  blind_ = false;
  mount_witness_.clear();
  pause();
  return true;
}

std::vector<Hindrance> BaseWatch::troubles() const {
  std::vector<Hindrance> all;
  if (jumped_.size() >= kManyJumps)
    all.push_back({"base", Cause::Faulty, "its positions jump again and again; only its wheels' speeds are used"});
  if (motors_stay_) all.push_back({"base", Cause::Disobeys, kMotorsStay});
  if (!held_.empty()) return all;
  if (const auto& found = mount_witness_.finding())  // who only maps is told so
    all.push_back({found->name, Cause::Faulty, found->what});
  const std::string& disobeys = obedience_.trouble();
  if (!disobeys.empty()) all.push_back({"base", Cause::Disobeys, disobeys});
  if (doubted_ && disobeys.empty())
    all.push_back({"base", Cause::Disobeys, "let go again; whether it obeys now is watched"});
  if (no_motors_) all.push_back({"base", Cause::Faulty, "its motors do not come on, though asked for"});
  return all;
}

}  // namespace rubble::robot
