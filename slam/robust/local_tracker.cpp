#include "slam/robust/local_tracker.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr int kLeastPairs = 15;
constexpr std::size_t kLeastPoints = 15;
constexpr double kLeastScore = 0.25;
constexpr double kWidestSearch = 1.0;  ///< [m]
constexpr double kDoubt = 0.01;        ///< what is left of the odometry's information once it is doubted
constexpr double kFound = 0.6;         ///< inliers (or score) that leave no doubt
constexpr double kFoundAgain = 0.5;    ///< inliers after a search of all headings
constexpr double kRunnerUp = 0.85;     ///< another place may score so much of the best
constexpr Work kWorkPerDrawnFrame = 8000;

ScanFitConfig tight() {
  ScanFitConfig config;
  config.first_radius = 0.2;
  return config;
}

}  // namespace

void LocalTracker::redraw(const KeyFrames& frames, Work* work) {
  const std::vector<int> newest = frames.ending_at(frames.last(), config_.frames, config_.path);
  frames.draw(newest, frames.pose(frames.last()), config_.cell, surfels_);
  correlator_ready_ = false;
  if (work != nullptr) *work += kWorkPerDrawnFrame * static_cast<Work>(newest.size());
}

Eigen::Matrix3d LocalTracker::prior_information(const TPose2D& motion) const {
  const double path = length(motion.x, motion.y);
  const double turn = std::abs(wrap_angle(motion.phi));
  const double distance = config_.least_distance + config_.distance_error * path + 0.02 * turn;
  const double angle = config_.least_turn + config_.turn_error * turn + config_.turn_error_per_m * path;
  return Eigen::Vector3d(1.0 / (distance * distance), 1.0 / (distance * distance), 1.0 / (angle * angle)).asDiagonal();
}

Tracked LocalTracker::track(const Cloud& cloud, const TPose2D& T_last_now, const TPose2D& T_frame_prior, Work* work) {
  const double distance = length(T_last_now.x, T_last_now.y);
  const double turn = std::abs(wrap_angle(T_last_now.phi));
  const PosePrior prior{T_frame_prior, prior_information(T_last_now)};
  Tracked tracked;
  tracked.fit = fit_scan(surfels_, cloud.points, T_frame_prior, prior, {}, work);
  if (distance > config_.large_step || turn > config_.large_turn)
    tracked.fit = best_of_several(cloud, prior, distance, turn, tracked.fit, work);
  if (tracked.fit.prior_chi2 > config_.slip_chi2 || tracked.fit.inliers < config_.lost_inliers)
    doubt_odometry(cloud, prior, distance, turn, tracked, work);
  tracked.found = tracked.fit.paired >= kLeastPairs;
  if (!tracked.found) tracked.fit.pose = T_frame_prior;
  return tracked;
}

std::optional<CorrelativeSearch::Found> LocalTracker::look_around(const Cloud& cloud, const SearchWindow& window,
                                                                  double floor,
                                                                  const std::optional<SearchExclusion>& exclusion,
                                                                  Work* work) {
  if (surfels_.empty() || cloud.points.size() < kLeastPoints) return std::nullopt;
  if (!correlator_ready_) correlator_.build(surfels_.surfels(), config_.search_cell, config_.search_blur, work);
  correlator_ready_ = true;
  return search(correlator_, cloud.points, window, floor, exclusion, work);
}

/// After a large step the nearest minimum need not be the right one: the two best places of a search are tried as well,
/// and the cheapest end wins.
ScanFit LocalTracker::best_of_several(const Cloud& cloud, const PosePrior& prior, double distance, double turn,
                                      ScanFit fit, Work* work) {
  const SearchWindow window{prior.pose, std::min(kWidestSearch, 0.15 + 0.2 * distance),
                            0.08 + 0.3 * turn + 0.1 * distance};
  const auto first = look_around(cloud, window, kLeastScore, std::nullopt, work);
  if (!first) return fit;
  const auto second = look_around(cloud, window, kLeastScore, SearchExclusion{first->pose, 0.25, 0.1}, work);
  for (const auto& start : {first, second}) {
    if (!start) continue;
    const ScanFit other = fit_scan(surfels_, cloud.points, start->pose, prior, {}, work);
    if (other.cost < fit.cost) fit = other;
  }
  return fit;
}

void LocalTracker::doubt_odometry(const Cloud& cloud, const PosePrior& prior, double distance, double turn,
                                  Tracked& tracked, Work* work) {
  tracked.slipped = true;
  const PosePrior loose{prior.pose, kDoubt * prior.information};
  ScanFit fit = fit_scan(surfels_, cloud.points, tracked.fit.pose, loose, {}, work);
  if (fit.inliers < kFound) {
    const SearchWindow window{prior.pose, std::min(kWidestSearch, 0.25 + 0.5 * distance), 0.15 + 0.5 * turn};
    if (const auto found = look_around(cloud, window, kLeastScore, std::nullopt, work)) {
      const ScanFit other = fit_scan(surfels_, cloud.points, found->pose, loose, tight(), work);
      if (other.inliers > fit.inliers + 0.03) fit = other;
    }
  }
  if (fit.inliers < config_.lost_inliers) {
    const auto other = any_heading(cloud, prior, distance, work);
    if (other && other->inliers > std::max(kFoundAgain, fit.inliers + 0.2)) {
      fit = *other;
      tracked.relocated = true;
    }
  }
  if (fit.inliers > tracked.fit.inliers + 0.02 || tracked.fit.inliers < config_.lost_inliers) tracked.fit = fit;
}

/// Lost: any heading will do, if there is but one.
std::optional<ScanFit> LocalTracker::any_heading(const Cloud& cloud, const PosePrior& prior, double distance,
                                                 Work* work) {
  const SearchWindow window{prior.pose, std::min(kWidestSearch, 0.3 + 0.5 * distance), kPi};
  const auto found = look_around(cloud, window, kFound, std::nullopt, work);
  if (!found) return std::nullopt;
  const auto runner_up =
      look_around(cloud, window, kRunnerUp * found->score, SearchExclusion{found->pose, 0.45, 0.2}, work);
  if (runner_up) return std::nullopt;
  const PosePrior anywhere{found->pose, Eigen::Matrix3d::Identity()};
  return fit_scan(surfels_, cloud.points, found->pose, anywhere, tight(), work);
}

}  // namespace rubble::slam
