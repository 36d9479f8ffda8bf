#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_damage.h"
#include "tests/support/scoring_grounds.h"

/// The laws any map score must obey, over mazes and generated arenas and seeded damage to them. The seed of a ground is
/// in its name.
namespace rubble::scoring {
namespace {

using namespace testing;

class ScoreLaws : public ::testing::TestWithParam<Ground> {
 protected:
  std::uint64_t seed() const { return GetParam().seed; }

  const OccupancyGrid truth = truth_of(GetParam());
  /// Some walls too many and some too few.
  const OccupancyGrid damaged = with_gaps(with_phantoms(truth, 6, seed()), 12, seed());
};

INSTANTIATE_TEST_SUITE_P(Grounds, ScoreLaws, ::testing::ValuesIn(grounds()),
                         [](const auto& info) { return info.param.name(); });

TEST_P(ScoreLaws, TheTruthItselfScoresOneAndHasNoPsi) {
  const MapScore score = score_map(truth, truth);
  EXPECT_TRUE(score.aligned) << score.note;
  EXPECT_NEAR(score.score, 1.0, 1e-6);
  EXPECT_NEAR(score.psi_m, 0.0, 1e-6);
  EXPECT_NEAR(score.psi_literal_m, 0.0, 1e-6);
  EXPECT_NEAR(score.known, 1.0, 1e-6);
  EXPECT_LT(score.runner_up, 0.9);
}

TEST_P(ScoreLaws, ARigidMotionOfTheMapImageChangesNothing) {
  const double expected = score_map(damaged, truth).score;
  for (const double angle_deg : {37.0, 90.0, 143.0, 180.0, -71.0}) {
    SCOPED_TRACE("turned by " + std::to_string(angle_deg));
    const MapScore score = score_map(moved(damaged, deg_to_rad(angle_deg), 3.0, -1.7), truth);
    EXPECT_TRUE(score.aligned) << score.note;
    EXPECT_NEAR(score.score, expected, 0.02);
  }
}

TEST_P(ScoreLaws, PaddingCroppingOriginAndResamplingChangeNothing) {
  const MapScore expected = score_map(damaged, truth);
  const MapScore wide = score_map(padded(damaged, 150), padded(truth, 90));
  EXPECT_NEAR(wide.score, expected.score, 0.02);
  EXPECT_NEAR(wide.psi_m, expected.psi_m, 0.01);
  EXPECT_NEAR(wide.psi_literal_m, expected.psi_literal_m, 0.02);
  EXPECT_NEAR(score_map(crop_to_known(damaged, 0.0), truth).score, expected.score, 0.02);
  EXPECT_NEAR(score_map(moved(damaged, 0.0, 512345.0, 5412345.0), truth).score, expected.score, 0.02);
  for (const double resolution : {0.025, 0.04, 0.0625}) {
    const MapScore coarser = score_map(moved(damaged, 0.3, 0.0, 0.0, resolution), truth);
    EXPECT_NEAR(coarser.overlap, expected.overlap, 0.02) << resolution;
    // On cells coarser than the walls are thick, ends and gaps of walls move by a cell.
    EXPECT_NEAR(coarser.score, expected.score, resolution > 0.05 ? 0.04 : 0.02) << resolution;
  }
}

TEST_P(ScoreLaws, AMirroredMapIsNoMatch) {
  const MapScore score = score_map(mirrored(truth), truth);
  EXPECT_FALSE(score.aligned);
  EXPECT_NE(score.note.find("the map is a mirror image"), std::string::npos) << score.note;
  EXPECT_EQ(score.score, 0.0);
}

TEST_P(ScoreLaws, AnotherGroundsMapIsNoMatch) {
  Ground other = GetParam();
  other.seed += 50;
  EXPECT_FALSE(score_map(truth_of(other), truth).aligned);
  EXPECT_FALSE(score_map(scaled(truth, 2.0), truth).aligned);
  EXPECT_FALSE(score_map(scaled(truth, 0.5), truth).aligned);
}

std::vector<Damage> damages() {
  return {bending({0.0, 0.2, 0.5, 1.0, 1.6}),
          phantom_walls({0, 5, 15, 30, 60}),
          erased_walls({0, 10, 30, 60, 100}),
          thickening({0, 1, 2, 4, 7}),
          lost_coverage({1.0, 0.8, 0.6, 0.4, 0.2}),
          salting({0.0, 0.01, 0.03, 0.08, 0.2}),
          scale_error({1.0, 1.01, 1.03, 1.06, 1.12, 1.3})};
}

class GrowingDamage : public ::testing::TestWithParam<std::tuple<Damage, Ground>> {};

INSTANTIATE_TEST_SUITE_P(Grounds, GrowingDamage,
                         ::testing::Combine(::testing::ValuesIn(damages()), ::testing::ValuesIn(grounds())),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" + std::get<1>(info.param).name();
                         });

/// ... and the worst is clearly below the first.
TEST_P(GrowingDamage, NeverRaisesTheScore) {
  const auto& [damage, ground] = GetParam();
  const OccupancyGrid truth = truth_of(ground);
  double first = 0.0;
  double last = 2.0;
  for (const double level : damage.levels) {
    const double score = score_map(moved(damage.apply(truth, level, ground.seed), 0.4, 1.0, 2.0), truth).score;
    EXPECT_LE(score, last + 0.01) << "at level " << level;
    if (last > 1.0) first = score;
    last = score;
  }
  EXPECT_LT(last, first - 0.03);
}

TEST_P(ScoreLaws, DegenerateMapsScoreNextToNothing) {
  OccupancyGrid single_wall(truth.frame(), Occupancy::Free);
  draw_wall(single_wall, {1.0, 1.0}, {4.0, 1.0}, 2);
  OccupancyGrid wall_only(truth.frame());
  draw_wall(wall_only, {1.0, 1.0}, {4.0, 1.0}, 2);
  OccupancyGrid noise(truth.frame());
  Rng rng(seed(), "noise");
  for (Occupancy& cell : noise.cells()) cell = static_cast<Occupancy>(rng.below(3));
  const std::vector<std::pair<std::string, OccupancyGrid>> maps = {
      {"all occupied", OccupancyGrid(truth.frame(), Occupancy::Occupied)},
      {"all free", OccupancyGrid(truth.frame(), Occupancy::Free)},
      {"all unknown", OccupancyGrid(truth.frame())},
      {"empty", OccupancyGrid()},
      {"one cell", OccupancyGrid(GridFrame{1, 1, 0.05, 0.0, 0.0}, Occupancy::Occupied)},
      {"single wall", single_wall},
      {"single wall in the unknown", wall_only},
      {"noise", noise}};
  for (const auto& [name, map] : maps) {
    for (const bool swapped : {false, true}) {
      SCOPED_TRACE(name + (swapped ? " as truth" : ""));
      const MapScore score = swapped ? score_map(truth, map) : score_map(map, truth);
      EXPECT_FALSE(score.aligned);
      EXPECT_EQ(score.score, 0.0);
      for (const double value : {score.psi_m, score.psi_literal_m, score.precision, score.recall, score.known,
                                 score.runner_up, score.T_truth_map.x, score.T_truth_map.y, score.T_truth_map.phi})
        EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST_P(ScoreLaws, TheSameMapsGiveTheSameBits) {
  const OccupancyGrid map = ragged(with_phantoms(moved(truth, 0.8, 1.0, 0.0), 8, seed()), 1, seed());
  const MapScore a = score_map(map, truth);
  const MapScore b = score_map(map, truth);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.psi_literal_m, b.psi_literal_m);
  EXPECT_EQ(a.T_truth_map.x, b.T_truth_map.x);
  EXPECT_EQ(a.T_truth_map.phi, b.T_truth_map.phi);
  EXPECT_EQ(a.runner_up, b.runner_up);
}

TEST_P(ScoreLaws, TheTransformFoundIsTheOneApplied) {
  const TPose2D T_map_truth(3.0, -1.0, 2.2);
  const MapScore score = score_map(moved(truth, T_map_truth.phi, T_map_truth.x, T_map_truth.y), truth);
  const TPose2D rest = score.T_truth_map + T_map_truth;
  EXPECT_NEAR(rest.norm(), 0.0, 0.05);
  EXPECT_NEAR(wrap_angle(rest.phi), 0.0, 0.005);
}

TEST_P(ScoreLaws, AtThePoseFoundTheGivenPoseScoresTheSame) {
  const OccupancyGrid map = moved(damaged, 0.8, 1.0, 0.0);
  ScoreConfig config;
  config.warp = true;
  const MapScore searched = score_map(map, truth, config);
  ASSERT_TRUE(searched.aligned) << searched.note;
  const MapScore given = score_at_pose(map, truth, searched.T_truth_map, config);
  EXPECT_EQ(given.score, searched.score);
  EXPECT_EQ(given.psi_m, searched.psi_m);
  EXPECT_EQ(given.errors.phantom_m, searched.errors.phantom_m);
  EXPECT_EQ(given.warped_score, searched.warped_score);
  EXPECT_EQ(names_of(given.by), "given");
}

/// Swapping the maps swaps precision and recall; what the map does not know costs recall only; what the truth does not
/// know costs nothing.
TEST_P(ScoreLaws, PrecisionAndRecallKeepTheirRoles) {
  const MapScore there = score_at_pose(damaged, truth, {});
  const MapScore back = score_at_pose(truth, damaged, {});
  EXPECT_NEAR(there.precision, back.recall, 0.02);
  EXPECT_NEAR(there.recall, back.precision, 0.02);
  const MapScore part = score_at_pose(with_coverage(truth, 0.5), truth, {});
  EXPECT_NEAR(part.precision, 1.0, 0.002);  // the cut changes the mean thickness a little
  EXPECT_LT(part.recall, 0.7);
  EXPECT_NEAR(score_at_pose(truth, with_coverage(truth, 0.5), {}).score, 1.0, 0.02);
}

/// Undoing the map's distortion never lowers the score, the penalty for it never lifts it over the warped score, and
/// both vanish with the bend.
TEST_P(ScoreLaws, TheWarpHelpsAndItsPenaltyVanishesWithTheBend) {
  ScoreConfig config;
  config.warp = true;
  for (const double bend : {0.0, 0.1, 0.5}) {
    SCOPED_TRACE("bend " + std::to_string(bend));
    const MapScore score = score_map(moved(bent(damaged, bend), 0.4, 1.0, 2.0), truth, config);
    ASSERT_TRUE(score.aligned) << score.note;
    EXPECT_GE(score.warped_score, score.score);
    EXPECT_GE(score.penalised_score, score.score);
    EXPECT_LE(score.penalised_score, score.warped_score);
    // A bend of b displaces the walls by 0.3 b (RMS); the rest is what the damage and the raster make of it.
    EXPECT_LE(score.warp_m, 0.35 * bend + 0.03);
    EXPECT_LE(score.warped_score - score.penalised_score, 0.5 * (0.35 * bend + 0.03));
  }
}

}  // namespace
}  // namespace rubble::scoring
