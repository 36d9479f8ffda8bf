#include "explore/plan/exploration_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "explore/plan/frontier.h"
#include "tests/support/explore_grids.h"
#include "tests/support/explore_oracle.h"

namespace rubble::explore {
namespace {

using test::measured;
using test::random_grid;

constexpr double kRounding = 0.011;  ///< step costs are whole numbers of 1/72 of a cell

std::vector<Source> frontier_sources(const Traversable& floor) {
  std::vector<Source> sources;
  for (const Cell c : frontier_cells(floor)) sources.push_back({c, 0.0});
  return sources;
}

template <class Visit>
void for_each_cell(const GridFrame& frame, Visit visit) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) visit(Cell{x, y});
}

class OnRandomGrids : public testing::TestWithParam<int> {
 protected:
  std::uint64_t seed = static_cast<std::uint64_t>(GetParam());
  Traversable floor = measured(random_grid(40 + 7 * GetParam(), 90 - 5 * GetParam(), seed));
  TransformConfig config{4.0 * (GetParam() % 4), 0.05 * (GetParam() % 4), 0.4};
};

TEST_P(OnRandomGrids, BucketsGiveTheCostsOfAHeap) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::vector<Source> sources = frontier_sources(floor);
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  const Grid<double> oracle = test::heap_transform(floor.cells, floor.clearance, sources, config);
  for_each_cell(floor.frame(), [&](Cell c) {
    ASSERT_EQ(transform.reached(c), std::isfinite(oracle[c])) << c.x << ", " << c.y;
    if (transform.reached(c)) {
      ASSERT_NEAR(transform.cost(c), oracle[c], kRounding * oracle[c] + 1e-9);
    }
  });
}

TEST_P(OnRandomGrids, WithoutDiscomfortItIsExactlyTheShortestWay) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  config.alpha = 0.0;
  const std::vector<Source> sources = frontier_sources(floor);
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  const Grid<double> oracle = test::heap_transform(floor.cells, floor.clearance, sources, config);
  for_each_cell(floor.frame(), [&](Cell c) {
    if (transform.reached(c)) {
      ASSERT_NEAR(transform.cost(c), oracle[c], 1e-9);
    }
  });
}

TEST_P(OnRandomGrids, EveryReachedCellHasALowerNeighbourUnlessItIsFrontier) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::vector<Source> sources = frontier_sources(floor);
  Grid<std::uint8_t> is_source(floor.frame());
  for (const Source& s : sources) is_source[s.cell] = 1;
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  for_each_cell(floor.frame(), [&](Cell c) {
    if (!transform.reached(c) || is_source[c] != 0) return;
    bool lower = false;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) lower = lower || transform.cost({c.x + dx, c.y + dy}) < transform.cost(c);
    ASSERT_TRUE(lower) << c.x << ", " << c.y;
  });
}

TEST_P(OnRandomGrids, DescendingWalksFreeCellsStepByStepToASourceAndAddsUpToTheCost) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::vector<Source> sources = frontier_sources(floor);
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  for_each_cell(floor.frame(), [&](Cell c) {
    const std::vector<Cell> way = transform.descend(c);
    ASSERT_EQ(way.empty(), !transform.reached(c));
    if (way.empty()) return;
    EXPECT_EQ(transform.cost(way.back()), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const int dx = std::abs(way[i].x - way[i + 1].x);
      const int dy = std::abs(way[i].y - way[i + 1].y);
      ASSERT_EQ(std::max(dx, dy), 1);
      ASSERT_EQ(floor.cells[way[i]], Occupancy::Free);
      sum += (dx + dy == 2 ? 17.0 / 12.0 : 1.0) * 0.05 * (1.0 + config.alpha * danger(floor.clearance[way[i]], config));
    }
    ASSERT_NEAR(sum, transform.cost(c), kRounding * sum + 1e-9);
  });
}

TEST_P(OnRandomGrids, StoppingEarlyLeavesTheCostAndTheWayOfThatCellAsTheyAre) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::vector<Source> sources = frontier_sources(floor);
  ExplorationTransform whole;
  whole.run(floor, sources, config);
  ExplorationTransform part;
  for (int y = 5; y < floor.cells.height(); y += 11)
    for (int x = 3; x < floor.cells.width(); x += 7) {
      part.run(floor, sources, config, Cell{x, y});
      ASSERT_EQ(part.cost({x, y}), whole.cost({x, y}));
      ASSERT_EQ(part.descend({x, y}), whole.descend({x, y}));
    }
}

TEST_P(OnRandomGrids, OneSourceMakesItThePathTransform) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Rng rng(seed, "target");
  ExplorationTransform transform;
  for (int i = 0; i < 5; ++i) {
    const Cell target{static_cast<int>(rng.below(static_cast<std::uint32_t>(floor.cells.width()))),
                      static_cast<int>(rng.below(static_cast<std::uint32_t>(floor.cells.height())))};
    transform.run(floor, {{target, 0.0}}, config);
    const Grid<double> oracle = test::heap_transform(floor.cells, floor.clearance, {{target, 0.0}}, config);
    for_each_cell(floor.frame(), [&](Cell c) {
      ASSERT_EQ(transform.reached(c), std::isfinite(oracle[c]));
      if (!transform.reached(c)) return;
      ASSERT_NEAR(transform.cost(c), oracle[c], kRounding * oracle[c] + 1e-9);
      ASSERT_EQ(transform.descend(c).back(), target);
    });
  }
}

/// Of two optimal ways the one for the larger alpha has the smaller sum of discomfort and the greater length: a law of
/// parametric optimisation.
TEST_P(OnRandomGrids, LargerAlphaBuysLessDiscomfortWithLength) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::vector<Source> target{{{floor.cells.width() / 2, floor.cells.height() / 2}, 0.0}};
  config.d_min = 0.0;
  const auto measure = [&](double alpha, Cell from) {
    config.alpha = alpha;
    ExplorationTransform transform;
    transform.run(floor, target, config, from);
    double length = 0.0;
    double discomfort = 0.0;
    const std::vector<Cell> way = transform.descend(from);
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const double step = (way[i].x != way[i + 1].x && way[i].y != way[i + 1].y ? 17.0 / 12.0 : 1.0) * 0.05;
      length += step;
      discomfort += step * danger(floor.clearance[way[i]], config);
    }
    return std::pair<double, double>{length, discomfort};
  };
  for (int y = 2; y < floor.cells.height(); y += 9)
    for (int x = 2; x < floor.cells.width(); x += 9) {
      const auto [short_length, short_discomfort] = measure(2.0, {x, y});
      const auto [safe_length, safe_discomfort] = measure(50.0, {x, y});
      EXPECT_LE(safe_discomfort, short_discomfort * (1.0 + kRounding) + 1e-9);
      EXPECT_GE(safe_length, short_length * (1.0 - kRounding) - 1e-9);
    }
}

/// Eq. (3) as printed by brute force: Bellman and Ford's sweeps until no way gets cheaper.
Grid<double> brute_force(const Traversable& floor, const std::vector<Source>& sources, const TransformConfig& config) {
  const double inf = std::numeric_limits<double>::infinity();
  Grid<double> cost(floor.frame(), inf);
  const auto own = [&](Cell c) {
    return floor.cells[c] == Occupancy::Free ? config.alpha * danger(floor.clearance[c], config) : inf;
  };
  for (const Source& s : sources) cost[s.cell] = own(s.cell);
  for (bool changed = true; changed;) {
    changed = false;
    for_each_cell(floor.frame(), [&](Cell c) {
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell n{c.x + dx, c.y + dy};
          if (!floor.cells.inside(n)) continue;
          const double through = cost[n] + std::hypot(dx, dy) * floor.frame().resolution + own(c);
          if (!(through < cost[c] - 1e-12)) continue;
          cost[c] = through;
          changed = true;
        }
    });
  }
  return cost;
}

TEST_P(OnRandomGrids, AsPrintedItIsTheBruteForceMinimumOverAllWaysAndHasNoLocalMinimum) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  floor = traversable(random_grid(22 + 2 * GetParam(), 40 - 2 * GetParam(), seed));
  measure_clearance(floor, 1000.0);
  config.discomfort = Discomfort::PerCell;
  const std::vector<Source> sources = frontier_sources(floor);
  Grid<std::uint8_t> is_source(floor.frame());
  for (const Source& s : sources) is_source[s.cell] = 1;
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  const Grid<double> oracle = brute_force(floor, sources, config);
  int reached = 0;
  for_each_cell(floor.frame(), [&](Cell c) {
    ASSERT_EQ(transform.reached(c), std::isfinite(oracle[c])) << c.x << ", " << c.y;
    if (!transform.reached(c)) return;
    ++reached;
    ASSERT_NEAR(transform.cost(c), oracle[c], 1e-9);
    const std::vector<Cell> way = transform.descend(c);
    ASSERT_EQ(is_source[way.back()], 1);
    double sum = 0.0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      sum += config.alpha * danger(floor.clearance[way[i]], config);
      if (i > 0) sum += std::hypot(way[i].x - way[i - 1].x, way[i].y - way[i - 1].y) * 0.05;
    }
    ASSERT_NEAR(sum, transform.cost(c), 1e-9) << "the sum over all cells of the way";
    bool lower = is_source[c] != 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) lower = lower || transform.cost({c.x + dx, c.y + dy}) < transform.cost(c);
    ASSERT_TRUE(lower) << c.x << ", " << c.y;
  });
  EXPECT_GT(reached, 20);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OnRandomGrids, testing::Range(1, 9));

TEST(Danger, IsInfiniteBelowTheMinimumAndGrowsOnBothSidesOfTheOptimum) {
  const TransformConfig config{4.0, 0.35, 0.60};
  EXPECT_TRUE(std::isinf(danger(0.34, config)));
  EXPECT_DOUBLE_EQ(danger(0.60, config), 0.0);
  EXPECT_NEAR(danger(0.40, config), 0.04, 1e-12);
  EXPECT_NEAR(danger(0.80, config), 0.04, 1e-12);
  EXPECT_GT(danger(1.20, config), danger(0.90, config));
}

TEST(Danger, SevenCellsOfFiveCentimetresAreTheMinimumOfThirtyFive) {
  const TransformConfig config{4.0, 0.35, 0.60};
  EXPECT_TRUE(std::isfinite(danger(7.0f * 0.05f, config)));
  EXPECT_TRUE(std::isfinite(danger(static_cast<float>(7 * 0.05), config)));
}

TEST(ExplorationTransform, LargerAlphaKeepsFartherFromTheWallsOfACorridor) {
  // A corridor of 1.2 m with its target and its start near the same wall.
  std::vector<std::string> rows(26, " " + std::string(80, '.') + " ");
  rows.front() = rows.back() = " " + std::string(80, '#') + " ";
  const Traversable floor = measured(test::drawn(rows));
  const auto mean_clearance = [&](double alpha) {
    ExplorationTransform transform;
    transform.run(floor, {{{75, 8}, 0.0}}, {alpha, 0.30, 0.60});
    const std::vector<Cell> way = transform.descend({5, 8});
    double sum = 0.0;
    for (const Cell c : way) sum += floor.clearance[c];
    return sum / static_cast<double>(way.size());
  };
  EXPECT_LT(mean_clearance(0.0) + 0.05, mean_clearance(5.0));
  EXPECT_LT(mean_clearance(5.0), mean_clearance(100.0));
}

TEST(ExplorationTransform, HeadStartMakesASourceLookFartherAway) {
  const Traversable floor = measured(test::drawn({"                     ",  //
                                                  " ................... ",  //
                                                  "                     "}));
  ExplorationTransform transform;
  const TransformConfig free_of_danger{0.0, 0.0, 0.6};
  transform.run(floor, {{{1, 1}, 0.0}, {{19, 1}, 0.0}}, free_of_danger);
  EXPECT_EQ(transform.descend({11, 1}).back(), (Cell{19, 1}));
  transform.run(floor, {{{1, 1}, 0.0}, {{19, 1}, 0.25}}, free_of_danger);
  EXPECT_EQ(transform.descend({11, 1}).back(), (Cell{1, 1}));
  EXPECT_NEAR(transform.cost({18, 1}), 0.30, 1e-9);
  transform.run(floor, {{{1, 1}, 50.0}, {{19, 1}, 70.0}}, free_of_danger);
  EXPECT_NEAR(transform.cost({18, 1}), 50.85, 1e-9);
}

TEST(ExplorationTransform, WithoutASourceNothingIsReached) {
  const Traversable floor = measured(random_grid(30, 30, 1));
  ExplorationTransform transform;
  transform.run(floor, {}, {});
  for_each_cell(floor.frame(), [&](Cell c) { ASSERT_FALSE(transform.reached(c)); });
  EXPECT_TRUE(std::isinf(transform.cost({-5, 3})));
}

}  // namespace
}  // namespace rubble::explore
