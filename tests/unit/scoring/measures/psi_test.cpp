#include "scoring/measures/psi.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/rng.h"

namespace rubble::scoring {
namespace {

OccupancyGrid random_grid(int width, int height, std::uint64_t seed, double wall, double free) {
  OccupancyGrid grid(GridFrame{width, height, 0.05, 0.0, 0.0});
  Rng rng(seed, "grid");
  for (Occupancy& cell : grid.cells()) {
    const double draw = rng.uniform();
    cell = draw < wall ? Occupancy::Occupied : draw < wall + free ? Occupancy::Free : Occupancy::Unknown;
  }
  return grid;
}

/// Eq. (6) word by word.
double brute_force(const OccupancyGrid& a, const OccupancyGrid& b, Occupancy colour) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      if (a[{x, y}] != colour) continue;
      int nearest = 1 << 30;
      for (int v = 0; v < b.height(); ++v)
        for (int u = 0; u < b.width(); ++u)
          if (b[{u, v}] == colour) nearest = std::min(nearest, std::abs(u - x) + std::abs(v - y));
      sum += nearest;
      ++count;
    }
  return sum / count * a.resolution();
}

TEST(Psi, EqualsBruteForceForEveryClassAndDirection) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const OccupancyGrid a = random_grid(23, 17, seed, 0.05, 0.5);
    const OccupancyGrid b = random_grid(23, 17, seed + 100, 0.03, 0.6);
    const Psi result = psi(a, b, 5.0);
    EXPECT_NEAR(result.occupied.map_to_truth, brute_force(a, b, Occupancy::Occupied), 1e-12);
    EXPECT_NEAR(result.occupied.truth_to_map, brute_force(b, a, Occupancy::Occupied), 1e-12);
    EXPECT_NEAR(result.free.map_to_truth, brute_force(a, b, Occupancy::Free), 1e-12);
    EXPECT_NEAR(result.free.truth_to_map, brute_force(b, a, Occupancy::Free), 1e-12);
    EXPECT_NEAR(result.unknown.map_to_truth, brute_force(a, b, Occupancy::Unknown), 1e-12);
    EXPECT_NEAR(result.unknown.truth_to_map, brute_force(b, a, Occupancy::Unknown), 1e-12);
    EXPECT_NEAR(result.literal,
                result.occupied.map_to_truth + result.occupied.truth_to_map + result.free.map_to_truth +
                    result.free.truth_to_map + result.unknown.map_to_truth + result.unknown.truth_to_map,
                1e-12);
  }
}

/// Sizes around the squares in which the sweeps go, and distances that bytes do not hold (255 and more).
TEST(Psi, EqualsBruteForceAcrossBlocksAndForLongDistances) {
  for (const auto& [width, height] :
       {std::pair{16, 16}, {17, 31}, {64, 65}, {130, 63}, {1, 90}, {255, 1}, {256, 1}, {1, 257}, {400, 3}, {3, 700}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    OccupancyGrid a = random_grid(width, height, 1, 0.01, 0.9);
    OccupancyGrid b(a.frame(), Occupancy::Free);
    b[{0, 0}] = Occupancy::Occupied;
    b[{width / 2, height / 2}] = Occupancy::Unknown;
    a[{width - 1, height - 1}] = Occupancy::Occupied;
    const Psi result = psi(a, b, 5.0);
    EXPECT_NEAR(result.occupied.map_to_truth, brute_force(a, b, Occupancy::Occupied), 1e-9);
    EXPECT_NEAR(result.occupied.truth_to_map, brute_force(b, a, Occupancy::Occupied), 1e-9);
    EXPECT_NEAR(result.free.map_to_truth, brute_force(a, b, Occupancy::Free), 1e-9);
    EXPECT_NEAR(result.free.truth_to_map, brute_force(b, a, Occupancy::Free), 1e-9);
    EXPECT_NEAR(result.unknown.map_to_truth, brute_force(a, b, Occupancy::Unknown), 1e-9);
    EXPECT_NEAR(result.unknown.truth_to_map, brute_force(b, a, Occupancy::Unknown), 1e-9);
  }
}

TEST(Psi, EqualImagesHaveNone) {
  const OccupancyGrid a = random_grid(40, 30, 3, 0.1, 0.6);
  const Psi result = psi(a, a, 5.0);
  EXPECT_EQ(result.literal, 0.0);
  EXPECT_EQ(result.mean, 0.0);
}

TEST(Psi, AClassThatOneImageLacksCountsTheCapAndOneThatBothLackNothing) {
  const GridFrame frame{20, 20, 0.05, 0.0, 0.0};
  const OccupancyGrid all_free(frame, Occupancy::Free);
  const OccupancyGrid all_wall(frame, Occupancy::Occupied);
  const Psi result = psi(all_free, all_wall, 5.0);
  EXPECT_EQ(result.occupied.map_to_truth, 5.0);
  EXPECT_EQ(result.occupied.truth_to_map, 5.0);
  EXPECT_EQ(result.free.map_to_truth, 5.0);
  EXPECT_EQ(result.unknown.map_to_truth, 0.0);
  EXPECT_EQ(result.literal, 20.0);
}

TEST(Psi, ScalesWithTheResolutionAndNotWithThePixelCount) {
  OccupancyGrid a(GridFrame{40, 40, 0.05, 0.0, 0.0}, Occupancy::Free);
  OccupancyGrid b = a;
  for (int y = 0; y < 40; ++y) {
    a[{10, y}] = Occupancy::Occupied;
    b[{16, y}] = Occupancy::Occupied;
  }
  EXPECT_NEAR(psi(a, b, 5.0).occupied.map_to_truth, 6 * 0.05, 1e-12);
}

}  // namespace
}  // namespace rubble::scoring
