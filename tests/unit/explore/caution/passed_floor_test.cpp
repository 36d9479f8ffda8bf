#include "explore/caution/passed_floor.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

TEST(PassedFloor, HoldsWhatIsBesideTheWayAndNothingElse) {
  PassedFloor floor;
  EXPECT_FALSE(floor.holds({0.0, 0.0}));
  for (double x = -1.0; x < 1.0; x += 0.15) floor.add({x, -0.02});
  for (double x = -0.95; x < 0.9; x += 0.05) {
    EXPECT_TRUE(floor.holds({x, 0.0}));
    EXPECT_TRUE(floor.holds({x, 0.12}));
    EXPECT_FALSE(floor.holds({x, 0.35}));
    EXPECT_FALSE(floor.holds({x, -0.35}));
  }
  floor.clear();
  EXPECT_FALSE(floor.holds({0.0, 0.0}));
}

}  // namespace
}  // namespace rubble::explore
