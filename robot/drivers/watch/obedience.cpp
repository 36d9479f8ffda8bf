#include "robot/drivers/watch/obedience.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::robot {
namespace {

constexpr Drive kStill{0.01, 0.02};             ///< slower stands [m/s], [rad/s]
constexpr Drive kExpected{0.15, 0.35};          ///< so far must wheels go that are told to [m], [rad]
constexpr Drive kSlack{0.05, 0.1};              ///< faster than told by so much [m/s], [rad/s] ...
constexpr double kSlackShare = 0.2;             ///< ... and by so much of it is still obeying
constexpr double kReaction = 0.5;               ///< line and firmware, and the window in which motion is seen [s]
constexpr double kWindow = 0.5;                 ///< motion is taken over so long [s]
constexpr double kLongestTurn = 0.1;            ///< from one call to the next [s]
constexpr double kGap = 0.5;                    ///< so long without a report and all begins anew [s]
constexpr Drive kCreep{0.03, deg_to_rad(3.0)};  ///< told not to they may go so far [m], [rad]
constexpr Drive kClearly{0.05, 0.1};            ///< told to go so fast it may not go back [m/s], [rad/s]
constexpr double kSteady = 1.0 / 3.0;           ///< of its mean speed a base that goes on has in each second
constexpr double kBansKept = 60.0;              ///< [s]
constexpr double kHalf = 0.5;                   ///< of the way that is told must be gone
constexpr double kLag = 1.5;                    ///< it is told to go for so long before it is judged [s]

bool is_within(double value, double least, double most, double slack) {
  const double share = 1.0 + kSlackShare;
  return value <= share * most + slack && value >= share * least - slack;
}

}  // namespace

void Obedience::forget() {
  seen_.clear();
  excess_ = stands_ = misses_since_ = Stamp::never();
  judged_ = false;
  forget_ways();
}

/// What is gone since the last report cannot be told.
void Obedience::forget_ways() {
  sure_way_ = {};
  sure_seconds_v_ = sure_seconds_w_ = 0.0;
  arrears_v_ = arrears_w_ = {};
}

void Obedience::pause() {
  forget();
  told_.clear();
  for (Ban& one : bans_) one.clear();
  expected_ = most_ = least_ = sure_ = {};
  standing_.clear();
  lagging_.clear();
  running_.clear();
  trouble_.clear();
  runs_away_ = false;
}

void Obedience::tell(const Drive& told, Stamp now) {
  const double dt = told_.empty() ? 0.0 : std::clamp(now - told_.back().first, 0.0, kLongestTurn);
  told_.emplace_back(now, told);
  while (now - told_.front().first > kReaction) told_.pop_front();
  // Braking may be hard, and then it goes nowhere while a ramp would still go on.
  const auto at_least = [](double is, double wanted, double most) {
    return std::clamp(approach(is, wanted, most), std::min(0.0, wanted), std::max(0.0, wanted));
  };
  expected_ = {at_least(expected_.v, told.v, ramp_.v * dt), at_least(expected_.w, told.w, ramp_.w * dt)};
  if (stands_ != Stamp::never()) {
    missed_.v += std::abs(expected_.v) * dt;
    missed_.w += std::abs(expected_.w) * dt;
  }
  Drive high{}, low{};
  Drive all_high = told, all_low = told;
  for (const auto& [when, one] : told_) {
    high = {std::max(high.v, one.v), std::max(high.w, one.w)};
    low = {std::min(low.v, one.v), std::min(low.w, one.w)};
    all_high = {std::max(all_high.v, one.v), std::max(all_high.w, one.w)};
    all_low = {std::min(all_low.v, one.v), std::min(all_low.w, one.w)};
  }
  most_ = {std::max(high.v, most_.v - ramp_.v * dt), std::max(high.w, most_.w - ramp_.w * dt)};
  least_ = {std::min(low.v, least_.v + ramp_.v * dt), std::min(low.w, least_.w + ramp_.w * dt)};
  ban(all_high, all_low, now);
  // Ways without their sign: a late line shifts them in time and takes nothing away, but an order that was taken back
  // within its lateness may never have been heard.
  // Nor does it go while it brakes from the other way.
  const bool known = now - told_.front().first > 0.9 * kReaction;
  const auto surely = [known](double low, double high, double moves, double slack) {
    const bool back = low > 0.0 ? moves < -slack : moves > slack;
    return known && !back ? std::max({0.0, low, -high}) : 0.0;
  };
  sure_ = {std::min(sure_.v + ramp_.v * dt, surely(all_low.v, all_high.v, moves_.v, kSlack.v)),
           std::min(sure_.w + ramp_.w * dt, surely(all_low.w, all_high.w, moves_.w, kSlack.w))};
  sure_way_ = {sure_way_.v + sure_.v * dt, sure_way_.w + sure_.w * dt};
  if (sure_.v > 0.0) sure_seconds_v_ += dt;
  if (sure_.w > 0.0) sure_seconds_w_ += dt;
}

/// By the pose, which a base without wheel speeds has as well.
Drive Obedience::motion() const {
  if (seen_.size() < 2) return {};
  const mrpt::math::TPose2D& a = seen_.front().second.pose;
  const mrpt::math::TPose2D& b = seen_.back().second.pose;
  const double dt = std::max(0.05, seen_.back().second.stamp - seen_.front().second.stamp);
  const double turn = wrap_angle(b.phi - a.phi);
  const double heading = a.phi + 0.5 * turn;
  return {(std::cos(heading) * (b.x - a.x) + std::sin(heading) * (b.y - a.y)) / dt, turn / dt};
}

void Obedience::look(const Odometry& odometry, Stamp now) {
  if (told_.empty()) return;
  if (!seen_.empty() && now - seen_.back().first > kGap) forget();
  if (seen_.empty()) {
    forget_ways();
  } else {
    mind_way(odometry, now);
  }
  seen_.emplace_back(now, odometry);
  while (now - seen_.front().first > kWindow) seen_.pop_front();
  moves_ = motion();
  mind_standing(odometry, now);
  mind_running(now);
  expect_braking();
  say();
}

/// The way from the last report to this one.
void Obedience::mind_way(const Odometry& odometry, Stamp now) {
  const auto& [before, last] = seen_.back();
  const double turn = wrap_angle(odometry.pose.phi - last.pose.phi);
  const double heading = last.pose.phi + 0.5 * turn;
  const Drive gone{
      std::cos(heading) * (odometry.pose.x - last.pose.x) + std::sin(heading) * (odometry.pose.y - last.pose.y), turn};
  stood_way_ = {stood_way_.v + std::abs(gone.v), stood_way_.w + std::abs(gone.w)};
  mind_arrears(gone, odometry.stalled);
  const double ways[kWays] = {gone.v, -gone.v, gone.w, -gone.w};
  for (int i = 0; i < kWays; ++i) bans_[static_cast<std::size_t>(i)].add(ways[i], before, now);
  mind_creeping();
}

/// `high`, `low`: of all that it was told lately. By now it has had the time to brake from what it was told before.
void Obedience::ban(const Drive& high, const Drive& low, Stamp now) {
  const bool rest = judged_ && most_.v == 0.0 && least_.v == 0.0 && most_.w == 0.0 && least_.w == 0.0;
  // Wheels that are not quite alike go a little ahead or aside while they turn: only who is clearly told the other way
  // may not do it.
  const auto holds = [&](double may, double other, double clearly) {
    return rest || (judged_ && may == 0.0 && other > clearly);
  };
  const bool held[kWays] = {holds(most_.v, -high.v, kClearly.v), holds(least_.v, low.v, kClearly.v),
                            holds(most_.w, -high.w, kClearly.w), holds(least_.w, low.w, kClearly.w)};
  for (int i = 0; i < kWays; ++i) bans_[static_cast<std::size_t>(i)].hold(held[i], rest, now);
}

void Obedience::Ban::hold(bool held, bool rest, Stamp now) {
  if (!held) since_ = Stamp::never();
  if (held && since_ == Stamp::never()) since_ = now;
  rest_ = rest;
}

void Obedience::Ban::add(double gone, Stamp before, Stamp now) {
  if (since_ == Stamp::never() || before < since_) return;
  if (sums_.empty()) sums_.push_back({before, 0.0, 0.0, 0.0});
  Sum sum = sums_.back();
  sum.when = now;
  sum.seconds += now - before;
  sum.gone += gone;
  if (rest_) sum.at_rest += now - before;
  sums_.push_back(sum);
  while (now - sums_.front().when > kBansKept) sums_.pop_front();
}

/// A base that is told to go and lags behind half of it owes more and more; one that obeys soon owes nothing.
void Obedience::mind_arrears(const Drive& gone, bool stalled) {
  const auto add = [](Arrears& one, double way, double seconds, double done, double most) {
    one.owed = std::min(one.owed + kHalf * way - std::abs(done), 2.0 * kHalf * most);
    one.seconds += seconds;
    one.told += way;
    one.gone += std::abs(done);
    if (one.owed <= 0.0) one = {};
  };
  const double heard = stands_ == Stamp::never() ? 1.0 : 0.0;  // wheels that stand are named as that
  add(arrears_v_, heard * sure_way_.v, heard * sure_seconds_v_, gone.v, kExpected.v);
  add(arrears_w_, heard * sure_way_.w, heard * sure_seconds_w_, gone.w, kExpected.w);
  sure_way_ = {};
  sure_seconds_v_ = sure_seconds_w_ = 0.0;
  if (stalled) arrears_v_ = arrears_w_ = {};
  if (arrears_v_.owed <= 0.0 && arrears_w_.owed <= 0.0) lagging_.clear();
  if (!lagging_.empty()) return;
  const bool v = arrears_v_.owed > kHalf * kExpected.v && arrears_v_.seconds >= kLag;
  const bool w = arrears_w_.owed > kHalf * kExpected.w && arrears_w_.seconds >= kLag;
  if (!v && !w) return;
  char text[160];
  if (v) {
    std::snprintf(text, sizeof text, "reports, but does not obey: went %.2f m of %.2f m that it was told to go",
                  arrears_v_.gone, arrears_v_.told);
  } else {
    std::snprintf(text, sizeof text, "reports, but does not obey: turned by %.0f deg of %.0f deg that it was told to",
                  rad_to_deg(arrears_w_.gone), rad_to_deg(arrears_w_.told));
  }
  lagging_ = text;
}

/// Between two reports on a straight line. `seconds`: within what is kept.
Obedience::Ban::Sum Obedience::Ban::at(double seconds) const {
  const auto after = std::lower_bound(sums_.begin(), sums_.end(), seconds,
                                      [](const Sum& sum, double value) { return sum.seconds < value; });
  if (after == sums_.begin()) return *after;
  if (after == sums_.end()) return sums_.back();
  const auto before = std::prev(after);
  const double share = (seconds - before->seconds) / (after->seconds - before->seconds);
  return {after->when, seconds, before->gone + share * (after->gone - before->gone),
          before->at_rest + share * (after->at_rest - before->at_rest)};
}

Obedience::Ban::Sum Obedience::Ban::lately(double seconds) const {
  const Sum from = at(sums_.back().seconds - seconds), to = sums_.back();
  return {to.when, seconds, to.gone - from.gone, to.at_rest - from.at_rest};
}

bool Obedience::Ban::broken(int seconds, double most) const {
  if (sums_.empty() || sums_.back().seconds - sums_.front().seconds < seconds) return false;
  const double all = lately(seconds).gone;
  if (all <= most) return false;
  const double end = sums_.back().seconds;
  for (int i = 1; i <= seconds; ++i)
    if ((at(end - i + 1).gone - at(end - i).gone) * seconds <= kSteady * all) return false;
  return true;
}

void Obedience::mind_creeping() {
  if (runs_away_) return;
  const double most[kWays] = {kCreep.v, kCreep.v, kCreep.w, kCreep.w};
  constexpr const char* kWords[kWays] = {"forwards", "backwards", "to the left", "to the right"};
  for (int i = 0; i < kWays; ++i) {
    const Ban& one = bans_[static_cast<std::size_t>(i)];
    for (const int seconds : {kCreeps, 2 * kCreeps, 4 * kCreeps}) {
      if (!one.broken(seconds, most[i])) continue;
      runs_away_ = true;
      const Ban::Sum sum = one.lately(seconds);
      const bool turns = i == Left || i == Right;
      char text[160];
      std::snprintf(text, sizeof text,
                    "does not obey: moves %s though told to %s, by %.*f %s in %d s; its motors are being switched off",
                    kWords[i], sum.at_rest > 0.5 * seconds ? "stop" : "go the other way", turns ? 0 : 2,
                    turns ? rad_to_deg(sum.gone) : sum.gone, turns ? "deg" : "m", seconds);
      running_ = text;
      return;
    }
  }
}

void Obedience::mind_standing(const Odometry& odometry, Stamp now) {
  const Drive seen = motion();
  const bool still = std::max(std::abs(odometry.v), std::abs(seen.v)) < kStill.v &&
                     std::max(std::abs(odometry.w), std::abs(seen.w)) < kStill.w;
  if (!still || odometry.stalled) {
    stands_ = misses_since_ = Stamp::never();
    standing_.clear();
    return;
  }
  if (stands_ == Stamp::never()) {
    stands_ = now;
    missed_ = stood_way_ = {};
  }
  const bool misses = (missed_.v >= kExpected.v && stood_way_.v < kHalf * missed_.v) ||
                      (missed_.w >= kExpected.w && stood_way_.w < kHalf * missed_.w);
  if (!misses) misses_since_ = Stamp::never();
  if (misses && misses_since_ == Stamp::never()) misses_since_ = now;
  // What it is told just now it may do later.
  if (!standing_.empty() || now - stands_ < kStands || !misses || now - misses_since_ < kReaction) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "reports, but does not obey: its wheels stand without a stall, told %.2f m/s, %.0f deg/s",
                told_.back().second.v, rad_to_deg(told_.back().second.w));
  standing_ = text;
}

/// Told to stand for longer than a line may be late, it brakes from where it is seen, not from where it might have
/// been.
void Obedience::expect_braking() {
  if (!judged_ || runs_away_ || told_.back().first - told_.front().first < 0.9 * kReaction) return;
  for (const auto& [when, one] : told_)
    if (one.v != 0.0 || one.w != 0.0) return;
  Drive high{};
  for (std::size_t i = 1; i < seen_.size(); ++i) {
    const Odometry& a = seen_[i - 1].second;
    const Odometry& b = seen_[i].second;
    const double dt = std::max(0.02, b.stamp - a.stamp);
    const double w = wrap_angle(b.pose.phi - a.pose.phi) / dt;
    const double v = std::hypot(b.pose.x - a.pose.x, b.pose.y - a.pose.y) / dt;
    high = {std::max(high.v, v), std::max(high.w, std::abs(w))};
  }
  // A report is a mean over its time, in which it may have gained speed still.
  high = {high.v + 0.1 * ramp_.v / kRamp, high.w + 0.1 * ramp_.w / kRamp};
  most_ = {std::min(most_.v, high.v), std::min(most_.w, high.w)};
  least_ = {std::max(least_.v, -high.v), std::max(least_.w, -high.w)};
}

/// The worst of it.
void Obedience::say() {
  const std::string& worst = !running_.empty() ? running_ : !standing_.empty() ? standing_ : lagging_;
  if (trouble_ != worst) trouble_ = worst;
}

void Obedience::mind_running(Stamp now) {
  const Drive seen = motion();
  if (!judged_) {
    if (seen_.back().first - seen_.front().first < 0.5 * kWindow) return;
    // Where it comes from: it may brake from there.
    most_ = {std::max(most_.v, seen.v), std::max(most_.w, seen.w)};
    least_ = {std::min(least_.v, seen.v), std::min(least_.w, seen.w)};
    judged_ = true;
  }
  if (is_within(seen.v, least_.v, most_.v, kSlack.v) && is_within(seen.w, least_.w, most_.w, kSlack.w)) {
    excess_ = Stamp::never();
    return;
  }
  if (excess_ == Stamp::never()) excess_ = now;
  if (runs_away_ || now - excess_ < kMoves) return;
  runs_away_ = true;
  char text[160];
  std::snprintf(text, sizeof text,
                "does not obey: moves at %.2f m/s and %.0f deg/s, told %.2f m/s and %.0f deg/s; its motors are being "
                "switched off",
                seen.v, rad_to_deg(seen.w), told_.back().second.v, rad_to_deg(told_.back().second.w));
  running_ = text;
}

}  // namespace rubble::robot
