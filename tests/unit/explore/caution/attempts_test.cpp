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

/// Else a frontier that was passed by at 7 m would be given up halfway when it is come back to from 38 m.
TEST(Attempts, BegunFromFartherAwayItGetsWhatThatIsMore) {
  const auto time_of = [](double first, double then) {
    Attempts attempts(0.5);
    attempts.overdrawn({5.0, 5.0}, first, 0.1, {});
    double spent = 0.1;
    while (!attempts.overdrawn({5.0, 5.0}, then, 0.1, {}) && spent < 1000.0) spent += 0.1;
    return spent;
  };
  EXPECT_NEAR(time_of(7.0, 38.0), time_of(38.0, 38.0), 0.2);
  EXPECT_NEAR(time_of(38.0, 7.0), time_of(38.0, 38.0), 0.2);
}

TEST(Attempts, OfATargetThatItTurnedAwayFromItIsTheFirstTimeOnce) {
  Attempts attempts(0.5);
  EXPECT_FALSE(attempts.turned_away({5.0, 5.0})) << "it was none";
  attempts.overdrawn({5.0, 5.0}, 2.0, 0.1, {});
  EXPECT_FALSE(attempts.turned_away({5.2, 5.0}));
  EXPECT_FALSE(attempts.turned_away({9.0, 5.0})) << "another one";
  EXPECT_TRUE(attempts.turned_away({5.0, 5.2}));
  while (!attempts.overdrawn({5.0, 5.0}, 2.0, 1.0, {})) continue;
  attempts.overdrawn({5.0, 5.0}, 2.0, 0.1, {});
  EXPECT_FALSE(attempts.turned_away({5.0, 5.0})) << "a new account";
}

}  // namespace
}  // namespace rubble::explore
