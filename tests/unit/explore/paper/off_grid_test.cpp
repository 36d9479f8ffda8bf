#include "explore/paper/off_grid.h"

#include <gtest/gtest.h>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using test::corridor_of_pallets;
using test::kPallet;

/// Cells of `what` in a rectangle [m].
int count(const Traversable& floor, double x0, double y0, double x1, double y1, Occupancy what) {
  OccupancyGrid marked = floor.cells;
  test::fill(marked, x0, y0, x1, y1, Occupancy::Unknown);
  int n = 0;
  for (int y = 0; y < marked.height(); ++y)
    for (int x = 0; x < marked.width(); ++x)
      n += marked[{x, y}] == Occupancy::Unknown && floor.cells[{x, y}] == what ? 1 : 0;
  return n;
}

/// Of what stands in the corridor from x0 to x1, y0 to y1 [m] the share that is made free.
double freed(double x0, double y0, double x1, double y1, double pallet = kPallet) {
  OccupancyGrid cells = corridor_of_pallets(4 * kPallet, 0.0, Occupancy::Free);
  test::fill(cells, x0, y0, x1, y1, Occupancy::Occupied);
  Traversable floor = test::measured(cells);
  const double before = count(floor, x0, y0, x1, y1, Occupancy::Occupied);
  free_off_grid(floor, pallet);
  EXPECT_GT(before, 0.0);
  return 1.0 - count(floor, x0, y0, x1, y1, Occupancy::Occupied) / before;
}

TEST(OffGrid, FloorOfASlopeThatLooksLikeAWallIsMadeFreeWhateverItsThickness) {
  for (const double thickness : {0.06, 0.12, 0.3})
    EXPECT_GT(freed(5.2, 0.25, 5.2 + thickness, 0.95), 0.99) << thickness;
}

TEST(OffGrid, SoIsPaperBesideAWall) {
  EXPECT_GT(freed(5.2, 0.1, 5.45, 0.4), 0.5) << "but for what is as near to the wall as a wall is thick";
  EXPECT_GT(freed(5.2, 0.45, 5.45, 0.7), 0.99);
}

TEST(OffGrid, WhereOnlyFloorIsAskedForSmallThingsStay) {
  OccupancyGrid cells = corridor_of_pallets(4 * kPallet, 0.0, Occupancy::Free);
  test::fill(cells, 5.2, 0.25, 5.3, 0.95, Occupancy::Occupied);
  test::fill(cells, 6.5, 0.4, 6.8, 0.7, Occupancy::Occupied);
  Traversable floor = test::measured(cells);
  free_off_grid(floor, kPallet, true);
  EXPECT_EQ(count(floor, 5.2, 0.25, 5.3, 0.95, Occupancy::Occupied), 0);
  EXPECT_GT(count(floor, 6.5, 0.4, 6.8, 0.7, Occupancy::Occupied), 0);
}

TEST(OffGrid, WallsAndTheSidesOfBoxesStay) {
  EXPECT_EQ(freed(4 * kPallet - 0.03, 0.0, 4 * kPallet + 0.03, kPallet), 0.0) << "on an edge";
  EXPECT_EQ(freed(4 * kPallet + 0.08, 0.0, 4 * kPallet + 0.14, kPallet), 0.0) << "and a little off it";
  EXPECT_EQ(freed(5.2, 0.0, 5.26, 0.42), 0.0) << "the side of a box";
  EXPECT_EQ(freed(5.2, 0.25, 5.5, 0.95, 0.0), 0.0) << "no pallets";
}

/// As the steps of a red field show, from corner to corner of their pallet.
TEST(OffGrid, SoDoFieldsOfSteps) {
  OccupancyGrid cells = corridor_of_pallets(4 * kPallet, 0.0, Occupancy::Free);
  for (double d = 0.1; d < 1.1; d += 0.07)
    test::fill(cells, 4.8 + d - 0.05, d - 0.05, 4.8 + d + 0.05, d + 0.05, Occupancy::Occupied);
  Traversable floor = test::measured(cells);
  EXPECT_FALSE(free_off_grid(floor, kPallet));
}

TEST(OffGrid, WhereTheWallsShowNoGridNothingIsMadeFree) {
  OccupancyGrid cells = test::room(6.0, 6.0);
  // At every quarter of a pallet as often as at every other.
  for (const double at : {1.5, 3.0, 4.5}) {
    test::fill(cells, at - 0.03, 0.6, at + 0.03, 5.4, Occupancy::Occupied);
    test::fill(cells, 0.6, at - 0.03, 5.4, at + 0.03, Occupancy::Occupied);
  }
  Traversable floor = test::measured(cells);
  EXPECT_FALSE(free_off_grid(floor, 1.2));
  EXPECT_EQ(floor.cells.cells(), cells.cells());
}

}  // namespace
}  // namespace rubble::explore
