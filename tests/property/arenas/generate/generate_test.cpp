#include "arenas/generate/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <set>

#include "arenas/files/arena_file.h"
#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "arenas/model/rims.h"
#include "arenas/truth/truth_map.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

GenerateConfig config_of(std::uint64_t seed) {
  constexpr std::array<std::array<int, 2>, 6> kSizes{{{2, 2}, {3, 2}, {4, 4}, {8, 8}, {5, 12}, {12, 12}}};
  GenerateConfig config;
  config.seed = seed;
  config.columns = kSizes[seed % 6][0];
  config.rows = kSizes[seed % 6][1];
  config.ramps = static_cast<double>(seed % 5) * 0.2;
  config.loops = static_cast<double>(seed % 4) * 0.33;
  config.paper = static_cast<double>(seed % 3) * 0.3;
  config.victims = static_cast<int>(seed % 4);
  return config;
}

std::string name_of(std::uint64_t seed) { return "seed " + std::to_string(seed); }

/// Whether the floor has no step of more than 20 mm on the straight way from a to b.
bool is_even(const PatchIndex& floor, const TPoint2D& a, const TPoint2D& b) {
  constexpr int kSteps = 24;
  const double climb = std::tan(0.18) * std::hypot(b.x - a.x, b.y - a.y) / kSteps;
  double last = floor.floor_height(a);
  for (int i = 1; i <= kSteps; ++i) {
    const double z = floor.floor_height(a + (b - a) * (static_cast<double>(i) / kSteps));
    if (!(std::abs(z - last) <= 0.02 + climb)) return false;
    last = z;
  }
  return true;
}

bool is_blocked(const Arena& arena, const std::string& element, const TPoint2D& a, const TPoint2D& b) {
  for (const Solid& solid : arena.solids) {
    if (solid.element == element && clip(solid.outline, a, b)) return true;
  }
  return false;
}

/// Whether the robot gets over the edge between two neighbouring pallets: even floor on two lanes 0.4 m left and right
/// of the middle, no wall, and at most one lane taken by a victim's box.
bool are_joined(const Arena& arena, const PatchIndex& floor, Cell a, Cell b) {
  const TPoint2D p{1.2 * a.x + 0.6, 1.2 * a.y + 0.6};
  const TPoint2D q{1.2 * b.x + 0.6, 1.2 * b.y + 0.6};
  const TPoint2D along = q - p;
  const TPoint2D aside{-along.y / 3.0, along.x / 3.0};
  const TPoint2D near = p + along * 0.375;
  const TPoint2D far = p + along * 0.625;
  for (const double lane : {-1.0, 1.0}) {
    if (is_blocked(arena, "wall", near + aside * lane, far + aside * lane)) return false;
    if (!is_even(floor, near + aside * lane, far + aside * lane)) return false;
  }
  return !is_blocked(arena, "victim_box", near + aside, far + aside) ||
         !is_blocked(arena, "victim_box", near - aside, far - aside);
}

/// Pallets the robot gets to from its start, never over a `barred` one.
std::size_t count_reachable(const Arena& arena, int columns, int rows,
                            const std::set<std::pair<int, int>>& barred = {}) {
  const PatchIndex floor(arena);
  std::set<std::pair<int, int>> seen{{static_cast<int>(arena.start.x / 1.2), static_cast<int>(arena.start.y / 1.2)}};
  std::vector<std::pair<int, int>> open(seen.begin(), seen.end());
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    for (const auto& [nx, ny] : {std::pair{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
      if (nx < 0 || ny < 0 || nx >= columns || ny >= rows || seen.count({nx, ny}) > 0) continue;
      if (barred.count({nx, ny}) > 0) continue;
      if (!are_joined(arena, floor, {x, y}, {nx, ny})) continue;
      seen.insert({nx, ny});
      open.push_back({nx, ny});
    }
  }
  return seen.size();
}

TEST(Generate, EveryPalletCanBeReachedWithoutAStep) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(name_of(seed));
    const GenerateConfig config = config_of(seed);
    const Arena arena = parse_arena(generate_arena(config), "generated");
    ASSERT_NO_THROW(check(arena, "generated"));
    ASSERT_EQ(arena.floor.size(), static_cast<std::size_t>(config.columns * config.rows));
    ASSERT_EQ(arena.victims.size(), static_cast<std::size_t>(config.victims));
    EXPECT_EQ(count_reachable(arena, config.columns, config.rows), arena.floor.size());
  }
}

/// Pallets with an obstacle that a P3-AT cannot cross, told by their floors.
std::set<std::pair<int, int>> barred_pallets(const Arena& arena) {
  std::set<std::pair<int, int>> barred;
  for (const FloorPatch& patch : arena.floor) {
    const bool is_steep = std::hypot(patch.gx, patch.gy) > 0.5;
    if (patch.element == "flat" || (patch.element == "ramp" && !is_steep)) continue;
    TPoint2D middle;
    for (const TPoint2D& p : patch.outline) middle = middle + p * (1.0 / static_cast<double>(patch.outline.size()));
    barred.insert({static_cast<int>(middle.x / 1.2), static_cast<int>(middle.y / 1.2)});
  }
  return barred;
}

bool has_wall_at(const Arena& arena, const TPoint2D& edge) {
  return std::any_of(arena.solids.begin(), arena.solids.end(),
                     [&](const Solid& s) { return s.element == "wall" && contains(s.outline, edge); });
}

/// Whatever can be driven is connected without crossing an obstacle, and every obstacle lies beside an open edge.
TEST(Generate, ObstaclesOfOrangeAndRedCutNothingOff) {
  for (const ArenaKind kind : {ArenaKind::Orange, ArenaKind::Red}) {
    double share = 0.0;
    constexpr std::uint64_t kSeeds = 300;
    std::set<std::string> elements;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(arenas::name_of(kind) + " " + name_of(seed));
      GenerateConfig config = config_of(seed);
      config.kind = kind;
      config.victims = static_cast<int>(seed % 2);
      const Arena arena = parse_arena(generate_arena(config), "generated");
      ASSERT_NO_THROW(check(arena, "generated"));
      const std::set<std::pair<int, int>> barred = barred_pallets(arena);
      const std::size_t pallets = static_cast<std::size_t>(config.columns * config.rows);
      EXPECT_EQ(count_reachable(arena, config.columns, config.rows, barred), pallets - barred.size());
      for (const auto& [x, y] : barred) {
        const TPoint2D m{1.2 * x + 0.6, 1.2 * y + 0.6};
        const bool closed = has_wall_at(arena, {m.x + 0.6, m.y}) && has_wall_at(arena, {m.x - 0.6, m.y}) &&
                            has_wall_at(arena, {m.x, m.y + 0.6}) && has_wall_at(arena, {m.x, m.y - 0.6});
        EXPECT_FALSE(closed) << x << " " << y;
      }
      share += static_cast<double>(barred.size()) / static_cast<double>(pallets) / kSeeds;
      for (const FloorPatch& patch : arena.floor) elements.insert(patch.element);
      for (const Solid& solid : arena.solids) elements.insert(solid.element);
      if (seed % 10 == 0) {
        EXPECT_EQ(generate_arena(config), generate_arena(config));
      }
    }
    std::cout << arenas::name_of(kind) << ": " << 100.0 * share << " % of the pallets have obstacles (25 % asked)\n";
    EXPECT_GT(share, 0.1);
    EXPECT_EQ(elements.count("step_field"), 1u);
    EXPECT_EQ(elements.count(kind == ArenaKind::Orange ? "crossing_ramp" : "stair"), 1u);
    EXPECT_EQ(elements.count("tunnel"), kind == ArenaKind::Red ? 1u : 0u);
  }
}

/// So no robot could drive off, and none of the simulator's kerbs stands there.
TEST(Generate, WallsLeaveNoOpenRim) {
  for (const ArenaKind kind : {ArenaKind::Yellow, ArenaKind::Orange, ArenaKind::Red}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      GenerateConfig config = config_of(seed);
      config.kind = kind;
      EXPECT_TRUE(open_rims(parse_arena(generate_arena(config), "generated"), 0.1).empty()) << name_of(seed);
    }
  }
}

/// Known from one field is nothing of another.
TEST(Generate, EveryStepFieldIsAThrowOfItsOwn) {
  for (const ArenaKind kind : {ArenaKind::Orange, ArenaKind::Red}) {
    GenerateConfig config;
    config.kind = kind;
    config.columns = config.rows = 12;
    const std::string text = generate_arena(config);
    std::set<std::string> throws;
    std::size_t fields = 0;
    for (std::size_t at = text.find("stepfield"); at != std::string::npos; at = text.find("stepfield", at + 1)) {
      const std::size_t key = text.find("throw: ", at);
      throws.insert(text.substr(key, text.find('}', key) - key));
      ++fields;
    }
    EXPECT_GT(fields, 3u);
    EXPECT_EQ(throws.size(), fields);
  }
}

/// An edge that is open but rough would let the mapper plan a way the robot cannot drive.
TEST(Generate, WhereThereIsNoWallTheFloorIsSmooth) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(name_of(seed));
    const GenerateConfig config = config_of(seed);
    const Arena arena = parse_arena(generate_arena(config), "generated");
    const PatchIndex floor(arena);
    for (int y = 0; y < config.rows; ++y) {
      for (int x = 0; x < config.columns; ++x) {
        for (const Cell next : {Cell{x + 1, y}, Cell{x, y + 1}}) {
          if (next.x >= config.columns || next.y >= config.rows) continue;
          const TPoint2D edge{0.6 * (x + next.x + 1), 0.6 * (y + next.y + 1)};
          bool has_wall = false;
          for (const Solid& s : arena.solids) has_wall = has_wall || (s.element == "wall" && contains(s.outline, edge));
          EXPECT_EQ(has_wall, !are_joined(arena, floor, {x, y}, next)) << edge.x << " " << edge.y;
        }
      }
    }
  }
}

TEST(Generate, SameSeedSameBytesAndAnotherSeedAnotherArena) {
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    GenerateConfig config;
    config.seed = seed;
    const std::string text = generate_arena(config);
    EXPECT_EQ(text, generate_arena(config)) << name_of(seed);
    texts.insert(text.substr(text.find("maze:")));
  }
  EXPECT_EQ(texts.size(), 1000u);
}

TEST(Generate, MorePaperLeavesTheMazeAsItWas) {
  GenerateConfig config;
  const std::string plain = generate_arena(config);
  config.paper = 0.5;
  const std::string papered = generate_arena(config);
  const auto maze = [](const std::string& text) {
    return text.substr(text.find("maze:"), text.find("paper:") - text.find("maze:"));
  };
  EXPECT_EQ(maze(plain), maze(papered));
}

/// Who is hidden from cameras is drawn anew; all else of the arena stays.
TEST(Generate, SharesOfTheVictimsAreHeardOrSmeltAlone) {
  std::set<std::string> draws;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(name_of(seed));
    GenerateConfig config;
    config.seed = seed;
    config.victims = 6;
    const Arena plain = parse_arena(generate_arena(config), "generated");
    config.sound_alone = 0.5;
    config.co2_alone = 1.0 / 3.0;
    const std::string text = generate_arena(config);
    EXPECT_EQ(text, generate_arena(config));
    const Arena arena = parse_arena(text, "generated");
    ASSERT_EQ(arena.victims.size(), 6u);
    int heard = 0, smelt = 0, seen = 0;
    std::string draw;
    for (std::size_t i = 0; i < 6; ++i) {
      const Victim& v = arena.victims[i];
      EXPECT_EQ(v.position.x, plain.victims[i].position.x);
      EXPECT_EQ(v.facing, plain.victims[i].facing);
      heard += v.sound && !v.co2 && !v.appearance && !v.heat ? 1 : 0;
      smelt += v.co2 && !v.sound && !v.appearance && !v.heat ? 1 : 0;
      seen += v.appearance ? 1 : 0;
      draw += v.appearance ? 'a' : v.sound ? 's' : 'c';
    }
    EXPECT_EQ(heard, 3);
    EXPECT_EQ(smelt, 2);
    EXPECT_EQ(seen, 1);
    draws.insert(draw);
  }
  EXPECT_GT(draws.size(), 10u);
}

TEST(Generate, PerfectMazeHasOneWayBetweenPallets) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    GenerateConfig config;
    config.seed = seed;
    config.loops = 0.0;
    const Arena arena = parse_arena(generate_arena(config), "generated");
    double wall_length = 0.0;
    for (const Solid& s : arena.solids) {
      if (s.element == "wall") wall_length += signed_area(s.outline) / 0.02;
    }
    const double inner_edges = 2 * 7 * 8;
    const double walls = 4 * 8 + inner_edges - (8 * 8 - 1);
    EXPECT_NEAR(wall_length, 1.2 * walls, 1e-6) << name_of(seed);
  }
}

TEST(Generate, ReachesTheShareOfRampsAskedFor) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    GenerateConfig config;
    config.seed = seed;
    const Arena arena = parse_arena(generate_arena(config), "generated");
    int ramps = 0;
    for (const FloorPatch& patch : arena.floor) ramps += patch.element == "ramp" ? 1 : 0;
    EXPECT_EQ(ramps, 19) << name_of(seed);  // 0.3 x 64
  }
}

TEST(Generate, VictimsStandInBoxesClearOfTheStartAndOfEachOther) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(name_of(seed));
    GenerateConfig config;
    config.seed = seed;
    config.columns = config.rows = 4;
    config.victims = 15;
    const Arena arena = parse_arena(generate_arena(config), "generated");
    std::set<std::pair<int, int>> taken{{static_cast<int>(arena.start.x / 1.2), static_cast<int>(arena.start.y / 1.2)}};
    for (const Victim& v : arena.victims) {
      const std::pair<int, int> cell{static_cast<int>(v.position.x / 1.2), static_cast<int>(v.position.y / 1.2)};
      EXPECT_TRUE(taken.insert(cell).second);
      const TPoint2D front{v.position.x + 0.35 * std::cos(v.facing), v.position.y + 0.35 * std::sin(v.facing)};
      for (const Solid& s : arena.solids) {
        if (s.z_bottom > v.position.z) continue;  // the lid
        EXPECT_FALSE(clip(s.outline, {v.position.x, v.position.y}, front)) << "the open side looks at a " << s.element;
      }
    }
  }
}

/// Every victim's box opens into floor that the start is connected to.
TEST(Generate, VictimsCanBeSeenFromReachableFloor) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(name_of(seed));
    GenerateConfig config;
    config.seed = seed;
    const Arena arena = parse_arena(generate_arena(config), "generated");
    const OccupancyGrid map = truth_map(arena);
    for (const Victim& v : arena.victims) {
      const TPoint2D front{v.position.x + 0.3 * std::cos(v.facing), v.position.y + 0.3 * std::sin(v.facing)};
      EXPECT_EQ(map[map.cell(front)], Occupancy::Free);
    }
  }
}

TEST(Generate, LargestArenaIsComplete) {
  GenerateConfig config;
  config.columns = config.rows = 60;
  config.victims = 40;
  const Arena arena = parse_arena(generate_arena(config), "generated");
  EXPECT_EQ(arena.floor.size(), 3600u);
  const OccupancyGrid map = truth_map(arena, 0.1);
  for (const FloorPatch& patch : arena.floor) {
    // A victim's box never covers this point of a pallet.
    const TPoint2D p{patch.outline[0].x + 0.55, patch.outline[0].y + 0.55};
    EXPECT_EQ(map[map.cell(p)], Occupancy::Free);
  }
}

TEST(Generate, ValuesOutOfRangeAreInputErrors) {
  const auto refuses = [](const auto& change) {
    GenerateConfig config;
    change(config);
    EXPECT_THROW(generate_arena(config), InputError);
  };
  EXPECT_THROW(arena_kind("pink"), InputError);
  EXPECT_THROW(arena_kind("blue"), InputError);
  for (const std::string& name : arena_kinds()) EXPECT_EQ(arenas::name_of(arena_kind(name)), name);
  refuses([](GenerateConfig& c) { c.columns = 1; });
  refuses([](GenerateConfig& c) { c.rows = 61; });
  refuses([](GenerateConfig& c) { c.ramps = 1.1; });
  refuses([](GenerateConfig& c) { c.paper = -0.1; });
  refuses([](GenerateConfig& c) { c.loops = NAN; });
  refuses([](GenerateConfig& c) { c.victims = 64; });
  refuses([](GenerateConfig& c) { c.ramp_deg = 0.0; });
  refuses([](GenerateConfig& c) { c.sound_alone = 0.6, c.co2_alone = 0.6; });
  refuses([](GenerateConfig& c) { c.co2_alone = -0.1; });
}

}  // namespace
}  // namespace rubble::arenas
