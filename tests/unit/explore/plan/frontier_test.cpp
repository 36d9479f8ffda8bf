#include "explore/plan/frontier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using test::drawn;

TEST(Frontier, IsFreeWithAnUnseenFourNeighbour) {
  const Traversable floor = traversable(drawn({"        ",  //
                                               " #####  ",  //
                                               " #...#  ",  //
                                               " #.. #  ",  //
                                               " #...#  ",  //
                                               " #####  ",  //
                                               "        "}));
  const std::vector<Cell> expected{{4, 2}, {3, 3}, {4, 4}};
  EXPECT_EQ(frontier_cells(floor), expected);
}

TEST(Frontier, AClosedRoomHasNone) {
  const Traversable floor = traversable(drawn({"       ",  //
                                               " ##### ",  //
                                               " #...# ",  //
                                               " ##### ",  //
                                               "       "}));
  EXPECT_TRUE(frontier_cells(floor).empty());
  EXPECT_TRUE(frontier_clusters(floor, 1).empty());
}

TEST(Frontier, WhereOnlyTheBodyStoodThereIsNone) {
  Traversable floor = traversable(drawn({"          ",  //
                                         "          ",  //
                                         "          ",  //
                                         "          "},
                                        0.1));
  free_body(floor, {0.5, 0.2, 0.0}, 0.4, 0.2, 0.0);
  EXPECT_TRUE(frontier_cells(floor).empty());
}

class FrontierOnRandomGrids : public testing::TestWithParam<int> {};

TEST_P(FrontierOnRandomGrids, CellsAndClustersAreThoseOfTheDefinition) {
  const std::uint64_t seed = static_cast<std::uint64_t>(GetParam());
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const Traversable floor = traversable(test::random_grid(50 + GetParam(), 60 - GetParam(), seed));
  std::vector<Cell> expected;
  for (int y = 1; y + 1 < floor.cells.height(); ++y)
    for (int x = 1; x + 1 < floor.cells.width(); ++x) {
      bool unseen = false;
      for (const Cell n : {Cell{x - 1, y}, Cell{x + 1, y}, Cell{x, y - 1}, Cell{x, y + 1}})
        unseen = unseen || floor.cells[n] == Occupancy::Unknown;
      if (unseen && floor.cells[{x, y}] == Occupancy::Free) expected.push_back({x, y});
    }
  EXPECT_EQ(frontier_cells(floor), expected);

  // Clusters: every cell in exactly one, neighbours in the same one, and each hangs together.
  const std::vector<FrontierCluster> clusters = frontier_clusters(floor, 1);
  Grid<int> owner(floor.frame(), -1);
  std::size_t cells = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i)
    for (const Cell c : clusters[i].cells) {
      ASSERT_EQ(owner[c], -1);
      owner[c] = static_cast<int>(i);
      ++cells;
    }
  EXPECT_EQ(cells, expected.size());
  for (const Cell c : expected)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (owner[{c.x + dx, c.y + dy}] >= 0) {
          ASSERT_EQ((owner[{c.x + dx, c.y + dy}]), owner[c]);
        }
  for (const FrontierCluster& cluster : clusters)
    for (std::size_t i = 1; i < cluster.cells.size(); ++i) {
      const Cell c = cluster.cells[i];
      EXPECT_TRUE(std::any_of(cluster.cells.begin(), cluster.cells.begin() + static_cast<std::ptrdiff_t>(i),
                              [&](Cell o) { return std::max(std::abs(o.x - c.x), std::abs(o.y - c.y)) == 1; }));
    }
}

TEST_P(FrontierOnRandomGrids, SmallClustersAreLeftOut) {
  const std::uint64_t seed = static_cast<std::uint64_t>(GetParam());
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const Traversable floor = traversable(test::random_grid(60, 60, seed));
  std::multiset<std::size_t> expected;
  for (const FrontierCluster& cluster : frontier_clusters(floor, 1))
    if (cluster.cells.size() >= 5) expected.insert(cluster.cells.size());
  std::multiset<std::size_t> sizes;
  for (const FrontierCluster& cluster : frontier_clusters(floor, 5)) sizes.insert(cluster.cells.size());
  EXPECT_EQ(sizes, expected);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FrontierOnRandomGrids, testing::Range(1, 7));

TEST(Frontier, TheCentroidIsTheMeanOfTheCells) {
  const Traversable floor = traversable(drawn({"       ",  //
                                               " ..... ",  //
                                               "       "},
                                              0.2));
  const std::vector<FrontierCluster> clusters = frontier_clusters(floor, 5);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_NEAR(clusters[0].centroid.x, 0.7, 1e-12);
  EXPECT_NEAR(clusters[0].centroid.y, 0.3, 1e-12);
}

}  // namespace
}  // namespace rubble::explore
