#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/search/floor_search.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kScrapCost = 16.0;  ///< of a metre of wall that is missing around a face [m]
constexpr double kSolidCost = 4.0;   ///< of a wall without a hole [m]

const auto kAnywhere = [](const TPoint2D&) { return 0.0; };

/// Open floor of 4 x 2.4 m, with walls so long in the middle of its south and its north side [m].
Traversable between(double south, double north, double resolution = 0.05) {
  OccupancyGrid cells = test::room(4.0, 2.4, resolution);
  test::fill(cells, 0.0, 0.0, 4.0, resolution, Occupancy::Unknown);
  test::fill(cells, 0.0, 2.4 - resolution, 4.0, 2.4, Occupancy::Unknown);
  test::fill(cells, 0.0, 0.0, resolution, 2.4, Occupancy::Unknown);
  test::fill(cells, 4.0 - resolution, 0.0, 4.0, 2.4, Occupancy::Unknown);
  test::fill(cells, 2.0 - 0.5 * south, 0.0, 2.0 + 0.5 * south, resolution, Occupancy::Occupied);
  test::fill(cells, 2.0 - 0.5 * north, 2.4 - resolution, 2.0 + 0.5 * north, 2.4, Occupancy::Occupied);
  return test::measured(std::move(cells));
}

/// As long as it is, to the distance of two subjects, whatever the cells.
TEST(Scraps, AreAsLongAtAnyResolution) {
  constexpr double kLong = 0.6;
  for (const double resolution : {0.1, 0.05, 0.025}) {
    SearchConfig config;
    config.min_cells = 4;
    FloorSearch search(config, 0.46, 0.4);
    const auto sources = search.sources(between(0.0, kLong, resolution), Subjects::Squarely, kAnywhere);
    ASSERT_FALSE(sources.empty());
    for (const Source& source : sources) {
      const double told = 1.0 - (search.choose_subject(source.cell) - kSolidCost) / kScrapCost;
      EXPECT_NEAR(told, kLong, cells_apart(kFaceStride, resolution) * resolution + 1e-9) << resolution;
    }
  }
}

/// From where a lane and a scrap across from it can be seen, the robot comes for the lane: that is what it faces, and
/// what its way was reckoned with.
TEST(Scraps, ThePlaceToFaceIsTheOneThatMadeTheWayCheap) {
  for (const bool lane_north : {false, true}) {
    const double south = lane_north ? 0.4 : 3.6, north = lane_north ? 3.6 : 0.4;
    const Traversable floor = between(south, north);
    FloorSearch search({}, 0.46, 0.4);
    const auto sources = search.sources(floor, Subjects::Squarely, kAnywhere);
    int both = 0;
    for (const Source& at : sources) {
      double least = std::numeric_limits<double>::infinity(), most = 0.0;
      for (const Source& source : sources) {
        if (source.cell != at.cell) continue;
        least = std::min(least, source.head_start);
        most = std::max(most, source.head_start);
      }
      if (most - least < 6.0) continue;
      ++both;
      FloorSearch there = search;
      EXPECT_EQ(there.choose_subject(at.cell), kSolidCost);
      const TPoint2D p = floor.cells.centre(at.cell);
      for (int i = 1; i <= 2; ++i)
        there.look(floor, {p.x, p.y, (lane_north ? 0.5 : -0.5) * kPi}, 0.0, Stamp::from_seconds(i));
      EXPECT_TRUE(there.subject_seen(floor)) << "from " << p.x << ", " << p.y;
    }
    EXPECT_GT(both, 0);
  }
}

}  // namespace
}  // namespace rubble::explore
