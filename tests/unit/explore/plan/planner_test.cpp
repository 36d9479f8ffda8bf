#include "explore/plan/planner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

const double kUsual = PlannerConfig().transform.d_min;

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const BarredFn kNothingBarred = [](const TPoint2D&) { return false; };

/// A straight corridor, `inside` cells wide, walls of one cell above and below, open (frontier) at the east end.
Traversable corridor(int inside, int length = 60) {
  std::vector<std::string> rows{std::string(static_cast<std::size_t>(length + 2), ' ')};
  rows.push_back(" " + std::string(static_cast<std::size_t>(length), '#') + " ");
  for (int i = 0; i < inside; ++i) rows.push_back(" #" + std::string(static_cast<std::size_t>(length - 1), '.') + " ");
  rows.push_back(rows[1]);
  rows.push_back(rows[0]);
  return test::measured(test::drawn(rows));
}

double way_length(const std::vector<PathPoint>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += std::hypot(path[i].p_map.x - path[i - 1].p_map.x, path[i].p_map.y - path[i - 1].p_map.y);
  return length;
}

TEST(Planner, DrivesDownTheMiddleOfACorridorToItsOpenEnd) {
  const Traversable floor = corridor(24);
  const double middle = 0.05 * (2 + 12);
  Planner planner({});
  const Plan plan = planner.to_frontier(floor, {0.6, middle, 0.0}, kNothingBarred, std::nullopt);
  ASSERT_TRUE(plan.found);
  EXPECT_EQ(plan.frontier_left, 1u);
  EXPECT_NEAR(plan.target.x, 61 * 0.05, 0.06);
  EXPECT_NEAR(way_length(plan.path), plan.target.x - 0.6, 0.10);
  for (const PathPoint& point : plan.path) EXPECT_NEAR(point.p_map.y, middle, 0.05);
}

/// 0.8 m are left between a victim box and the wall opposite; the robot is 0.5 m wide.
TEST(Planner, PassesAVictimBoxAtTheUsualDistance) {
  for (const int inside : {16, 15}) {  // 15: where walls and box blur over one cell more
    const Traversable floor = corridor(inside);
    Planner planner({});
    const Plan plan = planner.to_frontier(floor, {0.6, 0.05 * (2 + 0.5 * inside), 0.0}, kNothingBarred, std::nullopt);
    ASSERT_TRUE(plan.found) << inside;
    EXPECT_DOUBLE_EQ(plan.d_min, kUsual) << inside;
  }
}

TEST(Planner, LowersItsDistanceWhereNothingElseCanBeReachedButNotBelowTheFloor) {
  Planner planner({});
  const Plan narrow = planner.to_frontier(corridor(11), {0.6, 0.05 * 7.5, 0.0}, kNothingBarred, std::nullopt);
  ASSERT_TRUE(narrow.found) << "0.55 m are enough for a robot of 0.5 m";
  EXPECT_LT(narrow.d_min, kUsual);
  EXPECT_GE(narrow.d_min, 0.27);
  const Plan closed = planner.to_frontier(corridor(8), {0.6, 0.05 * 6.0, 0.0}, kNothingBarred, std::nullopt);
  EXPECT_FALSE(closed.found) << "0.40 m are not";
  EXPECT_EQ(closed.frontier_left, 1u);
}

/// As near to walls as it may for what lies 2 m behind a narrow place, where the rest is 10 m dearer. While that is
/// driven to the choice stays, although less and less is saved.
TEST(Planner, TakesANarrowWayWhereThatSavesAsMuchAsIsAsked) {
  OccupancyGrid cells = test::room(8.0, 1.3);
  for (const double y : {0.0, 0.95}) test::fill(cells, 2.9, y, 3.1, y + 0.36, Occupancy::Occupied);
  const Traversable floor = test::measured(cells);
  const std::vector<Source> sources{{cells.cell({2.0, 0.65}), 0.0}, {cells.cell({6.0, 0.65}), 10.0}};
  const TPose2D start{4.0, 0.65, 0.0};
  Planner planner({});
  const auto wide = [&](std::optional<double> detour, const std::optional<TPoint2D>& previous = std::nullopt) {
    const Plan plan = planner.to_cells(floor, start, sources, detour, previous);
    EXPECT_TRUE(plan.found);
    EXPECT_EQ(plan.target.x > 4.0, plan.d_min == kUsual) << plan.target.x << ", " << plan.d_min;
    return plan.target.x > 4.0;
  };
  EXPECT_TRUE(wide(std::nullopt));
  EXPECT_FALSE(wide(4.0));
  EXPECT_TRUE(wide(20.0)) << "it saves less";
  EXPECT_FALSE(wide(20.0, TPoint2D{2.0, 0.65})) << "but is driven to";
  EXPECT_TRUE(wide(20.0, TPoint2D{6.0, 0.65}));
  EXPECT_TRUE(wide(std::nullopt, TPoint2D{2.0, 0.65}));
}

/// A wide way round to the place that is driven to is one to the same place: the narrow one has to save as much.
TEST(Planner, DrivesRoundToItsTargetWhereANarrowWaySavesTooLittle) {
  OccupancyGrid cells = test::room(8.0, 4.0);
  test::fill(cells, 1.5, 1.3, 6.5, 2.6, Occupancy::Occupied);
  for (const double y : {0.0, 0.95}) test::fill(cells, 2.9, y, 3.1, y + 0.36, Occupancy::Occupied);
  const Traversable floor = test::measured(cells);
  const TPoint2D target{2.0, 0.65};
  Planner planner({});
  for (const double detour : {4.0, 40.0}) {
    const Plan plan = planner.to_cells(floor, {4.0, 0.65, 0.0}, {{cells.cell(target), 0.0}}, detour, target);
    ASSERT_TRUE(plan.found);
    EXPECT_EQ(plan.d_min == kUsual, detour > 20.0) << plan.d_min << ", " << plan.cost << " m";
  }
}

TEST(Planner, ClimbsAwayFromTheWallFirst) {
  const Traversable floor = corridor(24);
  const TPose2D at_the_wall{0.6, 0.05 * 4.5, 0.0};
  Planner planner({});
  const Plan plan = planner.to_frontier(floor, at_the_wall, kNothingBarred, std::nullopt);
  ASSERT_TRUE(plan.found);
  EXPECT_DOUBLE_EQ(plan.d_min, kUsual);
  EXPECT_LT(plan.path.front().clearance, kUsual);
  bool out = false;
  for (std::size_t i = 1; i < plan.path.size(); ++i) {
    if (!out) {
      EXPECT_GE(plan.path[i].clearance, plan.path[i - 1].clearance - 1e-6);
    }
    out = out || plan.path[i].clearance > 0.3499;
    if (out) {
      EXPECT_GE(plan.path[i].clearance, 0.3499);
    }
  }
  EXPECT_TRUE(out);
}

TEST(Planner, KeepsItsTargetUnlessAnotherIsMuchCheaper) {
  // Open at both ends; the robot a little nearer to the west one.
  std::vector<std::string> rows{std::string(82, ' '), " " + std::string(80, '#') + " "};
  for (int i = 0; i < 24; ++i) rows.push_back(" " + std::string(80, '.') + " ");
  rows.push_back(rows[1]);
  rows.push_back(rows[0]);
  const Traversable floor = test::measured(test::drawn(rows));
  Planner planner({});
  const TPose2D pose{1.95, 0.7, 0.0};
  const TPoint2D east{80.5 * 0.05, 0.7};
  EXPECT_LT(planner.to_frontier(floor, pose, kNothingBarred, std::nullopt).target.x, 0.2);
  EXPECT_GT(planner.to_frontier(floor, pose, kNothingBarred, east).target.x, 3.8);
  EXPECT_LT(planner.to_frontier(floor, {1.0, 0.7, 0.0}, kNothingBarred, east).target.x, 0.2);
  const BarredFn west_barred = [](const TPoint2D& p) { return p.x < 1.0; };
  const Plan barred = planner.to_frontier(floor, {1.0, 0.7, 0.0}, west_barred, std::nullopt);
  EXPECT_GT(barred.target.x, 3.8);
  EXPECT_EQ(barred.frontier_left, 1u);
}

TEST(Planner, GoesToTheFrontierWorthMostOfThoseInReach) {
  // Open at both ends; a third frontier lies behind a gap that is too narrow.
  std::vector<std::string> rows{std::string(82, ' '), " " + std::string(80, '#') + " "};
  for (int i = 0; i < 24; ++i) rows.push_back(" " + std::string(80, '.') + " ");
  rows.push_back(" " + std::string(39, '#') + ".." + std::string(39, '#') + " ");
  for (int i = 0; i < 10; ++i) rows.push_back("          " + std::string(60, '.') + "            ");
  rows.push_back(rows[0]);
  const Traversable floor = test::measured(test::drawn(rows));
  Planner planner({});
  const double middle = 0.05 * (static_cast<double>(rows.size()) - 14.0);
  std::vector<Candidate> asked;
  const auto plan = [&](const auto& worth) {
    asked.clear();
    return planner.to_frontier(floor, {1.5, middle, 0.0}, kNothingBarred, TPoint2D{4.0, middle},
                               [&](const Candidate& candidate) {
                                 asked.push_back(candidate);
                                 return worth(candidate);
                               });
  };
  const Plan shortest = plan([](const Candidate& c) { return -c.way; });
  EXPECT_LT(shortest.target.x, 0.2);
  EXPECT_EQ(shortest.frontier_left, 3u);
  ASSERT_EQ(asked.size(), 2u) << "the third cannot be reached";
  EXPECT_GT(plan([](const Candidate& c) { return c.way; }).target.x, 3.8);
  EXPECT_GT(plan([](const Candidate& c) { return c.driven_to ? 1.0 : 0.0; }).target.x, 3.8);
  for (const Candidate& c : asked) {
    const double x = floor.cells.centre(c.middle).x;
    EXPECT_NEAR(c.way, std::abs(x - 1.5), 0.2);
    EXPECT_NEAR(floor.cells.centre(c.middle).y, middle, 0.1);
  }
}

TEST(Planner, FindsTheWayToAPointAndSaysSoWhenThereIsNone) {
  const Traversable floor = corridor(24);
  Planner planner({});
  const Plan plan = planner.to_point(floor, {2.8, 0.7, 0.0}, {0.62, 0.72}, 0.15);
  ASSERT_TRUE(plan.found);
  EXPECT_NEAR(plan.target.x, 0.62, 0.05);
  EXPECT_NEAR(plan.target.y, 0.72, 0.05);
  EXPECT_FALSE(planner.to_point(floor, {2.8, 0.7, 0.0}, {0.62, 3.0}, 0.15).found);
  EXPECT_FALSE(planner.to_point(floor, {20.0, 0.7, 0.0}, {0.62, 0.7}, 0.15).found) << "a robot off the map";
}

TEST(Planner, ClimbingEndsOnALocalMaximum) {
  const Traversable floor = corridor(10);
  const std::vector<Cell> way = climb_clearance(floor, {20, 3}, 0.35);
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_GT(floor.clearance[way[i]], floor.clearance[way[i - 1]]);
  EXPECT_LT(floor.clearance[way.back()], 0.35);
}

class SmoothPath : public testing::TestWithParam<int> {};

TEST_P(SmoothPath, KeepsEndsAndClearanceAndIsNoLonger) {
  const std::uint64_t seed = static_cast<std::uint64_t>(GetParam());
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const Traversable floor = test::measured(test::random_grid(90, 90, seed));
  const double d_min = 0.1;
  ExplorationTransform transform;
  transform.run(floor, {{{45, 45}, 0.0}, {{10, 70}, 0.0}, {{70, 20}, 0.0}}, {4.0, d_min, 0.4});
  int ways = 0;
  for (int y = 2; y < 90; y += 5)
    for (int x = 2; x < 90; x += 5) {
      const std::vector<Cell> cells = transform.descend({x, y});
      if (cells.size() < 2) continue;
      ++ways;
      const std::vector<PathPoint> path = smooth_path(floor, cells, d_min);
      ASSERT_EQ(path.size(), cells.size());
      EXPECT_EQ(floor.cells.cell(path.front().p_map), cells.front());
      EXPECT_EQ(floor.cells.cell(path.back().p_map), cells.back());
      double raw = 0.0;
      for (std::size_t i = 0; i < path.size(); ++i) {
        EXPECT_GE(path[i].clearance, d_min - 1e-4);
        EXPECT_FLOAT_EQ(static_cast<float>(path[i].clearance), floor.clearance[floor.cells.cell(path[i].p_map)]);
        if (i == 0) continue;
        const bool diagonal = cells[i].x != cells[i - 1].x && cells[i].y != cells[i - 1].y;
        raw += diagonal ? 0.05 * std::sqrt(2.0) : 0.05;
      }
      EXPECT_LE(way_length(path), raw * 1.25 + 1e-9);
    }
  EXPECT_GT(ways, 20);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SmoothPath, testing::Range(1, 6));

}  // namespace
}  // namespace rubble::explore
