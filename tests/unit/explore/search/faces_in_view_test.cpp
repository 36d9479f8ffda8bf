#include <gtest/gtest.h>

#include "base/angle.h"
#include "explore/search/floor_search.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

double in_view(const Traversable& floor, const FloorSearch& search, double x, double y) {
  return search.faces_in_view(floor, floor.cells.cell({x, y}));
}

TEST(FacesInView, AreThoseInRangeThatWereNotLookedAt) {
  const Traversable floor = test::measured(test::room(8.0, 1.3));
  FloorSearch search({}, 0.46, 0.4);
  const double all = in_view(floor, search, 4.0, 0.65);
  EXPECT_GT(all, 2.0) << "1 m and more of each wall within 60 deg of its normal";
  EXPECT_LT(all, 2.0 * 2.0 * 1.8);
  Stamp now = Stamp::from_seconds(1.0);
  for (double x = 2.0; x < 6.0; x += 0.2)
    for (double heading = 0.0; heading < 2.0 * kPi; heading += 0.4)
      for (int looks = 0; looks < 2; ++looks) search.look(floor, {x, 0.65, heading}, 0.0, now = now + 1.0);
  EXPECT_EQ(in_view(floor, search, 4.0, 0.65), 0.0);
}

TEST(FacesInView, AreNotThoseBehindAWall) {
  OccupancyGrid cells = test::room(3.0, 1.3);
  const FloorSearch search({}, 0.46, 0.4);
  const double open = in_view(test::measured(cells), search, 1.2, 0.65);
  test::fill(cells, 1.4, 0.0, 1.5, 1.3, Occupancy::Unknown);  // has no face itself
  const double shut = in_view(test::measured(cells), search, 1.2, 0.65);
  EXPECT_LT(shut, 0.75 * open);
  EXPECT_GT(shut, 0.25 * open);
}

TEST(FacesInView, WithoutASearchThereAreNone) {
  SearchConfig off;
  off.on = false;
  EXPECT_EQ(in_view(test::measured(test::room(3.0, 1.3)), FloorSearch(off, 0.46, 0.4), 1.2, 0.65), 0.0);
}

}  // namespace
}  // namespace rubble::explore
