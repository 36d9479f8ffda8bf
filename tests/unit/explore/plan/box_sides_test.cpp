#include "explore/plan/box_sides.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

const GridFrame kFrame{80, 80, 0.05, -2.0, -2.0};

/// The cells below a straight piece of a board, `length` x `thickness` [m], about the middle of the grid.
Grid<std::uint8_t> board(double length, double thickness, double angle) {
  Grid<std::uint8_t> cells(kFrame);
  for (double along = -0.5 * length; along <= 0.5 * length; along += 0.005)
    for (double aside = -0.5 * thickness; aside <= 0.5 * thickness; aside += 0.005)
      cells[kFrame.cell({0.013 + along * std::cos(angle) - aside * std::sin(angle),
                         0.021 + along * std::sin(angle) + aside * std::cos(angle)})] = 1;
  return cells;
}

int count(const Grid<std::uint8_t>& cells) {
  int set = 0;
  for (const std::uint8_t c : cells.cells()) set += c;
  return set;
}

double share_kept(Grid<std::uint8_t> cells) {
  const int before = count(cells);
  keep_box_sides(cells);
  return static_cast<double>(count(cells)) / before;
}

TEST(BoxSides, AreKeptInEveryDirection) {
  for (int degrees = 0; degrees < 180; degrees += 3) {
    SCOPED_TRACE(testing::Message() << degrees << " deg");
    EXPECT_GE(share_kept(board(0.45, 0.0, deg_to_rad(degrees))), 0.8);
  }
}

TEST(BoxSides, LongerAndShorterRowsAreNone) {
  for (int degrees = 0; degrees < 180; degrees += 3) {
    SCOPED_TRACE(testing::Message() << degrees << " deg");
    EXPECT_LE(share_kept(board(1.2, 0.0, deg_to_rad(degrees))), 0.1) << "the edge of a ramp";
    EXPECT_EQ(share_kept(board(0.15, 0.0, deg_to_rad(degrees))), 0.0) << "a block";
  }
}

TEST(BoxSides, WhatIsWiderThanABoardIsNone) {
  for (int degrees = 0; degrees < 180; degrees += 3)
    EXPECT_LE(share_kept(board(0.45, 0.25, deg_to_rad(degrees))), 0.2) << degrees << " deg";
}

TEST(BoxSides, TheThreeSidesOfABoxAreKept) {
  Grid<std::uint8_t> cells(kFrame);
  for (int i = 0; i < 9; ++i) cells[{30, 30 + i}] = cells[{39, 30 + i}] = cells[{30 + i, 39}] = 1;
  EXPECT_EQ(share_kept(cells), 1.0);
}

}  // namespace
}  // namespace rubble::explore
