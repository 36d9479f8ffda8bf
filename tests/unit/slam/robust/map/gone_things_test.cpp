#include "slam/robust/map/gone_things.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/planar.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using slam_test::World;

const TPoint2D kBall{1.0, 0.5};
constexpr double kBallHalf = 0.1;  ///< [m]

/// A room with a box the size of a paper ball, or without.
World room_with(const std::vector<TPoint2D>& balls) {
  World world = slam_test::furnished_room();
  for (const TPoint2D& b : balls)
    slam_test::add_box(world, b.x - kBallHalf, b.y - kBallHalf, b.x + kBallHalf, b.y + kBallHalf);
  return world;
}

/// Walls within 0.2 m of a place.
int walls_near(const CountMap& map, const TPoint2D& place) {
  const OccupancyGrid grid = map.classify();
  int walls = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      walls += grid[{x, y}] == Occupancy::Occupied && distance(grid.centre({x, y}), place) < 0.2 ? 1 : 0;
  return walls;
}

/// A room that changes on the way: `before`, and from a quarter before the end of the drive on `after`.
CountMap mapped(const World& before, const World& after, bool drop, std::uint64_t seed) {
  const robot::RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(
      {{0.0, 0.0}, {2.5, 0.0}, {0.0, 0.0}, {2.5, 0.0}, {0.0, 0.0}, {2.5, 0.0}, {0.0, 0.0}, {2.5, 0.0}}, 0.0);
  std::vector<robot::Inputs> ticks = slam_test::record(before, drive, model, 0.5, 0.01, seed);
  const std::vector<robot::Inputs> later = slam_test::record(after, drive, model, 0.5, 0.01, seed);
  for (std::size_t i = ticks.size() * 3 / 4; i < ticks.size(); ++i) ticks[i] = later[i];
  RobustConfig config;
  config.drop_gone = drop;
  RobustMapper mapper(model, config, seed);
  slam_test::play(mapper, ticks);
  return mapper.map();
}

TEST(GoneThings, ABallThatWasPushedAwayFades) {
  const TPoint2D later{3.3, -0.6};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World before = room_with({kBall}), after = room_with({later});
    const CountMap kept = mapped(before, after, false, seed);
    const CountMap map = mapped(before, after, true, seed);
    EXPECT_GT(walls_near(kept, kBall), 0);  // what is counted alone still shows it
    EXPECT_EQ(walls_near(map, kBall), 0);
    EXPECT_EQ(walls_near(map, {1.55, -1.05}), walls_near(kept, {1.55, -1.05}));  // the post
  }
}

TEST(GoneThings, WhatStandsStays) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    World world = room_with({kBall, {3.3, -0.6}});
    slam_test::add_box(world, 0.5, -0.9, 0.52, -0.88);  // a pole that is seen by few beams
    const CountMap kept = mapped(world, world, false, seed);
    const CountMap map = mapped(world, world, true, seed);
    ASSERT_EQ(map.frame(), kept.frame());
    EXPECT_EQ(map.classify().cells(), kept.classify().cells());
  }
}

/// Shows the scans of a level laser at some places to a map that has a thing of one cell at (1, 0).
class OneThing : public ::testing::Test {
 protected:
  OneThing() {
    CountMap map(80, 80, 0.05);
    const GridFrame frame = map.frame();
    std::vector<std::uint16_t> seen(frame.size(), 10), occupied(frame.size(), 0);
    occupied[frame.index(frame.cell(kThing))] = 9;
    map.assign(frame, seen, occupied);
    things_.emplace(map);
  }
  void look(double x, double y, bool there, bool level = true) {
    const World with = {{{kThing.x, -0.02}, {kThing.x, 0.06}}, {{1.8, -1.8}, {1.8, 1.8}}};
    const World without = {with[1]};
    ScanPoints points;
    points.beam_width = 0.006;
    for (int beam = -100; beam <= 100; ++beam) {
      const double bearing = points.beam_width * beam;
      const double range = slam_test::cast(there ? with : without, {x, y}, bearing);
      points.rays.push_back({{range * std::cos(bearing), range * std::sin(bearing)}, true, true, beam});
    }
    things_->look(TPose2D(x, y, 0.0), points, level);
  }
  bool gone() const { return !things_->cells().empty(); }

  const TPoint2D kThing{1.02, 0.02};
  std::optional<GoneThings> things_;
};

TEST_F(OneThing, IsGoneOnceItIsSeenThroughFromWhereItWasSeen) {
  look(-0.5, 0.0, true);
  for (int i = 0; i < 3; ++i) look(-0.5 + 0.05 * i, 0.0, false);
  EXPECT_FALSE(gone());
  look(-0.3, 0.0, false);
  EXPECT_TRUE(gone());
  look(-0.3, 0.0, true);  // and stands there again
  EXPECT_FALSE(gone());
}

TEST_F(OneThing, StaysWhereItIsOverlookedFromElsewhereOrByALaserThatLeans) {
  look(-0.5, 0.0, true);
  for (int i = 0; i < 20; ++i) look(0.1 + 0.01 * i, 0.0, false);
  for (int i = 0; i < 20; ++i) look(-0.5, 0.0, false, false);
  EXPECT_FALSE(gone());
}

TEST_F(OneThing, IsGoneWhereTheRobotStood) {
  look(-0.5, 0.0, true);
  look(1.0, 0.05, false);
  EXPECT_TRUE(gone());
}

TEST_F(OneThing, ThatWasNeverSeenIsLeftAlone) {
  for (int i = 0; i < 20; ++i) look(-0.5, 0.0, false);
  EXPECT_FALSE(gone());
}

}  // namespace
}  // namespace rubble::slam
