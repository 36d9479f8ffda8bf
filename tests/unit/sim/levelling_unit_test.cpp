#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "base/angle.h"
#include "robot/levelling.h"
#include "sim/accelerometer.h"
#include "sim/body/servos.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

constexpr double kGravity = 9.80665;

TEST(Accelerometer, AtRestOnARampItReadsGravityTimesSine) {
  for (const double deg : {-10.0, 0.0, 5.0, 10.0}) {
    SimRobot robot(slope(-5, -5, 5, 5, deg_to_rad(deg)), {}, exact(), 1);
    robot::Acceleration last;
    run(robot, drive(0.0), 1.0, [&](const robot::Inputs& inputs) {
      for (const auto& a : inputs.accelerations) last = a;
    });
    EXPECT_NEAR(last.x, kGravity * std::sin(deg_to_rad(deg)), 0.01) << deg;  // one count is 8 mm/s^2
    EXPECT_NEAR(last.y, 0.0, 0.01);
  }
}

TEST(Accelerometer, LeftSideUpReadsPositiveAcross) {
  arenas::Arena arena = slope(-5, -5, 5, 5, deg_to_rad(10.0));
  arena.start = {0.0, 0.0, deg_to_rad(-90.0)};  // uphill is to the left
  SimRobot robot(arena, {}, exact(), 1);
  robot::Acceleration last;
  run(robot, drive(0.0), 1.0, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) last = a;
  });
  EXPECT_NEAR(last.y, kGravity * std::sin(deg_to_rad(10.0)), 0.01);
  EXPECT_NEAR(last.x, 0.0, 0.01);
}

TEST(Accelerometer, StartingFeelsLikeATiltOfOneAndThreeQuarterDegrees) {
  SimRobot robot(flat_floor(-10, -10, 10, 10), {}, exact(), 1);
  std::vector<double> tilts;
  run(robot, drive(0.6), 1.5, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) {
      if (a.stamp.seconds() > 0.3) tilts.push_back(rad_to_deg(std::asin(a.x / kGravity)));
    }
  });
  const auto [low, high] = std::minmax_element(tilts.begin(), tilts.end());
  std::cout << "0.3 m/s2 reads as " << *low << " .. " << *high << " deg\n";
  EXPECT_NEAR(*low, 1.75, 0.1);
  EXPECT_NEAR(*high, 1.75, 0.1);
}

TEST(Accelerometer, TurningOnTheSpotPullsOutwards) {
  const robot::RobotModel model;
  SimRobot robot(flat_floor(-10, -10, 10, 10), model, exact(), 1);
  double x = 0.0;
  run(robot, drive(0.0, 1.0), 4.0, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) x = a.x;
  });
  const double w = (robot.truth().back().pose.phi - robot.truth()[robot.truth().size() - 2].pose.phi) / model.tick;
  EXPECT_NEAR(x, -w * w * model.T_base_laser.x, 0.01);  // towards the turn centre
}

TEST(Accelerometer, OnThePlatformItSeesWhatTheServosLeave) {
  const double slope_angle = deg_to_rad(10.0);
  SimRobot robot(slope(-5, -5, 5, 5, slope_angle), {}, exact(), 1);
  double x = 0.0;
  run(robot, {{0.0, 0.0}, {-slope_angle, 0.0}}, 2.0, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) x = a.x;
  });
  EXPECT_NEAR(rad_to_deg(std::asin(x / kGravity)), 0.0, 0.35);  // the servo's dead band

  robot::RobotModel on_body;
  on_body.accelerometer_mount = robot::AccelerometerMount::Body;
  SimRobot body(slope(-5, -5, 5, 5, slope_angle), on_body, exact(), 1);
  run(body, {{0.0, 0.0}, {-slope_angle, 0.0}}, 2.0, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) x = a.x;
  });
  EXPECT_NEAR(rad_to_deg(std::asin(x / kGravity)), 10.0, 0.1);
}

/// One mount, read by the controller and by the simulated sensor: with the sensor on the body the servos undo the
/// slope.
TEST(Accelerometer, OnTheBodyControlAndSimulationAgree) {
  const double slope_angle = deg_to_rad(8.0);
  for (const auto mount : {robot::AccelerometerMount::Platform, robot::AccelerometerMount::Body}) {
    robot::RobotModel model;
    model.accelerometer_mount = mount;
    SimRobot robot(slope(-5, -5, 5, 5, slope_angle), model, exact(), 1);
    robot::Levelling levelling({}, robot.model());
    double pitch = 0.0;
    for (int tick = 0; tick < 150; ++tick) {
      const auto inputs = robot.read();
      ASSERT_TRUE(inputs);
      robot::Commands commands;
      commands.aim = levelling.update(*inputs);
      robot.command(commands);
      if (!inputs->aims.empty()) pitch = inputs->aims.back().pitch;
    }
    EXPECT_NEAR(rad_to_deg(pitch), -8.0, 0.5) << (mount == robot::AccelerometerMount::Body ? "body" : "platform");
  }
}

TEST(Accelerometer, NoiseIsThatOfTheDataSheet) {
  double spread = 0.0;
  double worst_offset = 0.0;
  const int parts = 20;
  for (int seed = 1; seed <= parts; ++seed) {
    SimRobot robot(flat_floor(-3, -3, 3, 3), {}, SimConfig{}, static_cast<std::uint64_t>(seed));
    double sum = 0.0;
    double squares = 0.0;
    int n = 0;
    run(robot, drive(0.0), 20.0, [&](const robot::Inputs& inputs) {
      for (const auto& a : inputs.accelerations) {
        sum += a.x / kGravity;
        squares += a.x * a.x / (kGravity * kGravity);
        ++n;
      }
    });
    EXPECT_EQ(n, 1000);
    spread += std::sqrt(squares / n - sum / n * sum / n) / parts;
    worst_offset = std::max(worst_offset, std::abs(sum / n));
  }
  std::cout << "noise " << 1e3 * spread << " mg rms (" << rad_to_deg(spread) << " deg), largest offset left "
            << 1e3 * worst_offset << " mg\n";
  // 500 ug/rtHz in 78.5 Hz is 4.4 mg a pulse; a sample is the mean of two.
  EXPECT_NEAR(spread, 500e-6 * std::sqrt(1.57 * 50.0) / std::sqrt(2.0), 0.0003);
  EXPECT_LT(worst_offset, 0.008);
}

/// Steps a servo from 0 to `deg`, angle after each millisecond [deg].
std::vector<double> servo_step(double deg, int milliseconds) {
  Servo servo{ServoParameters{}};
  servo.step(1);  // a frame has just begun
  servo.command(deg_to_rad(deg));
  std::vector<double> angles;
  for (int i = 0; i < milliseconds; ++i) {
    servo.step(1);
    angles.push_back(rad_to_deg(servo.angle()));
  }
  return angles;
}

TEST(Servos, AStepWaitsForTheFrameRunsAtThreeHundredDegreesPerSecondAndStopsInTheDeadBand) {
  const std::vector<double> angles = servo_step(30.0, 500);
  EXPECT_EQ(angles[18], 0.0);  // the pulse comes every 20 ms
  double fastest = 0.0;
  for (std::size_t i = 1; i < angles.size(); ++i) fastest = std::max(fastest, angles[i] - angles[i - 1]);
  EXPECT_NEAR(fastest, 0.3, 1e-9);
  EXPECT_NEAR(angles.back(), 30.0, 0.4);
  const auto reached = std::find_if(angles.begin(), angles.end(), [](double a) { return a > 27.0; });
  const double t90 = static_cast<double>(reached - angles.begin()) * 1e-3;
  std::cout << "30 deg step: 90 % after " << t90 << " s, rests at " << angles.back() << " deg\n";
  EXPECT_NEAR(t90, 0.02 + 18.0 / 300.0 + 0.04 * std::log(12.0 / 3.0), 0.01);  // rate limit to 12 deg, then 40 ms lag
}

TEST(Servos, ErrorsInsideTheDeadBandMoveNothing) {
  EXPECT_EQ(servo_step(0.25, 200).back(), 0.0);
  EXPECT_GT(servo_step(0.5, 200).back(), 0.1);
}

TEST(Servos, TravelEndsAtThirtyDegrees) {
  EXPECT_LE(servo_step(50.0, 800).back(), 30.0 + 1e-9);
  EXPECT_GE(servo_step(-50.0, 800).back(), -30.0 - 1e-9);
}

TEST(Servos, BacklashLeavesTheHornBehind) {
  ServoParameters parameters;
  parameters.backlash = deg_to_rad(0.6);
  Servo servo(parameters);
  const auto go = [&](double deg) {
    servo.command(deg_to_rad(deg));
    servo.step(1000);
    return rad_to_deg(servo.angle());
  };
  const double from_below = go(10.0);
  go(20.0);
  const double from_above = go(10.0);
  EXPECT_GT(from_above - from_below, 0.6);
}

}  // namespace
}  // namespace rubble::sim::test
