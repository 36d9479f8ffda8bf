#include "slam/robust/tracking/motion_expectation.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

using mrpt::math::TPose2D;
using robot::LaserScan;

namespace {

constexpr double kFastest = 10.0;          ///< odometry that goes faster has jumped [m/s]
constexpr double kFastestTurn = 20.0;      ///< or turns faster [rad/s]
constexpr double kFastestSweep = 3.0;      ///< the same within one sweep, or after a jump [m/s]
constexpr double kFastestSweepTurn = 6.0;  ///< [rad/s]
constexpr double kLeastJump = 0.5;         ///< below, a coarse clock may be to blame [m, rad]
constexpr int kOften = 3;                  ///< reports from scan to scan
constexpr double kForgiving = 0.6;         ///< what is left of the doubt after each scan that agrees with the odometry
constexpr double kNoDoubt = 0.05;
constexpr double kLongestCarry = 0.5;  ///< motion is taken to go on for so long [s]
constexpr double kTurnsFade = 0.45;    ///< turns of so long ago count by 1/e [s]
constexpr double kTurning = 0.16;      ///< turns this fast tell whether wheels hold the floor [rad/s] ...
constexpr double kTellingTurns =
    2.0 * kPi;                      ///< a drive that turned less does not tell whether its scans turn with it [rad]
constexpr double kAgainst = -0.25;  ///< of the wheels' turns: scans that found less turn the other way
constexpr double kHolds = 0.5;      ///< ... which they do where the robot turned by this share of them

bool finite(const robot::Odometry& o) {
  return std::isfinite(o.pose.x) && std::isfinite(o.pose.y) && std::isfinite(o.pose.phi) && std::isfinite(o.v) &&
         std::isfinite(o.w);
}

bool is_jump(const TPose2D& motion, double time) {
  const double path = length(motion.x, motion.y);
  const double turn = std::abs(wrap_angle(motion.phi));
  return (path > kLeastJump && path > kFastest * time) || (turn > kLeastJump && turn > kFastestTurn * time);
}

bool outruns_robots(const TPose2D& motion, double time) {
  return length(motion.x, motion.y) > 0.05 + kFastestSweep * time ||
         std::abs(wrap_angle(motion.phi)) > 0.05 + kFastestSweepTurn * time;
}

}  // namespace

void MotionExpectation::hear(const robot::Odometry& report, Stamp now) {
  if (!finite(report) || report.stamp - now > kAhead || report.stamp <= odometry_.newest()) return;
  robot::Odometry smooth = report;
  if (!odometry_.empty()) {
    const TPose2D step = report.pose - odometry_.pose_at(odometry_.newest());
    // Stamps that come bunched do not mean that the wheels were faster than they are.
    const bool jump = is_jump(step, std::max(report.stamp - odometry_.newest(), scan_period_ / kOften));
    smooth.pose = without_jumps_.pose_at(odometry_.newest()) + (jump ? TPose2D() : step);
    if (jump) last_jump_ = report.stamp;
  }
  without_jumps_.add(smooth);
  odometry_.add(report);
}

void MotionExpectation::begin_late() {
  if (!last_scan_ || T_odom_scan_ || odometry_.empty()) return;
  T_odom_scan_ = odometry_.pose_at(Stamp::never());
  T_smooth_scan_ = without_jumps_.pose_at(Stamp::never());
}

ExpectedMotion MotionExpectation::expect(const LaserScan& scan) {
  ExpectedMotion motion;
  if (!last_scan_) return motion;
  const Stamp reference = scan.middle();
  motion.T_last_now = since_scan(reference);
  motion.time = reference - *last_scan_;
  motion.carried = carried(motion.time);
  motion.doubt = doubt_;
  turn_now_ = 0.0;
  if (motion.time < kNoDuration) return motion;
  // Stamps that come bunched do not mean that the scanner was faster than it is.
  const double time = std::max(motion.time, scan_period_);
  const bool leapt = is_jump(motion.T_last_now, time) || jumps_within(scan) || jumps_between_reports(reference);
  const bool jumped = leapt || (leapt_ && outruns_robots(motion.T_last_now, time));
  leapt_ = leapt;
  const bool silent_then = silent_at_scan_ ? *silent_at_scan_ : odometry_.silent_at(*last_scan_);
  const bool silent = T_odom_scan_ && (silent_then || odometry_.silent_at(reference));
  jumps_ += jumped ? 1 : 0;
  silent_ += silent ? 1 : 0;
  motion.told = T_odom_scan_ && !jumped && !silent;
  if (motion.told) {
    turn_now_ = wrap_angle(motion.T_last_now.phi);
    motion.in_vain = in_vain(motion.time);
  }
  if (jumped || silent) motion.doubt = 1.0;
  if (jumped) motion.T_last_now = motion.carried.value_or(TPose2D());
  return motion;
}

/// A jump between two reports shows sooner within a sweep that lies between them, and its time is the scanner's own.
bool MotionExpectation::jumps_within(const LaserScan& scan) const {
  const std::optional<SweepMotion> sweep = sweep_motion(odometry_, scan);
  if (!sweep) return false;
  const double time = std::abs(scan.beam_stamp(scan.ranges.size() - 1) - scan.stamp);
  return outruns_robots(sweep->T_ref_last - sweep->T_ref_first, time);
}

/// Where reports come much more often than scans, the step from one to the next tells sooner than that between scans. A
/// jump that a scan lies in is one before and after it. Less than what outruns any robot may be a clock that is coarse:
/// in logs of rare scans true steps are of 3 to 8 m/s, by their stamps.
bool MotionExpectation::jumps_between_reports(Stamp reference) const {
  int steps = 0;
  bool jumps = false;
  odometry_.for_steps(*last_scan_, reference, [&](const TPose2D& step, double time) {
    jumps = jumps || is_jump(step, time);
    ++steps;
  });
  return jumps && steps >= kOften;
}

/// The share of the wheels' way that is none. Nothing but the scan tells how far a robot came, and between two bare
/// walls not even that; but its heading is always told, and wheels that do not turn the robot do not hold the floor.
double MotionExpectation::in_vain(double time) const {
  if (std::abs(turn_now_) < kTurning * time ||
      turns_told_ * std::exp(-time / kTurnsFade) < kTurning * kTurning * kTurnsFade)
    return 0.0;
  const double share = std::clamp(turns_found_ / turns_told_, 0.0, 1.0);
  return share < kHolds ? 1.0 - share : 0.0;
}

bool MotionExpectation::turns_against() const {
  return all_turns_ >= kTellingTurns && all_turns_found_ < kAgainst * all_turns_told_;
}

/// As the last two scans were apart, for `time`.
std::optional<TPose2D> MotionExpectation::carried(double time) const {
  if (last_step_time_ < kNoDuration || time < kNoDuration || std::max(time, last_step_time_) > kLongestCarry)
    return std::nullopt;
  const double share = time / last_step_time_;
  return TPose2D{share * last_step_.x, share * last_step_.y, share * wrap_angle(last_step_.phi)};
}

std::optional<SweepMotion> MotionExpectation::sweep(const LaserScan& scan, const ExpectedMotion& motion) const {
  return motion.doubt >= 1.0 && motion.carried ? sweep_at(scan, *motion.carried, motion.time)
                                               : sweep_motion(odometry_, scan);
}

std::optional<SweepMotion> MotionExpectation::sweep_at(const LaserScan& scan, const TPose2D& motion,
                                                       double time) const {
  if (scan.beam_period == 0.0 || time < kNoDuration || time > kLongestCarry) return sweep_motion(odometry_, scan);
  const Stamp reference = scan.middle();
  const auto part = [&](Stamp stamp) {
    const double share = (stamp - reference) / time;
    return TPose2D{share * motion.x, share * motion.y, share * wrap_angle(motion.phi)};
  };
  return SweepMotion{part(scan.stamp), part(scan.beam_stamp(scan.ranges.size() - 1))};
}

void MotionExpectation::found(const TPose2D& step, double time, bool contradicted) {
  last_step_ = step;
  last_step_time_ = time;
  if (time >= kNoDuration) {
    const double left = std::exp(-time / kTurnsFade);
    turns_told_ = left * turns_told_ + turn_now_ * turn_now_ / time;
    turns_found_ = left * turns_found_ + turn_now_ * wrap_angle(step.phi) / time;
    all_turns_ += std::abs(turn_now_);
    all_turns_told_ += turn_now_ * turn_now_;
    all_turns_found_ += turn_now_ * wrap_angle(step.phi);
  }
  doubt_ = contradicted ? 1.0 : doubt_ < kNoDoubt ? 0.0 : kForgiving * doubt_;
}

void MotionExpectation::scan_taken(Stamp reference) {
  if (!odometry_.empty()) T_odom_scan_ = odometry_.pose_at(reference);
  T_smooth_scan_ = without_jumps_.pose_at(reference);
  last_scan_ = reference;
  silent_at_scan_.reset();
}

TPose2D MotionExpectation::since_scan(Stamp stamp) const {
  return T_odom_scan_ ? odometry_.pose_at(stamp) - *T_odom_scan_ : TPose2D();
}

TPose2D MotionExpectation::believed_since_scan(Stamp stamp) const {
  if (!T_odom_scan_ || !last_scan_ || last_jump_ <= *last_scan_) return since_scan(stamp);
  return without_jumps_.pose_at(stamp) - T_smooth_scan_;
}

void MotionExpectation::forget_before(Stamp oldest_needed) {
  if (last_scan_ && !silent_at_scan_ && *last_scan_ < oldest_needed)
    silent_at_scan_ = odometry_.silent_at(*last_scan_);  // the last time that it can be told
  odometry_.forget_before(oldest_needed);
  without_jumps_.forget_before(oldest_needed);
}

}  // namespace rubble::slam
