#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

/// Fastest any point of the robot's outline goes.
double outline_speed(const robot::RobotModel& model, const StampedPose& a, const StampedPose& b) {
  const double dt = b.stamp - a.stamp;
  return std::hypot(b.pose.x - a.pose.x, b.pose.y - a.pose.y) / dt +
         std::abs(wrap_angle(b.pose.phi - a.pose.phi)) / dt * model.swing_radius();
}

/// At every instant: a ball in the open has no more speed than some point of the robot had in the last second, less
/// what the floor has braked since. Between a wall and a slanting side a ball may be faster for a while, as a wedge
/// throws: that case is the next test's.
TEST(Clutter, APushedBallInTheOpenIsNeverFasterThanTheRobotWas) {
  const robot::RobotModel model;
  constexpr double kBraking = 0.3 * 9.80665;  // floor friction [m/s^2]
  double closest = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "open");
    arenas::Arena arena = flat_floor(-12, -12, 12, 12);
    arena.balls = {{{0.6, rng.uniform(-0.2, 0.2)}, 0.12, rng.uniform(0.008, 0.05)}};
    SimRobot robot(arena, model, exact(), seed);
    std::vector<double> outline;
    auto before = robot.balls();
    for (int leg = 0; leg < 6; ++leg) {
      const double v = leg % 2 == 0 ? rng.uniform(0.2, 0.7) : rng.uniform(-0.3, 0.3);
      const double w = rng.uniform(-1.5, 1.5);
      run(robot, drive(v, w), 2.0, [&](const robot::Inputs&) {
        const Trajectory& truth = robot.truth();
        outline.push_back(outline_speed(model, truth[truth.size() - 2], truth.back()));
        const auto now = robot.balls();
        const double ball =
            std::hypot(now[0].position.x - before[0].position.x, now[0].position.y - before[0].position.y) / model.tick;
        before = now;
        double allowed = 0.0;
        for (std::size_t back = 0; back < std::min<std::size_t>(outline.size(), 50); ++back) {
          const double since = model.tick * static_cast<double>(std::max<std::size_t>(back, 1) - 1);
          allowed = std::max(allowed, outline[outline.size() - 1 - back] - kBraking * since);
        }
        if (ball > 0.05) closest = std::max(closest, ball / allowed);
        ASSERT_LE(ball, 1.02 * allowed + 1e-3);
      });
    }
  }
  std::cout << "a ball reaches at most " << closest << " times the robot's speed\n";
  EXPECT_GT(closest, 0.5);
}

TEST(Clutter, APushedBallAmongWallsIsNeverFasterThanTheRobotWasAtItsFastest) {
  const robot::RobotModel model;
  double fastest = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "balls");
    arenas::Arena arena = room(-2, -2, 2, 2);
    while (arena.balls.size() < 8) {
      const double x = rng.uniform(-1.7, 1.7);
      const double y = rng.uniform(-1.7, 1.7);
      const double mass = rng.uniform(0.008, 0.05);
      const bool clear = std::none_of(arena.balls.begin(), arena.balls.end(), [&](const arenas::PaperBall& b) {
        return std::hypot(b.position.x - x, b.position.y - y) < 0.26;
      });
      if (std::hypot(x, y) > 0.55 && clear) arena.balls.push_back({{x, y}, 0.12, mass});
    }
    SimRobot robot(arena, model, exact(), seed);
    double robot_top = 0.0;
    double ball_top = 0.0;
    auto before = robot.balls();
    for (int leg = 0; leg < 12; ++leg) {
      const double v = rng.uniform(-0.7, 0.7);
      const double w = rng.uniform(-1.5, 1.5);
      run(robot, drive(v, w), 2.5, [&](const robot::Inputs&) {
        const Trajectory& truth = robot.truth();
        robot_top = std::max(robot_top, outline_speed(model, truth[truth.size() - 2], truth.back()));
        const auto now = robot.balls();
        for (std::size_t i = 0; i < now.size(); ++i) {
          ball_top = std::max(
              ball_top, std::hypot(now[i].position.x - before[i].position.x, now[i].position.y - before[i].position.y) /
                            model.tick);
        }
        before = now;
      });
    }
    fastest = std::max(fastest, ball_top);
    EXPECT_LE(ball_top, 1.02 * robot_top) << "balls reached " << ball_top << " m/s, the robot " << robot_top;
    for (const auto& ball : robot.balls()) {
      EXPECT_LT(std::abs(ball.position.x), 2.0);
      EXPECT_LT(std::abs(ball.position.y), 2.0);
    }
  }
  EXPECT_GT(fastest, 0.2);
}

TEST(Clutter, BallsLeftAloneStayExactlyWhereTheyAre) {
  arenas::Arena arena = room(-3, -3, 3, 3);
  arena.balls = {{{2.0, 2.0}, 0.12, 0.03}, {{-2.0, 1.0}, 0.1, 0.03}};
  SimRobot robot(arena, {}, exact(), 1);
  const auto before = robot.balls();
  run(robot, drive(0.1, 0.5), 5.0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(robot.balls()[i].position.x, before[i].position.x);
    EXPECT_EQ(robot.balls()[i].position.y, before[i].position.y);
  }
}

TEST(Clutter, ABallPressedAgainstAWallStaysBetweenWallAndRobot) {
  for (const double offset : {0.0, 0.05, 0.2, 0.25}) {
    for (const double mass : {0.008, 0.03, 0.3}) {
      SCOPED_TRACE("offset " + std::to_string(offset) + " m, mass " + std::to_string(mass) + " kg");
      arenas::Arena arena = room(-2, -2, 2, 2);
      arena.balls = {{{1.0, offset}, 0.12, mass}};
      SimRobot robot(arena, {}, exact(), 1);
      double fastest = 0.0;
      auto before = robot.balls()[0].position;
      run(robot, drive(0.5), 8.0, [&](const robot::Inputs&) {
        const auto now = robot.balls()[0].position;
        fastest = std::max(fastest, std::hypot(now.x - before.x, now.y - before.y) / robot.model().tick);
        before = now;
      });
      const auto ball = robot.balls()[0].position;
      EXPECT_LE(ball.x, 1.98 - 0.12 + 0.02);
      EXPECT_LE(fastest, 0.7);
      EXPECT_LE(robot.truth().back().pose.x + 0.5 * robot.model().length, 1.99);
    }
  }
}

TEST(Clutter, ABallIsPushedAlongAndStaysWhereItIsLeft) {
  arenas::Arena arena = flat_floor(-3, -3, 6, 3);
  arena.balls = {{{1.0, 0.0}, 0.12, 0.03}};
  SimRobot robot(arena, {}, exact(), 1);
  run(robot, drive(0.3), 6.0);
  run(robot, drive(0.0), 2.0);
  const double front = robot.truth().back().pose.x + 0.5 * robot.model().length;
  const double left_at = robot.balls()[0].position.x;
  EXPECT_NEAR(left_at - 0.12, front, 0.05);
  run(robot, drive(-0.3), 3.0);
  EXPECT_NEAR(robot.balls()[0].position.x, left_at, 1e-3);
}

}  // namespace
}  // namespace rubble::sim::test
