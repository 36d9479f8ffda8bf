#include "explore/motion/pilot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/body.h"
#include "robot/slope_creep.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Plan straight(double from, double to) {
  Plan plan;
  plan.found = true;
  plan.d_min = 0.4;
  for (double x = from; x <= to; x += 0.05) plan.path.push_back({{x, 3.0}, 1.0});
  plan.target = plan.path.back().p_map;
  return plan;
}

/// A robot in an empty room that does what the pilot says.
struct Steered {
  static constexpr double kTickTime = 0.02;  // [s]

  robot::RobotModel model;
  Pilot pilot{model, FollowerConfig{}};
  Traversable floor = test::measured(test::room(6.0, 6.0));
  TPose2D pose{1.0, 3.0, 0.0};
  Stamp now = Stamp::from_seconds(1.0);
  double turned = 0.0;  ///< in the last tick [rad]
  double slope = 0.0;   ///< it rises to the north [rad]
  bool knows = true;    ///< of the slope
  robot::SlopeCreep creep{model, robot::kRubberOnWood};

  Pilot::Step step() {
    const robot::Tilt lean{slope * std::sin(pose.phi), slope * std::cos(pose.phi)};
    const Pilot::Step step = pilot.step({pose, turned, {}, knows ? lean : robot::Tilt{}}, floor, {}, now);
    turned = step.drive.w * kTickTime;
    const TPoint2D slid = creep.expected(lean, turned);
    pose = pose + TPose2D{step.drive.v * kTickTime + slid.x, slid.y, turned};
    now = now + kTickTime;
    return step;
  }
  /// Until the turn under way has ended, or for as long as it may take.
  Pilot::Step end_of_turn() {
    for (double t = 0.0; t < 20.0; t += kTickTime)
      if (const Pilot::Step last = step(); last.turn_ended) return last;
    ADD_FAILURE() << "it turns for ever";
    return {};
  }
};

/// Each turn begins where the one before ended: what it stands too high must not add up (3 cm a turn if each one stood
/// as high as a long one).
TEST(Pilot, TurnsToAndFroOnASlopeStayWhereTheyBegan) {
  for (const double heading : {0.5 * kPi, 0.0, -2.0}) {
    Steered robot;
    robot.slope = deg_to_rad(10.0);
    robot.pose = {3.0, 3.0, heading};
    for (int i = 0; i < 12; ++i) {
      robot.pilot.turn(i % 2 == 0 ? 0.6 : -0.6, TurnFor::WholeView, robot.now);
      robot.end_of_turn();
    }
    EXPECT_LT(robot.pose.y, 3.10) << heading;
    if (std::abs(std::sin(heading)) > 0.9) {
      EXPECT_GT(robot.pose.y, 2.95) << "it looks along the slope: " << heading;
    }
  }
}

/// The turns that a path begins with are the same as others.
TEST(Pilot, OnASlopeItTurnsToItsPathHigherThanARobotThatKnowsOfNone) {
  const auto turns_to_path_at = [](bool knows) {
    Steered robot;
    robot.slope = deg_to_rad(10.0);
    robot.knows = knows;
    robot.pose = {3.0, 3.0, 0.6 * kPi};
    robot.pilot.follow(straight(3.0, 5.0));
    for (int i = 0; i < 200 && (i == 0 || robot.turned != 0.0) && std::abs(robot.pose.phi) > 0.5; ++i) robot.step();
    return robot.pose.y;
  };
  EXPECT_LT(turns_to_path_at(false), 2.95) << "else there is nothing to keep";
  EXPECT_GT(turns_to_path_at(true), turns_to_path_at(false) + 0.02);
}

/// In a lane as wide as a pallet, with a wall above and one below it on the slope, no corner of the body touches one.
TEST(Pilot, ATurnOnASlopeBetweenTwoWallsTouchesNone) {
  Steered robot;
  robot.slope = deg_to_rad(10.0);
  robot.floor = test::measured(test::room(6.0, 1.3));  // with its walls
  for (const double heading : {0.5 * kPi, 0.0, -2.0}) {
    robot.pose = {3.0, 0.65, heading};
    robot.pilot.stop();
    robot.pilot.turn(2.0 * kPi, TurnFor::WholeView, robot.now);
    double least = 1.0, turned = 0.0;
    for (bool ended = false; !ended;) {
      ended = robot.step().turn_ended;
      turned += robot.turned;
      for (const TPoint2D& corner : robot::body_outline<TPoint2D, double>(robot.model)) {
        const double y = robot.pose.composePoint(corner).y;
        least = std::min({least, y - 0.05, 1.25 - y});
      }
    }
    EXPECT_GT(least, 0.01) << heading;
    EXPECT_GT(turned, 2.0 * kPi - 0.1) << "its time was over, heading " << heading;
  }
}

/// Carried away in between, it does not drive back to the spot of a turn that was given up.
TEST(Pilot, AStopForgetsTheSpotOfATurn) {
  Steered robot;
  robot.pilot.turn(2.0, TurnFor::WholeView, robot.now);
  for (int i = 0; i < 20; ++i) robot.step();
  robot.pilot.stop();
  robot.pose = {2.0, 3.0, 0.0};
  robot.pilot.turn(2.0, TurnFor::WholeView, robot.now);
  robot.end_of_turn();
  EXPECT_LT(distance(position(robot.pose), {2.0, 3.0}), 0.01);
}

TEST(Pilot, DrivesAPathToItsEndAndStands) {
  Steered robot;
  EXPECT_TRUE(robot.pilot.arrived()) << "without a path";
  robot.pilot.follow(straight(1.0, 4.0));
  EXPECT_NEAR(robot.pilot.left(), 3.0, 0.06);
  for (double t = 0.0; t < 30.0 && !robot.pilot.arrived(); t += Steered::kTickTime) robot.step();
  EXPECT_TRUE(robot.pilot.arrived());
  EXPECT_NEAR(distance(position(robot.pose), {4.0, 3.0}), 0.0, 0.15);
  EXPECT_EQ(robot.step().drive.v, 0.0);
}

TEST(Pilot, ATurnComesToItsAngleAndSaysWhatItWasFor) {
  for (const TurnFor purpose : {TurnFor::View, TurnFor::WholeView, TurnFor::Place}) {
    Steered robot;
    robot.pilot.follow(straight(1.0, 4.0));
    robot.pilot.turn(deg_to_rad(-120.0), purpose, robot.now);
    EXPECT_TRUE(robot.pilot.turning());
    EXPECT_TRUE(robot.pilot.path().empty()) << "a turn leaves the path";
    const Pilot::Step last = robot.end_of_turn();
    EXPECT_NEAR(robot.pose.phi, deg_to_rad(-120.0), deg_to_rad(6.0));
    EXPECT_EQ(last.faced, purpose == TurnFor::Place);
    EXPECT_FALSE(robot.pilot.turning());
    EXPECT_FALSE(robot.step().turn_ended) << "it is told once";
  }
}

TEST(Pilot, ANewWayEndsALookAroundButNoTurnThatIsToBeMadeToItsEnd) {
  for (const TurnFor purpose : {TurnFor::View, TurnFor::WholeView, TurnFor::Place}) {
    Steered robot;
    robot.pilot.turn(deg_to_rad(120.0), purpose, robot.now);
    robot.step();
    robot.pilot.follow(straight(1.0, 4.0));
    EXPECT_EQ(robot.pilot.turning(), purpose != TurnFor::View);
    if (purpose == TurnFor::View) continue;
    robot.end_of_turn();
    EXPECT_FALSE(robot.pilot.arrived()) << "then it drives";
  }
}

TEST(Pilot, ATurnThatIsHeldEndsInTime) {
  Steered robot;
  robot.pilot.turn(deg_to_rad(120.0), TurnFor::Place, robot.now);
  double seconds = 0.0;
  for (; seconds < 60.0; seconds += Steered::kTickTime) {
    robot.turned = 0.0;
    if (robot.step().turn_ended) break;
  }
  EXPECT_LT(seconds, 15.0);
}

TEST(Pilot, StopLeavesNothingUnderWay) {
  Steered robot;
  robot.pilot.turn(1.0, TurnFor::WholeView, robot.now);
  robot.pilot.follow(straight(1.0, 4.0));
  robot.pilot.leave_path();
  EXPECT_TRUE(robot.pilot.turning());
  EXPECT_TRUE(robot.pilot.arrived());
  robot.pilot.follow(straight(1.0, 4.0));
  robot.pilot.stop();
  EXPECT_FALSE(robot.pilot.turning());
  const robot::Drive drive = robot.step().drive;
  EXPECT_EQ(drive.v, 0.0);
  EXPECT_EQ(drive.w, 0.0);
}

TEST(Pilot, WaitsWhereSomethingNewStandsAndGoesOnByAnotherWay) {
  Steered robot;
  robot.pilot.follow(straight(1.0, 4.0));
  robot.step();
  EXPECT_TRUE(robot.pilot.check_due(robot.now));
  EXPECT_TRUE(robot.pilot.check({{1.6, 3.0}, {1.6, 3.05}, {1.6, 2.95}}, robot.pose, 0.0, robot.now));
  EXPECT_EQ(robot.pilot.new_things(robot.now).size(), 3u);
  EXPECT_EQ(robot.step().drive.v, 0.0);
  robot.pilot.follow(straight(1.0, 4.0));
  EXPECT_GT(robot.step().drive.v, 0.0);
  robot.pilot.turn(1.0, TurnFor::View, robot.now);
  robot.now = robot.now + 1.0;
  EXPECT_FALSE(robot.pilot.check_due(robot.now)) << "there is no path to check";
}

}  // namespace
}  // namespace rubble::explore
