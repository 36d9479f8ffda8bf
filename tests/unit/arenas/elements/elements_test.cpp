#include "arenas/elements/elements.h"
#include "tests/support/source_dir.h"

#include <gtest/gtest.h>

#include <string>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "arenas/model/geometry.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

Arena placed(const std::string& type, double rotation_deg = 0.0, const Element* wall = nullptr,
             std::optional<int> mount = std::nullopt) {
  Element element;
  element.type = type;
  element.rotation = deg_to_rad(rotation_deg);
  element.mount_point = mount;
  Arena arena;
  place(element, wall, arena);
  return arena;
}

/// Whether a solid stands at (x, y) at height z.
bool blocked(const Arena& arena, double x, double y, double z) {
  for (const Solid& s : arena.solids) {
    if (contains(s.outline, {x, y}) && s.z_bottom <= z && z <= s.z_top) return true;
  }
  return false;
}

TEST(Elements, WallTurnsClockwiseFromTheNorthernEdge) {
  const std::map<int, TPoint2D> edges{{0, {0.0, 0.6}}, {90, {0.6, 0.0}}, {180, {0.0, -0.6}}, {270, {-0.6, 0.0}}};
  for (const auto& [rotation, middle] : edges) {
    const Arena arena = placed("small_wall", rotation);
    ASSERT_EQ(arena.solids.size(), 1u);
    EXPECT_TRUE(blocked(arena, middle.x, middle.y, 1.19)) << rotation;
    EXPECT_FALSE(blocked(arena, middle.x, middle.y, 1.21));
    EXPECT_NEAR(signed_area(arena.solids[0].outline), 1.2 * 0.01, 1e-12);
  }
  EXPECT_TRUE(blocked(placed("tall_wall"), 0.0, 0.6, 2.39));
}

TEST(Elements, FullRampRisesAwayFromItsFrontHalfRampTowardsIt) {
  const Arena full = placed("full_ramp");
  EXPECT_NEAR(floor_height(full, {0.3, 0.6}), 0.0, 1e-12);
  EXPECT_NEAR(floor_height(full, {0.3, -0.6}), 0.339, 1e-12);
  const Arena half = placed("half_ramp");
  EXPECT_NEAR(floor_height(half, {0.3, -0.6}), 0.0, 1e-12);
  EXPECT_NEAR(floor_height(half, {0.3, 0.0}), 0.17, 1e-12);
  EXPECT_EQ(floor_height(half, {0.3, 0.1}), -INFINITY);
}

TEST(Elements, RampsTurnWithTheirElement) {
  for (const double rotation : {90.0, 180.0, 270.0}) {
    const Arena arena = placed("full_ramp", rotation);
    const double c = std::cos(deg_to_rad(-rotation));
    const double s = std::sin(deg_to_rad(-rotation));
    EXPECT_NEAR(floor_height(arena, {s * 0.5, -c * 0.5}), 0.339 * 1.1 / 1.2, 1e-9) << rotation;
  }
}

TEST(Elements, ElevatedRampMeetsTheElevatedFloor) {
  EXPECT_NEAR(floor_height(placed("simple_elev_ramp"), {0.0, 0.6}), 1.2, 1e-12);
  const Arena floor = placed("elevated_floor_120");
  EXPECT_TRUE(blocked(floor, 0.0, -0.6, 1.2));
  EXPECT_FALSE(blocked(floor, 0.0, 0.0, 1.1)) << "open below";
  EXPECT_TRUE(floor.floor.empty()) << "the ground below is to be driven on";
  EXPECT_FALSE(covers_pallet("elevated_floor_120"));
}

TEST(Elements, StairsClimbInEqualRisers) {
  const Arena solid = placed("stairs_120_solid");
  ASSERT_EQ(solid.floor.size(), 5u);
  const Arena open = placed("stairs_120");
  EXPECT_TRUE(open.floor.empty());
  for (int i = 0; i < 5; ++i) {
    const double z = 0.23 + 0.2 * i;
    EXPECT_NEAR(floor_height(solid, {0.0, -0.5 + 0.2325 * i}), z, 1e-12);
    EXPECT_TRUE(blocked(open, 0.0, -0.5 + 0.2325 * i, z));
    EXPECT_FALSE(blocked(open, 0.0, -0.5 + 0.2325 * i, z - 0.05)) << "open below";
  }
}

/// At the wall, where the meshes stand, so that the middle of the pallet is free.
TEST(Elements, BarrelsAndExtinguishersStandAtTheWall) {
  for (const char* type : {"fiducial_barrel", "red_barrel"}) {
    const Arena arena = placed(type);
    EXPECT_TRUE(blocked(arena, 0.0, 0.30, 0.35)) << type;
    EXPECT_TRUE(blocked(arena, 0.29, 0.58, 1.18)) << type;
    EXPECT_FALSE(blocked(arena, 0.0, 0.28, 0.35)) << type;
    EXPECT_FALSE(blocked(arena, 0.0, 0.5, 0.29)) << type;
  }
  const Arena extinguisher = placed("fire_extinguisher");
  EXPECT_TRUE(blocked(extinguisher, -0.31, 0.41, 0.0));
  EXPECT_TRUE(blocked(extinguisher, 0.14, 0.59, 0.88));
  EXPECT_FALSE(blocked(extinguisher, 0.16, 0.5, 0.5));
  EXPECT_FALSE(blocked(extinguisher, 0.0, 0.0, 0.1));
  EXPECT_TRUE(blocked(placed("pvc_pipe"), 0.024, 0.0, 0.3));
  EXPECT_FALSE(blocked(placed("pvc_pipe"), 0.026, 0.0, 0.3));
}

TEST(Elements, AWallWithoutATextureIsNarrower) {
  const Arena arena = placed("small_wall_no_tex");
  EXPECT_TRUE(blocked(arena, 0.49, 0.6, 0.35));
  EXPECT_FALSE(blocked(arena, 0.51, 0.6, 0.35));
}

TEST(Elements, AVictimInACubeLooksAheadFromAboveTheGround) {
  const Arena arena = placed("victim_1");
  ASSERT_EQ(arena.victims.size(), 1u);
  EXPECT_NEAR(arena.victims[0].position.z, 0.4, 1e-12);
  EXPECT_TRUE(blocked(arena, 0.0, -0.19, 0.4)) << "back";
  EXPECT_TRUE(blocked(arena, 0.19, 0.0, 0.4)) << "side";
  EXPECT_TRUE(blocked(arena, 0.0, 0.0, 0.59)) << "lid";
  EXPECT_FALSE(blocked(arena, 0.0, 0.0, 0.1)) << "it does not touch the ground";
  EXPECT_FALSE(blocked(arena, 0.0, 0.19, 0.4)) << "open to +y";
}

TEST(Elements, StepFieldsHaveTheCountsOfTheLeague) {
  const auto columns = [](const char* type, double unit, double base) {
    const Arena arena = placed(type);
    std::map<long, int> counts;
    for (int i = 0; i < 100; ++i) {
      const double z = floor_height(arena, {-0.45 + 0.1 * (i % 10), -0.45 + 0.1 * (i / 10)});
      ++counts[std::isfinite(z) ? std::lround((z - base) / unit) : 0];
      EXPECT_TRUE(i % 10 != i / 10 || std::abs(z - base - 4.0 * unit) < 1e-12) << "the diagonal is the highest";
      EXPECT_TRUE(base == 0.0 || z > base - 1e-12) << "no column is lower than the base";
    }
    return counts;
  };
  const std::map<long, int> league{{0, 9}, {1, 27}, {2, 33}, {3, 21}, {4, 10}};
  EXPECT_EQ(columns("stepfield_red_diagonal", 0.1, 0.05), league);
  EXPECT_EQ(columns("stepfield_orange_diagonal", 0.05, 0.0), league);
}

TEST(Elements, EveryThrowOfAStepFieldIsAnother) {
  const auto heights = [](std::uint64_t thrown) {
    Element element;
    element.type = "stepfield_red_diagonal";
    element.thrown = thrown;
    Arena arena;
    place(element, nullptr, arena);
    std::vector<double> z;
    for (int i = 0; i < 100; ++i) z.push_back(floor_height(arena, {-0.45 + 0.1 * (i % 10), -0.45 + 0.1 * (i / 10)}));
    return z;
  };
  EXPECT_EQ(heights(7), heights(7));
  EXPECT_NE(heights(7), heights(8));
  std::vector<double> a = heights(7);
  std::vector<double> b = heights(8);
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b) << "the same columns";
  EXPECT_TRUE(is_thrown("stepfield_orange_diagonal"));
  EXPECT_FALSE(is_thrown("crossing_ramps"));
}

TEST(Elements, HolesAreOpenAndTheRestOfTheWallIsNot) {
  const Arena arena = placed("wall_holes1");
  EXPECT_FALSE(blocked(arena, -0.28, 0.6, 0.31));
  EXPECT_FALSE(blocked(arena, -0.29, 0.6, 0.90));
  EXPECT_FALSE(blocked(arena, 0.29, 0.6, 0.59));
  EXPECT_TRUE(blocked(arena, -0.28, 0.6, 0.6));
  EXPECT_TRUE(blocked(arena, 0.0, 0.6, 0.59));
  double area = 0.0;
  for (const Solid& s : arena.solids) area += signed_area(s.outline) / 0.01 * (s.z_top - s.z_bottom);
  EXPECT_NEAR(area, 1.2 * 1.2 - 3 * 0.133 * 0.133, 1e-9);
}

TEST(Elements, BoxedVictimHangsAtTheHoleItIsMountedAt) {
  Element wall;
  wall.type = "wall_holes1";
  const std::array<double, 3> along{-0.3, 0.3, -0.3};
  const std::array<double, 3> height{0.9, 0.6, 0.3};
  for (std::size_t i = 0; i < 3; ++i) {
    const Arena arena = placed("victim_with_box1", 0.0, &wall, static_cast<int>(i));
    ASSERT_EQ(arena.victims.size(), 1u);
    EXPECT_NEAR(arena.victims[0].position.x, along[i], 1e-12);
    EXPECT_NEAR(arena.victims[0].position.z, height[i], 1e-12);
    EXPECT_NEAR(arena.victims[0].facing, kPi / 2, 1e-12) << "it looks through the wall";
  }
  EXPECT_NEAR(placed("victim_with_box1").victims[0].position.z, 0.2, 1e-12) << "without a wall it stands on the ground";
  wall.type = "small_wall";
  const Arena low = placed("victim_with_box1", 0.0, &wall);
  EXPECT_NEAR(low.victims[0].position.z, 0.1, 1e-12) << "a wall without holes: the upper half of the box";
  EXPECT_TRUE(blocked(low, 0.0, 0.45, 0.19)) << "lid";
  EXPECT_FALSE(blocked(low, 0.0, 0.45, 0.21));
}

TEST(Elements, VeilIsSeenButGivesWay) {
  const Arena arena = placed("veil_wall");
  int strips = 0;
  for (const Solid& s : arena.solids) {
    strips += s.gives_way ? 1 : 0;
    EXPECT_TRUE(s.gives_way || s.z_bottom > 1.0) << "only the lath above the robot is hard";
  }
  EXPECT_EQ(strips, 9);
}

TEST(Elements, EveryShapeIsSoundInEveryTurn) {
  for (const std::string& type : element_types()) {
    for (const double rotation : {0.0, 90.0, 180.0, 270.0, 30.0}) {
      SCOPED_TRACE(type + " " + std::to_string(rotation));
      Arena arena = placed(type, rotation);
      EXPECT_FALSE(arena.floor.empty() && arena.solids.empty() && arena.victims.empty());
      arena.floor.push_back({rectangle({0.0, 0.0}, 4.0, 4.0), 0.0, 0.0, 0.0, "flat"});
      EXPECT_EQ(parts_trouble(arena).value_or(""), "");
      for (const Solid& s : arena.solids) {
        for (const TPoint2D& p : s.outline) EXPECT_LT(std::hypot(p.x, p.y), 0.9) << "it stays on its pallet";
      }
    }
  }
}

/// Named for what they do to a robot that drives along the element's own +y.
TEST(Elements, APitchRampRisesAheadAndARollRampAside) {
  const double rise = 1.2 * std::tan(deg_to_rad(10.0));
  const Arena pitch = placed("pitch_ramp");
  EXPECT_NEAR(floor_height(pitch, {0.3, 0.6}) - floor_height(pitch, {0.3, -0.6}), rise, 1e-6);
  EXPECT_NEAR(floor_height(pitch, {-0.6, 0.1}), floor_height(pitch, {0.6, 0.1}), 1e-12);
  const Arena roll = placed("roll_ramp");
  EXPECT_NEAR(floor_height(roll, {0.6, 0.3}) - floor_height(roll, {-0.6, 0.3}), rise, 1e-6);
  EXPECT_NEAR(floor_height(roll, {0.1, -0.6}), floor_height(roll, {0.1, 0.6}), 1e-12);
  const Arena turned = placed("roll_ramp", 90.0);
  EXPECT_NEAR(floor_height(turned, {0.0, -0.6}) - floor_height(turned, {0.0, 0.6}), rise, 1e-6) << "clockwise";
  EXPECT_EQ(floor_height(placed("flat"), {0.59, -0.59}), 0.0);
}

/// Four half ramps: two from the ground to 0.17 m, two from there to 0.34 m.
TEST(Elements, ElevatedRampsStandOnEachOthersHeights) {
  const Arena arena = placed("elevated_ramps");
  ASSERT_EQ(arena.floor.size(), 4u);
  EXPECT_NEAR(floor_height(arena, {-0.599, -0.3}), 0.34, 1e-3);
  EXPECT_NEAR(floor_height(arena, {-0.001, -0.3}), 0.17, 1e-3);
  EXPECT_NEAR(floor_height(arena, {0.3, -0.599}), 0.17, 1e-3);
  EXPECT_NEAR(floor_height(arena, {0.3, -0.001}), 0.0, 1e-3);
  EXPECT_NEAR(floor_height(arena, {0.001, 0.3}), 0.34, 1e-3);
  EXPECT_NEAR(floor_height(arena, {0.599, 0.3}), 0.17, 1e-3);
  EXPECT_NEAR(floor_height(arena, {-0.3, 0.001}), 0.0, 1e-3);
  EXPECT_NEAR(floor_height(arena, {-0.3, 0.599}), 0.17, 1e-3);
}

TEST(Elements, LabelsAndStrangersAddNothing) {
  EXPECT_EQ(kind_of("hazmat_oxygen"), ElementKind::Label);
  EXPECT_EQ(kind_of("start_check"), ElementKind::Label);
  EXPECT_EQ(kind_of("flux_capacitor"), ElementKind::Unknown);
  for (const char* type : {"hazmat", "start_check", "flux_capacitor"}) {
    const Arena arena = placed(type);
    EXPECT_TRUE(arena.floor.empty() && arena.solids.empty() && arena.victims.empty());
  }
}

/// The first column of the table in docs/arenas.md names every type there is, and no other.
TEST(Elements, EachIsDescribedAndInTheDocumentation) {
  std::ifstream docs(std::string(RUBBLE_SOURCE_DIR) + "/docs/arenas.md");
  std::set<std::string> documented;
  std::string line;
  while (std::getline(docs, line) && line != "| type | shape |") {
  }
  while (std::getline(docs, line) && line[0] == '|') {
    std::istringstream names(line.substr(1, line.find('|', 1) - 1));
    for (std::string text; std::getline(names, text, '`') && std::getline(names, text, '`');) documented.insert(text);
  }
  const std::vector<std::string> types = element_types();
  EXPECT_EQ(documented, std::set<std::string>(types.begin(), types.end()));
  for (const std::string& type : types) {
    EXPECT_FALSE(description_of(type).empty()) << type;
    EXPECT_NE(name_of(kind_of(type)), "unknown") << type;
  }
}

TEST(Elements, FloorsHaveTheArenasFrictionUnlessGivenTheirOwn) {
  for (const std::string& type : element_types()) {
    for (const FloorPatch& patch : placed(type).floor) EXPECT_FALSE(patch.friction.has_value()) << type;
    Element element;
    element.type = type;
    element.friction = 0.3;
    Arena arena;
    place(element, nullptr, arena);
    EXPECT_EQ(has_floor(type), !arena.floor.empty()) << type;
    for (const FloorPatch& patch : arena.floor) EXPECT_EQ(patch.friction, 0.3) << type;
  }
}

}  // namespace
}  // namespace rubble::arenas
