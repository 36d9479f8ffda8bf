#include "arenas/truth/truth_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arenas/generate/generate.h"
#include "arenas/model/geometry.h"
#include "base/error.h"
#include "tests/support/arenas_draw.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using testing::arena;

int count(const OccupancyGrid& map, Occupancy what) {
  int n = 0;
  for (const Occupancy o : map.cells()) n += o == what ? 1 : 0;
  return n;
}

Occupancy at(const OccupancyGrid& map, double x, double y) { return map[map.cell({x, y})]; }

/// Whether some free cell lies at the border of the map or beside an unknown cell.
bool leaks(const OccupancyGrid& map) {
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Free) continue;
      for (const Cell c : {Cell{x + 1, y}, Cell{x - 1, y}, Cell{x, y + 1}, Cell{x, y - 1}}) {
        if (!map.inside(c) || map[c] == Occupancy::Unknown) return true;
      }
    }
  }
  return false;
}

TEST(TruthMap, RoomOfOnePalletHasItsExactCounts) {
  const Arena a = arena({"+---+",  //
                         "| S |",  //
                         "+---+"});
  // Walls lie on cell centres: 24 cells a pallet edge at 0.05 m, one of which is the wall.
  const OccupancyGrid map = truth_map(a, 0.05);
  EXPECT_EQ(count(map, Occupancy::Free), 23 * 23);
  EXPECT_EQ(count(map, Occupancy::Occupied), 4 * 24);
  const OccupancyGrid coarse = truth_map(a, 0.1);
  EXPECT_EQ(count(coarse, Occupancy::Free), 11 * 11);
  EXPECT_EQ(count(coarse, Occupancy::Occupied), 4 * 12);
}

TEST(TruthMap, LShapedHallHasItsExactCounts) {
  const Arena a = arena({"+---+---+",  //
                         "| . |    ",  //
                         "+   +---+",  //
                         "| .   S |",  //
                         "+---+---+"});
  const OccupancyGrid map = truth_map(a, 0.05);
  EXPECT_EQ(count(map, Occupancy::Free), 47 * 23 + 23 * 24);
  EXPECT_EQ(count(map, Occupancy::Occupied), 8 * 24);
  EXPECT_EQ(at(map, 1.8, 1.8), Occupancy::Unknown);
}

TEST(TruthMap, MarginOfUnknownIsLeftAround) {
  const Arena a = arena({"+---+", "| S |", "+---+"});
  for (const double margin : {0.0, 0.5, 2.0}) {
    const OccupancyGrid map = truth_map(a, 0.05, 0.35, margin);
    EXPECT_LE(map.frame().x0, a.min_corner.x - margin + 0.026);
    EXPECT_GE(map.frame().x0 + map.width() * 0.05, a.max_corner.x + margin - 0.026);
    EXPECT_EQ(count(map, Occupancy::Free), 23 * 23);
  }
}

TEST(TruthMap, OccupiedCellsAreWallLengthOverResolution) {
  for (const double resolution : {0.02, 0.04, 0.05, 0.1}) {
    GenerateConfig config;
    config.victims = 0;
    config.seed = 5;
    const Arena a = parse_arena(generate_arena(config), "generated");
    double length = 0.0;
    for (const Solid& solid : a.solids) length += signed_area(solid.outline) / 0.02;
    const int occupied = count(truth_map(a, resolution), Occupancy::Occupied);
    const double ends = 2.0 * static_cast<double>(a.solids.size());  // each end may share or add a cell
    EXPECT_NEAR(occupied, length / resolution, ends) << resolution;
  }
}

TEST(TruthMap, WallsAreClosedAtAnyResolution) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    GenerateConfig config;
    config.seed = seed;
    config.columns = 5;
    config.rows = 4;
    const Arena a = parse_arena(generate_arena(config), "generated");
    for (const double resolution : {0.013, 0.02, 0.037, 0.05, 0.06, 0.1, 0.17}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " resolution " + std::to_string(resolution));
      EXPECT_FALSE(leaks(truth_map(a, resolution)));
    }
  }
}

TEST(TruthMap, SlantedThinWallIsClosedToo) {
  const Arena a = arena({"+---+---+---+",  //
                         "| .   .   . |",  //
                         "+   +   +   +",  //
                         "| S   .   . |",  //
                         "+---+---+---+"},
                        "walls: [{from_m: [1.0, 0.0], to_m: [2.9, 2.4], thickness_m: 0.01}]\n");
  for (const double resolution : {0.02, 0.05, 0.1}) {
    const OccupancyGrid map = truth_map(a, resolution);
    EXPECT_EQ(at(map, 0.6, 0.6), Occupancy::Free);
    EXPECT_EQ(at(map, 3.2, 0.6), Occupancy::Unknown) << "behind the wall nobody gets";
    EXPECT_FALSE(leaks(map));
  }
}

TEST(TruthMap, OnlySolidsThatReachTheSliceAboveTheirFloorAreOccupied) {
  const Arena a = arena({"+---+---+---+",  //
                         "| .3  .   S |",  //
                         "+---+---+---+"},
                        "boxes:\n"
                        "  - {x_m: 1.8, y_m: 0.3, length_m: 0.1, height_m: 0.3}\n"                 // too low
                        "  - {x_m: 1.8, y_m: 0.6, length_m: 0.1, height_m: 0.4}\n"                 // high enough
                        "  - {x_m: 1.8, y_m: 0.9, length_m: 0.1, height_m: 0.4, bottom_m: 0.5}\n"  // hangs above
                        "  - {x_m: 1.0, y_m: 0.6, length_m: 0.1, height_m: 0.8}\n"                 // too low up there
                        "  - {x_m: 1.0, y_m: 0.9, length_m: 0.1, height_m: 1.1}\n");               // high enough
  const OccupancyGrid map = truth_map(a, 0.05);
  EXPECT_EQ(at(map, 1.8, 0.3), Occupancy::Free);
  EXPECT_NE(at(map, 1.8, 0.6), Occupancy::Free);
  EXPECT_EQ(at(map, 1.8, 0.9), Occupancy::Free);
  // The platform of 0.63 m is higher than the slice: its edge is a wall, and nobody gets onto it.
  EXPECT_EQ(at(map, 1.2, 0.6), Occupancy::Occupied);
  EXPECT_EQ(at(map, 0.6, 0.6), Occupancy::Unknown);
}

TEST(TruthMap, RiserBelowTheSliceIsNoWall) {
  const Arena a = arena({"+---+---+",  //
                         "| .1  S |",  //
                         "+---+---+"});
  EXPECT_EQ(count(truth_map(a, 0.05), Occupancy::Free), 47 * 23);
  EXPECT_EQ(count(truth_map(a, 0.05, 0.1), Occupancy::Free), 23 * 23);
}

TEST(TruthMap, RampFlankIsAWallWhereItRisesAboveTheSlice) {
  const Arena a = arena({"+---+",  //
                         "| > |",  //
                         "+   +",  //
                         "| S |",  //
                         "+---+"});
  const double rise = 1.2 * std::tan(10.0 * 3.14159265358979 / 180.0);
  const OccupancyGrid map = truth_map(a, 0.05, 0.5 * rise);
  EXPECT_EQ(at(map, 0.3, 1.2), Occupancy::Free);
  EXPECT_EQ(at(map, 0.9, 1.2), Occupancy::Occupied);
}

TEST(TruthMap, InsideOfABlockAndAnUnreachableRoomAreUnknown) {
  const Arena a = arena({"+---+---+---+",  //
                         "| #   S | . |",  //
                         "+---+---+---+"});
  const OccupancyGrid map = truth_map(a, 0.05);
  EXPECT_EQ(at(map, 0.6, 0.6), Occupancy::Unknown);
  EXPECT_EQ(at(map, 3.0, 0.6), Occupancy::Unknown);
  EXPECT_EQ(at(map, 1.2, 0.6), Occupancy::Occupied) << "the block's face";
  EXPECT_EQ(at(map, 2.4, 0.6), Occupancy::Occupied) << "the wall between";
  EXPECT_EQ(at(map, 3.6, 0.6), Occupancy::Unknown) << "a wall seen from the closed room only";
  EXPECT_EQ(count(map, Occupancy::Free), 23 * 23);
}

/// Second method: the outline of every solid sampled densely; no sample may lie in a free cell's inner half.
TEST(TruthMap, NoWallRunsThroughTheMiddleOfAFreeCell) {
  GenerateConfig config;
  config.seed = 3;
  const Arena a = parse_arena(generate_arena(config), "generated");
  const OccupancyGrid map = truth_map(a, 0.05);
  for (const Solid& solid : a.solids) {
    if (solid.z_bottom > 0.35) continue;  // the lid of a victim's box, above the slice
    for (std::size_t i = 0; i < solid.outline.size(); ++i) {
      const TPoint2D along = solid.outline[(i + 1) % solid.outline.size()] - solid.outline[i];
      for (int k = 0; k <= 2000; ++k) {
        const TPoint2D p = solid.outline[i] + along * (k / 2000.0);
        const TPoint2D off = p - map.centre(map.cell(p));
        const bool is_middle = std::abs(off.x) < 0.0125 && std::abs(off.y) < 0.0125;
        EXPECT_FALSE(is_middle && map[map.cell(p)] == Occupancy::Free);
      }
    }
  }
}

TEST(TruthMap, TooFineForTheArenaIsOneLineWithTheRemedy) {
  const Arena a = arena({"+---+", "| S |", "+---+"});
  try {
    truth_map(a, 1e-4);
    FAIL() << "a map of half a billion cells was made";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("at most 60 million"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("resolution"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace rubble::arenas
