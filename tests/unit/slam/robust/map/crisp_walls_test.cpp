#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "slam/robust/map/crisp_walls.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;

/// A scan from the origin of points given counter-clockwise, one a degree.
ScanPoints scan_of(const std::vector<TPoint2D>& ends) {
  ScanPoints points;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    points.rays.push_back({ends[i], true, i + 1 < ends.size(), static_cast<int>(i)});
    points.hits.push_back(ends[i]);
  }
  return points;
}

TEST(LoneHits, ABeamAloneIsLeftOutAndItsNeighboursKnowOfTheGap) {
  std::vector<TPoint2D> ends;
  for (int i = 0; i < 21; ++i) ends.push_back({1.0, -0.2 + 0.02 * i});
  ends[10].x = 0.6;
  ScanPoints points = scan_of(ends);
  drop_lone_hits(points);
  ASSERT_EQ(points.rays.size(), 20u);
  EXPECT_EQ(points.hits.size(), 20u);
  for (const ScanRay& ray : points.rays) {
    EXPECT_GT(ray.end.x, 0.9);
    EXPECT_EQ(ray.joined, ray.beam != 9 && ray.beam != 20) << "beam " << ray.beam;
  }
}

/// A map whose cells were all seen ten times and hit as often as drawn.
CountMap drawn(const std::vector<std::string>& rows) {
  CountMap map(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), 0.05);
  const GridFrame frame = map.frame();
  std::vector<std::uint16_t> seen(frame.size(), 10), occupied(frame.size(), 0);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const char c = rows[static_cast<std::size_t>(frame.height - 1 - y)][static_cast<std::size_t>(x)];
      if (c != '.') occupied[frame.index({x, y})] = static_cast<std::uint16_t>(c - '0');
    }
  map.assign(frame, seen, occupied);
  return map;
}

std::vector<std::string> walls_of(const CountMap& map) {
  const OccupancyGrid grid = map.classify();
  std::vector<std::string> rows;
  for (int y = grid.height() - 1; y >= 0; --y) {
    rows.emplace_back();
    for (int x = 0; x < grid.width(); ++x) rows.back() += grid[{x, y}] == Occupancy::Occupied ? '#' : '.';
  }
  return rows;
}

TEST(ThinWalls, TheCellsHitMoreOftenStay) {
  CountMap map = drawn({"...68...", "...87...", "...68...", "...69...", "........"});
  thin_walls(map);
  EXPECT_EQ(walls_of(map), (std::vector<std::string>{"....#...", "....#...", "....#...", "....#...", "........"}));
  CountMap lying = drawn({".......", ".99898.", ".77979.", "......."});
  thin_walls(lying);
  EXPECT_EQ(walls_of(lying), (std::vector<std::string>{".......", ".#####.", ".......", "......."}));
}

TEST(ThinWalls, CellsThatStickOutOfAWallGo) {
  CountMap map = drawn({"...9....", "...9....", "...96...", "...9....", "...9...."});
  thin_walls(map);
  EXPECT_EQ(walls_of(map), (std::vector<std::string>(5, "...#....")));
}

TEST(ThinWalls, WallsOfOneCellOrThreeCornersAndSmallThingsStay) {
  const std::vector<std::string> rows{"9.....999.", "9.....999.", "9.....999.", "9999..999.", "......999.",
                                      "..........", "..99......", "..99......", "..........", ".........."};
  CountMap map = drawn(rows);
  thin_walls(map);
  std::vector<std::string> expected = rows;
  for (std::string& row : expected) std::replace(row.begin(), row.end(), '9', '#');
  EXPECT_EQ(walls_of(map), expected);
}

/// Wherever the walls lie between the cells of a raster that began at the robot, they come out one cell thick.
TEST(RobustMap, WallsAreOneCellThickWhereverTheyLie) {
  const robot::RobotModel model;
  const slam_test::Drive drive =
      slam_test::drive_through({{0.0, 0.0}, {0.6, 0.0}, {3.0, 0.2}, {3.0, 1.0}, {0.0, 0.5}, {-1.2, -0.6}}, 0.0);
  for (const double offset : {0.0, 0.013, 0.025, 0.038}) {
    SCOPED_TRACE("offset " + std::to_string(offset));
    slam_test::World world;
    slam_test::add_box(world, -2.0 + offset, -1.5 + offset, 4.0 + offset, 2.5 + offset);
    RobustMapper mapper(model, {}, 1);
    slam_test::play(mapper, slam_test::record(world, drive, model, 1.0, 0.015, 1), world, drive.truth);
    const OccupancyGrid grid = mapper.map().classify();
    int occupied = 0;
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) occupied += grid[{x, y}] == Occupancy::Occupied ? 1 : 0;
    EXPECT_NEAR(occupied, 400, 24);  // 20 m of wall
  }
}

}  // namespace
}  // namespace rubble::slam
