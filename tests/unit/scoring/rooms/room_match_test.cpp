#include "scoring/rooms/room_match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "base/rigid.h"
#include "tests/support/scoring_grounds.h"
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

/// Rooms of arenas end at openings, of which many are nearly as wide as the rooms: a centimetre of wall decided which.
/// A map on another raster, turned, or with walls that are fatter has them all, divided as the truth's.
TEST(RoomMatch, ARightMapOfAnArenaHasItsRooms) {
  double worst = 1.0;
  for (std::uint64_t seed = 9201; seed <= 9206; ++seed)
    for (const char* kind : {"yellow", "orange", "maze"})
      for (const double turn : {0.0, 0.4, 2.1}) {
        SCOPED_TRACE(std::string(kind) + " of seed " + std::to_string(seed) + ", turned by " + std::to_string(turn));
        const OccupancyGrid truth = truth_of({kind, 8, 8, seed});
        const OccupancyGrid fine = moved(truth, turn, 2.0, -1.0, 0.025);
        const OccupancyGrid map = turn == 0.0 ? thickened(fine, 1) : fine;
        const TPose2D T_truth_map = TPose2D() - TPose2D(2.0, -1.0, turn);
        const Rooms of_truth = extract_rooms(truth);
        const RoomMatch match = match_rooms(extract_rooms_as(map, of_truth, T_truth_map), of_truth, T_truth_map);
        EXPECT_GE(match.score, turn == 0.0 ? 0.85 : 0.95);  // walls twice as thick leave rooms a smaller area
        EXPECT_LE(match.missing.size() + match.surplus.size(), 1u);
        worst = std::min(worst, match.score);
      }
  std::printf("rooms of right maps: %.3f at the lowest\n", worst);
}

TEST(RoomMatch, WallsThatTheMapLacksJoinRoomsAndPhantomsDivideThem) {
  double gaps = 0.0, phantoms = 0.0, right = 0.0, other = 0.0;
  for (std::uint64_t seed = 9111; seed <= 9114; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid truth = truth_of({"yellow", 8, 8, seed});
    const Rooms of_truth = extract_rooms(truth);
    const auto score = [&](const OccupancyGrid& map) {
      return match_rooms(extract_rooms_as(map, of_truth, {}), of_truth, {}).score;
    };
    EXPECT_GT(score(truth), 0.99);
    right += score(ragged(truth, 1, seed));
    gaps += score(with_gaps(truth, 12, seed));
    phantoms += score(with_phantoms(truth, 12, seed));
    other += score(truth_of({"yellow", 8, 8, seed + 1000}));
  }
  EXPECT_LT(gaps, right - 0.2);
  EXPECT_LT(phantoms, right - 0.2);
  EXPECT_LT(other, 4 * 0.4);
  std::printf("rooms: right %.3f, gaps %.3f, phantoms %.3f, another arena %.3f\n", right / 4, gaps / 4, phantoms / 4,
              other / 4);
}

TEST(RoomMatch, WithoutRoomsThereIsNoScore) {
  const Rooms rooms = rooms_of(1);
  EXPECT_EQ(match_rooms({}, rooms, {}).score, 0.0);
  EXPECT_EQ(match_rooms(rooms, {}, {}).score, 0.0);
  EXPECT_EQ(match_rooms(Rooms{}, Rooms{}, TPose2D()).score, 0.0);
}

}  // namespace
}  // namespace rubble::scoring
