#include "sim/laser/range_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "base/angle.h"

namespace rubble::sim::test {
namespace {

/// Half width of the data sheet's accuracy band at range r [m].
double accuracy_band(const robot::LaserModel& laser, double r) {
  return r < laser.accuracy_near_to ? laser.accuracy_near : laser.accuracy_far + laser.accuracy_far_share * r;
}

constexpr float kInf = std::numeric_limits<float>::infinity();

void expect_the_data_sheets_band(const robot::LaserModel& laser, std::initializer_list<float> distances) {
  for (const float range : distances) {
    double worst_bias = 0.0;
    double spread = 0.0;
    int outside = 0;
    const int devices = 40;
    const int scans = 20;
    for (int seed = 1; seed <= devices; ++seed) {
      RangeNoise noise(laser, 1.0, static_cast<std::uint64_t>(seed));
      double sum = 0.0;
      double squares = 0.0;
      int n = 0;
      for (int k = 0; k < scans; ++k) {
        std::vector<float> ranges(682, range);
        noise.apply(ranges);
        for (const float r : ranges) {
          ASSERT_TRUE(std::isfinite(r));
          const double error = r - range;
          sum += error;
          squares += error * error;
          ++n;
          outside += std::abs(error) > accuracy_band(laser, range) + 0.0005 ? 1 : 0;
        }
      }
      const double bias = sum / n;
      worst_bias = std::max(worst_bias, std::abs(bias));
      spread += std::sqrt(squares / n - bias * bias) / devices;
    }
    const double share = outside / (devices * scans * 682.0);
    std::cout << range << " m: sigma " << 1e3 * spread << " mm, largest bias " << 1e3 * worst_bias << " mm, outside +-"
              << 1e3 * accuracy_band(laser, range) << " mm: " << share << '\n';
    EXPECT_NEAR(spread, 0.25 * accuracy_band(laser, range), 0.04 * accuracy_band(laser, range));
    EXPECT_LE(worst_bias, 0.26 * accuracy_band(laser, range) + 0.0002);
    EXPECT_LT(share, 0.001);
  }
}

TEST(RangeNoise, StaysInTheDataSheetsBandWithItsSigma) { expect_the_data_sheets_band({}, {0.3f, 0.9f, 2.0f, 3.8f}); }

TEST(RangeNoise, AUtm30lxIsOffByThirtyMillimetresToTenMetresAndByFiftyBeyond) {
  const robot::LaserModel laser = robot::laser_model("UTM-30LX");
  EXPECT_EQ(accuracy_band(laser, 9.9), 0.03);
  EXPECT_EQ(accuracy_band(laser, 10.1), 0.05);
  expect_the_data_sheets_band(laser, {0.3f, 9.0f, 11.0f, 29.0f});
}

TEST(RangeNoise, IsSilentWhenTurnedOff) {
  RangeNoise noise(robot::LaserModel{}, 0.0, 1);
  std::vector<float> ranges{1.2344f, 1.2346f, 3.0f, kInf, 0.5f};
  noise.apply(ranges);
  EXPECT_EQ(ranges, (std::vector<float>{1234 * 0.001f, 1235 * 0.001f, 3000 * 0.001f, kInf, 500 * 0.001f}));
}

/// A post in front of a wall: two depth edges.
std::vector<float> post() {
  std::vector<float> ranges(682, 3.0f);
  for (std::size_t i = 300; i < 340; ++i) ranges[i] = 1.0f;
  return ranges;
}

TEST(RangeNoise, OnlyTheBeamsAtADepthEdgeMix) {
  int mixed = 0;
  int lost = 0;
  const int trials = 2000;
  RangeNoise noise(robot::LaserModel{}, 1.0, 5);
  for (int k = 0; k < trials; ++k) {
    std::vector<float> ranges = post();
    noise.apply(ranges);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const bool edge = i == 299 || i == 300 || i == 339 || i == 340;
      if (!edge) {
        ASSERT_TRUE(std::isfinite(ranges[i])) << i;
        ASSERT_NEAR(ranges[i], i > 299 && i < 340 ? 1.0f : 3.0f, 0.05f) << i;
        continue;
      }
      if (std::isnan(ranges[i])) ++lost;
      if (ranges[i] > 1.1f && ranges[i] < 2.9f) ++mixed;
    }
  }
  std::cout << "of the beams next to an edge " << 100.0 * mixed / (4 * trials) << " % lie between, "
            << 100.0 * lost / (4 * trials) << " % are lost\n";
  EXPECT_NEAR(mixed / (4.0 * trials), 0.33, 0.08);
  EXPECT_NEAR(lost / (4.0 * trials), 0.41, 0.08);
}

TEST(RangeNoise, AWallSeenEdgeOnGetsLost) {
  // A wall along the line of sight, 0.1 m aside: incidence grows with range.
  const robot::LaserModel laser;
  std::vector<float> exact(682, kInf);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double bearing = laser.angle_min + static_cast<double>(i) * laser.angle_step;
    if (bearing > 0.0 && bearing < 1.5) exact[i] = static_cast<float>(0.1 / std::sin(bearing));
    if (exact[i] > 4.0f) exact[i] = kInf;
  }
  int lost_flat = 0, flat = 0, lost_steep = 0, steep = 0;
  RangeNoise noise(laser, 1.0, 5);
  for (int k = 0; k < 200; ++k) {
    std::vector<float> ranges = exact;
    noise.apply(ranges);
    for (std::size_t i = 342; i < 500; ++i) {
      const double bearing = laser.angle_min + static_cast<double>(i) * laser.angle_step;
      if (!(exact[i] < kInf)) continue;
      const bool is_steep = rad_to_deg(bearing) > 12.0;  // incidence below 78 deg
      (is_steep ? steep : flat) += 1;
      if (std::isnan(ranges[i])) (is_steep ? lost_steep : lost_flat) += 1;
    }
  }
  EXPECT_EQ(lost_steep, 0);
  EXPECT_GT(lost_flat, flat / 10);
}

}  // namespace
}  // namespace rubble::sim::test
