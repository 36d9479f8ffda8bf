#include "explore/plan/pockets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

TEST(Pockets, ArePiecesOfUnknownGroundWithKnownGroundAllRound) {
  const OccupancyGrid cells = test::drawn({
      "            ",
      " .......... ",
      " .#  #. ... ",
      " .#  #.     ",
      " .####. ... ",
      " .......... ",
      "            ",
  });
  const double cell = cells.resolution() * cells.resolution();
  const Grid<std::uint8_t> found = pockets(cells, 5.0 * cell);
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width(); ++x) {
      const bool in_barrel = x >= 3 && x <= 4 && y >= 3 && y <= 4;
      EXPECT_EQ((found[{x, y}] != 0), in_barrel) << x << ", " << y << ": the other piece goes on to the end of the map";
    }
  const Grid<std::uint8_t> none = pockets(cells, 4.0 * cell);
  EXPECT_EQ(std::count(none.cells().begin(), none.cells().end(), 0), static_cast<long>(cells.frame().size()))
      << "not smaller than that";
}

TEST(Pockets, LeadNowhere) {
  const OccupancyGrid cells = test::drawn({
      "      ",
      " .... ",
      " . .. ",
      " .... ",
      "      ",
  });
  const Grid<std::uint8_t> small = pockets(cells, 1.0);
  EXPECT_NE((small[{2, 2}]), 0);
  EXPECT_FALSE(leads_on(cells, small, {3, 2})) << "beside the pocket";
  EXPECT_TRUE(leads_on(cells, small, {1, 2})) << "beside the end of the map";
}

}  // namespace
}  // namespace rubble::explore
