#include "explore/motion/pivot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/slope_creep.h"

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
    const robot::Drive drive = pivot != nullptr ? pivot->keep({0.0, 1.0}, pose, floor) : robot::Drive{0.0, 1.0};
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

/// How far below its spot a robot gets that turns round twice on a slope of 10 deg [m].
struct Below {
  double most = 0.0;
  double mean = 0.0;
  double least = 0.0;  ///< above its spot: below 0
};

/// friction: of the floor; the robot takes it to be rubber on wood.
Below turned_on_slope(double begin, bool knows, const Traversable& floor, double middle, double friction) {
  const robot::RobotModel model;
  const robot::SlopeCreep creep(model, friction), expected(model, robot::kRubberOnWood);
  Pivot pivot(model.swing_radius() + 0.13);
  TPose2D pose{3.0, middle, begin};
  Below below;
  int ticks = 0;
  for (double left = 4.0 * kPi; left > 0.0; ++ticks) {
    // It rises towards -y.
    const robot::Lean lean{-std::sin(pose.phi) * deg_to_rad(10.0), -std::cos(pose.phi) * deg_to_rad(10.0)};
    const robot::Drive drive =
        pivot.keep({0.0, 1.0}, pose, floor, knows ? expected.across(lean, std::min(0.6, left)) : TPoint2D{0.0, 0.0});
    const double turn = drive.w * kTick;
    const TPoint2D slid = creep.expected(lean, turn);
    pose = pose + TPose2D(drive.v * kTick + slid.x, slid.y, turn);
    left -= turn;
    below.most = std::max(below.most, pose.y - middle);
    below.least = std::min(below.least, pose.y - middle);
    below.mean += pose.y - middle;
  }
  below.mean /= ticks;
  return below;
}

/// The slope carries it down while it lies across it, and it drives up again while it looks along it: about its spot
/// where it knows of that, also where the floor is not what it takes it for.
TEST(Pivot, ATurnOnASlopeStaysAboutItsSpot) {
  const Traversable wide = floor_with_wall(5.0);
  for (const double friction : {0.5, 0.8, 1.1})
    for (const double begin : {0.0, 0.5 * kPi, 2.0}) {
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", heading " << begin);
      const Below blind = turned_on_slope(begin, false, wide, 2.0, friction);
      const Below knowing = turned_on_slope(begin, true, wide, 2.0, friction);
      EXPECT_GT(blind.mean, 0.06) << "else there is nothing to keep";
      EXPECT_LT(std::abs(knowing.mean), 0.4 * blind.mean);
      EXPECT_LT(knowing.most, 0.7 * blind.most);
      EXPECT_GT(knowing.least, -0.10);
    }
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
    EXPECT_EQ(Pivot(kRoom).keep({0.0, -0.7}, {3.0, 2.5, heading}, wide).w, -0.7) << heading;
  }
}

TEST(Pivot, LeavesEveryOtherDriveAsItIs) {
  const Traversable floor = floor_with_wall(3.0);
  Pivot pivot(kRoom);
  for (const robot::Drive& drive : {robot::Drive{0.4, 0.0}, robot::Drive{0.2, -1.0}, robot::Drive{0.0, 0.0}}) {
    const robot::Drive kept = pivot.keep(drive, {3.0, 2.7, 0.0}, floor);
    EXPECT_EQ(kept.v, drive.v);
    EXPECT_EQ(kept.w, drive.w);
  }
  EXPECT_EQ(pivot.keep({0.0, 1.0}, {3.0, 2.0, 0.0}, Traversable()).v, 0.0) << "before there is a map";
}

}  // namespace
}  // namespace rubble::explore
