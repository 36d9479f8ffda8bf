#include "robot/slope_creep.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rubble::robot {
namespace {

/// Forces and moment of four sliding wheels of a robot that turns at w, by Coulomb friction, per weight.
Eigen::Vector3d pull(const RobotModel& model, double friction, double w, const Eigen::Vector3d& slip) {
  const double a = 0.5 * model.wheelbase;
  const double b = 0.5 * model.track;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const double x : {a, -a})
    for (const double y : {b, -b}) {
      // The rims run by slip.z too fast, ahead on the right and back on the left.
      Eigen::Vector2d v(slip.x() + (y < 0.0 ? -slip.z() : slip.z()), slip.y() + w * x);
      const Eigen::Vector2d force = -0.25 * friction * v.normalized();
      sum += Eigen::Vector3d(force.x(), force.y(), x * force.y() - y * force.x());
    }
  return sum;
}

/// The slip at which friction holds the robot on its slope and nothing turns it faster or slower, by Newton's method on
/// a slope that grows.
Eigen::Vector3d steady(const RobotModel& model, double friction, double w, double pitch, double roll) {
  Eigen::Vector3d slip(0.0, 0.0, 0.05);
  const Eigen::Vector3d wanted(std::tan(pitch), std::tan(roll), 0.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d off = pull(model, friction, w, slip) - std::min(1.0, 0.01 * i) * wanted;
    Eigen::Matrix3d J;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = 1e-7 * Eigen::Vector3d::Unit(k);
      J.col(k) = (pull(model, friction, w, slip + d) - pull(model, friction, w, slip - d)) / 2e-7;
    }
    slip -= J.inverse() * off;
  }
  return slip;
}

TEST(SlopeCreep, HoldsTheRobotOnItsSlopeByFriction) {
  RobotModel model;
  for (const double friction : {0.4, 0.8})
    for (const double pitch : {0.02, -0.05, 0.0})
      for (const double roll : {0.0, 0.03, -0.05}) {
        const double w = 1.0;
        const Eigen::Vector3d slip = steady(model, friction, w, pitch, roll);
        const auto creep = SlopeCreep(model, friction).expected({pitch, roll}, 0.1 * w);
        const double bound = 0.05 * std::hypot(slip.x(), slip.y()) * 0.1 + 1e-9;
        EXPECT_NEAR(creep.x, 0.1 * slip.x(), bound) << friction << ' ' << pitch << ' ' << roll;
        EXPECT_NEAR(creep.y, 0.1 * slip.y(), bound) << friction << ' ' << pitch << ' ' << roll;
      }
}

TEST(SlopeCreep, IsTheSameForBothSensesOfTurningAndNoneWithoutSlope) {
  const SlopeCreep creep({}, 0.8);
  EXPECT_EQ(creep.expected({0.1, -0.15}, 0.1).x, creep.expected({0.1, -0.15}, -0.1).x);
  EXPECT_EQ(creep.expected({0.1, -0.15}, 0.1).y, creep.expected({0.1, -0.15}, -0.1).y);
  EXPECT_LT(creep.expected({0.1, -0.15}, 0.1).x, 0.0);  // nose up: back
  EXPECT_GT(creep.expected({0.1, -0.15}, 0.1).y, 0.0);  // right side up: to the left
  EXPECT_EQ(creep.expected({0.1, -0.15}, 0.0).y, 0.0);
}

TEST(SlopeCreep, WheelsThatTurnAsTheRobotDoesDoNotSlide) {
  RobotModel castors;
  castors.effective_track = castors.track + 0.001;  // as calibrated
  RobotModel one_axle, no_track;
  one_axle.wheelbase = 0.0;
  no_track.track = 0.0;
  for (const SlopeCreep& creep :
       {SlopeCreep(castors, 0.8), SlopeCreep(one_axle, 0.8), SlopeCreep(no_track, 0.8), SlopeCreep({}, 0.0)}) {
    EXPECT_EQ(creep.expected({0.2, 0.2}, 0.1).x, 0.0);
    EXPECT_EQ(creep.expected({0.2, 0.2}, 0.1).y, 0.0);
  }
}

TEST(SlopeCreep, AcrossASlopeItSlidesAsFarWhicheverWayItLies) {
  const SlopeCreep creep({}, 0.8);
  EXPECT_EQ(creep.across({0.0, 0.1}, 1.0).y, creep.expected({0.0, 0.1}, 1.0).y);
  EXPECT_EQ(creep.across({0.1, 0.0}, 1.0).x, creep.expected({0.0, 0.1}, 1.0).y);
  EXPECT_LT(std::abs(creep.expected({0.1, 0.0}, 1.0).x), std::abs(creep.across({0.1, 0.0}, 1.0).x));
}

/// A wrong friction or a tilt that no floor has does not carry it away: at most as fast as its wheels slide.
TEST(SlopeCreep, IsBounded) {
  for (const double friction : {0.01, 0.1, 0.8}) {
    const auto creep = SlopeCreep({}, friction).expected({0.6, -0.6}, 0.1);
    EXPECT_LE(std::hypot(creep.x, creep.y), 0.1 * 0.3) << friction;
  }
}

}  // namespace
}  // namespace rubble::robot
