#include "scoring/rooms/room_match.h"

#include <gtest/gtest.h>

#include "base/rigid.h"
#include "tests/support/scoring_plan.h"

namespace rubble::scoring {
namespace {

using namespace testing;
using mrpt::math::TPose2D;

Rooms rooms_of(std::uint64_t seed) {
  PlanSpec spec;
  spec.seed = seed;
  return extract_rooms(floor_plan(spec).grid);
}

TEST(RoomMatch, AMapHasAllItsOwnRooms) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Rooms rooms = rooms_of(seed);
    const RoomMatch match = match_rooms(rooms, rooms, {});
    EXPECT_EQ(match.pairs.size(), rooms.rooms.size());
    for (const RoomPair& p : match.pairs) EXPECT_EQ(p.map, p.truth);
    EXPECT_TRUE(match.missing.empty() && match.surplus.empty());
    EXPECT_DOUBLE_EQ(match.error, 0.0);
    EXPECT_DOUBLE_EQ(match.score, 1.0);
  }
}

TEST(RoomMatch, TheFurtherOffTheWorse) {
  const Rooms rooms = rooms_of(1);
  double last = 1.0;
  for (const double off : {0.1, 0.3, 0.6, 1.0, 1.3}) {
    const RoomMatch match = match_rooms(rooms, rooms, TPose2D(0.6 * off, -0.8 * off, 0.0));
    EXPECT_LT(match.score, last) << off;
    EXPECT_NEAR(match.score, 1.0 - off * off / 2.0, 1e-9) << off;
    last = match.score;
  }
  EXPECT_DOUBLE_EQ(match_rooms(rooms, rooms, TPose2D(500.0, 0.0, 0.0)).score, 0.0);  // W = 0 is the worst
}

TEST(RoomMatch, RoomsThatOneMapLacksAreNamedAndCostHalfTheCap) {
  const Rooms truth = rooms_of(2);
  Rooms map = truth;
  map.rooms.erase(map.rooms.begin() + 3);
  const double n = static_cast<double>(truth.rooms.size());
  const RoomMatch lost = match_rooms(map, truth, {});
  EXPECT_EQ(lost.missing, std::vector<std::size_t>{3});
  EXPECT_TRUE(lost.surplus.empty());
  EXPECT_NEAR(lost.error, 1.0 / (n - 0.5), 1e-12);
  const RoomMatch swapped = match_rooms(truth, map, {});
  EXPECT_EQ(swapped.surplus, std::vector<std::size_t>{3});
  EXPECT_NEAR(swapped.error, lost.error, 1e-12);
}

TEST(RoomMatch, WithoutRoomsThereIsNoScore) {
  const Rooms rooms = rooms_of(1);
  EXPECT_EQ(match_rooms({}, rooms, {}).score, 0.0);
  EXPECT_EQ(match_rooms(rooms, {}, {}).score, 0.0);
  EXPECT_EQ(match_rooms(Rooms{}, Rooms{}, TPose2D()).score, 0.0);
}

}  // namespace
}  // namespace rubble::scoring
