#include "explore/caution/trail.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Stamp second(int i) { return Stamp::from_seconds(i); }

TEST(Trail, KeepsAPointWheneverTheRobotHasMovedOn) {
  Trail trail;
  EXPECT_EQ(trail.length(), 0.0);
  for (int i = 0; i <= 300; ++i) trail.add(second(i), {0.01 * i, 0.0, 0.1 * i});
  ASSERT_GE(trail.points().size(), 2u);
  for (std::size_t i = 1; i < trail.points().size(); ++i) {
    EXPECT_GT(trail.points()[i].x - trail.points()[i - 1].x, 0.149);
    EXPECT_LT(trail.points()[i].x - trail.points()[i - 1].x, 0.171);
  }
  EXPECT_NEAR(trail.length(), 3.0, 0.17) << "as far as it goes, but for the last step";
  const std::size_t count = trail.points().size();
  for (int i = 0; i < 100; ++i) trail.add(second(400 + i), {3.0, 0.001 * i, 0.0});
  EXPECT_LE(trail.points().size(), count + 1) << "a robot that stands leaves no trail";
}

TEST(Trail, HasPassedWhatIsBesideItAndNothingElse) {
  Trail trail;
  for (int i = 0; i <= 100; ++i) trail.add(second(i), {0.02 * i, 0.0, 0.0});
  EXPECT_TRUE(trail.slope({1.0, 0.1}));
  EXPECT_FALSE(trail.slope({1.0, 0.5}));
  EXPECT_FALSE(trail.slope({3.0, 0.0}));
}

TEST(Trail, SlopesMoveWithTheirPoses) {
  test::PlantedMapper mapper;
  Trail trail;
  for (int i = 0; i < 10; ++i) {
    mapper.plant(second(i), {1.0 * i, 0.0, 0.0});
    trail.add(second(i), {1.0 * i, 0.0, 0.0}, 0.01 * i);
  }
  EXPECT_EQ(trail.slope({3.0, 0.0}), 0.03);
  mapper.correct(second(5), {0.0, 2.0, 0.0});
  trail.follow(mapper);
  EXPECT_FALSE(trail.slope({3.0, 0.0}));
  EXPECT_EQ(trail.slope({3.0, 2.0}), 0.03);
  EXPECT_EQ(trail.slope({7.0, 0.0}), 0.07);
}

TEST(Trail, MovesWithThePosesOfItsMoments) {
  const TPose2D shift{0.0, 2.0, deg_to_rad(90.0)};
  test::PlantedMapper mapper;
  Trail trail;
  EXPECT_TRUE(std::isinf(trail.follow(mapper))) << "there is no end yet that could have stayed";
  for (int i = 0; i < 10; ++i) {
    mapper.plant(second(i), {1.0 * i, 0.0, 0.0});
    trail.add(second(i), {1.0 * i, 0.0, 0.0});
  }
  const std::vector<TPoint2D> before = trail.points();
  mapper.correct(second(5), shift);
  EXPECT_EQ(trail.follow(mapper), 0.0) << "its end did not move";
  ASSERT_EQ(trail.points().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(distance(trail.points()[i], i < 5 ? shift.composePoint(before[i]) : before[i]), 0.0, 1e-9);
  EXPECT_FALSE(trail.slope(before[3]));
  EXPECT_TRUE(trail.slope(shift.composePoint(before[3])));
  mapper.correct(second(20), {0.0, 0.3, 0.0});
  EXPECT_NEAR(trail.follow(mapper), 0.3, 1e-9);
}

}  // namespace
}  // namespace rubble::explore
