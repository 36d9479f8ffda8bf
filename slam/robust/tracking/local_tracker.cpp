#include "slam/robust/tracking/local_tracker.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr int kLeastTrackedPairs = 15;
constexpr std::size_t kLeastScanPoints = 15;
constexpr double kLeastScore = 0.25;
constexpr double kWidestSearch = 1.0;   ///< [m]
constexpr double kDoubted = 0.5;        ///< so much doubt, and the odometry is but one of several starts
constexpr double kDoubt = 0.01;         ///< what is left of the odometry's information once it is doubted
constexpr double kAsWell = 0.05;        ///< inliers that decide nothing
constexpr double kCheaper = 0.5;        ///< another start must cost so much less than the expected place
constexpr double kFound = 0.6;          ///< inliers (or score) that leave no doubt
constexpr double kFoundAgain = 0.5;     ///< inliers after a search of all headings
constexpr double kRunnerUp = 0.85;      ///< another place may score so much of the best
constexpr double kNotFar = 0.2;         ///< a match so close to the expected one is a correction, not another place [m]
constexpr double kNotFarTurned = 0.15;  ///< [rad]
constexpr std::size_t kOdometryWitnesses = 6;  ///< key frames that are asked whether the odometry can be true
constexpr double kContradicted = 0.15;         ///< share of points they would have seen through, from which it cannot
constexpr double kOneWay = 0.2;  ///< share of the information along the walls, below which their ends are asked
// What a robot on wheels can have moved aside from what they say, and what it takes to believe a match beyond.
constexpr double kSlide = 0.005;        ///< [m]
constexpr double kSlideSpeed = 0.2;     ///< [m/s]
constexpr double kSlideShare = 0.2;     ///< of the way that the wheels rolled
constexpr double kSlidePerTurn = 0.1;   ///< [m/rad]
constexpr double kBeyondSpeed = 0.05;   ///< where wheels say nothing: beyond the most that the robot drives [m]
constexpr double kSameLeap = 0.02;      ///< two scans ask for the same correction [m]
constexpr double kSameLeapTurn = 0.05;  ///< [rad]
constexpr int kAskedLongEnough = 5;     ///< scans on end ...
constexpr double kAskedTime = 0.45;     ///< ... that take so long, however many a second there are [s]
constexpr int kHeldLongEnough = 10;     ///< scans on end, whatever they ask for ...
constexpr double kHeldTime = 0.95;      ///< ... and so long [s]
constexpr double kWorthALeap = 0.25;    ///< a level scan that loses so many inliers by staying is believed at once
constexpr double kFirm = 100.0;         ///< times the odometry's information, where a looser prior leaps as well

ScanFitConfig tight(const Correlator& found_by) {
  ScanFitConfig config;
  config.first_radius = std::max(0.2, found_by.least_radius());
  return config;
}

/// Whether nearly all that the scan tells lies across one direction, as in a corridor: what is left may be the slope of
/// a ramp, which comes along with a robot that pitches, or nothing.
bool along_one_way(const ScanFit& fit) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(fit.information.topLeftCorner<2, 2>());
  return axes.eigenvalues()[0] < kOneWay * axes.eigenvalues()[1];
}

}  // namespace

void LocalTracker::redraw(const KeyFrames& frames, int here, Work* work) {
  redraw(frames,
         here == frames.last() ? frames.ending_at(here, config_.frames, config_.path)
                               : frames.around(here, config_.frames, config_.path, frames.size()),
         work);
}

void LocalTracker::redraw(const KeyFrames& frames, std::vector<int> local, Work* work) {
  local_ = std::move(local);
  frames.draw(local_, frames.pose(local_.front()), config_.cell, surfels_);
  correlator_ready_ = false;
  leap_ = {};
  if (work != nullptr) *work += kWorkPerDrawnFrame * static_cast<Work>(local_.size());
}

LocalTracker::Reach LocalTracker::reach(const ExpectedMotion& motion) const {
  const double path = length(motion.T_last_now.x, motion.T_last_now.y);
  const double turn = std::abs(wrap_angle(motion.T_last_now.phi));
  return {std::min(kWidestSearch, 0.25 + 0.5 * path + motion.doubt * config_.most_speed * motion.time),
          std::min(kPi, 0.15 + 0.5 * turn + 3.0 * config_.turn_error_per_m * path +
                            motion.doubt * config_.most_turn_rate * motion.time)};
}

Eigen::Matrix3d LocalTracker::prior_information(const ExpectedMotion& motion) const {
  const double path = length(motion.T_last_now.x, motion.T_last_now.y);
  const double turn = std::abs(wrap_angle(motion.T_last_now.phi));
  const double distance = config_.least_distance + config_.distance_error * path + 0.02 * turn +
                          config_.vain_error * motion.in_vain * path + config_.creep_error * length(motion.crept) +
                          motion.doubt * (0.02 + config_.most_speed * motion.time);
  const double angle = config_.least_turn + config_.turn_error * turn + config_.turn_error_per_m * path +
                       motion.doubt * (0.02 + config_.most_turn_rate * motion.time);
  return Eigen::Vector3d(1.0 / (distance * distance), 1.0 / (distance * distance), 1.0 / (angle * angle)).asDiagonal();
}

Tracked LocalTracker::track(const KeyFrames& frames, const Cloud& cloud, const ExpectedMotion& motion,
                            const TPose2D& T_frame_last, Work* work) {
  const double distance = length(motion.T_last_now.x, motion.T_last_now.y);
  const double turn = std::abs(wrap_angle(motion.T_last_now.phi));
  const bool doubted = motion.doubt >= kDoubted;
  const PosePrior prior{T_frame_last + motion.believed(), prior_information(motion)};
  const std::optional<TPose2D> carried = motion.carried ? std::optional(T_frame_last + *motion.carried) : std::nullopt;
  points_ = cloud.points;
  Tracked tracked;
  tracked.fit = fit_scan(surfels_, points_, prior.pose, prior, {}, work);
  if (!cloud.ends.empty() && along_one_way(tracked.fit)) {
    points_.insert(points_.end(), cloud.ends.begin(), cloud.ends.end());
    tracked.fit = fit_scan(surfels_, points_, prior.pose, prior, {}, work);
  }
  ExpectedMotion undoubted = motion;
  undoubted.doubt = 0.0;
  if (doubted) {
    tracked.fit = without_odometry(cloud, motion, prior, carried, tracked.fit, work);
    if (motion.told && !motion.again) believe_again({prior.pose, prior_information(undoubted)}, tracked.fit, work);
  }
  if (!doubted && (distance > config_.large_step || turn > config_.large_turn))
    tracked.fit = best_of_several(cloud, prior, distance, turn, tracked.fit, work);
  if (tracked.fit.prior_chi2 > config_.slip_chi2 || tracked.fit.inliers < config_.lost_inliers)
    doubt_odometry(frames, cloud, prior, carried, reach(motion), tracked, work);
  if (tracked.relocated || tracked.fit.inliers < config_.lost_inliers)
    leap_ = {};
  else if (config_.hold_leaps && motion.ramps)
    hold_leap(motion, {prior.pose, prior_information(undoubted)}, carried, T_frame_last, tracked, work);
  tracked.found = tracked.fit.paired >= kLeastTrackedPairs;
  tracked.lost = doubted && (!tracked.found || tracked.fit.inliers < config_.lost_inliers);
  if (!tracked.found) tracked.fit.pose = prior.pose;
  if (tracked.found && !along_one_way(tracked.fit))
    blind_way_ = 0.0;
  else if (!motion.again)
    blind_way_ += distance;
  const TPose2D off = tracked.fit.pose - prior.pose;
  const Eigen::Vector3d d(off.x, off.y, wrap_angle(off.phi));
  tracked.odometry_chi2 = d.dot(prior_information(undoubted) * d);
  return tracked;
}

/// Whether a robot cannot have moved so between two scans. Wheels that turn move it between not at all (they spin) and
/// as they say, and it slides a little.
bool LocalTracker::leaps(const TPose2D& step, const ExpectedMotion& motion) const {
  if (!motion.told) return length(step.x, step.y) > config_.most_speed * motion.time + kBeyondSpeed;
  const TPose2D& wheels = motion.T_last_now;
  const double path = length(wheels.x, wheels.y);
  const double slide =
      kSlide + kSlideSpeed * motion.time + kSlideShare * path + kSlidePerTurn * std::abs(wrap_angle(wheels.phi));
  const double rolled =
      path > 0.0 ? std::clamp((step.x * wheels.x + step.y * wheels.y) / (path * path), 0.0, 1.0) : 0.0;
  return length(step.x - rolled * wheels.x, step.y - rolled * wheels.y) > slide;
}

/// A match farther from the last one than a robot can move is no motion. Either the last ones were off: then the next
/// ones ask for the same correction, or without it a level scan fits much worse. Or what is seen has moved, as the line
/// does in which the laser's plane cuts a ramp when the robot pitches before it: then it is not believed.
void LocalTracker::hold_leap(const ExpectedMotion& motion, const PosePrior& odometry,
                             const std::optional<TPose2D>& carried, const TPose2D& T_frame_last, Tracked& tracked,
                             Work* work) {
  // Wheels that were caught lying may lie on: a robot that goes on as it went does not leap.
  const bool goes_on = carried && motion.doubt >= kDoubted &&
                       length(tracked.fit.pose.x - carried->x, tracked.fit.pose.y - carried->y) < kSameLeap;
  if (goes_on || !leaps(tracked.fit.pose - T_frame_last, motion)) {
    if (!motion.again) leap_ = {};
    return;
  }
  // A robot that does not turn as its wheels say has not leapt for that: the scan tells its heading.
  PosePrior held = odometry;
  held.information(2, 2) *= kDoubt;
  ScanFit stay = fit_scan(surfels_, points_, held.pose, held, {}, work);
  if (carried && motion.doubt >= kDoubted) {
    const PosePrior on{*carried, held.information};
    const ScanFit other = fit_scan(surfels_, points_, on.pose, on, {}, work);
    if (other.cost < stay.cost) stay = other;
  }
  if (leaps(stay.pose - T_frame_last, motion)) {
    PosePrior firm{odometry.pose, kFirm * odometry.information};
    firm.information(2, 2) = held.information(2, 2);
    stay = fit_scan(surfels_, points_, firm.pose, firm, {}, work);
    if (leaps(stay.pose - T_frame_last, motion)) return;
  }
  const TPose2D correction(tracked.fit.pose.x - stay.pose.x, tracked.fit.pose.y - stay.pose.y,
                           wrap_angle(tracked.fit.pose.phi - stay.pose.phi));
  if (!motion.again) {
    const TPose2D& last = leap_.correction;
    const bool same = length(correction.x - last.x, correction.y - last.y) < kSameLeap &&
                      std::abs(wrap_angle(correction.phi - last.phi)) < kSameLeapTurn;
    const bool on_end = same && leap_.asked > 0;
    leap_.asked = on_end ? leap_.asked + 1 : 1;
    leap_.asked_for = on_end ? leap_.asked_for + motion.time : motion.time;
    leap_.correction = correction;
  }
  const bool worth = motion.level && stay.inliers < tracked.fit.inliers - kWorthALeap;
  const bool asked = leap_.asked >= kAskedLongEnough && leap_.asked_for >= kAskedTime;
  const bool held_long = leap_.held >= kHeldLongEnough && leap_.held_for >= kHeldTime;
  if (worth || asked || held_long) {
    leap_ = {};
    return;
  }
  if (!motion.again) {
    ++leap_.held;
    leap_.held_for += motion.time;
  }
  tracked.fit = stay;
  tracked.held = true;
}

/// Odometry says nothing: it is one guess, that the motion goes on another, and where there is no good match a search
/// as wide as a robot could have moved a third.
ScanFit LocalTracker::without_odometry(const Cloud& cloud, const ExpectedMotion& motion, const PosePrior& prior,
                                       const std::optional<TPose2D>& carried, ScanFit fit, Work* work) {
  const auto better = [&](const TPose2D& start) {
    const PosePrior about{start, prior.information};
    const ScanFit other = fit_scan(surfels_, points_, start, about, {}, work);
    if (other.cost < fit.cost) fit = other;
  };
  if (carried) better(*carried);
  if (fit.inliers >= kFound) return fit;
  const Reach far = reach(motion);
  const TPose2D& centre = carried ? *carried : prior.pose;
  if (const auto found = look_around(cloud, {centre, far.distance, far.turn}, kLeastScore, 1.0, work))
    better(found->pose);
  return fit;
}

/// What odometry says now stands where the scan fits it as well: a scan without its hold slides along walls, and each
/// slide would be one more reason to doubt.
void LocalTracker::believe_again(const PosePrior& odometry, ScanFit& fit, Work* work) const {
  const ScanFit by_odometry = fit_scan(surfels_, points_, odometry.pose, odometry, {}, work);
  if (by_odometry.prior_chi2 <= config_.slip_chi2 && by_odometry.inliers >= fit.inliers - kAsWell) fit = by_odometry;
}

std::optional<CorrelativeSearch::Found> LocalTracker::look_around(const Cloud& cloud, const SearchWindow& window,
                                                                  double floor, double later_floor, Work* work) {
  if (surfels_.empty() || cloud.points.size() < kLeastScanPoints) return std::nullopt;
  if (!correlator_ready_) correlator_.build(surfels_.surfels(), config_.search_cell, config_.search_blur, work);
  correlator_ready_ = true;
  search_.start(correlator_, cloud.points, window, floor, std::nullopt, later_floor);
  return found(work);
}

/// For the second best place of the last search.
std::optional<CorrelativeSearch::Found> LocalTracker::look_elsewhere(double floor, const SearchExclusion& exclusion,
                                                                     Work* work) {
  search_.start_again(floor, exclusion);
  return found(work);
}

std::optional<CorrelativeSearch::Found> LocalTracker::found(Work* work) {
  Work budget = std::numeric_limits<Work>::max();
  search_.advance(budget);
  if (work != nullptr) *work += std::numeric_limits<Work>::max() - budget;
  return search_.found();
}

/// After a large step the nearest minimum need not be the right one: the two best places of a search are tried as well.
/// Where costs are alike rounding would decide, so one of them must be clearly cheaper.
ScanFit LocalTracker::best_of_several(const Cloud& cloud, const PosePrior& prior, double distance, double turn,
                                      ScanFit fit, Work* work) {
  const SearchWindow window{prior.pose, std::min(kWidestSearch, 0.15 + 0.2 * distance),
                            0.08 + 0.3 * turn + 0.1 * distance};
  const auto first = look_around(cloud, window, kLeastScore, kLeastScore, work);
  if (!first) return fit;
  const auto second = look_elsewhere(kLeastScore, {first->pose, 0.25, 0.1}, work);
  for (const auto& start : {first, second}) {
    if (!start) continue;
    const ScanFit other = fit_scan(surfels_, points_, start->pose, prior, {}, work);
    if (other.cost < fit.cost - kCheaper) fit = other;
  }
  return fit;
}

void LocalTracker::doubt_odometry(const KeyFrames& frames, const Cloud& cloud, const PosePrior& prior,
                                  const std::optional<TPose2D>& carried, const Reach& reach, Tracked& tracked,
                                  Work* work) {
  tracked.slipped = true;
  const PosePrior loose{prior.pose, kDoubt * prior.information};
  ScanFit fit = fit_scan(surfels_, points_, tracked.fit.pose, loose, {}, work);
  for (const auto& centre : {std::optional(prior.pose), carried}) {
    if (!centre || fit.inliers >= kFound) continue;
    const SearchWindow window{*centre, reach.distance, reach.turn};
    const auto found = look_around(cloud, window, kLeastScore, 1.0, work);
    if (!found) continue;
    const PosePrior about{*centre, loose.information};
    const ScanFit other = fit_scan(surfels_, points_, found->pose, about, tight(correlator_), work);
    if (other.inliers > fit.inliers + 0.03) fit = other;
  }
  if (fit.inliers < config_.lost_inliers) {
    const auto other = any_heading(cloud, prior, reach.distance, work);
    if (other && other->inliers > std::max(kFoundAgain, fit.inliers + 0.2)) {
      fit = *other;
      tracked.relocated = true;
    }
  }
  const bool better = fit.inliers > tracked.fit.inliers + 0.02 || tracked.fit.inliers < config_.lost_inliers;
  if (better && overrules(frames, cloud, fit, tracked.fit, work)) tracked.fit = fit;
}

/// Whether a match far from where the robot is expected is believed. On new ground little fits the true place, and what
/// slides back over known ground always fits better; but only where it is wrong would beams have passed through what
/// the last key frames saw (the null test of loops).
bool LocalTracker::overrules(const KeyFrames& frames, const Cloud& cloud, const ScanFit& found, const ScanFit& expected,
                             Work* work) const {
  const TPose2D off = found.pose - expected.pose;
  if (length(off.x, off.y) < kNotFar && std::abs(wrap_angle(off.phi)) < kNotFarTurned) return true;
  const std::vector<int> close(
      local_.begin(), local_.begin() + static_cast<std::ptrdiff_t>(std::min(local_.size(), kOdometryWitnesses)));
  const TPose2D& origin = frames.pose(local_.front());
  const auto there = frames.agreement(cloud.points, expected.pose, origin, close);
  const auto here = frames.agreement(cloud.points, found.pose, origin, close);
  if (work != nullptr) *work += 2 * kWorkPerJudged * static_cast<Work>(cloud.points.size() * close.size());
  return there.contradiction() >= kContradicted && here.contradiction() < there.contradiction();
}

/// Lost: any heading will do, if there is but one.
std::optional<ScanFit> LocalTracker::any_heading(const Cloud& cloud, const PosePrior& prior, double distance,
                                                 Work* work) {
  const SearchWindow window{prior.pose, std::min(kWidestSearch, 0.05 + distance), kPi};
  const auto found = look_around(cloud, window, kFound, kRunnerUp * kFound, work);
  if (!found) return std::nullopt;
  const auto runner_up = look_elsewhere(kRunnerUp * found->score, SearchExclusion{found->pose}, work);
  if (runner_up) return std::nullopt;
  const PosePrior anywhere{found->pose, Eigen::Matrix3d::Identity()};
  return fit_scan(surfels_, points_, found->pose, anywhere, tight(correlator_), work);
}

}  // namespace rubble::slam
