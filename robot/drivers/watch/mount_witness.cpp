#include "robot/drivers/watch/mount_witness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "robot/drivers/watch/scan_motion.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

constexpr double kWayLasts = 1.5;   ///< [s]
constexpr double kWayGap = 0.35;    ///< between two reports nobody knows the way [s]
constexpr double kScanWaits = 0.6;  ///< for the report behind it [s]
constexpr double kLeastWay = 0.15;  ///< of a stretch that ends with its turn, to tell which way it went [m]
constexpr double kRound = deg_to_rad(30.0);
constexpr double kStraight = deg_to_rad(12.0);  ///< who turns by less goes straight
constexpr double kOnTheSpot = 0.12;             ///< who goes less turns on the spot [m]
constexpr double kFarTwice = 2.4;               ///< so many times a stretch is looked at again, if nothing moved
constexpr double kAside = deg_to_rad(45.0);     ///< and more from ahead is another mount
constexpr double kOtherExplains = 0.55, kOtherBetter = 0.15;  ///< shares of the points
constexpr double kClear = 0.65, kClearBetter = 0.3;  ///< the same of a way that is told soon: back instead of ahead ...
constexpr double kBack = deg_to_rad(150.0);          ///< ... by so much and more
constexpr double kMostTurn = 2.0;                    ///< times what wheels say is a mirrored turn, at most
constexpr double kFits = deg_to_rad(20.0);           ///< a mount along an axis of the robot is told as that, if so near
constexpr double kSeenShare = 0.5;                   ///< of what wheels say is seen at least, where a way is told by it
constexpr double kOfOne = 1.45, kSpread = 1.4;       ///< ratios of one scale lie beyond that, and so near each other
constexpr double kSlipLasts = 10.0;                  ///< at one obstacle, at most [s]
constexpr int kStillVotes = 3;  ///< so many stretches of a scanner that stands tell of another robot

TPose2D between(const Odometry& a, const Odometry& b, Stamp when) {
  const double share = (when - a.stamp) / (b.stamp - a.stamp);
  const TPose2D step = b.pose - a.pose;
  return a.pose + TPose2D{share * step.x, share * step.y, share * wrap_angle(step.phi)};
}

}  // namespace

void MountWitness::clear() {
  waiting_.reset();
  begin_.reset();
  for (auto* votes : {&ways_, &turns_, &stands_, &way_ratios_, &turn_ratios_}) votes->clear();
  finding_.reset();
  is_other_ = false;
}

void MountWitness::see(const LaserScan& scan, Stamp now) {
  if (!(scan.angle_step > 0.0)) return;
  if (waiting_ && now - waiting_->middle() < kScanWaits) return;
  waiting_ = scan;
}

void MountWitness::look(const Odometry& odometry, Stamp now) {
  const bool gap = !reports_.empty() &&
                   (odometry.stamp - reports_.back().stamp > kWayGap || odometry.stamp <= reports_.back().stamp);
  if (gap || odometry.stalled) {
    reports_.clear();
    begin_.reset();
  }
  reports_.push_back(odometry);
  while (odometry.stamp - reports_.front().stamp > kWayLasts) reports_.pop_front();
  if (!waiting_ || finding_) return;
  const Stamp when = waiting_->middle();
  if (when > odometry.stamp) return;
  const auto after = std::lower_bound(reports_.begin(), reports_.end(), when,
                                      [](const Odometry& one, Stamp stamp) { return one.stamp < stamp; });
  if (after != reports_.begin()) step(*waiting_, between(*std::prev(after), *after, when), now);
  waiting_.reset();
}

void MountWitness::step(const LaserScan& scan, const TPose2D& pose, Stamp now) {
  const bool other = begin_ && scan.ranges.size() != begin_->scan.ranges.size();
  if (!begin_ || other || now - begin_->when > kLongestTime) {
    begin_ = Begin{scan, pose, now};
    return;
  }
  const TPose2D motion = pose - begin_->pose;
  if (!begin_->looked_soon && std::abs(motion.x) >= kSoon && std::abs(motion.phi) <= kStraight) {
    begin_->looked_soon = true;
    if (judge_soon(*begin_, scan, motion, now)) begin_ = Begin{scan, pose, now};
    return;
  }
  const double far = begin_->looked ? kFarTwice : 1.0;
  if (std::hypot(motion.x, motion.y) < far * kWay && std::abs(motion.phi) < far * kTurn) return;
  if (judge(*begin_, scan, motion, now)) {
    begin_ = Begin{scan, pose, now};
  } else {
    begin_->looked = true;
  }
}

/// Whether the stretch is done with: one in which nothing seems to have moved is given more.
bool MountWitness::judge(const Begin& begin, const LaserScan& scan, const TPose2D& motion, Stamp now) {
  const double turn = wrap_angle(motion.phi);
  if (std::abs(turn) <= kRound && std::abs(motion.x) >= kLeastWay) return judge_way(begin, scan, motion, now);
  if (std::abs(turn) >= kTurn && std::hypot(motion.x, motion.y) <= kOnTheSpot)
    return judge_turn(begin, scan, motion, now);
  return true;
}

/// The scanner stands though the wheels turn: they slip, or are another robot's.
bool MountWitness::judge_standing(const Begin& begin, const TPose2D& motion, Stamp now) {
  if (begin.looked || doubted(now)) vote(stands_, 1.0, now);
  if (static_cast<int>(stands_.size()) >= kStillVotes && doubted(now)) {
    find("base",
         "its wheels go (%.2f m, %.0f deg), and scans show that the robot stands, since the line to it was lost; is it "
         "another robot's base?",
         motion.x, rad_to_deg(wrap_angle(motion.phi)));
    is_other_ = true;
  }
  return begin.looked;
}

bool MountWitness::judge_way(const Begin& begin, const LaserScan& scan, const TPose2D& motion, Stamp now) {
  const double turn = wrap_angle(motion.phi);
  const ScanMotion seen = motion_between(begin.scan, scan, T_base_laser_);
  if (seen.stood()) return judge_standing(begin, motion, now);
  if (seen.moved() && seen.ahead * motion.x > 0.0 && std::abs(seen.turn - turn) < kStraight) {
    ways_.clear();
    stands_.clear();
    if (std::abs(motion.x) >= kWay && std::abs(turn) <= kStraight)
      judge_scale(way_ratios_, seen.ahead / motion.x, false, now);
    return true;
  }
  const ScanWay way = way_between(begin.scan, scan, T_base_laser_, turn, motion.x < 0.0);
  if (way.fit < kOtherExplains || way.fit < way.as_told + kOtherBetter || way.way < kSeenShare * std::abs(motion.x))
    return true;
  vote_elsewhere(way.aside, motion.x, now);
  return true;
}

/// Whether the stretch is done with: scans tell clearly that the robot went elsewhere than its wheels say.
bool MountWitness::judge_soon(const Begin& begin, const LaserScan& scan, const TPose2D& motion, Stamp now) {
  const ScanMotion seen = motion_between(begin.scan, scan, T_base_laser_);
  if (seen.stood() || (seen.moved() && seen.ahead * motion.x > 0.0)) return false;
  const ScanWay way = way_between(begin.scan, scan, T_base_laser_, wrap_angle(motion.phi), motion.x < 0.0);
  const bool clear = way.fit >= kClear && way.fit >= way.as_told + kClearBetter && std::abs(way.aside) >= kBack;
  if (!clear || way.way < kSeenShare * std::abs(motion.x)) return false;
  vote_elsewhere(way.aside, motion.x, now);
  return true;
}

void MountWitness::vote_elsewhere(double aside, double ahead, Stamp now) {
  if (std::abs(aside) < kAside) return;
  const bool same = ways_.empty() || std::abs(wrap_angle(ways_.back().value - aside)) < kAside;
  if (!same) ways_.clear();
  vote(ways_, aside, now);
  if (static_cast<int>(ways_.size()) < kVotes) return;
  double x = 0.0, y = 0.0;
  for (const Vote& one : ways_) {
    x += std::cos(one.value);
    y += std::sin(one.value);
  }
  const double mean = std::atan2(y, x), axis = 0.5 * kPi * std::round(mean / (0.5 * kPi));
  const double told = axis != 0.0 && std::abs(mean - axis) < kFits ? axis : mean;
  find("urg",
       "looks elsewhere than the robot file says: wheels go %.2f m, scans show that way turned; lower "
       "devices.urg.yaw_deg by about %.0f deg",
       ahead, std::abs(rad_to_deg(told)) > 179.0 ? 180.0 : rad_to_deg(told));
}

bool MountWitness::judge_turn(const Begin& begin, const LaserScan& scan, const TPose2D& motion, Stamp now) {
  const double turn = wrap_angle(motion.phi);
  const ScanMotion seen = motion_between(begin.scan, scan, T_base_laser_);
  if (seen.stood()) return judge_standing(begin, motion, now);
  if (!seen.moved()) return true;
  if (seen.turn * turn > 0.0) {
    turns_.clear();
    stands_.clear();
    judge_scale(turn_ratios_, seen.turn / turn, true, now);
    return true;
  }
  if (std::abs(seen.turn) < kSeenShare * std::abs(turn) || std::abs(seen.turn) > kMostTurn * std::abs(turn))
    return true;
  vote(turns_, seen.turn, now);
  if (static_cast<int>(turns_.size()) < kVotes) return true;
  find("urg",
       "is upside down, other than the robot file says: wheels turn by %.0f deg, scans show %.0f deg; see "
       "devices.urg.upside_down",
       rad_to_deg(turn), rad_to_deg(seen.turn));
  return true;
}

/// One that is wrong is so all the time, by the same, and either way; what slips at one obstacle is told by its time.
void MountWitness::judge_scale(std::deque<Vote>& ratios, double ratio, bool turns, Stamp now) {
  vote(ratios, ratio, now);
  std::vector<double> sorted;
  for (const Vote& one : ratios) sorted.push_back(one.value);
  std::sort(sorted.begin(), sorted.end());
  const double middle = sorted[sorted.size() / 2];
  const bool more = sorted.size() >= kScaleVotes && sorted.front() > kOfOne && middle >= kScale;
  const bool less = sorted.size() >= 2 * kScaleVotes && sorted.back() < 1.0 / kOfOne && middle <= 1.0 / kScale &&
                    now - ratios.front().when > kSlipLasts;
  const std::size_t few = sorted.size() / 5;
  if ((!more && !less) || sorted[sorted.size() - 1 - few] > kSpread * sorted[few]) return;
  if (turns) {
    find("base", "turns %.2f times as far as it reports, by the scans; see devices.base.turn_scale", middle);
  } else {
    find("base", "goes %.2f times as far as it reports, by the scans; see devices.base.distance_scale", middle);
  }
}

void MountWitness::vote(std::deque<Vote>& votes, double value, Stamp now) const {
  const double lasts = &votes == &turns_ || &votes == &stands_ ? kForget : kForgetWay;
  while (!votes.empty() && now - votes.front().when > lasts) votes.pop_front();
  votes.push_back({now, value});
}

void MountWitness::find(const char* name, const char* format, double a, double b) {
  char text[240];
  std::snprintf(text, sizeof text, format, a, b);
  finding_ = Hindrance{name, Hindrance::Cause::Held, text};
}

}  // namespace rubble::robot
