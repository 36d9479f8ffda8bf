#include "explore/stuck/rest.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kSettling = 0.5, kPeriod = 0.02;  // [s]

robot::Acceleration sample(double t, double x) {
  robot::Acceleration sample{};
  sample.stamp = Stamp::from_seconds(t);
  sample.x = x;
  return sample;
}

TEST(Rest, OfAStepIsLearnedByItsTimeConstant) {
  Rest rest(kSettling);
  EXPECT_FALSE(rest.update(sample(0.0, 0.0)));
  EXPECT_EQ(rest.felt(), 0.0);
  for (int i = 1; i <= 100; ++i) {
    const auto dt = rest.update(sample(i * kPeriod, 1.7));
    ASSERT_TRUE(dt);
    EXPECT_NEAR(*dt, kPeriod, 1e-9);
    EXPECT_NEAR(rest.felt(), 1.7 * std::pow(1.0 - kPeriod / kSettling, i - 1), 1e-9);
  }
}

TEST(Rest, BeginsAnewAfterAGapAndWithTimeThatRunsBack) {
  for (const double gap : {-0.02, 0.11}) {
    Rest rest(kSettling);
    rest.update(sample(1.0, 0.3));
    EXPECT_FALSE(rest.update(sample(1.0 + gap, 1.7))) << gap;
    EXPECT_EQ(rest.felt(), 0.0);
    EXPECT_EQ(rest.last(), Stamp::from_seconds(1.0 + gap));
  }
}

/// As in logs that tell each sample twice.
TEST(Rest, LearnsNothingWhileTimeStands) {
  Rest once(kSettling), twice(kSettling);
  for (int i = 0; i <= 50; ++i) {
    const robot::Acceleration told = sample(i * kPeriod, i < 10 ? 0.3 : 1.7);
    once.update(told);
    twice.update(told);
    EXPECT_EQ(twice.update(told), std::optional(0.0));
  }
  EXPECT_NEAR(twice.felt(), once.felt() * (1.0 - kPeriod / kSettling), 1e-9) << "by the rest that the first one left";
}

TEST(Rest, IsKeptWhereNothingIsToBeLearned) {
  Rest rest(kSettling);
  for (int i = 0; i <= 50; ++i) rest.update(sample(i * kPeriod, 0.3));
  for (int i = 51; i <= 60; ++i) {
    EXPECT_TRUE(rest.update(sample(i * kPeriod, -2.0), false));
    EXPECT_NEAR(rest.felt(), -2.3, 1e-9);
  }
  EXPECT_FALSE(rest.update(sample(2.0, 0.5), false)) << "a gap";
  EXPECT_NEAR(rest.felt(), 0.2, 1e-9) << "by what was known before";
}

}  // namespace
}  // namespace rubble::explore
