#include "scoring/walls/overlap.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

constexpr double kTau = 0.5;

OccupancyGrid wall_at(double x, int thickness = 1, double resolution = 0.05) {
  const int n = static_cast<int>(std::lround(4.0 / resolution));
  OccupancyGrid grid(GridFrame{n, n, resolution, 0.0, 0.0}, Occupancy::Free);
  const int column = grid.cell({x, 0.0}).x;
  for (int y = 0; y < n; ++y)
    for (int i = 0; i < thickness; ++i) grid[{column + i, y}] = Occupancy::Occupied;
  return grid;
}

TEST(Overlap, EqualMapsScoreOne) {
  const OccupancyGrid grid = maze();
  const Overlap o = overlap(grid, grid, {}, kTau);
  EXPECT_EQ(o.precision, 1.0);
  EXPECT_EQ(o.recall, 1.0);
  EXPECT_EQ(o.score, 1.0);
}

/// A room of 4 x 3 m, and black for so many metres around it.
OccupancyGrid room_in_black(double around) {
  constexpr double kCell = 0.05;
  const auto cells = [&](double metres) { return static_cast<int>(std::lround(metres / kCell)); };
  OccupancyGrid grid(GridFrame{cells(4.0 + 2.0 * around), cells(3.0 + 2.0 * around), kCell, -around, -around},
                     Occupancy::Occupied);
  for (int y = cells(around); y < cells(3.0 + around); ++y)
    for (int x = cells(around); x < cells(4.0 + around); ++x) grid[{x, y}] = Occupancy::Free;
  for (int x = cells(around); x < cells(3.0 + around); ++x)  // a wall within
    grid[{x, cells(around + 1.5)}] = grid[{x, cells(around + 1.5) + 1}] = Occupancy::Occupied;
  return grid;
}

TEST(Overlap, HowMuchBlackLiesAroundAPlanIsNotTheThicknessOfItsWalls) {
  EXPECT_NEAR(wall_half_thickness(room_in_black(3.0)), 0.05, 0.01);
  EXPECT_EQ(wall_half_thickness(room_in_black(3.0)), wall_half_thickness(room_in_black(8.0)));
  const Overlap o = overlap(room_in_black(8.0), room_in_black(3.0), {}, kTau);
  EXPECT_EQ(o.precision, 1.0);
  EXPECT_EQ(o.recall, 1.0);
}

TEST(Overlap, AShiftedWallLosesWhatTheKernelSays) {
  // 0.3 m apart, half a cell of it is the width of the wall: k = 1 - 0.275 / 0.5.
  const Overlap o = overlap(wall_at(2.325), wall_at(2.025), {}, kTau);
  EXPECT_NEAR(o.precision, 1.0 - 0.275 / 0.5, 1e-5);
  EXPECT_NEAR(o.recall, 1.0 - 0.275 / 0.5, 1e-5);
}

TEST(Overlap, WallsAtTauAndBeyondCountNothing) { EXPECT_EQ(overlap(wall_at(2.6), wall_at(2.0), {}, kTau).score, 0.0); }

TEST(Overlap, SwappingTheMapsSwapsPrecisionAndRecall) {
  const OccupancyGrid a = maze({5, 5, 1});
  const OccupancyGrid b = with_gaps(with_phantoms(thickened(a, 1), 10, 1), 10, 1);
  const TPose2D T(0.3, -0.2, 0.05);
  // Both say something everywhere, so nothing is ignored on either side.
  OccupancyGrid a_known = a;
  OccupancyGrid b_known = b;
  for (OccupancyGrid* grid : {&a_known, &b_known})
    for (Occupancy& cell : grid->cells())
      if (cell == Occupancy::Unknown) cell = Occupancy::Free;
  a_known = padded(a_known, 20);
  b_known = padded(b_known, 20);
  for (OccupancyGrid* grid : {&a_known, &b_known})
    for (Occupancy& cell : grid->cells())
      if (cell == Occupancy::Unknown) cell = Occupancy::Free;
  const Overlap forward = overlap(a_known, b_known, T, kTau);
  const Overlap backward = overlap(b_known, a_known, TPose2D(0, 0, 0) - T, kTau);
  EXPECT_NEAR(forward.precision, backward.recall, 1e-9);
  EXPECT_NEAR(forward.recall, backward.precision, 1e-9);
}

TEST(Overlap, WhatTheTruthDoesNotKnowIsIgnored) {
  OccupancyGrid truth = wall_at(1.0);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 50; x < truth.width(); ++x) truth[{x, y}] = Occupancy::Unknown;
  OccupancyGrid map = truth;
  for (int y = 0; y < truth.height(); ++y) map[{60, y}] = Occupancy::Occupied;
  EXPECT_EQ(overlap(map, truth, {}, kTau).precision, 1.0);
}

TEST(Overlap, WhatTheMapDoesNotKnowCostsRecallOnly) {
  const OccupancyGrid truth = maze({6, 6, 2});
  const Overlap half = overlap(with_coverage(truth, 0.5), truth, {}, kTau);
  EXPECT_NEAR(half.precision, 1.0, 0.01);
  EXPECT_LT(half.recall, 0.7);
}

TEST(Overlap, ThickeningNeverRaisesTheScoreWhateverElseIsWrong) {
  const OccupancyGrid truth = maze({6, 6, 3});
  const OccupancyGrid maps[] = {truth, with_gaps(truth, 30, 1), with_phantoms(truth, 20, 1), with_coverage(truth, 0.6),
                                bent(truth, 0.6)};
  for (const OccupancyGrid& map : maps) {
    for (const double shift : {0.0, 0.1, 0.3}) {
      double last = 2.0;
      for (const int cells : {0, 1, 2, 4, 6}) {
        const double score = overlap(thickened(map, cells), truth, {shift, 0.0, 0.0}, kTau).score;
        EXPECT_LE(score, last + 0.005) << "shift " << shift << ", thickened by " << cells;
        last = score;
      }
    }
  }
}

TEST(Overlap, NoWallsOnEitherSideIsNoScore) {
  const OccupancyGrid truth = maze({3, 3, 1});
  const OccupancyGrid bare(truth.frame(), Occupancy::Free);
  EXPECT_EQ(overlap(bare, truth, {}, kTau).score, 0.0);
  EXPECT_EQ(overlap(truth, bare, {}, kTau).score, 0.0);
  EXPECT_EQ(overlap(bare, bare, {}, kTau).score, 0.0);
}

TEST(WallHalfThickness, IsThatOfTheWallsAtAnyAngle) {
  OccupancyGrid frame(GridFrame{200, 200, 0.05, 0.0, 0.0}, Occupancy::Free);
  for (const double angle_deg : {0.0, 15.0, 30.0, 45.0, 70.0}) {
    const double c = std::cos(deg_to_rad(angle_deg));
    const double s = std::sin(deg_to_rad(angle_deg));
    OccupancyGrid grid = frame;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const TPoint2D p = grid.centre({x, y}) - TPoint2D(5.0, 5.0);
        if (std::abs(-s * p.x + c * p.y) < 0.1 && std::abs(c * p.x + s * p.y) < 4.0) grid[{x, y}] = Occupancy::Occupied;
      }
    EXPECT_NEAR(wall_half_thickness(grid), 0.1, 0.01) << angle_deg << " deg";
  }
}

}  // namespace
}  // namespace rubble::scoring
