#include "scenarios/evidence/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace rubble::scenarios {
namespace {

TEST(Statistics, QuantilesLieBetweenOrderStatistics) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(quantile({10.0, 20.0, 30.0, 40.0, 50.0}, 0.1), 14.0);
  EXPECT_EQ(quantile({7.0}, 0.9), 7.0);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Statistics, RobustDeviationIgnoresAnOutlier) {
  EXPECT_NEAR(robust_deviation({1.0, 2.0, 3.0, 4.0, 5.0}), 1.4826, 1e-12);
  EXPECT_NEAR(robust_deviation({1.0, 2.0, 3.0, 4.0, 5000.0}), 1.4826, 1e-12);
}

// Table values of Student's distribution, two-sided 95 % (any textbook).
TEST(Statistics, StudentQuantilesMatchTheTable) {
  EXPECT_NEAR(student_quantile(0.975, 1), 12.7062, 1e-4);
  EXPECT_NEAR(student_quantile(0.975, 2), 4.30265, 1e-5);
  EXPECT_NEAR(student_quantile(0.975, 5), 2.57058, 1e-5);
  EXPECT_NEAR(student_quantile(0.975, 10), 2.22814, 1e-5);
  EXPECT_NEAR(student_quantile(0.975, 29), 2.04523, 1e-5);
  EXPECT_NEAR(student_quantile(0.025, 120), -1.97993, 1e-5);
  EXPECT_NEAR(normal_cdf(1.959964), 0.975, 1e-7);
}

TEST(Statistics, SignTestIsExact) {
  EXPECT_NEAR(sign_test(5, 0), 2.0 / 32.0, 1e-12);
  EXPECT_NEAR(sign_test(0, 6), 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(sign_test(9, 1), 2.0 * 11.0 / 1024.0, 1e-12);
  EXPECT_EQ(sign_test(4, 4), 1.0);
  EXPECT_EQ(sign_test(0, 0), 1.0);
  EXPECT_GT(sign_test(400, 400), 0.95);
  EXPECT_LT(sign_test(450, 350), 0.001);
}

TEST(Statistics, BootstrapOfEqualValuesIsAPoint) {
  const Interval interval = bootstrap_mean({0.25, 0.25, 0.25}, 1);
  EXPECT_EQ(interval.low, 0.25);
  EXPECT_EQ(interval.high, 0.25);
  EXPECT_TRUE(std::isinf(bootstrap_mean({0.25}, 1).high));
}

TEST(Statistics, BootstrapIsTheSameForOneSeed) {
  const std::vector<double> values = {0.1, 0.4, -0.3, 0.9, 0.2};
  EXPECT_EQ(bootstrap_mean(values, 5).low, bootstrap_mean(values, 5).low);
  EXPECT_NE(bootstrap_mean(values, 5).low, bootstrap_mean(values, 6).low);
}

/// How often the interval holds the true mean (0) of samples drawn by `draw`.
template <class Draw>
double coverage(int n, int trials, const Draw& draw) {
  Rng rng(7, "coverage");
  int inside = 0;
  for (int t = 0; t < trials; ++t) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back(draw(rng));
    const Interval interval = bootstrap_mean(values, static_cast<std::uint64_t>(t));
    inside += interval.low <= 0.0 && 0.0 <= interval.high ? 1 : 0;
  }
  return static_cast<double>(inside) / trials;
}

TEST(Statistics, BootstrapIntervalsHoldTheMeanAsOftenAsTheySay) {
  EXPECT_NEAR(coverage(8, 200, [](Rng& rng) { return rng.gaussian(); }), 0.95, 0.035);
  EXPECT_NEAR(coverage(24, 200, [](Rng& rng) { return rng.gaussian(); }), 0.95, 0.035);
  // A skewed population costs some coverage in a small sample, whatever the method.
  EXPECT_GT(coverage(24, 200, [](Rng& rng) { return -std::log(1.0 - rng.uniform()) - 1.0; }), 0.88);
}

}  // namespace
}  // namespace rubble::scenarios
