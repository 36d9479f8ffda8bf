#include "arenas/truth/visible.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

Arena parse(const std::string& maze, const std::string& rest = "") {
  return parse_arena("maze: |\n" + maze + rest, "drawn");
}

struct View {
  Arena arena;
  OccupancyGrid truth, known;
  explicit View(const Arena& a) : arena(a), truth(truth_map(a)), known(visible_truth(a, truth)) {}
  Occupancy at(double x, double y) const { return known[known.cell({x, y})]; }
};

std::size_t cells_of(const OccupancyGrid& map, Occupancy what) {
  return static_cast<std::size_t>(std::count(map.cells().begin(), map.cells().end(), what));
}

TEST(Visible, AnOpenRoomIsSeenThroughout) {
  const View view(parse("  +---+---+\n  |S.   . |\n  +   +   +\n  | .   . |\n  +---+---+\n"));
  EXPECT_EQ(cells_of(view.known, Occupancy::Free), cells_of(view.truth, Occupancy::Free));
  EXPECT_EQ(cells_of(view.known, Occupancy::Occupied), cells_of(view.truth, Occupancy::Occupied));
}

TEST(Visible, ToldIsHowFarTheLookingIs) {
  const Arena arena = parse("  +---+---+\n  |S.   . |\n  +   +   +\n  | .   . |\n  +---+---+\n");
  std::vector<double> shares;
  visible_truth(arena, truth_map(arena), {}, [&](double share) { shares.push_back(share); });
  ASSERT_GT(shares.size(), 4u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

/// The laser sees the strips and past them, the robot drives through; judged is what lies beyond.
TEST(Visible, AVeilIsNotJudgedAndWhatLiesBeyondIs) {
  const View view(parse("  +---+---+\n  |S.   . |\n  +---+---+\n",
                        "elements:\n  - {type: veil_wall, x_m: 0.6, y_m: 0.6, rotation_deg: 90}\n"));
  EXPECT_EQ(view.at(0.6, 0.6), Occupancy::Free);
  EXPECT_EQ(view.at(1.8, 0.6), Occupancy::Free);
  int strips = 0;
  for (double y = 0.15; y < 1.1; y += 0.05) {
    strips += view.truth[view.truth.cell({1.2, y})] == Occupancy::Occupied ? 1 : 0;
    EXPECT_EQ(view.at(1.2, y), Occupancy::Unknown) << y;
  }
  EXPECT_GT(strips, 4);
  EXPECT_EQ(view.at(1.2, 0.0), Occupancy::Occupied) << "the wall beside it";
  EXPECT_EQ(view.at(1.35, 0.6), Occupancy::Free) << "beyond it";
}

/// A gap of 0.3 m is too narrow to drive through, but the laser looks in as far as it can see round the edges.
TEST(Visible, BehindANarrowGapOnlyWhatTheGapShowsCounts) {
  const View view(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                        "walls:\n  - {from_m: [1.2, 0], to_m: [1.2, 0.9]}\n"));
  EXPECT_EQ(view.at(0.6, 0.6), Occupancy::Free);
  EXPECT_EQ(view.at(1.5, 1.05), Occupancy::Free);      // through the gap
  EXPECT_EQ(view.at(1.35, 0.15), Occupancy::Unknown);  // round the corner
  EXPECT_EQ(view.truth[view.truth.cell({1.35, 0.15})], Occupancy::Free);
  const Grid<std::uint8_t> reachable = reachable_mask(view.arena, view.truth);
  EXPECT_EQ(reachable[reachable.frame().cell({1.8, 0.6})], 0);
  EXPECT_EQ(reachable[reachable.frame().cell({0.6, 0.6})], 1);
}

/// A platform 0.21 m up without a ramp: seen over its edge, never climbed.
TEST(Visible, AStepTooHighIsNotClimbed) {
  const View view(parse("  +---+---+\n  |S.   .1|\n  +---+---+\n"));
  const Grid<std::uint8_t> reachable = reachable_mask(view.arena, view.truth);
  EXPECT_EQ(reachable[reachable.frame().cell({1.8, 0.6})], 0);
  EXPECT_EQ(view.at(1.8, 0.6), Occupancy::Free);
}

/// The steps between the ramps of a crossing are 0.106 m high at the pallet's edge and none in its middle: 3 cm of them
/// are too high, the rest is driven over, in the simulator and here.
TEST(Visible, AStepThatIsTooHighOverAShortPieceIsPassedBesideIt) {
  const View view(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                        "elements:\n  - {type: crossing_ramps, x_m: 1.8, y_m: 0.6}\n"));
  const Grid<std::uint8_t> reachable = reachable_mask(view.arena, view.truth);
  EXPECT_EQ(reachable[reachable.frame().cell({3.0, 0.6})], 1);
  EXPECT_EQ(reachable[reachable.frame().cell({1.8, 0.3})], 1) << "over a step of half the height";
  EXPECT_EQ(reachable[reachable.frame().cell({1.8, 0.2})], 0) << "the high end, and the wall";
}

/// A floor two ramps up ends 0.42 m above the pallets beside it, which no laser up there can see as a wall.
TEST(Visible, ADropIsAWallFromBelowOnly) {
  const std::string tower = "  |S.   >   >1  .2  .   . |\n";
  const std::string line = "  +---+---+---+---+---+---+\n";
  const View above(parse(line + tower + line));
  ASSERT_EQ(above.truth[above.truth.cell({4.8, 0.6})], Occupancy::Occupied);
  EXPECT_EQ(above.at(4.8, 0.6), Occupancy::Unknown) << "nobody gets down there to see it";
  EXPECT_EQ(above.at(4.8, 0.0), Occupancy::Occupied) << "the wall beside it";
  const View around(
      parse(line + "  |S.   >   >1  .2  .   . |\n  +   +---+---+---+   +   +\n  | .   .   .   .   .   . |\n" + line));
  EXPECT_EQ(around.at(4.8, 1.8), Occupancy::Occupied) << "seen from below";
}

TEST(Visible, OpenGroundCountsAsFarAsAWallIsSeenFromIt) {
  Arena arena = parse("  +---+\n  |S. |\n  +   +\n", "floors:\n  - {x_m: 0.6, y_m: -6, length_m: 12, width_m: 12}\n");
  const View view(arena);
  EXPECT_EQ(view.at(0.6, 0.6), Occupancy::Free) << "inside";
  EXPECT_EQ(view.at(0.6, -3.5), Occupancy::Free);
  EXPECT_EQ(view.at(0.6, -4.5), Occupancy::Unknown);
  arena.solids.clear();
  EXPECT_EQ(View(arena).at(0.6, -4.5), Occupancy::Free) << "no walls: all there is";
}

/// Drawn as free floor, for the truth is cut at one height above each floor: but a level laser sees a steep ramp as a
/// wall where it is as high as the laser, and nothing of the platform behind. A ramp that can be climbed hides nothing.
TEST(Visible, WhatLiesBehindARampThatNobodyClimbsCountsOnlyBelowTheLaser) {
  const auto arena = [](const char* ramp, const char* top) {
    return View(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                      std::string("elements:\n  - {type: ") + ramp +
                          ", x_m: 1.8, y_m: 0.6, rotation_deg: 90}\n  - {type: " + top + ", x_m: 3.0, y_m: 0.6}\n"));
  };
  const View steep = arena("steep_ramp_45", "elevated_floor_120_solid");
  ASSERT_GT(floor_height(steep.arena, {2.3, 0.6}), 0.8) << "the ramp rises away from the start";
  EXPECT_EQ(steep.at(1.4, 0.6), Occupancy::Free);     // 0.2 m up
  EXPECT_EQ(steep.at(1.7, 0.6), Occupancy::Unknown);  // 0.5 m up
  EXPECT_EQ(steep.at(3.0, 0.6), Occupancy::Unknown);
  EXPECT_EQ(steep.truth[steep.truth.cell({3.0, 0.6})], Occupancy::Free);
  // Where it is as high as the laser (0.35 m up, at 1.55 m) a map may show a wall or not.
  const auto unknown_before_the_end = [](const View& view) {
    int cells = 0;
    for (double x = 1.2; x < 1.55; x += 0.05) cells += view.at(x + 0.01, 0.6) == Occupancy::Unknown ? 1 : 0;
    return cells;
  };
  EXPECT_GE(unknown_before_the_end(steep), 1);
  EXPECT_LE(unknown_before_the_end(steep), 3);
  const View flat(parse("  +---+---+---+\n  |S.   >   .1|\n  +---+---+---+\n"));
  EXPECT_EQ(flat.at(3.0, 0.6), Occupancy::Free);
}

/// From the foot of two ramps in a row the second one looks like a wall: but the robot drives up there, so that is a
/// phantom, and the floor counts.
TEST(Visible, RampsThatCanBeDrivenLeaveNothingOpen) {
  const View view(parse("  +---+---+---+---+\n  |S.   >   >1  .2|\n  +---+---+---+---+\n"));
  ASSERT_GT(floor_height(view.arena, {4.2, 0.6}), 0.40);
  for (double x = 0.3; x < 4.5; x += 0.05) EXPECT_EQ(view.at(x, 0.6), Occupancy::Free) << x;
}

/// The second riser of stairs stands before a laser at their foot; from a ramp beside them another one does.
TEST(Visible, StairsCountUpToTheRiserThatTheLaserMeets) {
  const View view(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                        "elements:\n  - {type: stairs_120_solid, x_m: 1.8, y_m: 0.6, rotation_deg: 90}\n"));
  EXPECT_EQ(view.at(1.0, 0.6), Occupancy::Free);
  int riser = 0;
  while (riser < 40 && floor_height(view.arena, {1.2 + 0.03 * riser, 0.6}) < 0.35) ++riser;
  const double end = 1.2 + 0.03 * riser;
  EXPECT_EQ(view.at(end - 0.06, 0.6), Occupancy::Unknown) << "riser at " << end;
  EXPECT_EQ(view.at(end + 0.1, 0.6), Occupancy::Unknown);
}

/// Under a floor that is open below the robot drives, and sees; between the treads of open stairs its laser sees
/// through.
TEST(Visible, WhatIsOpenBelowHidesNothing) {
  const View floor(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                         "elements:\n  - {type: elevated_floor_120, x_m: 1.8, y_m: 0.6}\n"));
  EXPECT_EQ(floor.at(1.8, 0.6), Occupancy::Free);
  EXPECT_EQ(floor.at(3.0, 0.6), Occupancy::Free);
  const Grid<std::uint8_t> reachable = reachable_mask(floor.arena, floor.truth);
  EXPECT_EQ(reachable[reachable.frame().cell({3.0, 0.6})], 1);
  const View stairs(parse("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n",
                          "elements:\n  - {type: stairs_120, x_m: 1.8, y_m: 0.6, rotation_deg: 90}\n"));
  EXPECT_EQ(stairs.at(3.0, 0.6), Occupancy::Free);
  const Grid<std::uint8_t> before = reachable_mask(stairs.arena, stairs.truth);
  EXPECT_EQ(before[before.frame().cell({3.0, 0.6})], 0) << "no robot gets through the treads";
}

TEST(Visible, NothingFartherThanTheRangeCounts) {
  const Arena arena = parse("  +---+---+---+---+---+---+\n  |S.   .   .   .   .   . |\n  +---+---+---+---+---+---+\n",
                            "boxes:\n  - {x_m: 1.2, y_m: 0.6, length_m: 0.1, width_m: 1.2, height_m: 0.3}\n");
  const View view(arena);  // the low box stops the robot, not the laser
  EXPECT_EQ(view.at(4.5, 0.6), Occupancy::Free);
  EXPECT_EQ(view.at(5.5, 0.6), Occupancy::Unknown);
}

/// The robot's middle has 0.15 m to either side there: wherever the cells lie, it looks from all along the way.
TEST(Visible, ANarrowCorridorIsSeenWhole) {
  for (int i = 0; i < 8; ++i) {
    const double at = 1.0 + i * 0.05625;  // eight phases of a cell, and of the 0.4 m between poses
    const auto wall = [&](double x0, double y0, double x1, double y1) {
      const auto point = [&](double x, double y) {
        return "[" + std::to_string(at + x) + ", " + std::to_string(at + y) + "]";
      };
      return "  - {from_m: " + point(x0, y0) + ", to_m: " + point(x1, y1) + "}\n";
    };
    const View view(
        parse_arena("floors: [{x_m: 4, y_m: 4, length_m: 8, width_m: 8}]\nstart: {x_m: " + std::to_string(at + 0.6) +
                        ", y_m: " + std::to_string(at + 0.6) + "}\nwalls:\n" + wall(0, 0, 1.2, 0) + wall(0, 0, 0, 1.2) +
                        wall(0, 1.2, 1.2, 1.2) + wall(1.2, 0, 1.2, 0.3) + wall(1.2, 0.95, 1.2, 1.2) +
                        wall(1.2, 0.3, 4.65, 0.3) + wall(1.2, 0.95, 4.0, 0.95) + wall(4.65, 0.3, 4.65, 5.0) +
                        wall(4.0, 0.95, 4.0, 5.0) + wall(4.0, 5.0, 4.65, 5.0),
                    "corridor"));
    EXPECT_EQ(cells_of(view.known, Occupancy::Free), cells_of(view.truth, Occupancy::Free)) << "at " << at;
    EXPECT_EQ(view.at(at + 4.3, at + 4.9), Occupancy::Free) << "at " << at;
  }
}

/// In a yellow arena everything can be reached, so all but slivers behind victims' boxes and in corners is seen.
TEST(Visible, AYellowArenaIsSeenAlmostWhole) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    GenerateConfig config;
    config.seed = seed;
    const View view(parse_arena(generate_arena(config), "generated"));
    const double share = static_cast<double>(cells_of(view.known, Occupancy::Free)) /
                         static_cast<double>(cells_of(view.truth, Occupancy::Free));
    EXPECT_GT(share, 0.985) << "seed " << seed;
    for (std::size_t i = 0; i < view.known.cells().size(); ++i) {
      const Occupancy cell = view.known.cells()[i];
      ASSERT_TRUE(cell == Occupancy::Unknown || cell == view.truth.cells()[i]);
    }
  }
}

}  // namespace
}  // namespace rubble::arenas
