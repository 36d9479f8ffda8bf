#include "scoring/alignment/drawing_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_maze.h"
#include "tests/support/scoring_second_drawings.h"

namespace rubble::scoring {
namespace {

using namespace testing;

const Ground kGround{"yellow", 6, 8, 3};

TEST(DrawingSizes, AreToldByGroundAndReachHoweverTheDrawingIsTurned) {
  const OccupancyGrid truth = truth_of(kGround);
  for (const double size : {0.4, 0.8, 1.7})
    for (const double turn : {0.0, 0.3}) {
      const OccupancyGrid drawing = moved(drawn_at(truth, size, size), turn, 0.0, 0.0);
      const ToldSizes told = sizes_told(crop_to_known(drawing, 0.0), truth);
      ASSERT_FALSE(told.sizes.empty());
      for (const double times : told.sizes) EXPECT_NEAR(times * size, 1.0, 0.05) << size << ", turned by " << turn;
    }
}

TEST(DrawingSizes, ProportionsAreToldAlongTheWalls) {
  const OccupancyGrid truth = truth_of(kGround);
  const ToldSizes told = sizes_told(crop_to_known(drawn_at(truth, 1.25, 1.0), 0.0), truth);
  const bool found = std::any_of(told.stretches.begin(), told.stretches.end(), [](const AxisSizes& by) {
    const bool along_x = std::abs(std::cos(by.direction)) > 0.7;
    return std::abs((along_x ? by.along : by.across) - 0.8) < 0.02 &&
           std::abs((along_x ? by.across : by.along) - 1.0) < 0.02;
  });
  EXPECT_TRUE(found);
}

TEST(DrawingSizes, NothingIsToldOfNothing) {
  const OccupancyGrid truth = truth_of(kGround);
  for (const int known : {0, 1}) {
    OccupancyGrid drawing(GridFrame{20, 20, 0.05, 0.0, 0.0});
    if (known > 0) drawing[{5, 5}] = Occupancy::Occupied;
    const ToldSizes told = sizes_told(drawing, truth);
    EXPECT_TRUE(told.sizes.empty()) << known;
    EXPECT_TRUE(told.stretches.empty()) << known;
  }
}

TEST(DrawingSizes, StretchingKeepsEveryWall) {
  OccupancyGrid drawing(GridFrame{40, 40, 0.05, 0.0, 0.0}, Occupancy::Free);
  for (int x = 0; x < 40; ++x) drawing[{x, 17}] = Occupancy::Occupied;
  const OccupancyGrid low = stretched(drawing, {0.0, 1.0, 0.4});
  EXPECT_EQ(low.width(), 40);
  EXPECT_EQ(low.height(), 16);
  EXPECT_EQ(std::count(low.cells().begin(), low.cells().end(), Occupancy::Occupied), 40);
}

}  // namespace
}  // namespace rubble::scoring
