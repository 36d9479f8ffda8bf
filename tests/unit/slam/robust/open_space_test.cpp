#include <gtest/gtest.h>

#include <algorithm>

#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using robot::Inputs;

/// A hall that is wider than the scanner sees, with a few boxes to find the way by.
slam_test::World wide_hall() {
  slam_test::World world;
  slam_test::add_box(world, -6.0, -6.0, 8.0, 6.0);
  for (const TPoint2D& at : {TPoint2D{2.0, 1.6}, TPoint2D{-1.5, -1.8}, TPoint2D{3.6, -1.4}, TPoint2D{-0.8, 2.2}})
    slam_test::add_box(world, at.x, at.y, at.x + 0.5, at.y + 0.3);
  return world;
}

slam_test::Drive hall_drive() {
  return slam_test::drive_through({{0.0, 0.0}, {2.6, 0.4}, {2.4, -1.0}, {-0.4, -0.8}, {-1.2, 0.8}, {0.0, 0.0}}, 0.0);
}

/// `codes`: the scanner says why beams fail; none of these do.
std::vector<Inputs> hall_ticks(bool codes) {
  std::vector<Inputs> ticks = slam_test::record(wide_hall(), hall_drive(), robot::RobotModel(), 0.3, 0.01, 41);
  for (Inputs& tick : ticks)
    for (robot::LaserScan& scan : tick.scans) scan.codes.assign(codes ? scan.ranges.size() : 0, 0);
  return ticks;
}

struct HallMap {
  Trajectory trajectory;
  OccupancyGrid grid;
  long free = 0;  ///< cells
};

HallMap map_hall(MissTrust misses, bool codes) {
  RobustConfig config;
  config.misses = misses;
  RobustMapper mapper(robot::RobotModel(), config, 1);
  slam_test::play(mapper, hall_ticks(codes));
  HallMap out{mapper.trajectory(), mapper.map().classify()};
  out.free = std::count(out.grid.cells().begin(), out.grid.cells().end(), Occupancy::Free);
  return out;
}

bool is_wall_near(const OccupancyGrid& grid, Cell c) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (grid[{c.x + dx, c.y + dy}] == Occupancy::Occupied) return true;
  return false;
}

/// What beams that meet nothing say of the hall is true, takes no wall away, and moves the robot by no bit.
TEST(OpenSpace, IsFreedByMissesAndThePoseKnowsNothingOfThem) {
  const HallMap without = map_hall(MissTrust::None, true);
  const HallMap with = map_hall(MissTrust::Sure, true);
  ASSERT_EQ(with.trajectory.size(), without.trajectory.size());
  for (std::size_t i = 0; i < with.trajectory.size(); ++i)
    ASSERT_EQ(with.trajectory[i].pose, without.trajectory[i].pose) << "scan " << i;
  EXPECT_GT(static_cast<double>(with.free), 1.3 * static_cast<double>(without.free));
  ASSERT_EQ(with.grid.frame().size(), without.grid.frame().size());
  for (int y = 1; y + 1 < with.grid.height(); ++y)
    for (int x = 1; x + 1 < with.grid.width(); ++x) {
      const TPoint2D p = with.grid.centre({x, y});
      if (with.grid[{x, y}] == Occupancy::Free) {
        ASSERT_TRUE(p.x > -6.1 && p.x < 8.1 && p.y > -6.1 && p.y < 6.1) << p.x << " " << p.y;
      }
      if (without.grid[{x, y}] == Occupancy::Occupied) {
        EXPECT_TRUE(is_wall_near(with.grid, {x, y})) << p.x << " " << p.y;
      }
    }
}

/// Ranges alone write a dark wall and an open hall alike.
TEST(OpenSpace, StaysUnknownWhereTheScannerTellsNoReasons) {
  const HallMap without = map_hall(MissTrust::None, false);
  const HallMap with = map_hall(MissTrust::Sure, false);
  EXPECT_EQ(with.grid.cells(), without.grid.cells());
  EXPECT_GT(map_hall(MissTrust::All, false).free, without.free);
}

}  // namespace
}  // namespace rubble::slam
