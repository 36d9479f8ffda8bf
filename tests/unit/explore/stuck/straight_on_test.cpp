#include "explore/stuck/straight_on.h"

#include <gtest/gtest.h>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;
using robot::Drive;

const robot::RobotModel kModel;
const TPose2D kHere{2.0, 2.0, 0.0};

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

const StuckWatch::Hold kStands{"it does not move", Escape::Met::Forwards, true};

TEST(StraightOn, ExplainsWheelsThatTurnInACurve) {
  const StraightOn straight_on(kModel);
  const Drive curve{0.15, 0.4};
  const StuckWatch::Hold steers{"it does not move", Escape::Met::Forwards, false, true};
  const StuckWatch::Hold struck{"a blow stops it", Escape::Met::Forwards};
  EXPECT_TRUE(straight_on.explains(steers, curve, curve)) << "it creeps on, but does not turn";
  EXPECT_FALSE(straight_on.explains(struck, curve, curve)) << "something is there";
  EXPECT_TRUE(straight_on.explains(kStands, curve, curve));
  EXPECT_TRUE(straight_on.explains(kStands, {0.15, -0.4}, Drive{0.14, -0.38}));
  EXPECT_FALSE(straight_on.explains(kStands, curve, std::nullopt)) << "nobody knows what the wheels do";
  EXPECT_FALSE(straight_on.explains(kStands, curve, Drive{0.02, 0.4})) << "the wheels are held";
  EXPECT_FALSE(straight_on.explains(kStands, curve, Drive{0.15, 0.05})) << "the wheels are held";
  EXPECT_FALSE(straight_on.explains(kStands, {0.3, 0.1}, Drive{0.3, 0.1})) << "hardly a curve: something is ahead";
  EXPECT_FALSE(straight_on.explains(kStands, {-0.15, 0.4}, Drive{-0.15, 0.4})) << "nobody looks backwards";
  EXPECT_FALSE(straight_on.explains(kStands, {0.0, 0.4}, Drive{0.0, 0.4}));
}

TEST(StraightOn, DrivesOnForAWayOrATime) {
  StraightOn straight_on(kModel);
  const Traversable floor = test::measured(test::room(4.0, 4.0));
  ASSERT_TRUE(straight_on.worth(kHere, floor, {}, at(10.0)));
  straight_on.begin(kHere, at(10.0));
  const auto drive = straight_on.drive(kHere, at(10.1));
  ASSERT_TRUE(drive);
  EXPECT_GT(drive->v, 0.2);
  EXPECT_EQ(drive->w, 0.0);
  EXPECT_FALSE(straight_on.drive({2.4, 2.0, 0.0}, at(11.0))) << "it came on";
  EXPECT_FALSE(straight_on.drive(kHere, at(12.0))) << "it stands";
}

TEST(StraightOn, IsTriedOnceInAPlaceAndNotTowardsAWall) {
  StraightOn straight_on(kModel);
  const Traversable floor = test::measured(test::room(4.0, 4.0));
  straight_on.begin(kHere, at(10.0));
  EXPECT_FALSE(straight_on.worth({2.1, 2.0, 1.0}, floor, {}, at(20.0)));
  EXPECT_TRUE(straight_on.worth({3.0, 2.0, 3.1}, floor, {}, at(20.0)));
  EXPECT_TRUE(straight_on.worth(kHere, floor, {}, at(80.0)));
  OccupancyGrid with_wall = test::room(4.0, 4.0);
  test::fill(with_wall, 2.3, 0.0, 2.35, 4.0, Occupancy::Occupied);
  const Traversable tight = test::measured(std::move(with_wall));
  EXPECT_FALSE(straight_on.worth(kHere, tight, {}, at(80.0)));
  EXPECT_TRUE(straight_on.worth({2.0, 2.0, 3.14159}, tight, {}, at(80.0))) << "away from it";
  straight_on.begin({3.0, 2.0, 3.1}, at(81.0));
  straight_on.begin({1.0, 1.0, 0.0}, at(82.0));
  EXPECT_FALSE(straight_on.worth({3.1, 2.0, 3.1}, floor, {}, at(90.0))) << "two places do not take turns";
}

/// Whatever lies in the body's way as far as it takes to stop ends it: walls, hits of the newest scan, the unknown.
TEST(StraightOn, NeedsRoomForTheWholeBodyAndItsStop) {
  const StraightOn straight_on(kModel);
  const Traversable floor = test::measured(test::room(4.0, 4.0));
  EXPECT_TRUE(straight_on.room(kHere, floor, {}));
  EXPECT_FALSE(straight_on.room(kHere, floor, {{2.35, 2.0}})) << "somebody steps before it";
  EXPECT_FALSE(straight_on.room(kHere, floor, {{2.40, 2.24}})) << "a post before its corner";
  EXPECT_TRUE(straight_on.room(kHere, floor, {{2.40, 2.40}, {1.6, 2.0}, {3.0, 2.0}})) << "beside, behind and far ahead";
  OccupancyGrid unknown = test::room(4.0, 4.0);
  test::fill(unknown, 2.40, 2.15, 2.45, 2.25, Occupancy::Unknown);
  EXPECT_FALSE(straight_on.room(kHere, test::measured(std::move(unknown)), {}));
  EXPECT_FALSE(straight_on.room({0.3, 2.0, 3.14159}, floor, {})) << "the edge of the map";
}

}  // namespace
}  // namespace rubble::explore
