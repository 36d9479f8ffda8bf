#include "scoring/alignment/matching.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "scoring/proposals/features.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

class EachFeature : public ::testing::TestWithParam<FeatureKind> {};

TEST_P(EachFeature, FindsTheMotionOfATurnedMapFromDescriptorsAlone) {
  for (const std::uint64_t seed : {1u, 2u}) {
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
