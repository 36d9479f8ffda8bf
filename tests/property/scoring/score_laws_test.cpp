#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/angle.h"
#include "scoring/resample.h"
#include "scoring/scorecard.h"
#include "tests/support/scoring_maze.h"

/// The laws any map score must obey, over random mazes and seeded damage.
namespace rubble::scoring {
namespace {

using namespace testing;

MazeSpec spec(std::uint64_t seed, int side = 7) {
  MazeSpec out;
  out.columns = side;
  out.rows = side;
  out.seed = seed;
  return out;
}

const std::vector<std::uint64_t> kSeeds = {1, 2};

TEST(ScoreLaws, TheTruthItselfScoresOneAndHasNoPsi) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    const MapScore score = score_map(truth, truth);
    EXPECT_TRUE(score.aligned) << score.note;
    EXPECT_NEAR(score.score, 1.0, 1e-6);
    EXPECT_NEAR(score.psi_m, 0.0, 1e-6);
    EXPECT_NEAR(score.psi_literal_m, 0.0, 1e-6);
    EXPECT_NEAR(score.known, 1.0, 1e-6);
    EXPECT_LT(score.runner_up, 0.9);
  }
}

TEST(ScoreLaws, ARigidMotionOfTheMapImageChangesNothing) {
  for (const std::uint64_t seed : kSeeds) {
    const OccupancyGrid truth = maze(spec(seed));
    const OccupancyGrid map = with_gaps(with_phantoms(truth, 6, seed), 12, seed);
    const double expected = score_map(map, truth).score;
    for (const double angle_deg : {37.0, 90.0, 143.0, 180.0, -71.0}) {
      SCOPED_TRACE("maze seed " + std::to_string(seed) + ", turned by " + std::to_string(angle_deg));
      const MapScore score = score_map(moved(map, deg_to_rad(angle_deg), 3.0, -1.7), truth);
      EXPECT_TRUE(score.aligned) << score.note;
      EXPECT_NEAR(score.score, expected, 0.02);
    }
  }
}

TEST(ScoreLaws, PaddingCroppingOriginAndResamplingChangeNothing) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    const OccupancyGrid map = with_gaps(with_phantoms(truth, 6, seed), 12, seed);
    const MapScore expected = score_map(map, truth);
    const MapScore wide = score_map(padded(map, 150), padded(truth, 90));
    EXPECT_NEAR(wide.score, expected.score, 0.02);
    EXPECT_NEAR(wide.psi_m, expected.psi_m, 0.01);
    EXPECT_NEAR(wide.psi_literal_m, expected.psi_literal_m, 0.02);
    EXPECT_NEAR(score_map(crop_to_known(map, 0.0), truth).score, expected.score, 0.02);
    EXPECT_NEAR(score_map(moved(map, 0.0, 512345.0, 5412345.0), truth).score, expected.score, 0.02);
    for (const double resolution : {0.025, 0.04, 0.0625})
      EXPECT_NEAR(score_map(moved(map, 0.3, 0.0, 0.0, resolution), truth).score, expected.score, 0.02) << resolution;
  }
}

TEST(ScoreLaws, AMirroredMapIsNoMatch) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    const MapScore score = score_map(mirrored(truth), truth);
    EXPECT_FALSE(score.aligned);
    EXPECT_FALSE(score.note.empty());
    EXPECT_EQ(score.score, 0.0);
  }
}

TEST(ScoreLaws, AnotherArenasMapIsNoMatch) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    EXPECT_FALSE(score_map(maze(spec(seed + 50)), truth).aligned);
    EXPECT_FALSE(score_map(scaled(truth, 2.0), truth).aligned);
    EXPECT_FALSE(score_map(scaled(truth, 0.5), truth).aligned);
  }
}

/// Scores of a map under growing damage never rise, and the worst is clearly below the first.
void expect_falling(const std::string& kind, const std::vector<double>& levels,
                    const std::function<OccupancyGrid(const OccupancyGrid&, double, std::uint64_t)>& damage) {
  for (const std::uint64_t seed : {1, 2}) {
    const OccupancyGrid truth = maze(spec(seed));
    double last = 2.0;
    double first = 0.0;
    for (const double level : levels) {
      SCOPED_TRACE(kind + " " + std::to_string(level) + ", maze seed " + std::to_string(seed));
      const double score = score_map(moved(damage(truth, level, seed), 0.4, 1.0, 2.0), truth).score;
      if (last > 1.0) first = score;
      EXPECT_LE(score, last + 0.01);
      last = score;
    }
    EXPECT_LT(last, first - 0.03) << kind << ", maze seed " << seed;
  }
}

TEST(ScoreLaws, BendingNeverRaisesTheScore) {
  expect_falling("bend [m]", {0.0, 0.2, 0.5, 1.0, 1.6},
                 [](const OccupancyGrid& truth, double level, std::uint64_t) { return bent(truth, level); });
}

TEST(ScoreLaws, PhantomWallsNeverRaiseTheScore) {
  expect_falling("phantoms", {0, 5, 15, 30, 60}, [](const OccupancyGrid& truth, double level, std::uint64_t seed) {
    return with_phantoms(truth, static_cast<int>(level), seed);
  });
}

TEST(ScoreLaws, ErasedWallsNeverRaiseTheScore) {
  expect_falling("gaps", {0, 10, 30, 60, 100}, [](const OccupancyGrid& truth, double level, std::uint64_t seed) {
    return with_gaps(truth, static_cast<int>(level), seed);
  });
}

TEST(ScoreLaws, ThickeningNeverRaisesTheScore) {
  expect_falling("cells", {0, 1, 2, 4, 7}, [](const OccupancyGrid& truth, double level, std::uint64_t) {
    return thickened(truth, static_cast<int>(level));
  });
}

TEST(ScoreLaws, LostCoverageNeverRaisesTheScore) {
  expect_falling("coverage", {1.0, 0.8, 0.6, 0.4, 0.2},
                 [](const OccupancyGrid& truth, double level, std::uint64_t) { return with_coverage(truth, level); });
}

TEST(ScoreLaws, SaltNeverRaisesTheScore) {
  expect_falling(
      "salt", {0.0, 0.01, 0.03, 0.08, 0.2},
      [](const OccupancyGrid& truth, double level, std::uint64_t seed) { return with_salt(truth, level, seed); });
}

TEST(ScoreLaws, AScaleErrorNeverRaisesTheScore) {
  expect_falling("scale", {1.0, 1.01, 1.03, 1.06, 1.12, 1.3},
                 [](const OccupancyGrid& truth, double level, std::uint64_t) { return scaled(truth, level); });
}

TEST(ScoreLaws, DegenerateMapsScoreNextToNothing) {
  const OccupancyGrid truth = maze(spec(1));
  OccupancyGrid single_wall(truth.frame(), Occupancy::Free);
  draw_wall(single_wall, {1.0, 1.0}, {4.0, 1.0}, 2);
  OccupancyGrid wall_only(truth.frame());
  draw_wall(wall_only, {1.0, 1.0}, {4.0, 1.0}, 2);
  OccupancyGrid noise(truth.frame());
  Rng rng(1, "noise");
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

TEST(ScoreLaws, TheSameMapsGiveTheSameBits) {
  const OccupancyGrid truth = maze(spec(4));
  const OccupancyGrid map = ragged(with_phantoms(moved(truth, 0.8, 1.0, 0.0), 8, 4), 1, 4);
  const MapScore a = score_map(map, truth);
  const MapScore b = score_map(map, truth);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.psi_literal_m, b.psi_literal_m);
  EXPECT_EQ(a.T_truth_map.x, b.T_truth_map.x);
  EXPECT_EQ(a.T_truth_map.phi, b.T_truth_map.phi);
  EXPECT_EQ(a.runner_up, b.runner_up);
}

TEST(ScoreLaws, TheTransformFoundIsTheOneApplied) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    const TPose2D T_map_truth(3.0, -1.0, 2.2);
    const MapScore score = score_map(moved(truth, T_map_truth.phi, T_map_truth.x, T_map_truth.y), truth);
    const TPose2D rest = score.T_truth_map + T_map_truth;
    EXPECT_NEAR(rest.norm(), 0.0, 0.05);
    EXPECT_NEAR(wrap_angle(rest.phi), 0.0, 0.005);
  }
}

TEST(ScoreLaws, AtThePoseFoundTheGivenPoseScoresTheSame) {
  const OccupancyGrid truth = maze(spec(6));
  const OccupancyGrid map = moved(with_gaps(with_phantoms(truth, 8, 6), 12, 6), 0.8, 1.0, 0.0);
  ScoreConfig config;
  config.warp = true;
  const MapScore searched = score_map(map, truth, config);
  ASSERT_TRUE(searched.aligned) << searched.note;
  const MapScore given = score_at_pose(map, truth, searched.T_truth_map, config);
  EXPECT_EQ(given.score, searched.score);
  EXPECT_EQ(given.psi_m, searched.psi_m);
  EXPECT_EQ(given.errors.phantom_m, searched.errors.phantom_m);
  EXPECT_EQ(given.warped_score, searched.warped_score);
  EXPECT_EQ(given.source, "given");
}

/// Swapping the maps swaps precision and recall; what the map does not know costs recall only; what the truth does not
/// know costs nothing.
TEST(ScoreLaws, PrecisionAndRecallKeepTheirRoles) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze(spec(seed));
    const OccupancyGrid map = with_gaps(with_phantoms(truth, 6, seed), 12, seed);
    const MapScore there = score_at_pose(map, truth, {});
    const MapScore back = score_at_pose(truth, map, {});
    EXPECT_NEAR(there.precision, back.recall, 0.02);
    EXPECT_NEAR(there.recall, back.precision, 0.02);
    const MapScore part = score_at_pose(with_coverage(truth, 0.5), truth, {});
    EXPECT_NEAR(part.precision, 1.0, 0.002);  // the cut changes the mean thickness a little
    EXPECT_LT(part.recall, 0.7);
    EXPECT_NEAR(score_at_pose(truth, with_coverage(truth, 0.5), {}).score, 1.0, 0.02);
  }
}

}  // namespace
}  // namespace rubble::scoring
