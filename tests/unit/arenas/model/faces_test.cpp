#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arenas/model/arena.h"
#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "arenas/model/risers.h"
#include "base/rng.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPoint3D;

FloorPatch flat(double x, double y, double edge, double z) {
  return {rectangle({x, y}, edge, edge), z, 0.0, 0.0, "flat"};
}

/// Rises to the east from z = 0 at its western edge.
FloorPatch ramp_east(double x, double y, double edge, double slope) {
  return {rectangle({x, y}, edge, edge), 0.0, slope, 0.0, "ramp"};
}

double riser_area(const Arena& arena) {
  double area = 0.0;
  for (const Riser& r : risers(arena)) {
    const double length = std::hypot(r.b.x - r.a.x, r.b.y - r.a.y);
    area += 0.5 * length * (r.high_a - r.low_a + r.high_b - r.low_b);
  }
  return area;
}

TPoint3D normal(const Face& face) {
  const TPoint3D u = face.vertices[1] - face.vertices[0];
  const TPoint3D v = face.vertices[2] - face.vertices[0];
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

TEST(Risers, FlushNeighboursLeaveNone) {
  Arena arena;
  arena.floor = {flat(0.6, 0.6, 1.2, 0.0), ramp_east(1.8, 0.6, 1.2, 0.2)};
  for (const Riser& r : risers(arena)) EXPECT_GT(std::max(r.a.x, r.b.x), 1.2 + 1e-9) << "a riser at the flush edge";
}

TEST(Risers, FreeRampHasTwoTriangularFlanksAndABack) {
  Arena arena;
  arena.floor = {ramp_east(0.5, 0.5, 1.0, 0.3)};
  const auto found = risers(arena);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(riser_area(arena), 0.3 + 2 * 0.15, 1e-12);
  for (const Riser& r : found) EXPECT_FALSE(r.above_floor);
  std::size_t triangles = 0;
  for (const Face& face : faces(arena)) triangles += face.vertices.size() == 3 ? 1 : 0;
  EXPECT_EQ(triangles, 2u);
}

TEST(Risers, StepOntoAFloorStartsAtThatFloor) {
  Arena arena;
  arena.floor = {flat(0.5, 0.5, 1.0, 0.5), flat(1.5, 0.5, 1.0, 0.2)};
  double above_floor = 0.0;
  for (const Riser& r : risers(arena)) {
    if (!r.above_floor) continue;
    above_floor += r.high_a - r.low_a;
    EXPECT_DOUBLE_EQ(r.low_a, 0.2);
    EXPECT_DOUBLE_EQ(r.a.x, 1.0);
  }
  EXPECT_NEAR(above_floor, 0.3, 1e-12);
  EXPECT_NEAR(riser_area(arena), 3 * 0.5 + 3 * 0.2 + 0.3, 1e-12);
}

TEST(Risers, NeighbourAcrossHalfAnEdgeHidesThatHalf) {
  Arena arena;
  arena.floor = {flat(0.5, 0.5, 1.0, 0.4), {rectangle({1.25, 0.25}, 0.5, 0.5), 0.4, 0.0, 0.0, "flat"}};
  EXPECT_NEAR(riser_area(arena), 0.4 * (3.0 + 0.5 + 3 * 0.5), 1e-3);
}

TEST(Risers, OppositeRampsSideBySideMakeTwoTrianglesWhereTheyCross) {
  Arena arena;
  FloorPatch west{rectangle({0.5, 1.5}, 1.0, 1.0), 0.4, -0.4, 0.0, "ramp"};
  arena.floor = {ramp_east(0.5, 0.5, 1.0, 0.4), west};
  double between = 0.0;
  for (const Riser& r : risers(arena)) {
    if (r.above_floor) between += 0.5 * std::abs(r.b.x - r.a.x) * (r.high_a - r.low_a + r.high_b - r.low_b);
  }
  EXPECT_NEAR(between, 2 * 0.5 * 0.5 * 0.4, 1e-12);
}

TEST(Risers, EveryPatchOnTopOfAnotherIsClosedDownToIt) {
  Arena arena;
  arena.floor = {flat(0.0, 0.0, 4.0, 0.1), flat(0.0, 0.0, 0.1, 0.3)};
  EXPECT_NEAR(riser_area(arena), 16 * 0.1 + 0.4 * 0.2, 1e-12);
}

TEST(Faces, SolidHasSidesAndTopAndABottomOnlyWhenItHangs) {
  Arena arena;
  arena.floor = {flat(0.0, 0.0, 4.0, 0.0)};
  arena.solids = {{rectangle({0.0, 0.0}, 1.0, 0.02), 0.0, 1.2, "wall"}};
  const std::size_t floor_faces = 1;
  EXPECT_EQ(faces(arena).size(), floor_faces + 5);
  arena.solids[0].z_bottom = 0.5;
  EXPECT_EQ(faces(arena).size(), floor_faces + 6);
}

TEST(Faces, AreOfAreaAndPointOutwards) {
  Arena arena;
  arena.floor = {ramp_east(0.5, 0.5, 1.0, 0.3)};
  arena.solids = {{rectangle({0.5, 0.5}, 0.2, 0.1, 0.4), 0.5, 1.2, "box"}};
  const TPoint3D inside{0.5, 0.5, 0.05};  // below the ramp
  const TPoint3D in_box{0.5, 0.5, 0.9};
  const auto all = faces(arena);
  ASSERT_EQ(all.size(), 1u + 3u + 6u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TPoint3D n = normal(all[i]);
    EXPECT_GT(n.norm(), 1e-6);
    const TPoint3D from = all[i].vertices[0] - (i < 4 ? inside : in_box);
    EXPECT_GT(n.x * from.x + n.y * from.y + n.z * from.z, 0.0) << "face " << i;
  }
}

TEST(FloorHeight, HigherPatchCarriesAndOutsideThereIsNone) {
  Arena arena;
  arena.floor = {flat(0.0, 0.0, 4.0, 0.1), flat(0.0, 0.0, 0.1, 0.3), ramp_east(2.5, 0.0, 1.0, 0.5)};
  EXPECT_DOUBLE_EQ(floor_height(arena, {1.0, 1.0}), 0.1);
  EXPECT_DOUBLE_EQ(floor_height(arena, {0.01, 0.02}), 0.3);
  EXPECT_DOUBLE_EQ(floor_height(arena, {2.5, 0.0}), 0.25);
  EXPECT_EQ(floor_height(arena, {9.0, 0.0}), -INFINITY);
}

/// Patches whose bounding box, 1 mm larger, touches that of a and b, by asking all.
std::vector<std::size_t> patches_near(const Arena& arena, const TPoint2D& a, const TPoint2D& b) {
  constexpr double kSlack = 1e-3;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < arena.floor.size(); ++i) {
    const Outline& o = arena.floor[i].outline;
    const auto [west, east] = std::minmax_element(o.begin(), o.end(), [](auto& p, auto& q) { return p.x < q.x; });
    const auto [south, north] = std::minmax_element(o.begin(), o.end(), [](auto& p, auto& q) { return p.y < q.y; });
    if (west->x - kSlack <= std::max(a.x, b.x) && east->x + kSlack >= std::min(a.x, b.x) &&
        south->y - kSlack <= std::max(a.y, b.y) && north->y + kSlack >= std::min(a.y, b.y))
      near.push_back(i);
  }
  return near;
}

TEST(PatchIndex, AgreesWithAskingEveryPatch) {
  Rng rng(7, "patch index");
  Arena arena;
  for (int i = 0; i < 80; ++i) {
    const double x = rng.uniform(-6.0, 6.0);
    const double y = rng.uniform(-6.0, 6.0);
    const double length = rng.uniform(0.05, 3.0);
    const double angle = rng.uniform(0.0, 3.0);
    const double gx = rng.uniform(-0.3, 0.3);
    arena.floor.push_back({rectangle({x, y}, length, 0.7 * length, angle), 0.1, gx, 0.1, "ramp"});
  }
  const PatchIndex index(arena);
  for (int i = 0; i < 20000; ++i) {
    const double x = rng.uniform(-9.0, 9.0);
    const double y = rng.uniform(-9.0, 9.0);
    EXPECT_EQ(index.floor_height({x, y}), floor_height(arena, {x, y}));
    const TPoint2D a{x, y};
    const TPoint2D b{x + rng.uniform(-1.0, 1.0), y + rng.uniform(-1.0, 1.0)};
    EXPECT_EQ(index.near(a, b), patches_near(arena, a, b));
  }
}

TEST(Risers, AStepIsTooHighWhereItIsHigherThanTheLimit) {
  // 0 m at a, rising to 0.2 m at b.
  const Riser rising{{0.0, 0.0}, {1.0, 0.0}, 0.0, 0.0, 0.0, 0.2, false};
  EXPECT_NEAR(too_high(rising, 0.1).from, 0.5, 1e-12);
  EXPECT_EQ(too_high(rising, 0.1).to, 1.0);
  const Riser falling{{0.0, 0.0}, {1.0, 0.0}, 0.0, 0.2, 0.0, 0.0, false};
  EXPECT_EQ(too_high(falling, 0.1).from, 0.0);
  EXPECT_NEAR(too_high(falling, 0.1).to, 0.5, 1e-12);
  // Down to the limit itself: all of it but the end.
  const Riser to_the_limit{{0.0, 0.0}, {1.0, 0.0}, 0.0, 0.2, 0.0, 0.1, false};
  EXPECT_EQ(too_high(to_the_limit, 0.1).from, 0.0);
  EXPECT_EQ(too_high(to_the_limit, 0.1).to, 1.0);
  const auto low = too_high(rising, 0.3);
  EXPECT_GE(low.from, low.to);
}

}  // namespace
}  // namespace rubble::arenas
