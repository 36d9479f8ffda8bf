#include "explore/motion/corner_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/body.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

const robot::RobotModel kCornerBody;
constexpr double kCornerTick = 0.02;  // [s]
constexpr double kRoomWidth = 3.0;    ///< width of the room [m]

/// The walls of the room are its outermost cells: their insides lie a cell within.
double nearest_wall(const TPose2D& pose) {
  double least = kRoomWidth;
  for (const TPoint2D& corner : robot::body_outline<TPoint2D, double>(kCornerBody)) {
    const TPoint2D p = pose.composePoint(corner);
    least = std::min({least, p.x - 0.05, p.y - 0.05, kRoomWidth - 0.05 - p.x, kRoomWidth - 0.05 - p.y});
  }
  return least;
}

/// The base on its ramps.
struct Base {
  TPose2D pose;
  Drive moving;

  void go(const Drive& drive, bool brakes) {
    moving.v = brakes ? 0.0 : robot::approach(moving.v, drive.v, kCornerBody.max_accel * kCornerTick);
    moving.w = brakes ? 0.0 : robot::approach(moving.w, drive.w, kCornerBody.max_turn_accel * kCornerTick);
    pose = pose + TPose2D{moving.v * kCornerTick, 0.0, moving.w * kCornerTick};
  }
};

struct Turn {
  double nearest = kRoomWidth;  ///< that a corner came to a wall [m]
  double seconds = 0.0;
  bool braked = false;
};

/// Turns by `angle` [rad], as told or with its corners kept off the walls.
Turn turn(Base base, double angle, bool kept) {
  const Traversable floor = test::measured(test::room(kRoomWidth, kRoomWidth));
  CornerRoom corners(kCornerBody);
  Turn turn;
  for (double left = angle; std::abs(left) > 0.05 && turn.seconds < 30.0; turn.seconds += kCornerTick) {
    const Drive told{0.0, std::copysign(1.0, left)};
    CornerRoom::Kept now{told};
    if (kept) now = corners.keep(told, base.moving, {{}, base.pose}, floor, {});
    base.go(now.drive, now.brakes);
    turn.braked = turn.braked || now.brakes;
    left -= base.moving.w * kCornerTick;
    turn.nearest = std::min(turn.nearest, nearest_wall(base.pose));
  }
  return turn;
}

TEST(CornerRoom, WithRoomItTurnsAsTold) {
  const Traversable floor = test::measured(test::room(kRoomWidth, kRoomWidth));
  CornerRoom corners(kCornerBody);
  for (double heading = -3.0; heading < 3.1; heading += 0.25) {
    const auto kept = corners.keep({0.05, -0.7}, {0.05, -0.7}, {{}, {1.5, 1.5, heading}}, floor, {});
    EXPECT_EQ(kept.drive.v, 0.05);
    EXPECT_EQ(kept.drive.w, -0.7);
    EXPECT_FALSE(kept.brakes);
  }
}

/// Beside a wall, alongside or askew, where the corners have no room on the spot.
TEST(CornerRoom, CornersThatWouldTurnIntoAWallDoNot) {
  for (const double beside : {0.05, 0.08})
    for (const double heading : {0.0, 0.15, kPi - 0.1, kPi})
      for (const double angle : {2.5, -2.5}) {
        // The corner that is nearest stands `beside` off the wall.
        TPose2D pose{1.5, 1.5, heading};
        pose.y -= nearest_wall({1.5, 0.5, heading}) + 1.0 - beside;
        const Turn told = turn({pose, {}}, angle, false);
        const Turn kept = turn({pose, {}}, angle, true);
        EXPECT_LT(told.nearest, 0.036) << "else there is nothing to keep off";
        EXPECT_GT(kept.nearest, beside < 0.06 ? 0.018 : 0.042) << beside << " " << heading << " " << angle;
        EXPECT_LT(kept.seconds, 9.0);
      }
}

/// On its ramp it would roll on for 0.6 m.
TEST(CornerRoom, ARobotThatRollsTowardsAWallAsItTurnsBrakes) {
  for (const double turns : {1.5, -1.5}) {
    const Base base{{kRoomWidth - 0.75, 1.5, 0.0}, {0.6, 0.0}};
    EXPECT_LT(turn(base, turns, false).nearest, 0.0);
    const Turn kept = turn(base, turns, true);
    EXPECT_GT(kept.nearest, 0.02);
    EXPECT_TRUE(kept.braked);
    EXPECT_LT(kept.seconds, 8.0);
  }
  EXPECT_FALSE(turn({{1.0, 1.5, 0.0}, {0.3, 0.0}}, 1.5, true).braked) << "where it has room there is no need";
}

/// The map shows a wall in cells; the newest scan shows where it ends. A ball gives way.
TEST(CornerRoom, HitsBesideAWallAreOfItAndHitsThatStandAloneAreNot) {
  const Traversable floor = test::measured(test::room(kRoomWidth, kRoomWidth));
  const TPose2D pose{1.5, 0.05 + 0.12 + 0.5 * kCornerBody.width, 0.0};
  const Drive told{0.0, 1.0};
  const auto kept = [&](const std::vector<TPoint2D>& hits) {
    return CornerRoom(kCornerBody).keep(told, told, {{}, pose}, floor, hits).drive;
  };
  EXPECT_EQ(kept({}).w, told.w) << "there is room";
  // Before the two corners that swing outwards: behind on the right, ahead on the left.
  EXPECT_NE(kept({{1.4, 0.13}}).w, told.w);
  EXPECT_EQ(kept({{1.6, 2.0 * pose.y - 0.13}}).w, told.w);
}

TEST(CornerRoom, DoesNotDriveWhereNobodyLooked) {
  OccupancyGrid cells = test::room(kRoomWidth, kRoomWidth);
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width(); ++x)
      if (cells.centre({x, y}).x < 1.5 - 0.5 * kCornerBody.length - 0.05 && cells[{x, y}] == Occupancy::Free)
        cells[{x, y}] = Occupancy::Unknown;
  const Traversable floor = test::measured(cells);
  const Traversable all_seen = test::measured(test::room(kRoomWidth, kRoomWidth));
  // Askew beside a wall, its nose towards it: backwards leads off.
  const TPose2D pose{1.5, 0.05 + 0.33, -0.3};
  const Drive told{0.0, -1.0};
  EXPECT_LT(CornerRoom(kCornerBody).keep(told, {}, {{}, pose}, all_seen, {}).drive.v, 0.0);
  EXPECT_GE(CornerRoom(kCornerBody).keep(told, {}, {{}, pose}, floor, {}).drive.v, 0.0);
}

/// There is no room to be had: it gets round nevertheless.
TEST(CornerRoom, BetweenTwoWallsItTurnsAllTheSame) {
  GridFrame frame;
  frame.resolution = 0.05;
  frame.width = 60;
  frame.height = 14;  // 0.6 m of floor
  OccupancyGrid cells(frame, Occupancy::Free);
  for (int x = 0; x < frame.width; ++x) cells[{x, 0}] = cells[{x, frame.height - 1}] = Occupancy::Occupied;
  const Traversable floor = test::measured(cells);
  CornerRoom corners(kCornerBody);
  Base base{{1.5, 0.35, 0.0}, {}};
  double seconds = 0.0;
  for (; base.pose.phi < 3.0 && seconds < 30.0; seconds += kCornerTick) {
    const auto kept = corners.keep({0.0, 1.0}, base.moving, {{}, base.pose}, floor, {});
    base.go(kept.drive, kept.brakes);
  }
  EXPECT_LT(seconds, 12.0);
}

}  // namespace
}  // namespace rubble::explore
