#include "scoring/alignment/matching.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rigid.h"
#include "base/rng.h"
#include "scoring/alignment/pose_search.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// All descriptor distances from feature i of the map, nearest first, sizes permitting.
std::vector<Match> candidates(const FeatureSet& map, std::size_t i, const FeatureSet& truth, const cv::Mat& distances,
                              const MatchConfig& config) {
  std::vector<Match> out;
  const float* row = distances.ptr<float>(static_cast<int>(i));
  for (std::size_t j = 0; j < truth.features.size(); ++j) {
    const double ratio = map.features[i].size / truth.features[j].size;
    if (ratio > config.max_size_ratio || ratio * config.max_size_ratio < 1.0) continue;
    out.push_back({i, j, static_cast<double>(row[j]), 1.0});
  }
  const std::size_t keep = std::min(out.size(), config.neighbours + 1);
  std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(keep), out.end(),
                    [](const Match& a, const Match& b) {
                      return a.distance != b.distance ? a.distance < b.distance : a.truth < b.truth;
                    });
  out.resize(keep);
  return out;
}

cv::Mat distance_table(const FeatureSet& map, const FeatureSet& truth) {
  cv::Mat table;
  cv::batchDistance(map.descriptors, truth.descriptors, table, map.binary() ? CV_32S : CV_32F, cv::noArray(),
                    map.binary() ? cv::NORM_HAMMING : cv::NORM_L2);
  if (map.binary()) table.convertTo(table, CV_32F, 1.0 / (8.0 * map.descriptors.cols));
  return table;
}

/// Poses found so far.
class Poses {
 public:
  Poses(const FeatureSet& map, const FeatureSet& truth, const std::vector<Match>& matches, const MatchConfig& config)
      : map_(map), truth_(truth), matches_(matches), config_(config) {}

  /// The pose that two matches ask for, if they agree with each other.
  void try_pair(const Match& a, const Match& b) {
    const TPoint2D map_line = map_.features[b.map].p - map_.features[a.map].p;
    const TPoint2D truth_line = truth_.features[b.truth].p - truth_.features[a.truth].p;
    const double map_length = map_line.norm();
    if (map_length < config_.least_baseline || std::abs(map_length - truth_line.norm()) > config_.stretch) return;
    const double phi = std::atan2(truth_line.y, truth_line.x) - std::atan2(map_line.y, map_line.x);
    for (const Match* m : {&a, &b}) {
      const double turn = truth_.features[m->truth].angle - map_.features[m->map].angle;
      if (std::abs(wrap_angle(turn - phi)) > config_.twist) return;
    }
    const TPoint2D map_middle = (map_.features[a.map].p + map_.features[b.map].p) * 0.5;
    const TPoint2D truth_middle = (truth_.features[a.truth].p + truth_.features[b.truth].p) * 0.5;
    add(turned_onto(map_middle, truth_middle, wrap_angle(phi)));
  }

  std::vector<PoseGuess> best() {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const PoseGuess& a, const PoseGuess& b) { return a.score > b.score; });
    if (found_.size() > config_.guesses) found_.resize(config_.guesses);
    return found_;
  }

 private:
  /// Matches that agree with a pose; each feature of the map counts once, by its nearest candidate.
  std::vector<std::size_t> inliers(const TPose2D& pose) const {
    const PlanarTransform T(pose);
    std::vector<std::size_t> out;
    std::vector<std::size_t> of_feature(map_.features.size(), matches_.size());
    for (std::size_t k = 0; k < matches_.size(); ++k) {
      const Match& m = matches_[k];
      const TPoint2D gap = T(map_.features[m.map].p) - truth_.features[m.truth].p;
      if (gap.sqrNorm() > config_.inlier * config_.inlier || of_feature[m.map] < matches_.size()) continue;
      of_feature[m.map] = k;
      out.push_back(k);
    }
    return out;
  }

  TPose2D fit(const std::vector<std::size_t>& inliers) const {
    std::vector<TPoint2D> from;
    std::vector<TPoint2D> to;
    for (const std::size_t k : inliers) {
      from.push_back(map_.features[matches_[k].map].p);
      to.push_back(truth_.features[matches_[k].truth].p);
    }
    return fit_rigid(from, to);
  }

  void add(const TPose2D& pose) {
    std::vector<std::size_t> support = inliers(pose);
    // Not worth a fit where a better one of the same kind is known, or where it is chance.
    if (support.size() < config_.least_inliers) return;
    const TPoint2D centre = map_.features[matches_[support.front()].map].p;
    PoseGuess* known = nullptr;
    for (PoseGuess& guess : found_)
      if (same_pose(guess.T_truth_map, pose, centre, 1.0, 0.05)) known = &guess;
    if (known != nullptr && known->score >= static_cast<double>(support.size())) return;
    TPose2D fitted = fit(support);
    for (int i = 0; i < 2; ++i) {
      const std::vector<std::size_t> again = inliers(fitted);
      if (again.size() < support.size()) break;
      support = again;
      fitted = fit(support);
    }
    const PoseGuess guess{fitted, static_cast<double>(support.size()), AlignBy::Features};
    if (known != nullptr)
      *known = guess;
    else
      found_.push_back(guess);
  }

  const FeatureSet& map_;
  const FeatureSet& truth_;
  const std::vector<Match>& matches_;
  const MatchConfig& config_;
  std::vector<PoseGuess> found_;
};

}  // namespace

std::vector<Match> associate(const FeatureSet& map, const FeatureSet& truth, const MatchConfig& config) {
  if (map.features.empty() || truth.features.empty()) return {};
  const cv::Mat distances = distance_table(map, truth);
  std::vector<Match> out;
  for (std::size_t i = 0; i < map.features.size(); ++i) {
    const std::vector<Match> near = candidates(map, i, truth, distances, config);
    for (std::size_t k = 0; k + 1 < near.size() && k < config.neighbours; ++k) {
      out.push_back(near[k]);
      out.back().ratio = near[k].distance / std::max(near[k + 1].distance, 1e-9);
    }
    if (near.size() == 1) out.push_back(near[0]);
  }
  std::stable_sort(out.begin(), out.end(), [](const Match& a, const Match& b) { return a.ratio < b.ratio; });
  if (out.size() > config.max_matches) out.resize(config.max_matches);
  return out;
}

std::vector<PoseGuess> poses_from(const FeatureSet& map, const FeatureSet& truth, const std::vector<Match>& matches,
                                  const MatchConfig& config) {
  if (matches.size() < 2) return {};
  Poses poses(map, truth, matches, config);
  Rng rng(config.seed, "ransac");
  for (int draw = 0; draw < config.draws; ++draw) {
    // The pool grows from the most distinctive ten to all matches over the first half of the draws.
    const double share = std::min(1.0, 2.0 * draw / config.draws);
    const auto pool = static_cast<std::uint32_t>(
        std::min<double>(static_cast<double>(matches.size()), 10.0 + share * static_cast<double>(matches.size())));
    const std::uint32_t a = rng.below(pool);
    const std::uint32_t b = rng.below(pool);
    if (a != b) poses.try_pair(matches[a], matches[b]);
  }
  return poses.best();
}

std::vector<PoseGuess> propose_by_features(const OccupancyGrid& map, const OccupancyGrid& truth, FeatureKind kind,
                                           const MatchConfig& config) {
  const FeatureSet of_map = find_features(map, kind);
  const FeatureSet of_truth = find_features(truth, kind);
  return poses_from(of_map, of_truth, associate(of_map, of_truth, config), config);
}

}  // namespace rubble::scoring
