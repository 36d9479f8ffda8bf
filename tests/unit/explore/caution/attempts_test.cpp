#include "explore/caution/attempts.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

TEST(Attempts, ATargetGetsTimeByItsCostAndIsThenOverdrawn) {
  Attempts attempts(0.5);
  double spent = 0.0;
  while (!attempts.overdrawn({5.0, 5.0}, 10.0, 0.1, {})) ASSERT_LT(spent += 0.1, 1000.0);
  EXPECT_GT(spent, 10.0 / 0.4) << "more than the drive takes";
  EXPECT_FALSE(attempts.overdrawn({5.0, 5.0}, 10.0, 0.1, {})) << "a new account";
}

TEST(Attempts, GoingToAndFroBetweenTargetsDoesNotRenewTheirTime) {
  Attempts attempts(0.5);
  double spent = 0.0;
  bool overdrawn = false;
  for (int i = 0; !overdrawn; ++i) {
    overdrawn =
        attempts.overdrawn(i % 2 == 0 ? mrpt::math::TPoint2D{0.0, 0.0} : mrpt::math::TPoint2D{9.0, 0.0}, 2.0, 0.5, {});
    ASSERT_LT(spent += 0.5, 200.0);
  }
}

}  // namespace
}  // namespace rubble::explore
