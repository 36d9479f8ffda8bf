#include "explore/plan/outlook.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

/// Expected from (x, y) [m] in a room of 3 x 3 m with the unknown put where `change` does.
template <class Change>
double from(double x, double y, const Change& change) {
  OccupancyGrid cells = test::room(3.0, 3.0);
  change(cells);
  const Traversable floor = traversable(cells);
  return expected_area(floor, floor.cells.cell({x, y}));
}

void door(OccupancyGrid& cells, double width) { test::fill(cells, 2.8, 0.4, 3.1, 0.4 + width, Occupancy::Unknown); }

TEST(ExpectedArea, InAClosedRoomIsNone) {
  EXPECT_EQ(from(1.5, 1.5, [](OccupancyGrid&) {}), 0.0);
}

TEST(ExpectedArea, IsTheUnknownInSight) {
  const auto pocket = [](OccupancyGrid& cells) { test::fill(cells, 1.0, 1.0, 1.5, 1.5, Occupancy::Unknown); };
  EXPECT_NEAR(from(0.5, 1.25, pocket), 0.25, 1e-9);
  const auto behind_a_wall = [&](OccupancyGrid& cells) {
    pocket(cells);
    test::fill(cells, 0.8, 0.0, 0.9, 3.0, Occupancy::Occupied);
  };
  EXPECT_EQ(from(0.5, 1.25, behind_a_wall), 0.0);
}

TEST(ExpectedArea, GrowsWithTheDoorAndReachesBeyondTheMap) {
  const double narrow = from(2.5, 0.9, [](OccupancyGrid& cells) { door(cells, 0.6); });
  const double wide = from(2.5, 0.9, [](OccupancyGrid& cells) { door(cells, 1.2); });
  EXPECT_GT(narrow, 0.3);
  EXPECT_GT(wide, 1.3 * narrow);
}

/// The next wall is a pallet off.
TEST(ExpectedArea, GoesNotFartherIntoTheUnknownThanAPallet) {
  const auto nothing = [](OccupancyGrid& cells) {
    test::fill(cells, -1.0, -1.0, 4.0, 4.0, Occupancy::Unknown);
    test::fill(cells, 1.4, 1.4, 1.6, 1.6, Occupancy::Free);
  };
  EXPECT_NEAR(from(1.5, 1.5, nothing), kPi * 1.3 * 1.3, 0.3);
}

}  // namespace
}  // namespace rubble::explore
