#include "base/distance_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"

namespace rubble {
namespace {

Grid<std::uint8_t> random_mask(Rng& rng, int width, int height, double density, double resolution) {
  Grid<std::uint8_t> mask(GridFrame{width, height, resolution, -3.0, 2.0});
  for (auto& cell : mask.cells()) cell = rng.uniform() < density ? static_cast<std::uint8_t>(1 + rng.below(255)) : 0;
  return mask;
}

/// By trying every set cell.
Grid<float> brute_force(const Grid<std::uint8_t>& mask, double cap) {
  std::vector<Cell> set;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask[{x, y}] != 0) set.push_back({x, y});
  Grid<float> distance(mask.frame());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      double least = std::numeric_limits<double>::infinity();
      for (const Cell c : set) {
        const double dx = c.x - x;
        const double dy = c.y - y;
        least = std::min(least, dx * dx + dy * dy);
      }
      distance[{x, y}] = static_cast<float>(std::min(cap, mask.resolution() * std::sqrt(least)));
    }
  return distance;
}

TEST(DistanceTransform, EqualsBruteForceOnRandomMasks) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "mask");
    const int width = 1 + static_cast<int>(rng.below(50));
    const int height = 1 + static_cast<int>(rng.below(50));
    const double density = std::pow(rng.uniform(), 4.0);
    const double resolution = rng.uniform(0.01, 0.2);
    const double cap = rng.below(3) == 0 ? 1e9 : rng.uniform(0.0, 40.0 * resolution);
    const auto mask = random_mask(rng, width, height, density, resolution);
    const Grid<float> distance = distance_transform(mask, cap);
    EXPECT_EQ(distance.frame(), mask.frame());
    EXPECT_EQ(distance.cells(), brute_force(mask, cap).cells());
  }
}

// Rows with distances on both sides of the reach of the window search, sparse rows and crowded ones.
TEST(DistanceTransform, EqualsBruteForceOnWideGapsAndCrowds) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "gaps");
    const int width = 200 + static_cast<int>(rng.below(250));
    const int height = 200 + static_cast<int>(rng.below(200));
    Grid<std::uint8_t> mask(GridFrame{width, height, 0.05, 0.0, 0.0});
    const int crowd = static_cast<int>(rng.below(120));
    for (int i = 0; i < 150; ++i) {
      const auto x = static_cast<int>(rng.below(static_cast<std::uint32_t>(width - crowd)));
      const auto y = static_cast<int>(rng.below(20));
      mask[{x, y}] = 1;
    }
    const double cap = rng.below(2) == 0 ? 1e9 : rng.uniform(0.0, 20.0);
    ASSERT_EQ(distance_transform(mask, cap).cells(), brute_force(mask, cap).cells());
  }
}

TEST(DistanceTransform, FarCellsAreExactToo) {
  for (const int width : {700, 64, 1}) {
    Grid<std::uint8_t> mask(GridFrame{width, 300, 1.0, 0.0, 0.0});
    const Cell a{width / 10, 3};
    const Cell b{width - 1, 290};
    mask[a] = mask[b] = 1;
    for (const double cap : {50.0, 127.0, 127.5, 128.0, 200.0, std::numeric_limits<double>::infinity()}) {
      const Grid<float> distance = distance_transform(mask, cap);
      for (int y = 0; y < 300; ++y)
        for (int x = 0; x < width; ++x) {
          const double to_a = std::hypot(x - a.x, y - a.y);
          const double to_b = std::hypot(x - b.x, y - b.y);
          ASSERT_FLOAT_EQ((distance[{x, y}]), static_cast<float>(std::min({to_a, to_b, cap}))) << x << ' ' << y;
        }
    }
  }
}

TEST(DistanceTransform, NothingSetGivesTheCapEverywhere) {
  const Grid<std::uint8_t> mask(GridFrame{70, 30, 0.05, 0.0, 0.0});
  for (const double cap : {0.0, 0.3, 20.0, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(distance_transform(mask, cap).cells(), std::vector<float>(mask.cells().size(), static_cast<float>(cap)));
}

TEST(DistanceTransform, AnEmptyGridIsFine) {
  EXPECT_TRUE(distance_transform(Grid<std::uint8_t>(GridFrame{0, 0, 0.05, 0.0, 0.0}), 1.0).cells().empty());
}

}  // namespace
}  // namespace rubble
