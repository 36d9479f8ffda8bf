#include "base/wall_between.h"

#include <gtest/gtest.h>

#include <random>

namespace rubble {
namespace {

using mrpt::math::TPoint2D;

/// A wall across the grid stands between two places when they lie on different sides of it, and at no other time; what
/// lies beyond the grid is no wall.
TEST(WallBetween, IsWhereALineCrossesAWall) {
  GridFrame frame;
  frame.width = frame.height = 40;
  frame.resolution = 0.05;
  frame.x0 = frame.y0 = -1.0;
  OccupancyGrid known(frame, Occupancy::Free);
  for (int x = 0; x < 40; ++x) known[{x, 25}] = Occupancy::Occupied;
  known[{3, 3}] = Occupancy::Unknown;
  const double low = -1.0 + 25 * 0.05, high = low + 0.05;
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-0.99, 0.99);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const TPoint2D from(along(random), along(random)), to(along(random), along(random));
    const auto touches = [&](double y) { return y >= low && y < high; };
    const bool expected = touches(from.y) || touches(to.y) || (from.y < low) != (to.y < low);
    EXPECT_EQ(wall_between(known, from, to), expected) << from.asString() << " " << to.asString();
    EXPECT_EQ(wall_between(known, to, from), expected);
    crossed += expected ? 1 : 0;
  }
  EXPECT_GT(crossed, 500);
  EXPECT_FALSE(wall_between(known, {-3.0, -2.0}, {3.0, -2.0}));
  EXPECT_TRUE(wall_between(known, {0.0, -2.0}, {0.0, 2.0}));
}

}  // namespace
}  // namespace rubble
