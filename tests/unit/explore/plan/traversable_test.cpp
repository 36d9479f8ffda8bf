#include "explore/plan/traversable.h"
#include "explore/plan/loose_things.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rng.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using slam::CountMap;
using slam::ScanPoints;

/// Stamps a scan whose rays fan out from `origin` to the given hits.
void stamp(CountMap& map, const TPoint2D& origin, const std::vector<TPoint2D>& hits) {
  ScanPoints scan;
  scan.origin = origin;
  scan.hits = hits;
  map.stamp({}, scan);
}

std::vector<TPoint2D> circle(const TPoint2D& centre, double radius) {
  std::vector<TPoint2D> hits;
  for (int i = 0; i < 720; ++i) {
    const double a = deg_to_rad(0.5 * i);
    hits.emplace_back(centre.x + radius * std::cos(a), centre.y + radius * std::sin(a));
  }
  return hits;
}

TEST(Traversable, ShowsWhatTheMapSaysAndOnlyTheKnownPartOfIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Rng rng(seed, "scans");
    CountMap map(160, 120, 0.05);
    for (int i = 0; i < 6; ++i) {
      const double x = rng.uniform(-2.0, 2.0);
      const double y = rng.uniform(-1.0, 1.0);
      const double radius = rng.uniform(0.3, 1.2);
      stamp(map, {x, y}, circle({x, y}, radius));
    }
    const Traversable floor = traversable(map, 0.5);
    const OccupancyGrid whole = map.classify(0.5);
    int known = 0;
    for (int y = 0; y < whole.height(); ++y)
      for (int x = 0; x < whole.width(); ++x) {
        if (whole[{x, y}] == Occupancy::Unknown) continue;
        ++known;
        const Cell c = floor.cells.cell(whole.centre({x, y}));
        ASSERT_TRUE(floor.cells.inside(c));
        ASSERT_EQ(floor.cells[c], (whole[{x, y}]));
      }
    bool touches[4] = {false, false, false, false};
    for (int y = 0; y < floor.cells.height(); ++y)
      for (int x = 0; x < floor.cells.width(); ++x) {
        if (floor.cells[{x, y}] == Occupancy::Unknown) continue;
        --known;
        touches[0] |= x == 1;
        touches[1] |= y == 1;
        touches[2] |= x == floor.cells.width() - 2;
        touches[3] |= y == floor.cells.height() - 2;
      }
    EXPECT_EQ(known, 0);
    EXPECT_TRUE(touches[0] && touches[1] && touches[2] && touches[3]) << "one rim of unknown cells, not more";
  }
}

TEST(Traversable, OfAnUnseenMapIsEmpty) {
  const Traversable floor = traversable(CountMap(100, 100, 0.05), 0.5);
  EXPECT_EQ(floor.cells.width(), 0);
  EXPECT_EQ(floor.cells.height(), 0);
}

TEST(Traversable, ALoneWeakCellIsNoObstacleAndAStrongOneIs) {
  CountMap map(160, 160, 0.05);
  const TPoint2D speck{1.02, 0.02};
  stamp(map, {0.02, 0.02}, {speck});
  stamp(map, {0.02, 0.02}, {speck});
  Traversable floor = traversable(map, 0.5);
  EXPECT_EQ(floor.cells[floor.cells.cell(speck)], Occupancy::Occupied);
  EXPECT_EQ(floor.obstacle[floor.cells.cell(speck)], 0);
  stamp(map, {0.02, 0.02}, {speck});
  floor = traversable(map, 0.5);
  EXPECT_EQ(floor.obstacle[floor.cells.cell(speck)], 1);
}

TEST(Traversable, WhatMostScansPassOverIsFreeAndKnownToBeThere) {
  const TPoint2D low{1.02, 0.02}, behind{2.02, 0.02};
  const auto after = [&](int hits, int passes) {
    CountMap map(160, 160, 0.05);
    std::vector<TPoint2D> side;
    for (int i = -5; i <= 5; ++i) side.emplace_back(low.x, low.y + 0.04 * i);
    for (int i = 0; i < hits; ++i) stamp(map, {0.02, 0.02}, side);
    std::vector<TPoint2D> wall;
    for (int i = -10; i <= 10; ++i) wall.emplace_back(behind.x, behind.y + 0.04 * i);
    for (int i = 0; i < passes; ++i) stamp(map, {0.02, 0.02}, wall);
    return traversable(map, 0.5, true);
  };
  const auto said_of = [&](const Traversable& floor, const TPoint2D& p) {
    return std::pair(floor.cells[floor.cells.cell(p)], floor.seen_over[floor.cells.cell(p)] != 0);
  };
  const Traversable box = after(20, 80);
  EXPECT_EQ(said_of(box, low), std::pair(Occupancy::Free, true));
  EXPECT_EQ(said_of(box, behind), std::pair(Occupancy::Occupied, false));
  EXPECT_EQ(said_of(box, {0.82, 0.02}), std::pair(Occupancy::Free, false));
  EXPECT_EQ(said_of(after(80, 20), low), std::pair(Occupancy::Occupied, false)) << "a wall";
  EXPECT_EQ(said_of(after(2, 8), low), std::pair(Occupancy::Free, false)) << "noise";
  EXPECT_EQ(said_of(after(5, 500), low), std::pair(Occupancy::Free, false)) << "it was there once";
}

TEST(Traversable, AWallThatAGoodPartOfTheScansPassedIsUnsure) {
  const TPoint2D wall{1.02, 0.02}, behind{2.02, 0.02};
  const auto after = [&](int hits, int passes) {
    CountMap map(160, 160, 0.05);
    for (int i = 0; i < hits; ++i) stamp(map, {0.02, 0.02}, {wall});
    for (int i = 0; i < passes; ++i) stamp(map, {0.02, 0.02}, {behind});
    const Traversable floor = traversable(map, 0.5);
    const Cell c = floor.cells.cell(wall);
    return std::pair(floor.cells[c], floor.unsure[c] != 0);
  };
  EXPECT_EQ(after(20, 0), std::pair(Occupancy::Occupied, false));
  EXPECT_EQ(after(18, 2), std::pair(Occupancy::Occupied, false)) << "errors of poses";
  EXPECT_EQ(after(16, 4), std::pair(Occupancy::Occupied, true));
  EXPECT_EQ(after(1, 1), std::pair(Occupancy::Occupied, true));
  EXPECT_EQ(after(4, 16), std::pair(Occupancy::Free, false)) << "no wall";
}

TEST(Traversable, TellsHowManyScansSawACell) {
  for (const int scans : {1, 7, 60, 255, 256, 300}) {
    CountMap map(160, 160, 0.05);
    for (int i = 0; i < scans; ++i) stamp(map, {0.02, 0.02}, circle({0.02, 0.02}, 1.0));
    for (int i = 0; i < 5; ++i) stamp(map, {0.52, 0.02}, circle({0.52, 0.02}, 1.0));
    const Traversable floor = traversable(map, 0.5);
    for (int y = 0; y < floor.cells.height(); ++y)
      for (int x = 0; x < floor.cells.width(); ++x) {
        const Cell c = map.frame().cell(floor.cells.centre({x, y}));
        ASSERT_EQ((floor.scans[{x, y}]), std::min<int>(map.seen(c), 255));
      }
    EXPECT_EQ(floor.scans[floor.cells.cell({0.27, 0.02})], std::min(scans + 5, 255)) << "both kinds of scan";
  }
}

/// From the foot of a slope scans meet its floor, here and there as the robot rocks; from upon it they do not.
TEST(Traversable, AWideBandThatMostScansPassOverIsSlopeAndNoBoard) {
  for (const int rows : {1, 2, 5}) {
    SCOPED_TRACE(testing::Message() << rows << " rows");
    CountMap map(160, 160, 0.05);
    const auto stamp_row = [&](double x, int times) {
      std::vector<TPoint2D> hits;
      for (int i = -12; i <= 12; ++i) hits.emplace_back(x, 0.02 + 0.02 * i * x);
      for (int i = 0; i < times; ++i) stamp(map, {0.02, 0.02}, hits);
    };
    for (int i = 0; i < rows; ++i) stamp_row(1.02 + 0.05 * i, 20);
    stamp_row(2.02, 60);
    const Traversable floor = traversable(map, 0.5, true);
    for (int i = 0; i < rows; ++i) {
      const Cell c = floor.cells.cell({1.02 + 0.05 * i, 0.02});
      EXPECT_EQ(floor.cells[c], Occupancy::Free);
      EXPECT_EQ(floor.seen_over[c], rows < 3 ? 1 : 0);
    }
  }
}

TEST(Traversable, WeakCellsInARowAreAWall) {
  CountMap map(160, 160, 0.05);
  std::vector<TPoint2D> wall;
  for (int i = 0; i < 5; ++i) wall.emplace_back(1.02, 0.02 + 0.15 * i);  // seen at a grazing angle: every third cell
  stamp(map, {0.02, 0.02}, wall);
  const Traversable floor = traversable(map, 0.5);
  for (const TPoint2D& p : wall) EXPECT_EQ(floor.obstacle[floor.cells.cell(p)], 1);
}

TEST(Traversable, TheRobotStandsOnFreeFloorWhateverTheMapSays) {
  OccupancyGrid grid = test::random_grid(60, 60, 3);
  for (Occupancy& o : grid.cells()) o = Occupancy::Occupied;
  Traversable floor = traversable(grid);
  const mrpt::math::TPose2D pose{1.5, 1.4, deg_to_rad(30.0)};
  free_body(floor, pose, 0.5, 0.3, 0.0);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      const TPoint2D p = pose.inverseComposePoint(floor.cells.centre({x, y}));
      const bool below = std::abs(p.x) <= 0.25 && std::abs(p.y) <= 0.15;
      ASSERT_EQ((floor.obstacle[{x, y}] == 0), below);
      ASSERT_EQ((floor.cells[{x, y}] == Occupancy::Free), below);
      ASSERT_EQ((floor.body[{x, y}]), 0) << "known cells are no secret of the body's";
    }
}

TEST(Traversable, TheTrailFreesOnlyWhatWasNeverSeen) {
  OccupancyGrid grid = test::drawn({"          ",  //
                                    " ...##    ",  //
                                    " ...##    ",  //
                                    "          "},
                                   0.1);
  Traversable floor = traversable(grid);
  free_trail(floor, {{0.55, 0.2}}, 0.25);
  EXPECT_EQ((floor.cells[{4, 1}]), Occupancy::Occupied);
  EXPECT_EQ((floor.cells[{6, 1}]), Occupancy::Free);
  EXPECT_EQ((floor.body[{6, 1}]), 1);
  EXPECT_EQ((floor.cells[{9, 1}]), Occupancy::Unknown);
}

/// A heap that was pushed against the wall of the only lane home, a wall that the robot passed by as near as it can.
TEST(Traversable, WhatLiesOnTheTrailIsNoObstacleAndTheRobotFitsWhereItPassed) {
  OccupancyGrid grid = test::room(4.0, 4.0);
  test::fill(grid, 0.0, 1.26, 4.0, 1.36, Occupancy::Occupied);  // a wall, 0.26 m beside the trail on either side
  test::fill(grid, 1.8, 0.6, 2.2, 1.30, Occupancy::Occupied);   // the heap
  std::vector<TPoint2D> trail;
  for (double x = 0.5; x < 3.5; x += 0.15) trail.push_back({x, 1.0});
  for (double x = 3.5; x > 0.5; x -= 0.15) trail.push_back({x, 1.62});
  Traversable floor = traversable(std::move(grid));
  loosen_trail(floor, trail, 0.25);
  measure_clearance(floor, 1.2);
  const auto at = [&](double x, double y) { return floor.clearance[floor.clearance.cell(TPoint2D{x, y})]; };
  EXPECT_LT(at(2.0, 1.0), 0.3F) << "the heap goes on beside it";
  const TPoint2D felt{2.9, 1.0};
  add_obstacles(floor, {felt}, 0.0);
  measure_clearance(floor, 1.2);
  widen_trail(floor, trail, 0.4, {felt});
  for (double x = 0.6; x < 3.4; x += 0.05) {
    SCOPED_TRACE(x);
    const double away = std::abs(x - felt.x);
    EXPECT_TRUE(away < 0.4 || at(x, 1.0) >= 0.4F);
    EXPECT_TRUE(away > 0.3 || at(x, 1.0) < 0.4F) << "something was met there since";
  }
  EXPECT_EQ(floor.cells[floor.cells.cell(TPoint2D{2.0, 1.1})], Occupancy::Free);
  EXPECT_FALSE(floor.loose.empty()) << "the scanner may go on seeing it";
  EXPECT_EQ(floor.cells[floor.cells.cell(TPoint2D{2.0, 0.65})], Occupancy::Occupied) << "off the trail";
  for (double x = 0.1; x < 3.9; x += 0.05)
    EXPECT_EQ(floor.cells[floor.cells.cell(TPoint2D{x, 1.31})], Occupancy::Occupied) << "no way through the wall";
}

TEST(Traversable, KeptToTheTrailOnlyFloorBesideItIsFree) {
  const Traversable all = traversable(test::random_grid(60, 40, 3));
  Traversable floor = all;
  const std::vector<TPoint2D> trail{{0.5, 0.5}, {1.2, 1.0}, {2.9, 1.9}};
  keep_to_trail(floor, trail, 0.35);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      double nearest = 1e9;
      for (const TPoint2D& p : trail) nearest = std::min(nearest, distance(p, floor.cells.centre({x, y})));
      if (all.cells[{x, y}] != Occupancy::Free || nearest < 0.3) {
        EXPECT_EQ((floor.cells[{x, y}]), (all.cells[{x, y}]));
      } else if (nearest > 0.4) {
        EXPECT_EQ((floor.cells[{x, y}]), Occupancy::Unknown);
      }
      EXPECT_EQ((floor.obstacle[{x, y}]), (all.obstacle[{x, y}]));
    }
}

TEST(Traversable, FreshHitsNearAnObstacleAreThatObstacle) {
  std::vector<std::string> rows(20, " " + std::string(30, '.') + " ");
  rows.front() = rows.back() = std::string(32, ' ');
  rows[10] = " " + std::string(10, '#') + std::string(20, '.') + " ";
  Traversable floor = traversable(test::drawn(rows));
  const double wall_y = floor.cells.centre({1, 9}).y;
  const TPoint2D displaced{0.3, wall_y + 0.1};
  const TPoint2D fresh{1.2, wall_y};
  add_obstacles(floor, {displaced, fresh, {50.0, 50.0}}, 0.15);
  EXPECT_EQ(floor.obstacle[floor.cells.cell(displaced)], 0);
  EXPECT_EQ(floor.obstacle[floor.cells.cell(fresh)], 1);
}

TEST(Traversable, OnlySmallThingsThatStandAloneAreMadeFree) {
  Traversable floor = traversable(
      test::drawn({"                    ", " #################  ", " ................#  ", " ................#  ",
                   " ................#  ", " ................#  ", " ...##...........#  ", " ...##..........##  ",
                   " ...............##  ", " ................#  ", " ................#  ", " ................#  ",
                   " .##########.....#  ", " ................#  ", "                    "}));
  const OccupancyGrid before = floor.cells;
  EXPECT_TRUE(free_small_things(floor, 0.3));
  int freed = 0;
  for (int y = 0; y < before.height(); ++y)
    for (int x = 0; x < before.width(); ++x) {
      if (floor.cells[{x, y}] == before[{x, y}]) continue;
      ++freed;
      EXPECT_TRUE(x == 4 || x == 5) << x << " " << y;
      EXPECT_EQ((floor.obstacle[{x, y}]), 0);
      EXPECT_EQ((floor.cells[{x, y}]), Occupancy::Free);
    }
  EXPECT_EQ(freed, 4) << "the thing beside the wall and the long one stay";
  ASSERT_EQ(floor.loose.size(), 4u);
  for (const Cell c : floor.loose) EXPECT_NE(floor.cells[c], before[c]);
  EXPECT_FALSE(free_small_things(floor, 0.3));
}

/// Strips across a corridor, from wall to wall; three posts and a piece of wall beside them are none.
TEST(Traversable, StripsThatHangInARowAreMadeFree) {
  Traversable floor = traversable(test::drawn(
      {"                      ", " #################### ", " #..................# ", " #........#.........# ",
       " #...............#..# ", " #........#.........# ", " #..................# ", " #........#.......#.# ",
       " #.........#........# ", " #..................# ", " #........#....####.# ", " #..................# ",
       " #........#......#..# ", " #..................# ", " #################### ", "                      "}));
  const OccupancyGrid before = floor.cells;
  EXPECT_TRUE(free_strips(floor));
  for (int y = 0; y < before.height(); ++y)
    for (int x = 0; x < before.width(); ++x) {
      const bool strip = (x == 10 || x == 11) && y > 1 && y < 14 && before[{x, y}] == Occupancy::Occupied;
      EXPECT_EQ((floor.cells[{x, y}] != before[{x, y}]), strip) << x << " " << y;
    }
  EXPECT_FALSE(free_strips(floor)) << "there are no more";

  // Specks of a wall at a grazing angle look alike, but for what lies between them.
  OccupancyGrid specks = before;
  for (int y = 2; y < 14; ++y)
    for (int x = 9; x < 13; ++x)
      if (specks[{x, y}] == Occupancy::Free) specks[{x, y}] = Occupancy::Unknown;
  Traversable unseen = traversable(std::move(specks));
  EXPECT_FALSE(free_strips(unseen));

  // A veil that hangs askew, on cells so fine that a strip covers several.
  OccupancyGrid fine = test::room(3.0, 3.0, 0.02);
  for (int i = 0; i < 7; ++i) {
    const double x = 0.9 + 0.11 * i, y = 0.9 + 0.08 * i;
    test::fill(fine, x, y, x + 0.05, y + 0.05, Occupancy::Occupied);
  }
  Traversable askew = traversable(std::move(fine));
  ASSERT_TRUE(free_strips(askew));
  EXPECT_GE(askew.loose.size(), 7u * 4u);
}

}  // namespace
}  // namespace rubble::explore
