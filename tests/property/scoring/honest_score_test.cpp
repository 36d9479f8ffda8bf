#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "scoring/measures/sight_lines.h"
#include "scoring/scorecard.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"

/// The laws that keep the headline score from being gamed, over generated arenas. With RUBBLE_ARENA_SEEDS=N in the
/// environment over N seeds a shape.
namespace rubble::scoring {
namespace {

using namespace testing;

double at_true_pose(const OccupancyGrid& map, const OccupancyGrid& truth) {
  return score_at_pose(map, truth, {}).score;
}

/// Scores of many maps of one truth at the true pose; the truth is prepared once.
class Judge {
 public:
  explicit Judge(const OccupancyGrid& truth) : sights_(truth) {}
  double operator()(const OccupancyGrid& map) const { return sights_.at(map, PlanarTransform()).score; }
  const SightLines& sights() const { return sights_; }

 private:
  SightLines sights_;
};

class HonestScore : public ::testing::TestWithParam<Ground> {
 protected:
  std::uint64_t seed() const { return GetParam().seed; }
  const OccupancyGrid truth = truth_of(GetParam());
  const Judge judge{truth};
};

INSTANTIATE_TEST_SUITE_P(Grounds, HonestScore, ::testing::ValuesIn(grounds()),
                         [](const auto& info) { return info.param.name(); });

TEST_P(HonestScore, WhoeverKnowsNothingEarnsNothing) {
  EXPECT_NEAR(judge(truth), 1.0, 1e-9);
  EXPECT_EQ(judge(OccupancyGrid(truth.frame(), Occupancy::Free)), 0.0);
  EXPECT_EQ(judge(OccupancyGrid(truth.frame(), Occupancy::Occupied)), 0.0);
  EXPECT_EQ(judge(OccupancyGrid(truth.frame())), 0.0);
  EXPECT_EQ(judge(framed(OccupancyGrid(truth.frame(), Occupancy::Free), 4)), 0.0);
  double sum = 0.0;
  for (std::uint64_t i = 0; i < 10; ++i) sum += judge(guessed(truth, 0.1 * static_cast<double>(i), 100 * seed() + i));
  EXPECT_LE(sum / 10.0, 0.03);
}

/// The arena may be fuller on one side.
TEST_P(HonestScore, AnHonestPartEarnsItsShare) {
  for (const bool western : {true, false}) {
    const OccupancyGrid half = half_of(truth, western);
    EXPECT_NEAR(judge(half), share_within(judge.sights(), half), 0.05);
  }
}

TEST_P(HonestScore, FillingTheUnknownByGuessesGainsNothing) {
  double gained = 0.0;
  int guesses = 0;
  for (const bool western : {true, false}) {
    const OccupancyGrid half = half_of(truth, western);
    const double honest = judge(half);
    EXPECT_LE(judge(unknown_as_free(half)), honest);
    for (const double p : {0.2, 0.35, 0.5})
      for (std::uint64_t i = 0; i < 10; ++i) {
        gained += judge(filled(half, guessed(truth, p, 100 * seed() + i))) - honest;
        ++guesses;
      }
  }
  EXPECT_LE(gained / guesses, 0.01);
}

TEST_P(HonestScore, AFatPencilCostsLittle) {
  const int cells = static_cast<int>(std::lround(0.05 / truth.resolution()));
  EXPECT_GE(judge(thickened(truth, cells)), 0.95);
  EXPECT_GE(judge(thickened(truth, 2 * cells)), 0.9);
  EXPECT_LT(judge(thickened(truth, 2 * cells)), judge(thickened(truth, cells)));
}

TEST_P(HonestScore, WallsInTheWrongPlaceCost) {
  double last = 1.0;
  for (const double shift : {0.05, 0.1, 0.2, 0.4}) {
    const double score = judge.sights().at(truth, PlanarTransform({0.8 * shift, 0.6 * shift, 0.0})).score;
    EXPECT_LT(score, last - 0.03) << "shifted by " << shift;
    last = score;
  }
  EXPECT_LE(last, 0.2);
}

TEST_P(HonestScore, TouchingUpADamagedMapGainsNothing) {
  const OccupancyGrid damaged = with_gaps(with_phantoms(truth, 6, seed()), 12, seed());
  const double honest = at_true_pose(damaged, truth);
  EXPECT_LE(at_true_pose(framed(damaged, 4), truth), honest + 0.01);
  EXPECT_LE(at_true_pose(smoothed(damaged), truth), honest + 0.01);
  EXPECT_LE(at_true_pose(unknown_as_free(damaged), truth), honest + 0.01);
  EXPECT_LE(at_true_pose(beside_copies(damaged, {0.95, 1.05}), truth), honest + 0.01);
  EXPECT_LE(at_true_pose(without_unsure(damaged, 0.05), truth), honest + 0.01);
}

/// Each further hypothesis on one canvas is one guess more: what the best of them earns is shared by all.
TEST_P(HonestScore, ASecondDrawingOnTheCanvasCosts) {
  const double alone = at_true_pose(truth, truth);
  EXPECT_LE(at_true_pose(beside_copies(truth, {1.0}), truth), 0.55 * alone);
}

/// The best pose that the alignment finds, trusted or not.
TEST(HonestScoreOfStrangers, IsNearZeroAtTheBestPose) {
  const char* seeds = std::getenv("RUBBLE_ARENA_SEEDS");
  const std::uint64_t count = seeds == nullptr ? 3 : std::strtoull(seeds, nullptr, 10);
  double sum = 0.0;
  int pairs = 0;
  for (const char* kind : {"yellow", "orange"})
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
      const OccupancyGrid truth = truth_of({kind, 8, 8, seed});
      const MapScore score = score_map(truth_of({"yellow", 8, 8, seed + 500}), truth);
      EXPECT_LE(score.score_at_best_pose, 0.2) << kind << " seed " << seed;
      EXPECT_FALSE(score.aligned);
      EXPECT_EQ(score.score, 0.0);
      sum += score.score_at_best_pose;
      ++pairs;
    }
  EXPECT_LE(sum / pairs, 0.1);
}

}  // namespace
}  // namespace rubble::scoring
