#include "sim/sim_team.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "base/error.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

TeamMember at(double x, double y, double heading = 0.0) { return {robot::RobotModel{}, {x, y, heading}}; }

/// One tick of all robots under their commands.
std::vector<robot::Inputs> tick(SimTeam& team, const std::vector<robot::Commands>& commands) {
  std::vector<robot::Inputs> all;
  for (std::size_t i = 0; i < team.size(); ++i) team.robot(i).command(commands[i]);
  for (std::size_t i = 0; i < team.size(); ++i) all.push_back(team.robot(i).read().value());
  return all;
}

float ahead(const robot::LaserScan& scan) { return scan.ranges[340]; }

TEST(SimTeam, EachSeesTheOtherAtItsDistance) {
  SimTeam team(flat_floor(-5, -5, 5, 5), {at(-1, 0), at(1, 0, kPi)}, exact(), 1);
  std::vector<float> seen[2];
  for (int k = 0; k < 10; ++k) {
    const auto all = tick(team, {{}, {}});
    for (std::size_t i = 0; i < 2; ++i) {
      for (const auto& scan : all[i].scans) seen[i].push_back(ahead(scan));
    }
  }
  const robot::RobotModel model;
  const double gap = 2.0 - model.T_base_laser.x - 0.5 * model.length;
  for (const auto& ranges : seen) {
    ASSERT_FALSE(ranges.empty());
    for (const float range : ranges) EXPECT_NEAR(range, gap, 1.5e-3);
  }
}

/// The sweep's caster, too: both turn on the spot while they look.
TEST(SimTeam, TheySeeEachOtherWhileTheyTurn) {
  SimTeam team(flat_floor(-5, -5, 5, 5), {at(-1, 0), at(1, 0, kPi)}, exact(), 1);
  int hits = 0;
  for (int k = 0; k < 200; ++k) {
    for (const auto& inputs : tick(team, {drive(0.0, 0.5), drive(0.0, 0.5)})) {
      for (const auto& scan : inputs.scans) {
        for (const float range : scan.ranges) {
          if (!std::isfinite(range)) continue;
          ++hits;
          ASSERT_GT(range, 1.35f);
          ASSERT_LT(range, 2.3f);
        }
      }
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(SimTeam, APushMovesTheOther) {
  SimTeam team(flat_floor(-3, -3, 6, 3), {at(0, 0), at(0.8, 0)}, exact(), 1);
  for (int k = 0; k < 400; ++k) tick(team, {drive(0.3), {}});
  const auto pusher = team.truth(0).back().pose;
  const auto pushed = team.truth(1).back().pose;
  std::cout << "pusher at " << pusher.x << " m, pushed from 0.8 to " << pushed.x << " m\n";
  EXPECT_GT(pushed.x, 0.9);
  EXPECT_NEAR(pushed.x - pusher.x, robot::RobotModel{}.length, 0.03);
}

TEST(SimTeam, NeitherGetsThroughTheOther) {
  SimTeam team(flat_floor(-3, -3, 3, 3), {at(-1, 0.05), at(1, -0.05, kPi)}, exact(), 1);
  double nearest = 10.0;
  for (int k = 0; k < 500; ++k) {
    tick(team, {drive(0.4), drive(0.4)});
    const auto a = team.truth(0).back().pose;
    const auto b = team.truth(1).back().pose;
    nearest = std::min(nearest, std::hypot(a.x - b.x, a.y - b.y));
  }
  std::cout << "head on: centres at least " << nearest << " m apart\n";
  EXPECT_GT(nearest, robot::RobotModel{}.length - 0.02);
}

TEST(SimTeam, OneRobotOfATeamIsASimRobot) {
  arenas::Arena arena = room(-3, -3, 3, 3);
  arena.balls = {{{1.0, 0.3}, 0.12, 0.03}};
  SimRobot alone(arena, {}, SimConfig{}, 5);
  SimTeam team(arena, {{robot::RobotModel{}, arena.start}}, SimConfig{}, 5);
  for (int k = 0; k < 300; ++k) {
    alone.command(drive(0.3, 0.2));
    const auto one = alone.read().value();
    const auto other = tick(team, {drive(0.3, 0.2)})[0];
    ASSERT_EQ(one.scans.size(), other.scans.size());
    for (std::size_t i = 0; i < one.scans.size(); ++i) {
      for (std::size_t b = 0; b < one.scans[i].ranges.size(); ++b) {
        const float x = one.scans[i].ranges[b];
        const float y = other.scans[i].ranges[b];
        ASSERT_TRUE(x == y || (std::isnan(x) && std::isnan(y)));
      }
    }
  }
  EXPECT_EQ(alone.truth().back().pose, team.truth(0).back().pose);
}

TEST(SimTeam, SameSeedSameBitsWhateverTheOrderOfReading) {
  const arenas::Arena arena = room(-3, -3, 3, 3);
  SimTeam a(arena, {at(-1, 0), at(1, 0, kPi)}, SimConfig{}, 3);
  SimTeam b(arena, {at(-1, 0), at(1, 0, kPi)}, SimConfig{}, 3);
  for (int k = 0; k < 300; ++k) {
    tick(a, {drive(0.3, 0.1), drive(0.2, -0.1)});
    b.robot(1).command(drive(0.2, -0.1));
    b.robot(0).command(drive(0.3, 0.1));
    b.robot(1).read();
    b.robot(0).read();
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a.truth(i).back().pose, b.truth(i).back().pose);
}

TEST(SimTeam, RefusesTwoRobotsInOnePlace) {
  EXPECT_THROW(SimTeam(flat_floor(-3, -3, 3, 3), {at(0, 0), at(0.3, 0)}, exact(), 1), InputError);
  EXPECT_THROW(SimTeam(flat_floor(-3, -3, 3, 3), {}, exact(), 1), InputError);
}

arenas::Arena with_bottle(double height) {
  arenas::Arena arena = flat_floor(-3, -3, 6, 3);
  arena.objects = {{{1.0, 0.0}, 0.033, height, 0.5, arenas::ObjectKind::Bottle}};
  return arena;
}

TEST(LooseObjects, ABottleIsSeenWhenItReachesTheScanPlane) {
  for (const double height : {0.23, 0.5}) {
    SimRobot robot(with_bottle(height), {}, exact(), 1);
    float nearest = 10.0f;
    run(robot, {}, 0.5, [&](const robot::Inputs& inputs) {
      for (const auto& scan : inputs.scans) nearest = std::min(nearest, ahead(scan));
    });
    if (height > 0.35) {
      EXPECT_NEAR(nearest, 1.0 - 0.033 - 0.145, 2e-3);
    } else {
      EXPECT_GT(nearest, 4.0f);
    }
  }
}

TEST(LooseObjects, ABottleIsPushedAndStays) {
  SimRobot robot(with_bottle(0.23), {}, exact(), 1);
  run(robot, drive(0.3), 6.0);
  run(robot, drive(0.0), 2.0);
  const double front = robot.truth().back().pose.x + 0.5 * robot.model().length;
  const auto bottle = robot.objects()[0].position;
  std::cout << "bottle pushed from 1.0 to " << bottle.x << " m\n";
  EXPECT_GT(bottle.x, 1.2);
  EXPECT_GT(bottle.x, front);
}

}  // namespace
}  // namespace rubble::sim::test
