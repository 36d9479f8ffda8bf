#include "explore/paper/prospects.h"

#include <gtest/gtest.h>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

/// A room with a wall across it that leaves a gap, and unknown ground of so many metres beyond.
struct Halved {
  Halved(double gap, double unknown) {
    test::fill(cells, 4.0, 0.0, 4.1, 4.0, Occupancy::Occupied);
    test::fill(cells, 4.0, 2.0 - 0.5 * gap, 4.1, 2.0 + 0.5 * gap, Occupancy::Free);
    test::fill(cells, 6.0, 1.0, 6.0 + unknown, 1.0 + unknown, Occupancy::Unknown);
  }
  std::size_t prospects(bool settled = false) {
    return explore::prospects(test::measured(cells), {2.0, 2.0, 0.0}, 5, [&](const TPoint2D&) { return settled; });
  }
  OccupancyGrid cells = test::room(8.0, 4.0);
};

TEST(Prospects, AreGroundThatTheBodyCouldGetTo) {
  EXPECT_EQ(Halved(0.8, 1.0).prospects(), 1u);
  EXPECT_EQ(Halved(0.15, 1.0).prospects(), 0u) << "behind a hole in the wall";
  EXPECT_EQ(Halved(0.8, 0.4).prospects(), 0u) << "a pocket";
  EXPECT_EQ(Halved(0.8, 1.0).prospects(true), 0u) << "it was there";
  EXPECT_EQ(prospects({}, {}, 5, [](const TPoint2D&) { return false; }), 0u) << "nothing was seen yet";
}

TEST(Prospects, WhatWasFeltIsNoWall) {
  Halved halved(0.8, 1.0);
  Traversable floor = traversable(halved.cells);
  std::vector<TPoint2D> felt;
  for (double y = 1.5; y < 2.5; y += 0.05) felt.push_back({3.0, y});
  add_obstacles(floor, felt, 0.0);
  measure_clearance(floor, 1.2);
  EXPECT_EQ(prospects(floor, {2.0, 2.0, 0.0}, 5, [](const TPoint2D&) { return false; }), 1u);
}

/// A ball lies in the gap.
TEST(Prospects, ThingsInTheWayAreNoneOnceTheyArePushedAside) {
  Halved halved(0.8, 1.0);
  test::fill(halved.cells, 3.85, 1.8, 4.25, 2.2, Occupancy::Occupied);
  const Traversable floor = test::measured(halved.cells);
  const auto count = [](const Traversable& f) {
    return prospects(f, {2.0, 2.0, 0.0}, 5, [](const TPoint2D&) { return false; });
  };
  EXPECT_EQ(count(floor), 0u);
  EXPECT_EQ(count(with_all_pushed(floor, 0.0)), 1u);
}

}  // namespace
}  // namespace rubble::explore
