#include "scoring/alignment/match_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/angle.h"
#include "base/planar.h"
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
double brute_force(const std::vector<TPoint2D>& map, const std::vector<TPoint2D>& truth, const PlanarTransform& T,
                   double cap) {
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
      sum += (T(map[i]) - truth[j]).sqrNorm();
      ++matched;
    }
    const double unmatched = static_cast<double>(map.size() + truth.size()) - 2.0 * matched;
    best = std::min(best, sum + 0.5 * cap * unmatched);
  } while (std::next_permutation(partner.begin(), partner.end()));
  return best / (0.5 * static_cast<double>(map.size() + truth.size()));
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
    EXPECT_NEAR(found.error, brute_force(map, truth, PlanarTransform(T), 1.5), 1e-9);
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

}  // namespace
}  // namespace rubble::scoring
