#include "scoring/alignment/feature_score.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/scorecard.h"
#include "scoring/walls/overlap.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

FeatureVerdict verdict_of(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T) {
  const OccupancyGrid a = crop_to_known(map, 0.0);
  const OccupancyGrid b = crop_to_known(truth, 0.0);
  return judge_features(a, features_of(a), b, truth_features(b), T);
}

TEST(FeatureScore, TheTruthIsOneAndAStrangerFarBelowADamagedMap) {
  double strangers = 0.0;
  int pairs = 0;
  for (const Ground& ground : {Ground{"maze", 8, 7, 7501}, {"yellow", 8, 7, 7502}, {"orange", 8, 7, 7503}}) {
    SCOPED_TRACE(ground.name());
    const OccupancyGrid truth = truth_of(ground);
    Ground other = ground;
    other.seed += 500;
    const OccupancyGrid stranger = truth_of(other);
    const OccupancyGrid damaged = with_gaps(with_phantoms(truth, 6, ground.seed), 12, ground.seed);
    EXPECT_NEAR(verdict_of(truth, truth, {}).score, 1.0, 1e-9);
    const double of_stranger = verdict_of(stranger, truth, score_map(stranger, truth).T_truth_map).score;
    EXPECT_GT(verdict_of(damaged, truth, {}).score, of_stranger + 0.2);
    EXPECT_LE(of_stranger, 0.25);
    strangers += of_stranger;
    ++pairs;
  }
  EXPECT_LE(strangers / pairs, 0.15);
}

/// Walls of one cell have holes and steps where a map is turned.
TEST(FeatureScore, ATurnedDrawingKeepsItsFeatures) {
  const OccupancyGrid truth = truth_of({"yellow", 8, 7, 7502});
  for (const double deg : {3.0, 13.0, 31.0}) {
    SCOPED_TRACE(deg);
    const OccupancyGrid turned = moved(truth, deg_to_rad(deg), 3.0, -1.7);
    EXPECT_GT(verdict_of(turned, truth, score_map(turned, truth).T_truth_map).score, 0.7);
  }
}

TEST(FeatureScore, OutliersAndPairsAreAllFeatures) {
  const OccupancyGrid truth = truth_of({"yellow", 8, 7, 7504});
  for (const KindScore& kind : verdict_of(with_gaps(truth, 12, 1), truth, {}).kinds) {
    EXPECT_LE(kind.match.pairs.size(), std::min(kind.map.size(), kind.truth.size())) << name_of(kind.kind);
    EXPECT_EQ(kind.match.pairs.size(), kind.match.matched);
    EXPECT_LE(kind.match.error, feature_cap(kind.kind));
  }
}

/// Eq. (7) pulls a pose that is a little off to where it belongs.
TEST(FeatureScore, MinimisingTheErrorFindsThePose) {
  for (const std::uint64_t seed : {7505u, 7506u}) {
    const OccupancyGrid truth = crop_to_known(truth_of({"yellow", 8, 7, seed}), 0.0);
    const MapFeatures features = features_of(truth);
    const TPose2D start(0.25, -0.2, 0.03);
    const FeaturePose found = minimise_feature_error(features, features, start);
    EXPECT_NEAR(found.T_truth_map.norm(), 0.0, 0.03) << "seed " << seed;
    EXPECT_NEAR(found.T_truth_map.phi, 0.0, 0.005) << "seed " << seed;
    EXPECT_NEAR(found.error, 0.0, 0.02) << "seed " << seed;
  }
}

/// Eq. (8) over pairs of features undoes a bend; without one there is nothing to undo.
TEST(FeatureScore, TheWarpFromFeaturesUndoesABend) {
  const OccupancyGrid truth = crop_to_known(truth_of({"maze", 9, 7, 7507}), 0.0);
  const MapFeatures of_truth = features_of(truth);
  EXPECT_LT(fit_feature_warp(of_truth, of_truth, {}, truth.frame()).size, 0.01);
  const OccupancyGrid map = crop_to_known(bent(truth, 0.4), 0.0);
  const MapFeatures of_map = features_of(map);
  const TPose2D T = score_map(map, truth).T_truth_map;
  const FeatureWarp warp = fit_feature_warp(of_map, of_truth, T, map.frame());
  // The walls, which the fit has not seen, come together.
  const WallOverlap walls(map, truth, 0.5);
  EXPECT_GT(walls.at(warp.warp).score, walls.at(PlanarTransform(T)).score + 0.02);
  EXPECT_GT(warp.size, 0.05);
  EXPECT_LT(warp.size, 0.4);
}

/// A league prepares the truth once for all teams.
TEST(FeatureScore, APreparedTruthGivesTheSameBits) {
  const OccupancyGrid truth = truth_of({"maze", 6, 5, 7508});
  ScoreConfig config;
  config.warp = true;
  const ScoreConfig prepared = prepared_for(truth, config);
  ASSERT_NE(prepared.of_truth, nullptr);
  const OccupancyGrid map = with_gaps(truth, 6, 3);
  const MapScore a = score_at_pose(map, truth, {}, config);
  const MapScore b = score_at_pose(map, truth, {}, prepared);
  EXPECT_GT(a.by_features.score, 0.3);
  EXPECT_EQ(a.by_features.score, b.by_features.score);
  EXPECT_EQ(a.features.error, b.features.error);
  EXPECT_EQ(a.feature_warped_score, b.feature_warped_score);
}

TEST(FeatureScore, AMapWithoutFeaturesIsNoMatch) {
  const OccupancyGrid truth = maze({});
  const OccupancyGrid empty(truth.frame(), Occupancy::Free);
  EXPECT_EQ(verdict_of(empty, truth, {}).score, 0.0);
  EXPECT_GE(verdict_of(truth, empty, {}).score, 0.0);
}

}  // namespace
}  // namespace rubble::scoring
