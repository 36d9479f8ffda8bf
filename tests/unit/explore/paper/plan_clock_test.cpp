#include "explore/paper/plan_clock.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

TEST(PlanClock, BeforeTheFirstPlanItsAgeIsBeyondAll) {
  PlanClock clock;
  EXPECT_GT(clock.age(Stamp::from_seconds(0.12)), 1e12);
  clock.plan(1, 2.0, Stamp::from_seconds(1.0));
  EXPECT_DOUBLE_EQ(clock.age(Stamp::from_seconds(1.5)), 0.5);
}

}  // namespace
}  // namespace rubble::explore
