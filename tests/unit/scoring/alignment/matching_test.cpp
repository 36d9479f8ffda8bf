#include "scoring/alignment/matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/angle.h"
#include "base/rigid.h"
#include "base/rng.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

std::vector<TPoint2D> random_points(int n, Rng& rng) {
  std::vector<TPoint2D> out;
  for (int i = 0; i < n; ++i) {
    const double x = rng.uniform(0.0, 3.0);
    const double y = rng.uniform(0.0, 3.0);
    out.emplace_back(x, y);
  }
  return out;
}

/// Eq. (7) by trying every association.
double brute_force(const std::vector<TPoint2D>& map, const std::vector<TPoint2D>& truth, const Rigid& T, double cap) {
  std::vector<int> partner(std::max(map.size(), truth.size()) + map.size());
  std::iota(partner.begin(), partner.end(), 0);  // map feature i takes partner[i]; beyond the truth's: none
  double best = 1e18;
  std::sort(partner.begin(), partner.end());
  do {
    double sum = 0.0;
    int matched = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
      const auto j = static_cast<std::size_t>(partner[i]);
      if (j >= truth.size()) continue;
      sum += (T.forward(map[i]) - truth[j]).sqrNorm();
      ++matched;
    }
    const double unmatched = static_cast<double>(map.size() + truth.size()) - 2.0 * matched;
    best = std::min(best, sum + 0.5 * cap * unmatched);
  } while (std::next_permutation(partner.begin(), partner.end()));
  return best / (0.5 * static_cast<double>(map.size() + truth.size()));
}

TEST(FitRigid, RecoversTheMotionAndNeverAScale) {
  Rng rng(3, "points");
  const std::vector<TPoint2D> from = random_points(9, rng);
  const Rigid T(TPose2D(1.5, -2.0, 2.6));
  std::vector<TPoint2D> to;
  std::vector<TPoint2D> twice;
  for (const TPoint2D& p : from) to.push_back(T.forward(p));
  for (const TPoint2D& p : to) twice.push_back(p * 2.0);
  const TPose2D found = fit_rigid(from, to);
  EXPECT_NEAR(found.x, 1.5, 1e-12);
  EXPECT_NEAR(found.y, -2.0, 1e-12);
  EXPECT_NEAR(found.phi, 2.6, 1e-12);
  const Rigid of_twice(fit_rigid(from, twice));
  EXPECT_NEAR((of_twice.forward(from[0]) - of_twice.forward(from[1])).norm(), (from[0] - from[1]).norm(), 1e-12);
}

TEST(MatchError, EqualsTryingEveryAssociation) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "features");
    const auto n = static_cast<int>(1 + rng.below(4));
    const auto m = static_cast<int>(1 + rng.below(4));
    const std::vector<TPoint2D> map = random_points(n, rng);
    const std::vector<TPoint2D> truth = random_points(m, rng);
    const TPose2D T(0.3, -0.2, 0.4);
    const MatchError found = match_error(
        map, truth, T, [](std::size_t, std::size_t) { return 0.0; }, 1.5);
    EXPECT_NEAR(found.error, brute_force(map, truth, Rigid(T), 1.5), 1e-9);
  }
}

TEST(MatchError, NothingMatchedIsTheWorstAndIdenticalMapsTheBest) {
  Rng rng(1, "features");
  const std::vector<TPoint2D> features = random_points(6, rng);
  const auto none = [](std::size_t, std::size_t) { return 0.0; };
  const MatchError same = match_error(features, features, {}, none, 1.0);
  EXPECT_NEAR(same.error, 0.0, 1e-12);
  EXPECT_EQ(same.matched, 6U);
  EXPECT_EQ(match_error(features, features, {100.0, 0.0, 0.0}, none, 1.0).error, 1.0);
  EXPECT_EQ(match_error({}, features, {}, none, 1.0).error, 1.0);
  EXPECT_EQ(match_error({}, {}, {}, none, 1.0).error, 1.0);
  const auto unlike = [](std::size_t, std::size_t) { return 5.0; };
  EXPECT_EQ(match_error(features, features, {}, unlike, 1.0).error, 1.0);
}

class EachFeature : public ::testing::TestWithParam<FeatureKind> {};

TEST_P(EachFeature, FindsTheMotionOfATurnedMapFromDescriptorsAlone) {
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE("maze seed " + std::to_string(seed));
    const OccupancyGrid truth = maze_of(seed, 10, 8);
    const TPose2D T_map_truth(4.0, -2.0, 0.7);
    const OccupancyGrid map = moved(with_gaps(truth, 15, seed), T_map_truth.phi, T_map_truth.x, T_map_truth.y);
    const std::vector<PoseGuess> guesses = propose_by_features(map, truth, GetParam());
    ASSERT_FALSE(guesses.empty());
    const TPose2D rest = guesses.front().T_truth_map + T_map_truth;
    EXPECT_NEAR(rest.norm(), 0.0, 0.3);
    EXPECT_NEAR(wrap_angle(rest.phi), 0.0, 0.03);
  }
}

TEST_P(EachFeature, GivesTheSameFeaturesTwiceAndNoneOnEmptyMaps) {
  const OccupancyGrid map = maze_of(4, 10, 8);
  const FeatureSet a = find_features(map, GetParam());
  const FeatureSet b = find_features(map, GetParam());
  ASSERT_FALSE(a.features.empty());
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].p, b.features[i].p);
    EXPECT_EQ(descriptor_distance(a, i, b, i), 0.0);
  }
  EXPECT_TRUE(find_features(OccupancyGrid(map.frame()), GetParam()).features.empty());
  EXPECT_TRUE(find_features(OccupancyGrid(map.frame(), Occupancy::Occupied), GetParam()).features.size() < 50);
  EXPECT_TRUE(propose_by_features(OccupancyGrid(), map, GetParam()).empty());
}

INSTANTIATE_TEST_SUITE_P(Matching, EachFeature,
                         ::testing::Values(FeatureKind::Surf, FeatureKind::Akaze, FeatureKind::Orb),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace rubble::scoring
