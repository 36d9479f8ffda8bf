#include "base/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rubble {
namespace {

using Block = std::array<std::uint32_t, 4>;

// The known-answer vectors that come with Random123.
TEST(Philox, GivesThePublishedVectors) {
  EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32_10({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}), (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, SameSeedAndNameGiveTheSameNumbers) {
  Rng a(42, "scan");
  Rng b(42, "scan");
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.next_u32(), b.next_u32());
}

TEST(Rng, FillingGivesWhatSingleDrawsGive) {
  Rng single(7, "fill");
  Rng filled(7, "fill");
  for (const std::size_t n : {1u, 2u, 16u, 17u, 3u, 341u, 0u, 64u}) {
    std::vector<std::uint32_t> words(n);
    filled.fill(words.data(), n);
    for (const std::uint32_t word : words) ASSERT_EQ(word, single.next_u32()) << "of " << n;
  }
}

TEST(Rng, ACopyGoesOnByItself) {
  Rng a(42, "scan");
  a.gaussian();
  Rng b = a;
  const double next = a.gaussian();
  a.next_u32();
  EXPECT_EQ(b.gaussian(), next);
}

TEST(Rng, OtherNamesAndSeedsGiveUncorrelatedNumbers) {
  constexpr int kCount = 20000;
  const auto correlation = [](Rng a, Rng b) {
    double sum = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const double x = a.gaussian();
      const double y = b.gaussian();
      sum += x * y;
    }
    return sum / kCount;
  };
  const double bound = 4.0 / std::sqrt(kCount);
  EXPECT_LT(std::abs(correlation(Rng(1, "scan"), Rng(1, "odometry"))), bound);
  EXPECT_LT(std::abs(correlation(Rng(1, "scan"), Rng(2, "scan"))), bound);
  EXPECT_LT(std::abs(correlation(Rng(1, "scan"), Rng(1ull << 32, "scan"))), bound);
  EXPECT_LT(std::abs(correlation(Rng(1, "robot 1"), Rng(1, "robot 2"))), bound);
}

TEST(Rng, UniformHasTheMomentsOfTheUniformDistribution) {
  constexpr int kCount = 200000;
  Rng rng(5, "uniform");
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    mean += u / kCount;
    square += u * u / kCount;
  }
  EXPECT_NEAR(mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kCount));
  EXPECT_NEAR(square, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / kCount));
}

TEST(Rng, GaussianHasTheMomentsOfTheNormalDistribution) {
  constexpr int kCount = 200000;
  Rng rng(5, "gaussian");
  std::array<double, 5> moment{};
  int beyond_2 = 0;
  for (int i = 0; i < kCount; ++i) {
    const double z = rng.gaussian();
    for (std::size_t k = 1; k < moment.size(); ++k) moment[k] += std::pow(z, static_cast<double>(k)) / kCount;
    beyond_2 += std::abs(z) > 2.0 ? 1 : 0;
  }
  const double unit = 1.0 / std::sqrt(kCount);  // bounds: four standard errors, from the moments up to the eighth
  EXPECT_NEAR(moment[1], 0.0, 4.0 * unit);
  EXPECT_NEAR(moment[2], 1.0, 4.0 * std::sqrt(2.0) * unit);
  EXPECT_NEAR(moment[3], 0.0, 4.0 * std::sqrt(15.0) * unit);
  EXPECT_NEAR(moment[4], 3.0, 4.0 * std::sqrt(96.0) * unit);
  const double tail = std::erfc(2.0 / std::sqrt(2.0));
  EXPECT_NEAR(static_cast<double>(beyond_2) / kCount, tail, 4.0 * std::sqrt(tail * (1.0 - tail)) * unit);
}

TEST(Rng, SigmaScales) {
  Rng a(1, "x");
  Rng b(1, "x");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.gaussian(0.03), 0.03 * b.gaussian());
}

TEST(Rng, BelowIsEvenAndNeverReachesItsBound) {
  Rng rng(9, "below");
  for (const std::uint32_t n : {1u, 2u, 6u, 7u}) {
    constexpr int kCount = 70000;
    std::vector<int> histogram(n, 0);
    for (int i = 0; i < kCount; ++i) ++histogram.at(rng.below(n));
    const double expected = static_cast<double>(kCount) / n;
    double chi_square = 0.0;
    for (const int count : histogram) chi_square += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_square, n - 1.0 + 5.0 * std::sqrt(2.0 * n)) << n;
  }
  for (int i = 0; i < 100; ++i) EXPECT_LT(rng.below(0x80000001u), 0x80000001u);
}

// A bound just over half of 2^32 rejects almost half of the draws; without that the lower half would come twice as
// often.
TEST(Rng, BelowHasNoModuloBias) {
  Rng rng(9, "bias");
  constexpr int kCount = 30000;
  constexpr std::uint32_t kBound = 0xC0000000u;
  int low = 0;
  for (int i = 0; i < kCount; ++i) low += rng.below(kBound) < 0x40000000u ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(low) / kCount, 1.0 / 3.0, 4.0 * std::sqrt(2.0 / 9.0 / kCount));
}

}  // namespace
}  // namespace rubble
