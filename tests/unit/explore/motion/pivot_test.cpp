#include "explore/motion/pivot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/body.h"
#include "robot/slope_creep.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRoom = 0.40;  // [m]
constexpr double kTick = 0.02;  // [s]

/// Free floor of 6 x 6 m, a wall along y = wall [m].
Traversable floor_with_wall(double wall) {
  GridFrame frame;
  frame.resolution = 0.05;
  frame.width = frame.height = 120;
  OccupancyGrid cells(frame, Occupancy::Free);
  for (int i = 0; i < 120; ++i) {
    cells[{i, 0}] = cells[{i, 119}] = cells[{0, i}] = cells[{119, i}] = Occupancy::Unknown;
    cells[frame.cell({(i + 0.5) * 0.05, wall})] = Occupancy::Occupied;
  }
  Traversable floor = traversable(std::move(cells));
  measure_clearance(floor, 1.2);
  return floor;
}

/// Where a robot comes to stand that turns by `angle` while the ground moves it by `creep` [m/s]. What comes within
/// `*nearest` of y = 3 m of a rectangle of 0.52 x 0.49 m about its middle is noted there.
TPose2D turned(Pivot* pivot, TPose2D pose, double angle, const TPoint2D& creep, const Traversable& floor,
               double* nearest = nullptr) {
  int ticks = 0;
  for (double left = angle; left > 0.0;) {
    const robot::Drive drive = pivot != nullptr ? pivot->keep({0.0, 1.0}, {{}, pose}, floor) : robot::Drive{0.0, 1.0};
    EXPECT_GT(drive.w, 0.0);
    EXPECT_LE(drive.w, 1.0);
    EXPECT_LE(std::abs(drive.v), Pivot::kMostSpeed);
    if (++ticks > 12.0 / kTick) {
      ADD_FAILURE() << "the turn takes longer than 12 s";
      break;
    }
    left -= drive.w * kTick;
    if (nearest != nullptr)
      *nearest =
          std::min(*nearest, 3.0 - pose.y - 0.26 * std::abs(std::sin(pose.phi)) - 0.245 * std::abs(std::cos(pose.phi)));
    pose.x += (drive.v * std::cos(pose.phi) + creep.x) * kTick;
    pose.y += (drive.v * std::sin(pose.phi) + creep.y) * kTick;
    pose.phi += drive.w * kTick;
  }
  return pose;
}

TEST(Pivot, ATurnThatWandersComesToStandNearerToItsSpot) {
  const Traversable floor = floor_with_wall(5.0);
  for (const TPoint2D& creep : {TPoint2D{0.05, 0.0}, TPoint2D{0.0, -0.05}, TPoint2D{-0.03, 0.03}}) {
    Pivot pivot(kRoom);
    const TPose2D kept = turned(&pivot, {2.0, 2.0, 0.3}, 1.5 * kPi, creep, floor);
    const TPose2D left = turned(nullptr, {2.0, 2.0, 0.3}, 1.5 * kPi, creep, floor);
    EXPECT_LT(distance({kept.x, kept.y}, {2.0, 2.0}), 0.6 * distance({left.x, left.y}, {2.0, 2.0}));
  }
}

/// A robot that turns round twice on a slope, from where its middle was [m]; the slope rises towards -y.
struct TurnedOnSlope {
  double lowest = 0.0;
  double mean = 0.0;
  double highest = 0.0;  ///< above its spot: below 0
  int back_and_forth = 0;
  double nearest = 1.0;  ///< of its corners to y = 1 m, above it
};

/// friction: of the floor; the robot takes it to be rubber on wood.
TurnedOnSlope turned_on_slope(const TPose2D& begin, bool knows, const Traversable& floor, double angle,
                              double friction) {
  const robot::RobotModel model;
  const robot::SlopeCreep creep(model, friction), expected(model, robot::kRubberOnWood);
  Pivot pivot(model.swing_radius() + 0.13);
  TPose2D pose = begin;
  TurnedOnSlope turned;
  double sense = 0.0;
  int ticks = 0;
  for (double left = 4.0 * kPi; left > 0.0 && ticks < 60.0 / kTick; ++ticks) {
    const robot::Tilt lean{-std::sin(pose.phi) * angle, -std::cos(pose.phi) * angle};
    const Pivot::Slope slope{knows ? expected.across(lean, 1.0) : TPoint2D{0.0, 0.0}, left};
    const robot::Drive drive = pivot.keep({0.0, 1.0}, {{}, pose}, floor, slope);
    if (std::abs(drive.v) > 0.02) {
      turned.back_and_forth += drive.v * sense < 0.0 ? 1 : 0;
      sense = drive.v;
    }
    const double turn = drive.w * kTick;
    const TPoint2D slid = creep.expected(lean, turn);
    pose = pose + TPose2D(drive.v * kTick + slid.x, slid.y, turn);
    left -= turn;
    turned.lowest = std::max(turned.lowest, pose.y - begin.y);
    turned.highest = std::min(turned.highest, pose.y - begin.y);
    turned.mean += pose.y - begin.y;
    for (const TPoint2D& corner : robot::body_outline<TPoint2D, double>(model))
      turned.nearest = std::min(turned.nearest, pose.composePoint(corner).y - 1.0);
  }
  EXPECT_LT(ticks, 60.0 / kTick) << "the turn does not end";
  turned.mean /= ticks;
  return turned;
}

/// The slope carries it down while it lies across it, and it drives up again while it looks along it: about its spot
/// where it knows of that, also where the floor is not what it takes it for.
TEST(Pivot, ATurnOnASlopeStaysAboutItsSpot) {
  const Traversable wide = floor_with_wall(5.0);
  for (const double friction : {0.5, 0.8, 1.1})
    for (const double begin : {0.0, 0.5 * kPi, 2.0}) {
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", heading " << begin);
      const TurnedOnSlope blind = turned_on_slope({3.0, 2.0, begin}, false, wide, deg_to_rad(10.0), friction);
      const TurnedOnSlope knowing = turned_on_slope({3.0, 2.0, begin}, true, wide, deg_to_rad(10.0), friction);
      EXPECT_GT(blind.mean, 0.06) << "else there is nothing to keep";
      EXPECT_LT(std::abs(knowing.mean), 0.4 * blind.mean);
      EXPECT_LT(knowing.lowest, 0.7 * blind.lowest);
      EXPECT_GT(knowing.highest, -0.10);
    }
}

/// On twice as steep a slope it slides twice as far.
TEST(Pivot, ATurnOnASteepSlopeEndsLessFarBelow) {
  const Traversable wide = floor_with_wall(5.0);
  for (const double begin : {0.0, 0.5 * kPi, 2.0}) {
    SCOPED_TRACE(begin);
    const TurnedOnSlope blind = turned_on_slope({3.0, 2.0, begin}, false, wide, deg_to_rad(16.0), 0.8);
    const TurnedOnSlope knowing = turned_on_slope({3.0, 2.0, begin}, true, wide, deg_to_rad(16.0), 0.8);
    EXPECT_LT(std::abs(knowing.mean), 0.5 * blind.mean);
    EXPECT_LT(knowing.lowest, 0.7 * blind.lowest);
  }
}

/// A wall above is left for as much room as a turn needs there, and approached no further: neither rule undoes what the
/// other one does, and no corner touches it.
TEST(Pivot, BelowAWallOnASlopeItDoesNotDriveBackAndForth) {
  const Traversable floor = floor_with_wall(1.0);
  for (const double away : {0.40, 0.44, 0.48, 0.50, 0.52, 0.56, 0.60})
    for (const double begin : {0.0, 0.5 * kPi, 2.0, -2.0}) {
      SCOPED_TRACE(testing::Message() << away << " m from the wall above, heading " << begin);
      const TurnedOnSlope turned = turned_on_slope({3.0, 1.0 + away, begin}, true, floor, deg_to_rad(10.0), 0.8);
      // Half a turn in which it looks up, and half in which it looks down, twice: four changes and what begins.
      EXPECT_LE(turned.back_and_forth, 8);
      EXPECT_GT(turned.nearest, 0.0);
      EXPECT_GT(turned.highest, -0.10);
      EXPECT_LT(turned.lowest, 0.25);
    }
}

/// What it slid down in one piece of a turn it drives up in the next, after a pause.
TEST(Pivot, WhereItOnlyStoodTheSpotStays) {
  const Traversable wide = floor_with_wall(5.0);
  Pivot pivot(kRoom);
  pivot.keep({0.0, 1.0}, {{}, {2.0, 2.0, 0.0}}, wide);
  pivot.keep({0.0, 0.0}, {{}, {2.1, 2.0, 0.0}}, wide);
  EXPECT_LT(pivot.keep({0.0, 1.0}, {{}, {2.1, 2.0, 0.0}}, wide).v, -0.05);
  pivot.keep({0.1, 0.0}, {{}, {2.1, 2.0, 0.0}}, wide);
  EXPECT_EQ(pivot.keep({0.0, 1.0}, {{}, {2.1, 2.0, 0.0}}, wide).v, 0.0) << "it drove";
}

TEST(Pivot, TheSpotFollowsACorrectedMap) {
  const Traversable wide = floor_with_wall(5.0);
  test::PlantedMapper mapper;
  const Stamp begun = Stamp::from_seconds(1.0), later = Stamp::from_seconds(2.0);
  mapper.plant(begun, {2.0, 2.0, 0.0});
  Pivot pivot(kRoom);
  pivot.keep({0.0, 1.0}, {begun, {2.0, 2.0, 0.0}}, wide);
  mapper.correct(later, {0.5, 0.0, 0.0});
  pivot.follow(mapper);
  EXPECT_NEAR(pivot.keep({0.0, 1.0}, {later, {2.5, 2.0, 0.0}}, wide).v, 0.0, 1e-9);
}

TEST(Pivot, WhereCornersHaveNoRoomTheTurnLeadsAwayFromTheWall) {
  const Traversable floor = floor_with_wall(3.0);
  for (const double heading : {0.2, 1.0, 2.0, -1.0, -2.0}) {
    Pivot pivot(kRoom);
    const double before = 0.30;
    const TPose2D end = turned(&pivot, {3.0, 3.0 - before, heading}, kPi, {}, floor);
    EXPECT_GT(3.0 - end.y, before + 0.03) << heading;
  }
}

TEST(Pivot, CornersLeaveAWallBeforeTheyTurnIntoIt) {
  const Traversable floor = floor_with_wall(3.0);
  for (const double heading : {0.0, 0.1, 0.4, 1.2, kPi - 0.2, kPi, kPi + 0.3, -0.2, -0.5}) {
    const double before = 0.34, angle = 1.9 * kPi;
    double kept = 1.0, left = 1.0;
    Pivot pivot(std::hypot(0.26, 0.245) + 0.13);
    turned(&pivot, {3.0, 3.0 - before, heading}, angle, {}, floor, &kept);
    turned(nullptr, {3.0, 3.0 - before, heading}, angle, {}, floor, &left);
    EXPECT_LT(left, 0.0) << "else there is nothing to keep off";
    EXPECT_GT(kept, 0.0) << heading;
  }
}

TEST(Pivot, WithRoomOrBetweenTwoWallsItTurnsAsFastAsItWasTold) {
  const Traversable wide = floor_with_wall(3.0);
  for (double heading = -3.0; heading < 3.1; heading += 0.25) {
    EXPECT_EQ(Pivot(kRoom).keep({0.0, -0.7}, {{}, {3.0, 2.5, heading}}, wide).w, -0.7) << heading;
  }
}

TEST(Pivot, LeavesEveryOtherDriveAsItIs) {
  const Traversable floor = floor_with_wall(3.0);
  Pivot pivot(kRoom);
  for (const robot::Drive& drive : {robot::Drive{0.4, 0.0}, robot::Drive{0.2, -1.0}, robot::Drive{0.0, 0.0}}) {
    const robot::Drive kept = pivot.keep(drive, {{}, {3.0, 2.7, 0.0}}, floor);
    EXPECT_EQ(kept.v, drive.v);
    EXPECT_EQ(kept.w, drive.w);
  }
  EXPECT_EQ(pivot.keep({0.0, 1.0}, {{}, {3.0, 2.0, 0.0}}, Traversable()).v, 0.0) << "before there is a map";
}

}  // namespace
}  // namespace rubble::explore
