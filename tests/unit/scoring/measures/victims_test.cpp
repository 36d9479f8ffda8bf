#include "scoring/measures/victims.h"
#include "base/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

TEST(Assign, CostsNoMoreThanAnyPermutation) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "cost");
    std::vector<std::vector<double>> cost(4, std::vector<double>(6));
    for (auto& row : cost)
      for (double& value : row) value = rng.uniform(0.0, 10.0);
    const std::vector<std::size_t> column = assign(cost);
    double total = 0.0;
    for (std::size_t i = 0; i < 4; ++i) total += cost[i][column[i]];
    std::vector<std::size_t> permutation(6);
    std::iota(permutation.begin(), permutation.end(), std::size_t{0});
    double best = 1e9;
    do {
      double sum = 0.0;
      for (std::size_t i = 0; i < 4; ++i) sum += cost[i][permutation[i]];
      best = std::min(best, sum);
    } while (std::next_permutation(permutation.begin(), permutation.end()));
    EXPECT_NEAR(total, best, 1e-9);
  }
}

TEST(Victims, AReportServesOneVictimOnlyAndTheRestAreFalse) {
  const std::vector<TPoint2D> truth = {{0, 0}, {5, 0}};
  const std::vector<TPoint2D> reported = {{0.1, 0}, {0.3, 0}, {9, 9}};
  const VictimScore score = score_victims(reported, truth, {});
  EXPECT_EQ(score.found, 1u);
  EXPECT_EQ(score.total, 2u);
  EXPECT_EQ(score.false_alarms, 2u);
  EXPECT_NEAR(score.mean_error_m, 0.1, 1e-12);
}

TEST(Victims, AsManyAsPossibleAreFoundEvenIfTheNearestPairHasToGiveWay) {
  // Greedy by distance would take (b, A) and leave a without a partner.
  const std::vector<TPoint2D> truth = {{0, 0}, {2, 0}};
  const std::vector<TPoint2D> reported = {{-1.0, 0}, {0.9, 0}};
  const VictimScore score = score_victims(reported, truth, {});
  EXPECT_EQ(score.found, 2u);
  EXPECT_EQ(score.matches[0].truth, 0u);
  EXPECT_EQ(score.matches[1].truth, 1u);
}

TEST(Victims, ErrorIsMeasuredAfterTheAlignment) {
  const TPose2D T_truth_map(3.0, -2.0, 0.7);
  const std::vector<TPoint2D> truth = {{1, 2}, {4, -1}, {0, 6}};
  std::vector<TPoint2D> reported;
  for (const TPoint2D& p : truth) reported.push_back(T_truth_map.inverseComposePoint(TPoint2D(p.x + 0.5, p.y)));
  const VictimScore score = score_victims(reported, truth, T_truth_map);
  EXPECT_EQ(score.found, 3u);
  EXPECT_NEAR(score.mean_error_m, 0.5, 1e-12);
}

TEST(Victims, OnePalletAwayIsFoundAndFurtherIsNot) {
  EXPECT_EQ(score_victims({{1.19, 0}}, {{0, 0}}, {}).found, 1u);
  EXPECT_EQ(score_victims({{1.21, 0}}, {{0, 0}}, {}).found, 0u);
  EXPECT_EQ(score_victims({}, {{0, 0}}, {}).total, 1u);
  EXPECT_EQ(score_victims({{0, 0}}, {}, {}).false_alarms, 1u);
}

}  // namespace
}  // namespace rubble::scoring
