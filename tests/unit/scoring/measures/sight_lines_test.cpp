#include "scoring/measures/sight_lines.h"

#include <gtest/gtest.h>

namespace rubble::scoring {
namespace {

constexpr double kCell = 0.05;

void fill(OccupancyGrid& grid, double x0, double y0, double x1, double y1, Occupancy what) {
  const Cell low = grid.cell({x0 + 0.5 * kCell, y0 + 0.5 * kCell});
  const Cell high = grid.cell({x1 - 0.5 * kCell, y1 - 0.5 * kCell});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) grid[{x, y}] = what;
}

/// A hall with four solid elements of 2 x 0.7 m, whose insides nobody sees, and two thin walls. `far_faces`: of the
/// elements, known or not.
OccupancyGrid hall(bool far_faces, double far_shift = 0.0) {
  OccupancyGrid grid(GridFrame{180, 180, kCell, 0.0, 0.0}, Occupancy::Unknown);
  fill(grid, 0.45, 0.45, 8.55, 8.55, Occupancy::Occupied);
  fill(grid, 0.5, 0.5, 8.5, 8.5, Occupancy::Free);
  for (const double x : {1.5, 5.3})
    for (const double y : {1.6, 5.2}) {
      fill(grid, x, y, x + 2.0, y + 0.7, Occupancy::Unknown);
      fill(grid, x, y, x + 2.0, y + kCell, Occupancy::Occupied);
      if (far_faces) fill(grid, x, y + 0.65 + far_shift, x + 2.0, y + 0.7 + far_shift, Occupancy::Occupied);
    }
  fill(grid, 4.2, 1.0, 4.25, 4.0, Occupancy::Occupied);
  fill(grid, 1.0, 4.2, 4.0, 4.25, Occupancy::Occupied);
  return grid;
}

TEST(SightLines, FacesThatTheTruthDoesNotKnowAreNoWallsTooMany) {
  const OccupancyGrid truth = hall(false);
  const SightLines lines(truth);
  ASSERT_TRUE(lines.usable());
  EXPECT_NEAR(lines.at(truth, PlanarTransform()).kappa, 1.0, 1e-9);
  EXPECT_GT(lines.at(hall(true), PlanarTransform()).kappa, 0.95);
  // A wall where the truth knows that there is none still costs.
  EXPECT_LT(lines.at(hall(true, 0.5), PlanarTransform()).kappa, 0.9);
}

}  // namespace
}  // namespace rubble::scoring
