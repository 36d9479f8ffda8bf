#include "scenarios/run/first_seen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/angle.h"
#include "scenarios/run/mission_figures.h"

namespace rubble::scenarios {
namespace {

/// Ten by ten cells of 0.1 m from (x0, 0) on, of which the lowest rows have been seen.
slam::CountMap seen_rows(int rows, double x0 = 0.0) {
  const GridFrame frame{10, 10, 0.1, x0, 0.0};
  std::vector<std::uint16_t> seen(frame.size(), 0);
  std::fill_n(seen.begin(), 10 * rows, std::uint16_t{1});
  slam::CountMap map(10, 10, 0.1);
  map.assign(frame, seen, std::vector<std::uint16_t>(frame.size(), 0));
  return map;
}

/// A row more every five seconds.
FirstSeen row_by_row(int rows) {
  FirstSeen seen;
  for (int row = 1; row <= rows; ++row) seen.note(seen_rows(row), 5.0 * row);
  return seen;
}

OccupancyGrid all_free() { return OccupancyGrid({10, 10, 0.1, 0.0, 0.0}, Occupancy::Free); }

TEST(FirstSeen, KnowsWhenEachPlaceWasSeenAlsoWhenTheMapGrows) {
  FirstSeen seen = row_by_row(3);
  EXPECT_EQ(seen.at({0.55, 0.05}), 5.0);
  EXPECT_EQ(seen.at({0.55, 0.25}), 15.0);
  EXPECT_TRUE(std::isinf(seen.at({0.55, 0.35})));
  EXPECT_TRUE(std::isinf(seen.at({-3.0, 0.05}))) << "off the map";
  seen.note(seen_rows(10, -0.5), 60.0);
  EXPECT_EQ(seen.at({0.15, 0.05}), 5.0) << "it stays where it was";
  EXPECT_EQ(seen.at({-0.45, 0.05}), 60.0);
}

TEST(AreaPerMinute, IsUntil95PerCentOfWhatCanBeSeenAreKnown) {
  // The tenth row makes it more than 95 %: 0.95 m2 in 50 s.
  EXPECT_NEAR(area_per_minute(row_by_row(10), all_free(), {}, 900.0), 0.95 * 60.0 / 50.0, 1e-6);
}

/// What it knows itself in the end is not what could be seen.
TEST(AreaPerMinute, OfARunThatLeavesHalfOfItIsSmall) {
  EXPECT_NEAR(area_per_minute(row_by_row(5), all_free(), {}, 900.0), 0.5 * 60.0 / 900.0, 1e-6);
}

TEST(AreaPerMinute, LooksWhereTheArenaLiesInTheMap) {
  EXPECT_NEAR(area_per_minute(row_by_row(10), all_free(), {0.0, 5.0, 0.0}, 900.0), 0.0, 1e-9);
  EXPECT_NEAR(area_per_minute(row_by_row(10), all_free(), {1.0, 1.0, kPi}, 900.0), 0.95 * 60.0 / 50.0, 1e-6);
}

TEST(AreaPerMinute, OfNothingIsNone) {
  EXPECT_EQ(area_per_minute({}, all_free(), {}, 0.0), 0.0);
  EXPECT_EQ(area_per_minute({}, OccupancyGrid(), {}, 10.0), 0.0);
}

}  // namespace
}  // namespace rubble::scenarios
