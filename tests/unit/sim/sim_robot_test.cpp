#include "sim/sim_robot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <iostream>

#include "base/angle.h"
#include "base/rng.h"
#include "tests/support/sim_arena.h"
#include "tests/support/sim_random_scene.h"

namespace rubble::sim::test {
namespace {

/// FNV-1a over the bits of everything a run delivers.
class Hash {
 public:
  template <class T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) {
      hash_ ^= byte;
      hash_ *= 1099511628211ull;
    }
  }
  void add(const robot::Inputs& inputs) {
    add(inputs.now.ns);
    for (const auto& scan : inputs.scans) {
      add(scan.stamp.ns);
      for (const float range : scan.ranges) add(std::isnan(range) ? -1.0f : range);
    }
    for (const auto& o : inputs.odometry) add(o.stamp.ns), add(o.pose.x), add(o.pose.y), add(o.pose.phi), add(o.v);
    for (const auto& a : inputs.accelerations) add(a.stamp.ns), add(a.x), add(a.y);
    for (const auto& a : inputs.aims) add(a.stamp.ns), add(a.pitch), add(a.roll);
    for (const auto& c : inputs.cues) add(c.stamp.ns), add(c.bearing), add(c.range), add(c.confidence);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ull;
};

/// A minute of driving about in a maze that has everything.
std::uint64_t hash_of_a_run(std::uint64_t arena_seed, std::uint64_t seed) {
  const arenas::Arena arena = random_maze(arena_seed);
  SimRobot robot(arena, {}, SimConfig{}, seed);
  Hash hash;
  Rng rng(arena_seed, "commands");
  for (int leg = 0; leg < 20; ++leg) {
    const double v = rng.uniform(-0.3, 0.6);
    const double w = rng.uniform(-1.0, 1.0);
    const double pitch = rng.uniform(-0.2, 0.2);
    run(robot, {{v, w}, {pitch, -pitch}}, 3.0, [&](const robot::Inputs& inputs) { hash.add(inputs); });
  }
  for (const StampedPose& pose : robot.truth()) hash.add(pose.pose.x), hash.add(pose.pose.y), hash.add(pose.pose.phi);
  for (const auto& ball : robot.balls()) hash.add(ball.position.x), hash.add(ball.position.y);
  return hash.value();
}

TEST(SimRobot, SameSeedSameBits) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const std::uint64_t hash = hash_of_a_run(seed, 11);
    std::cout << "arena seed " << seed << ": " << std::hex << hash << std::dec << '\n';
    EXPECT_EQ(hash, hash_of_a_run(seed, 11)) << "arena seed " << seed;
  }
}

TEST(SimRobot, AnotherSeedAnotherNoiseButTheSameTruth) {
  const arenas::Arena arena = random_maze(4);
  Hash noise[2];
  Hash truth[2];
  for (std::uint64_t i = 0; i < 2; ++i) {
    SimRobot robot(arena, {}, SimConfig{}, 20 + i);
    run(robot, drive(0.2, 0.3), 5.0, [&](const robot::Inputs& inputs) { noise[i].add(inputs); });
    for (const StampedPose& pose : robot.truth()) truth[i].add(pose.pose.x), truth[i].add(pose.pose.phi);
  }
  EXPECT_NE(noise[0].value(), noise[1].value());
  EXPECT_EQ(truth[0].value(), truth[1].value());  // commands did not depend on the noise
}

TEST(SimRobot, SensorNoiseStreamsAreIndependent) {
  const arenas::Arena arena = room(-2, -2, 2, 2);
  SimConfig quiet;
  quiet.acceleration_noise = 0.0;
  SimRobot all(arena, {}, SimConfig{}, 5);
  SimRobot some(arena, {}, quiet, 5);
  for (int i = 0; i < 100; ++i) {
    const auto a = all.read();
    const auto b = some.read();
    ASSERT_EQ(a->scans.size(), b->scans.size());
    for (std::size_t k = 0; k < a->scans.size(); ++k) {
      for (std::size_t j = 0; j < a->scans[k].ranges.size(); ++j) {
        if (std::isnan(a->scans[k].ranges[j])) continue;
        ASSERT_EQ(a->scans[k].ranges[j], b->scans[k].ranges[j]);
      }
    }
  }
}

TEST(SimRobot, DeliversEverySensorAtItsRateSortedAndNeverFromTheFuture) {
  SimRobot robot(room(-2, -2, 2, 2), {}, SimConfig{}, 1);
  std::size_t scans = 0, odometry = 0, accelerations = 0, aims = 0, ticks = 0;
  Stamp last_odometry = Stamp::never();
  run(robot, drive(0.1, 0.2), 10.0, [&](const robot::Inputs& inputs) {
    ++ticks;
    EXPECT_EQ(inputs.now.ns, static_cast<std::int64_t>(ticks) * 20000000);
    scans += inputs.scans.size();
    odometry += inputs.odometry.size();
    accelerations += inputs.accelerations.size();
    aims += inputs.aims.size();
    for (const auto& o : inputs.odometry) {
      EXPECT_GT(o.stamp, last_odometry);
      EXPECT_LE(o.stamp, inputs.now);
      last_odometry = o.stamp;
    }
    for (const auto& a : inputs.accelerations) EXPECT_LE(a.stamp, inputs.now);
    for (const auto& s : inputs.scans) EXPECT_LE(s.beam_stamp(s.ranges.size() - 1), inputs.now);
  });
  EXPECT_EQ(scans, 100u);
  EXPECT_EQ(odometry, 101u);  // one about the start
  EXPECT_EQ(accelerations, 500u);
  EXPECT_EQ(aims, 500u);
  EXPECT_EQ(robot.truth().size(), ticks + 1);
}

TEST(SimRobot, EndsAtItsTimeLimit) {
  SimConfig config;
  config.time_limit = 0.5;
  SimRobot robot(room(-2, -2, 2, 2), {}, config, 1);
  int ticks = 0;
  while (robot.read()) ++ticks;
  EXPECT_EQ(ticks, 25);
  EXPECT_FALSE(robot.read());
}

TEST(SimRobot, AStepThatDoesNotFitTheTickIsRefused) {
  for (const double step : {0.0, -0.01, 0.003, 0.0105, 0.015}) {
    SimConfig config;
    config.physics_step = step;
    EXPECT_THROW(SimRobot(flat_floor(-1, -1, 1, 1), {}, config, 1), InputError) << step;
  }
}

TEST(SimRobot, WithoutLevellingUnitThereIsNeitherAccelerationNorAim) {
  robot::RobotModel model;
  model.has_levelling_unit = false;
  SimRobot robot(flat_floor(-10, -10, 10, 10), model, exact(), 1);
  run(robot, {{0.0, 0.0}, {deg_to_rad(-20.0), 0.0}}, 1.0, [&](const robot::Inputs& inputs) {
    EXPECT_TRUE(inputs.accelerations.empty());
    EXPECT_TRUE(inputs.aims.empty());
    for (const auto& scan : inputs.scans) EXPECT_TRUE(std::isinf(scan.ranges[340]));  // the laser stays level
  });
}

TEST(SimRobot, StartsAtTheArenasStartWithOdometryAtZero) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  arena.start = {1.0, -2.0, 0.7};
  SimRobot robot(arena, {}, SimConfig{}, 1);
  EXPECT_EQ(robot.truth().front().stamp, Stamp{});
  EXPECT_EQ(robot.truth().front().pose.x, 1.0);
  EXPECT_EQ(robot.truth().front().pose.phi, 0.7);
  const auto inputs = robot.read();
  ASSERT_FALSE(inputs->odometry.empty());
  EXPECT_EQ(inputs->odometry.front().stamp, Stamp{});
  EXPECT_EQ(inputs->odometry.front().pose, (mrpt::math::TPose2D{0, 0, 0}));
}

}  // namespace
}  // namespace rubble::sim::test
