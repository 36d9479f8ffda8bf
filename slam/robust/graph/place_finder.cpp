#include "slam/robust/graph/place_finder.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kCells = 400.0;        ///< of the raster of the whole map, from the middle to its edges
constexpr double kFinestCell = 0.10;    ///< cell of that raster [m]
constexpr double kCoarsestCell = 0.40;  ///< [m]
constexpr double kBlurCells = 1.0;      ///< sigma of a surface in it
constexpr std::size_t kLeastPlacePoints = 60;
constexpr int kLeastPlacePairs = 40;
constexpr double kOtherPlaceAway = 0.6;      ///< another place lies at least so far away [m]
constexpr double kOtherPlaceTurned = 0.25;   ///< or is turned so much [rad]
constexpr std::size_t kPlaceWitnesses = 16;  ///< key frames of the map that are asked what they saw
constexpr double kPlaceWitnessAway = 5.0;    ///< at most [m]
constexpr double kTieDistance = 0.03;        ///< least error of a tie [m]
constexpr double kTieAngle = 0.008;          ///< [rad]

TPose2D inverse(const TPose2D& T) { return TPose2D() - T; }

/// Of a fit, given along the axes of the map, along those of `from`, with an error that no match is free of.
Eigen::Matrix3d tie_information(const Eigen::Matrix3d& information, const TPose2D& from) {
  return limited(turned(information, -from.phi), kTieDistance, kTieAngle);
}

}  // namespace

PlaceFinder::PlaceFinder(const KeyFrames& map, const PlaceConfig& config, double surfel_cell)
    : map_(map),
      config_(config),
      surfel_cell_(surfel_cell),
      search_({config.least_score, config.runner_up, kOtherPlaceAway, kOtherPlaceTurned}) {
  std::vector<int> all(static_cast<std::size_t>(map.size()));
  std::iota(all.begin(), all.end(), 0);
  map.draw(all, TPose2D(), surfel_cell, surfels_);
  if (surfels_.empty()) return;
  TPoint2D low(std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
  TPoint2D high(-low.x, -low.y);
  for (int i = 0; i < map.size(); ++i) {
    low = {std::min(low.x, map.pose(i).x), std::min(low.y, map.pose(i).y)};
    high = {std::max(high.x, map.pose(i).x), std::max(high.y, map.pose(i).y)};
  }
  middle_ = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.0};
  // The newest key frame lies where the robot has been, or not far from it.
  extent_ = 0.5 * std::max(high.x - low.x, high.y - low.y) + 1.0;
  const double cell = std::clamp(extent_ / kCells, kFinestCell, kCoarsestCell);
  correlator_.build(surfels_.surfels(), cell, kBlurCells * cell);
  map_points_ = surfels_.every_nth(1);
}

void PlaceFinder::begin() {
  search_.stop();
  newest_ = frame_ = -1;
  T_map_expected_.reset();
  believed_.clear();
  found_.reset();
}

void PlaceFinder::begin_near(const TPose2D& T_map_drive, bool told) {
  begin();
  T_map_expected_ = T_map_drive;
  told_ = told;
}

/// Whether the robot is still close to where it was expected to begin.
bool PlaceFinder::expected(const KeyFrames& drive) const {
  return T_map_expected_ && drive[frame_].path <= config_.expected_path;
}

void PlaceFinder::work(const KeyFrames& drive, Work& budget) {
  while (budget > 0 && !found_ && !surfels_.empty()) {
    if (!search_.running()) {
      if (newest_ < 0) return;
      frame_ = newest_;
      newest_ = -1;
      start_search(drive, budget);
    } else if (search_.advance(budget)) {
      weigh(drive, budget);
    }
  }
}

void PlaceFinder::weigh(const KeyFrames& drive, Work& budget) {
  if (!search_.best()) {
    ++counts_.nowhere;
    return;
  }
  const std::optional<GraphEdge> tie = judge(drive, search_.best()->pose, budget);
  if (!tie) {
    ++counts_.contradicted;
  } else if (search_.rival() && judge(drive, search_.rival()->pose, budget)) {
    ++counts_.ambiguous;
  } else {
    ++counts_.believed;
    believe(drive, *tie);
  }
}

void PlaceFinder::start_search(const KeyFrames& drive, Work& budget) {
  frames_ = drive.ending_at(frame_, config_.frames, config_.path);
  SurfelGrid seen;
  drive.draw(frames_, drive.pose(frame_), surfel_cell_, seen);
  budget -= kWorkPerDrawnFrame * static_cast<Work>(frames_.size());
  points_ = seen.thinned_to(kSearchedPoints);
  const bool short_drive = drive[frame_].path < config_.least_path && !(told_ && expected(drive));
  if (points_.size() < kLeastPlacePoints || short_drive) return;
  ++counts_.searched;
  SearchWindow window{middle_, extent_, kPi};
  if (expected(drive))
    window = {*T_map_expected_ + drive.pose(frame_), config_.expected_distance, config_.expected_angle};
  search_.start(correlator_, points_, window);
}

bool PlaceFinder::contradicted(const KeyFrames& drive, const TPose2D& T_map_frame,
                               const std::vector<int>& close) const {
  const auto there = map_.agreement(points_, T_map_frame, TPose2D(), close);
  std::vector<OrientedPoint> around;
  for (const OrientedPoint& p : map_points_)
    if (length(static_cast<double>(p.x) - T_map_frame.x, static_cast<double>(p.y) - T_map_frame.y) < kPlaceWitnessAway)
      around.push_back(p);
  const auto back = drive.agreement(around, drive.pose(frame_) + inverse(T_map_frame), TPose2D(), frames_);
  const auto judged = static_cast<double>(points_.size() * std::max<std::size_t>(1, close.size()));
  return std::max(there.contradiction(), back.contradiction()) > config_.most_contradiction ||
         there.supported < config_.least_supported * judged;
}

/// What ties the drive to the map at the place next to `start`; nothing when it does not stand the tests.
std::optional<GraphEdge> PlaceFinder::judge(const KeyFrames& drive, const TPose2D& start, Work& budget) const {
  ScanFitConfig fitting;
  fitting.first_radius = std::max(0.25, 2.5 * correlator_.resolution());
  fitting.iterations = 20;
  Work used = 0;
  const ScanFit fit = fit_scan(surfels_, points_, start, {start, 1e-3 * Eigen::Matrix3d::Identity()}, fitting, &used);
  const std::vector<int> close = map_.closest(fit.pose, kPlaceWitnessAway, kPlaceWitnesses, map_.size());
  budget -= used + kWorkPerJudged * static_cast<Work>(points_.size() * (close.size() + frames_.size()));
  if (close.empty() || fit.inliers < config_.least_inliers || fit.paired < kLeastPlacePairs || !well_conditioned(fit) ||
      contradicted(drive, fit.pose, close))
    return std::nullopt;
  GraphEdge tie;
  tie.from = close.front();
  tie.to = frame_;
  tie.T_from_to = fit.pose - map_.pose(tie.from);
  tie.information = tie_information(fit.information, map_.pose(tie.from));
  tie.loop = true;
  return tie;
}

/// A place counts when those found after a good part of the path say the same; near where somebody says that
/// the robot is, it counts by itself.
void PlaceFinder::believe(const KeyFrames& drive, const GraphEdge& tie) {
  const Believed now{tie, map_.pose(tie.from) + tie.T_from_to + inverse(drive.pose(frame_)), drive[frame_].path};
  std::vector<GraphEdge> ties{tie};
  double last = now.path;
  for (auto old = believed_.rbegin(); old != believed_.rend(); ++old) {
    // Compared where the robot is: a turned origin far away says little.
    const TPose2D off = (old->T_map_drive + drive.pose(frame_)) - (now.T_map_drive + drive.pose(frame_));
    if (last - old->path < config_.apart || length(off.x, off.y) > config_.agree_distance ||
        std::abs(wrap_angle(off.phi)) > config_.agree_angle)
      continue;
    ties.push_back(old->tie);
    last = old->path;
  }
  believed_.push_back(now);
  const bool enough = told_ && expected(drive);
  if (!enough && static_cast<int>(ties.size()) < config_.confirmations) return;
  std::reverse(ties.begin(), ties.end());
  found_ = FoundPlace{now.T_map_drive, std::move(ties)};
}

}  // namespace rubble::slam
