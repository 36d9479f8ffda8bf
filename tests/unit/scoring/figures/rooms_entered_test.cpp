#include "scoring/figures/rooms_entered.h"

#include <gtest/gtest.h>

#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "tests/support/sim_arena.h"

namespace rubble::scoring {
namespace {

/// Three rooms of 3 x 3 m in a row, with doors of 1 m between them.
arenas::Arena three_rooms() {
  arenas::Arena arena = sim::test::room(-1.5, -1.5, 7.5, 1.5);
  for (const double x : {1.5, 4.5}) {
    sim::test::add_wall(arena, x - 0.03, -1.5, x + 0.03, -0.5);
    sim::test::add_wall(arena, x - 0.03, 0.5, x + 0.03, 1.5);
  }
  return arena;
}

RoomsEntered of(const arenas::Arena& arena, double from, double to) {
  const OccupancyGrid truth = arenas::truth_map(arena);
  Trajectory path;
  for (int i = 0; i <= 100; ++i)
    path.push_back({Stamp::from_seconds(0.1 * i), {from + (to - from) * 0.01 * i, 0.0, 0.0}});
  return rooms_entered(truth, arenas::reachable_mask(arena, truth), path);
}

TEST(RoomsEntered, CountsThoseInWhichTheRobotWas) {
  const arenas::Arena arena = three_rooms();
  EXPECT_EQ(of(arena, 0.0, 0.5).reachable, 3u);
  EXPECT_EQ(of(arena, 0.0, 0.5).entered, 1u);
  EXPECT_EQ(of(arena, 0.0, 1.2).entered, 1u) << "before the door";
  EXPECT_EQ(of(arena, 0.0, 2.2).entered, 2u);
  EXPECT_EQ(of(arena, 0.0, 6.0).entered, 3u);
  EXPECT_EQ(of(arena, 100.0, 101.0).entered, 0u);
}

TEST(RoomsEntered, AsksForNoneThatTheRobotCannotGetTo) {
  arenas::Arena arena = three_rooms();
  sim::test::add_wall(arena, 4.47, -0.3, 4.53, 0.5);  // a gap of 0.2 m is left
  EXPECT_EQ(of(arena, 0.0, 3.0).reachable, 2u);
  EXPECT_EQ(of(arena, 0.0, 3.0).entered, 2u);
  EXPECT_EQ(of(arena, 0.0, 6.0).entered, 2u) << "it was in one that does not count";
}

TEST(RoomsEntered, OfAnArenaWithoutFloorAreNone) {
  const OccupancyGrid truth(GridFrame{40, 40, 0.05, 0.0, 0.0}, Occupancy::Unknown);
  const RoomsEntered rooms = rooms_entered(truth, Grid<std::uint8_t>(truth.frame()), {{Stamp{0}, {1.0, 1.0, 0.0}}});
  EXPECT_EQ(rooms.reachable, 0u);
  EXPECT_EQ(rooms.entered, 0u);
}

}  // namespace
}  // namespace rubble::scoring
