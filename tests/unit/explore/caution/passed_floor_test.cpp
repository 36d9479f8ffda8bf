#include "explore/caution/passed_floor.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

TEST(PassedFloor, KnowsTheSlopeBesideTheWayAndNothingElse) {
  PassedFloor floor;
  EXPECT_FALSE(floor.slope({0.0, 0.0}));
  for (double x = -1.0; x < 1.0; x += 0.15) floor.add({x, -0.02}, 0.1);
  for (double x = -0.95; x < 0.9; x += 0.05) {
    EXPECT_EQ(floor.slope({x, 0.0}), 0.1);
    EXPECT_EQ(floor.slope({x, 0.12}), 0.1);
    EXPECT_FALSE(floor.slope({x, 0.35}));
    EXPECT_FALSE(floor.slope({x, -0.35}));
  }
  floor.clear();
  EXPECT_FALSE(floor.slope({0.0, 0.0}));
}

TEST(PassedFloor, TakesTheSteepestNearbyAndTheLastInOnePlace) {
  PassedFloor floor;
  floor.add({0.05, 0.05}, 0.3);
  floor.add({0.20, 0.05}, 0.1);
  EXPECT_EQ(floor.slope({0.20, 0.05}), 0.3) << "the steepest about it";
  floor.add({0.06, 0.06}, 0.0);
  EXPECT_EQ(floor.slope({0.20, 0.05}), 0.1) << "what was steep once is not now";
}

}  // namespace
}  // namespace rubble::explore
