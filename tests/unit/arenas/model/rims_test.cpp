#include "arenas/model/rims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"

namespace rubble::arenas {
namespace {

/// A pallet with its middle at (x, 0), `z` above the ground.
FloorPatch pallet(double x, double z = 0.0) { return {rectangle({x, 0.0}, kPallet, kPallet), z, 0.0, 0.0, "flat"}; }

constexpr double kCorner = 0.03;  ///< a board on one edge covers half its thickness of the next [m]

double length_of(const std::vector<Rim>& rims) {
  double sum = 0.0;
  for (const Rim& rim : rims) sum += std::hypot(rim.b.x - rim.a.x, rim.b.y - rim.a.y);
  return sum;
}

TEST(Rims, AreWhereNoFloorGoesOn) {
  Arena arena;
  arena.floor = {pallet(0.0), pallet(kPallet)};
  EXPECT_NEAR(length_of(open_rims(arena, 0.1)), 6.0 * kPallet, 1e-9);
  for (const Rim& rim : open_rims(arena, 0.1)) EXPECT_FALSE(std::abs(rim.a.x - 0.6) < 1e-9 && rim.a.x == rim.b.x);
}

TEST(Rims, WallsThatStandOnThemCloseThem) {
  Arena arena;
  arena.floor = {pallet(0.0)};
  const auto add = [&](double from, double to, double z_bottom, double z_top) {
    arena.solids.push_back({strip({from, 0.6}, {to, 0.6}, 0.02), z_bottom, z_top, "wall"});
  };
  add(-0.6, 0.0, 0.0, 1.2);
  EXPECT_NEAR(length_of(open_rims(arena, 0.1)), 3.5 * kPallet, kCorner);
  add(0.2, 0.6, 0.0, 1.2);
  EXPECT_NEAR(length_of(open_rims(arena, 0.1)), 3.0 * kPallet, kCorner) << "through a gap of 0.2 m nothing drives";
  arena.solids.clear();
  add(-0.6, 0.6, 1.0, 1.2);
  EXPECT_NEAR(length_of(open_rims(arena, 0.1)), 4.0 * kPallet, kCorner) << "under a lath it does";
  arena.solids.back().z_bottom = 0.0;
  arena.solids.back().gives_way = true;
  EXPECT_NEAR(length_of(open_rims(arena, 0.1)), 4.0 * kPallet, kCorner) << "and through a veil";
}

TEST(Rims, OfFloorsHigherThanTheClimbAreStepsToTheGround) {
  Arena arena;
  arena.floor = {pallet(0.0, 0.2)};
  EXPECT_TRUE(open_rims(arena, 0.1).empty());
  EXPECT_NEAR(length_of(open_rims(arena, 0.3)), 4.0 * kPallet, 1e-6);
}

}  // namespace
}  // namespace rubble::arenas
