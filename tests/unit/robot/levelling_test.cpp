#include "robot/levelling.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/levelling_rig.h"

namespace rubble::robot {
namespace {

using levelling_test::Body;
using levelling_test::Sample;

constexpr double kStart = 1.0;  ///< [s] the body begins to move

Body step_of_ten_degrees(double t) { return {t < kStart ? 0.0 : deg_to_rad(10.0), 0.0, 0.0, 0.0}; }

/// Wheelbase on a 10 deg ramp: the pitch rises over 0.67 s.
Body onto_a_ramp(double t) { return {deg_to_rad(10.0) * std::clamp((t - kStart) / 0.67, 0.0, 1.0), 0.0, 0.0, 0.0}; }

/// Drives off at 0.3 m/s^2 for a second on level ground.
Body drive_off(double t) {
  const double v = 0.3 * std::clamp(t - kStart, 0.0, 1.0);
  return {0.0, t >= kStart && t < kStart + 1.0 ? 0.3 : 0.0, v, 0.0};
}

double overshoot(const std::vector<Sample>& samples) {
  double least = 0.0;
  for (const Sample& s : samples) {
    if (s.t > kStart) least = std::min(least, s.plane_pitch);
  }
  return -least;
}

Inputs standing(double t, double pitch, double roll) {
  Inputs inputs;
  inputs.now = Stamp::from_seconds(t);
  const double g = 9.80665;
  inputs.accelerations.push_back({inputs.now, g * std::sin(pitch), g * std::sin(roll) * std::cos(pitch)});
  return inputs;
}

TEST(Levelling, LevelRobotKeepsTheLaserStill) {
  Levelling levelling({}, RobotModel());
  for (int i = 0; i < 100; ++i) {
    const LaserAim aim = levelling.update(standing(0.02 * i, 0.0, 0.0));
    EXPECT_EQ(aim.pitch, 0.0);
    EXPECT_EQ(aim.roll, 0.0);
  }
}

TEST(Levelling, NoseUpRobotTurnsTheLaserNoseDown) {
  const auto samples = levelling_test::run({}, 4.0, step_of_ten_degrees);
  EXPECT_NEAR(rad_to_deg(samples.back().aim_pitch), -10.0, 1.0);
}

TEST(Levelling, TenDegreeStepIsLevelledInAboutHalfASecond) {
  const auto samples = levelling_test::run({}, 4.0, step_of_ten_degrees);
  const double settled = levelling_test::settled_after(samples, deg_to_rad(1.0)) - kStart;
  EXPECT_GT(settled, 0.57 * 0.7);
  EXPECT_LT(settled, 0.57 * 1.3);
  EXPECT_LT(rad_to_deg(overshoot(samples)), 0.6);
}

TEST(Levelling, HigherIntegralGainIsFasterUntilItRings) {
  double last = 10.0;
  for (const double ki : {2.0, 4.0, 6.0}) {
    LevellingConfig config;
    config.ki = ki;
    const auto samples = levelling_test::run(config, 5.0, step_of_ten_degrees);
    const double settled = levelling_test::settled_after(samples, deg_to_rad(1.0)) - kStart;
    EXPECT_LT(settled, last) << "ki " << ki;
    last = settled;
  }
  LevellingConfig ringing;
  ringing.ki = 12.0;
  EXPECT_GT(rad_to_deg(overshoot(levelling_test::run(ringing, 5.0, step_of_ten_degrees))), 1.0);
}

/// The choices side by side: sensor on the platform or the body, with and without feed forward of the wheels' own
/// acceleration. The design's simulation had: settled after 0.57 s and 0.17 s, ramp 3.5 deg and 1.6 deg, false tilt
/// 1.75 deg.
TEST(Levelling, FiguresOfTheChoices) {
  for (const AccelerometerMount mount : {AccelerometerMount::Platform, AccelerometerMount::Body}) {
    for (const bool feed_forward : {false, true}) {
      LevellingConfig config;
      config.feed_forward = feed_forward;
      const auto step = levelling_test::run(config, 4.0, step_of_ten_degrees, mount);
      const auto ramp = levelling_test::run(config, 4.0, onto_a_ramp, mount);
      const auto start = levelling_test::run(config, 4.0, drive_off, mount);
      const double settled = levelling_test::settled_after(step, deg_to_rad(1.0)) - kStart;
      const double on_ramp = rad_to_deg(levelling_test::largest(ramp, kStart, 4.0));
      const double false_tilt = rad_to_deg(levelling_test::largest(start, kStart, 4.0));
      std::cout << (mount == AccelerometerMount::Platform ? "platform" : "body")
                << (feed_forward ? ", feed forward" : ", plain") << ": step within 1 deg after " << settled
                << " s, overshoot " << rad_to_deg(overshoot(step)) << " deg; ramp at most " << on_ramp
                << " deg off; a start at 0.3 m/s2 tilts by " << false_tilt << " deg\n";
      const double wanted_settled = mount == AccelerometerMount::Platform ? 0.57 : 0.17;
      const double wanted_on_ramp = mount == AccelerometerMount::Platform ? 3.5 : 1.6;
      EXPECT_NEAR(settled, wanted_settled, 0.3 * wanted_settled);
      EXPECT_NEAR(on_ramp, wanted_on_ramp, 0.3 * wanted_on_ramp);
    }
  }
}

/// The design's simulation: 1.3, 0.57, 0.33 s; Ki 8 overshoots by 0.2 deg, Ki 12 rings. Here Ki 8 overshoots by a
/// degree: docs/simulator.md.
TEST(Levelling, FiguresOfTheGains) {
  struct Wanted {
    double ki, settled, least_overshoot, most_overshoot;
  };
  for (const Wanted& wanted : {Wanted{2.0, 1.3, 0.0, 0.3}, Wanted{4.0, 0.57, 0.0, 0.3}, Wanted{6.0, 0.33, 0.0, 0.3},
                               Wanted{8.0, 0.0, 0.2, 1.5}, Wanted{12.0, 0.0, 1.7, 5.0}}) {
    LevellingConfig config;
    config.ki = wanted.ki;
    const auto step = levelling_test::run(config, 5.0, step_of_ten_degrees);
    const double settled = levelling_test::settled_after(step, deg_to_rad(1.0)) - kStart;
    const double over = rad_to_deg(overshoot(step));
    std::cout << "Ki " << wanted.ki << ": step within 1 deg after " << settled << " s, overshoot " << over << " deg\n";
    if (wanted.settled > 0.0) {
      EXPECT_NEAR(settled, wanted.settled, 0.3 * wanted.settled);
    }
    EXPECT_GE(over, wanted.least_overshoot);
    EXPECT_LE(over, wanted.most_overshoot);
  }
}

/// Why a unit that answers late holds the robot (SafetySettings::levelling_answer): as late as is permitted the plane
/// still comes to rest; some more, and it swings without end.
TEST(Levelling, ALateLineSwingsTheLaser) {
  const auto late_by = [](int ms) {
    return levelling_test::run({}, 12.0, step_of_ten_degrees, AccelerometerMount::Platform, 0.1, ms);
  };
  const auto permitted = late_by(250);
  EXPECT_LT(levelling_test::settled_after(permitted, deg_to_rad(1.0)) - kStart, 4.0);
  EXPECT_GT(rad_to_deg(levelling_test::largest(late_by(400), 8.0, 12.0)), 5.0);
}

TEST(Levelling, RampIsFollowedWithinAFewDegrees) {
  const auto samples = levelling_test::run({}, 4.0, onto_a_ramp);
  EXPECT_NEAR(rad_to_deg(levelling_test::largest(samples, kStart, 4.0)), 3.5, 1.05);
  EXPECT_NEAR(levelling_test::settled_after(samples, deg_to_rad(1.0)) - kStart, 0.95, 0.285);
}

TEST(Levelling, SettledPlaneStaysWithinTheServosDeadBand) {
  const auto samples = levelling_test::run({}, 6.0, step_of_ten_degrees);
  EXPECT_LT(rad_to_deg(levelling_test::largest(samples, 4.0, 6.0)), 0.7);
}

TEST(Levelling, DrivingOffLooksLikeTiltWithoutFeedForward) {
  LevellingConfig config;
  config.feed_forward = false;
  const auto samples = levelling_test::run(config, 4.0, drive_off);
  EXPECT_NEAR(rad_to_deg(levelling_test::largest(samples, kStart, 4.0)), 1.75, 0.35);
}

TEST(Levelling, FeedForwardTakesMostOfTheFalseTiltAway) {
  LevellingConfig without;
  without.feed_forward = false;
  const double plain = levelling_test::largest(levelling_test::run(without, 4.0, drive_off), kStart, 4.0);
  const double helped = levelling_test::largest(levelling_test::run({}, 4.0, drive_off), kStart, 4.0);
  EXPECT_LT(helped, 0.65 * plain);
}

TEST(Levelling, CurvesDoNotRollTheLaser) {
  Levelling levelling({}, RobotModel());
  LaserAim aim;
  for (int i = 0; i < 200; ++i) {
    Inputs inputs;
    inputs.now = Stamp::from_seconds(0.02 * i);
    if (i % 5 == 0) inputs.odometry.push_back({inputs.now, {}, 0.3, 0.5, false});
    inputs.accelerations.push_back({inputs.now, 0.0, 0.3 * 0.5});
    aim = levelling.update(inputs);
  }
  EXPECT_NEAR(rad_to_deg(aim.roll), 0.0, 0.3);
}

TEST(Levelling, TurnsOnTheSpotDoNotTiltALaserAheadOfTheirCentre) {
  // The platform sits 0.145 m ahead: it feels w^2 r backwards and dw/dt r to the left.
  const double ahead = RobotModel().T_base_laser.x;
  Levelling levelling({}, RobotModel());
  double worst_pitch = 0.0, worst_roll = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.02 * i;
    const double w = std::sin(t), alpha = std::cos(t);
    Inputs inputs;
    inputs.now = Stamp::from_seconds(t);
    if (i % 5 == 0) inputs.odometry.push_back({inputs.now, {}, 0.0, w, false});
    inputs.accelerations.push_back({inputs.now, -w * w * ahead, alpha * ahead});
    const LaserAim aim = levelling.update(inputs);
    if (t < 1.0) continue;
    worst_pitch = std::max(worst_pitch, std::abs(aim.pitch));
    worst_roll = std::max(worst_roll, std::abs(aim.roll));
  }
  EXPECT_LT(rad_to_deg(worst_pitch), 0.4);  // without the lever: 0.85 deg
  EXPECT_LT(rad_to_deg(worst_roll), 0.4);
}

TEST(Levelling, LeftSideUpTurnsTheLaserLeftSideDown) {
  LevellingConfig config;
  RobotModel model;
  model.accelerometer_mount = AccelerometerMount::Body;
  Levelling levelling(config, model);
  LaserAim aim;
  for (int i = 0; i < 100; ++i) aim = levelling.update(standing(0.02 * i, deg_to_rad(-4.0), deg_to_rad(6.0)));
  EXPECT_NEAR(rad_to_deg(aim.pitch), 4.0, 0.01);
  EXPECT_NEAR(rad_to_deg(aim.roll), -6.0, 0.01);
}

TEST(Levelling, BodyMountFollowsTheMeasuredTiltFaster) {
  LevellingConfig config;
  const AccelerometerMount mount = AccelerometerMount::Body;
  const auto samples = levelling_test::run(config, 4.0, step_of_ten_degrees, mount);
  const double settled = levelling_test::settled_after(samples, deg_to_rad(1.0)) - kStart;
  EXPECT_LT(settled, 0.3);
  const auto ramp = levelling_test::run(config, 4.0, onto_a_ramp, mount);
  EXPECT_LT(rad_to_deg(levelling_test::largest(ramp, kStart, 4.0)), 2.5);
}

TEST(Levelling, CommandNeverLeavesTheServosTravel) {
  Levelling levelling({}, RobotModel());
  for (int i = 0; i < 500; ++i) {  // sensor on a platform that the servo cannot bring level
    const LaserAim aim = levelling.update(standing(0.02 * i, deg_to_rad(40.0), deg_to_rad(-40.0)));
    EXPECT_LE(std::abs(aim.pitch), deg_to_rad(30.0));
    EXPECT_LE(std::abs(aim.roll), deg_to_rad(30.0));
  }
  LaserAim aim;
  for (int i = 500; i < 600; ++i) aim = levelling.update(standing(0.02 * i, deg_to_rad(-10.0), 0.0));
  EXPECT_GT(aim.pitch, deg_to_rad(20.0)) << "no wind-up: the command comes back at once";
}

TEST(Levelling, CommandRespectsTheSlewLimit) {
  LevellingConfig config;
  RobotModel model;
  model.accelerometer_mount = AccelerometerMount::Body;
  Levelling levelling(config, model);
  levelling.update(standing(0.0, 0.0, 0.0));
  double last = 0.0;
  for (int i = 1; i < 50; ++i) {
    const LaserAim aim = levelling.update(standing(0.02 * i, deg_to_rad(25.0), 0.0));
    EXPECT_LE(std::abs(aim.pitch - last), config.max_rate * 0.02 + 1e-12);
    last = aim.pitch;
  }
}

TEST(Levelling, StartsFromTheServosAndKeepsStillWithoutASensor) {
  Levelling levelling({}, RobotModel());
  Inputs inputs;
  inputs.aims.push_back({Stamp{0}, 0.1, -0.05});
  EXPECT_EQ(levelling.update(inputs).pitch, 0.1);
  EXPECT_EQ(levelling.update(Inputs{}).roll, -0.05);
}

TEST(Levelling, SwitchedOffHoldsZero) {
  LevellingConfig config;
  config.on = false;
  Levelling levelling(config, RobotModel());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(levelling.update(standing(0.02 * i, 0.3, 0.3)).pitch, 0.0);
}

}  // namespace
}  // namespace rubble::robot
