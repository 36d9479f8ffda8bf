#include "scoring/rooms/room_hypotheses.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/rigid.h"
#include "tests/support/scoring_maze.h"
#include "tests/support/scoring_plan.h"

namespace rubble::scoring {
namespace {

using namespace testing;

TEST(RoomHypotheses, MovedPlanIsFoundWithoutAGuess) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    PlanSpec spec;
    spec.seed = seed;
    const Plan plan = floor_plan(spec);
    const TPose2D T_map_truth(2.0, 5.0, deg_to_rad(70.0 * static_cast<double>(seed)));
    const Rooms truth = extract_rooms(plan.grid);
    const Rooms map = extract_rooms(moved(plan.grid, T_map_truth.phi, T_map_truth.x, T_map_truth.y));
    const auto found = room_hypotheses(map.rooms, truth.rooms);
    ASSERT_FALSE(found.empty());
    for (const Room& room : truth.rooms) {
      const TPoint2D back = found[0].T_truth_map.composePoint(T_map_truth.composePoint(room.centre));
      EXPECT_LT((back - room.centre).norm(), 0.15);
    }
    EXPECT_EQ(found[0].matches.size(), truth.rooms.size());
  }
}

TEST(RoomHypotheses, IdenticalMapsCostNothingAndNoAssociationIsTheWorst) {
  const Rooms rooms = extract_rooms(floor_plan({}).grid);
  EXPECT_NEAR(match_rooms(rooms.rooms, rooms.rooms, {}).score, 1.0, 1e-9);
  EXPECT_NEAR(match_rooms(rooms.rooms, rooms.rooms, {500.0, 0.0, 0.0}).score, 0.0, 1e-12);
  EXPECT_TRUE(match_rooms(rooms.rooms, rooms.rooms, {500.0, 0.0, 0.0}).matches.empty());
}

TEST(RoomHypotheses, PartOfAPlanIsEnough) {
  const Plan plan = floor_plan({});
  const Rooms truth = extract_rooms(plan.grid);
  const Rooms part = extract_rooms(with_coverage(plan.grid, 0.4));
  const auto found = room_hypotheses(part.rooms, truth.rooms);
  ASSERT_FALSE(found.empty());
  double nearest = 1e9;  // some hypothesis, not always the first, is right
  for (const RigidHypothesis& h : found)
    nearest = std::min(nearest, std::hypot(h.T_truth_map.x, h.T_truth_map.y) + 10.0 * std::abs(h.T_truth_map.phi));
  EXPECT_LT(nearest, 0.5);
}

TEST(RoomHypotheses, FewerThanTwoRoomsGiveNone) {
  const Rooms rooms = extract_rooms(floor_plan({}).grid);
  EXPECT_TRUE(room_hypotheses({}, rooms.rooms).empty());
  EXPECT_TRUE(room_hypotheses({rooms.rooms[0]}, rooms.rooms).empty());
  EXPECT_TRUE(room_hypotheses(rooms.rooms, {rooms.rooms[0]}).empty());
}

TEST(RoomHypotheses, RigidFitIsExactOnExactPairs) {
  const TPose2D T(1.0, -2.0, 2.5);
  const std::vector<TPoint2D> from{{0, 0}, {4, 1}, {-2, 3}};
  std::vector<TPoint2D> to;
  for (const TPoint2D& p : from) to.push_back(T.composePoint(p));
  const TPose2D found = fit_rigid(from, to);
  EXPECT_NEAR(found.x, T.x, 1e-12);
  EXPECT_NEAR(found.y, T.y, 1e-12);
  EXPECT_NEAR(wrap_angle(found.phi - T.phi), 0.0, 1e-12);
}

}  // namespace
}  // namespace rubble::scoring
