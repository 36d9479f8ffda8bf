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
      const double told = 1.0 - search.choose_subject(source.cell) / kScrapCost;
      EXPECT_NEAR(told, kLong, kFaceStride * resolution + 1e-9) << resolution;
    }
  }
}

}  // namespace
}  // namespace rubble::explore
