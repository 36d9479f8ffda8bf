#include "explore/caution/left_alone.h"

#include <gtest/gtest.h>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

const TPoint2D kTarget{5.0, 5.0};

Stamp seconds(double s) { return Stamp::from_seconds(s); }

/// Something stopped the robot driving forwards, in the middle of an empty room where no pallets show.
void feel(LeftAlone& left_alone, double x, Stamp now) {
  left_alone.feel({now, {x, 2.0, 0.0}}, false, {}, test::room(8.0, 4.0), {});
}

/// How long a target is barred from `now` on [s].
double barred_for(const LeftAlone& left_alone, Stamp now) {
  double t = 0.0;
  while (left_alone.barred(kTarget, now + t) && t < 1e5) t += 1.0;
  return t;
}

TEST(LeftAlone, EachFailureBarsATargetTwiceAsLongUpToAnHour) {
  LeftAlone left_alone({}, 0.5);
  Stamp now = seconds(1.0);
  double last = 0.0;
  for (int i = 0; i < 10; ++i) {
    left_alone.bar(kTarget, {now, {}});
    const double t = barred_for(left_alone, now);
    if (i == 0) {
      EXPECT_NEAR(t, 60.0, 1.0);
    } else if (i <= 6) {
      EXPECT_NEAR(t, 2.0 * last, 2.0);
    } else {
      EXPECT_EQ(t, last);
    }
    last = t;
    now = now + t + 1.0;
  }
  EXPECT_FALSE(left_alone.barred({kTarget.x + 1.0, kTarget.y}, seconds(2.0)));
}

/// In the order of their degrees: what each forgives, and what it leaves.
TEST(LeftAlone, ForgivesByDegrees) {
  const Stamp now = seconds(10.0);
  LeftAlone left_alone({}, 0.5);
  EXPECT_FALSE(left_alone.pardon(now));
  EXPECT_FALSE(left_alone.pardon_all(now));
  EXPECT_FALSE(left_alone.forget(now)) << "there is nothing to forgive";

  left_alone.bar(kTarget, {now, {}});
  left_alone.bar_for_good({9.0, 9.0}, {now, {}});
  EXPECT_TRUE(left_alone.pardon(now));
  EXPECT_FALSE(left_alone.barred(kTarget, now));
  EXPECT_TRUE(left_alone.barred({9.0, 9.0}, now)) << "for good";
  EXPECT_TRUE(left_alone.pardon_all(now));
  EXPECT_FALSE(left_alone.barred({9.0, 9.0}, now));

  left_alone.bar(kTarget, {now, {}});
  for (int i = 0; i < 3; ++i) feel(left_alone, 3.0, now);  // certain by then
  EXPECT_TRUE(left_alone.pardon_all(now)) << "a bar shrinks";
  EXPECT_FALSE(left_alone.obstacles(now).empty()) << "but what is certain stays";
  left_alone.bar(kTarget, {now, {}});
  EXPECT_TRUE(left_alone.forget(now));
  EXPECT_TRUE(left_alone.obstacles(now).empty());
  EXPECT_TRUE(left_alone.barred(kTarget, now)) << "a target is nothing that was felt";
}

TEST(LeftAlone, APardonLeavesNeitherTargetsNorThingsOut) {
  const Stamp now = seconds(10.0);
  LeftAlone left_alone({}, 0.5);
  left_alone.bar(kTarget, {now, {}});
  feel(left_alone, 3.0, now);
  const std::size_t points = left_alone.obstacles(now).size();
  EXPECT_TRUE(left_alone.pardon(now));
  EXPECT_FALSE(left_alone.barred(kTarget, now));
  EXPECT_LT(left_alone.obstacles(now).size(), points);
}

TEST(LeftAlone, WhereTheRobotStandsInGoodOrderNothingIsInTheWay) {
  const Stamp now = seconds(10.0);
  LeftAlone left_alone({}, 0.5);
  feel(left_alone, 3.0, now);
  ASSERT_FALSE(left_alone.obstacles(now).empty());
  const TPoint2D there = left_alone.obstacles(now).front();
  left_alone.passed({there.x, 2.0, 0.0}, {});
  EXPECT_TRUE(left_alone.obstacles(now).empty());
}

}  // namespace
}  // namespace rubble::explore
