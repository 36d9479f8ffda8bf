#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

constexpr double kFrom = 1.0;  // [s]

/// What came in the last second of two, of a robot on a slope of 10 deg whose servos are told to level it and, from
/// 1.2 s on, to look straight ahead.
struct Heard {
  std::size_t aims = 0, accelerations = 0;
  double aim = 0.0, felt = 0.0;
};

Heard heard(LevellingFault fault, double at_least = 0.0) {
  SimConfig config = exact();
  config.levelling_fault = fault;
  config.levelling_fault_from = kFrom;
  config.levelling_fault_tilt = at_least;
  SimRobot robot(slope(-5, -5, 5, 5, deg_to_rad(10.0)), {}, config, 1);
  Heard heard;
  const auto hear = [&](const robot::Inputs& inputs) {
    if (inputs.now.seconds() <= kFrom + 0.05) return;
    heard.aims += inputs.aims.size();
    heard.accelerations += inputs.accelerations.size();
    for (const auto& aim : inputs.aims) heard.aim = aim.pitch;
    for (const auto& felt : inputs.accelerations) heard.felt = std::asin(felt.x / 9.80665);
  };
  run(robot, {{}, {deg_to_rad(-10.0), 0.0}}, 1.2, hear);
  run(robot, {{}, {0.0, 0.0}}, 1.0, hear);
  return heard;
}

TEST(LevellingFault, WithoutOneTheServosTurn) {
  const Heard all = heard(LevellingFault::None);
  EXPECT_GT(all.aims, 50u);
  EXPECT_EQ(all.accelerations, all.aims);
  EXPECT_NEAR(rad_to_deg(all.felt), 10.0, 0.5);
}

TEST(LevellingFault, ASilentUnitSaysNothing) {
  const Heard none = heard(LevellingFault::Silent);
  EXPECT_EQ(none.aims, 0u);
  EXPECT_EQ(none.accelerations, 0u);
}

TEST(LevellingFault, WithoutItsAccelerometerTheServosTurnOn) {
  const Heard aims = heard(LevellingFault::NoAccelerometer);
  EXPECT_GT(aims.aims, 50u);
  EXPECT_EQ(aims.accelerations, 0u);
  EXPECT_NEAR(aims.aim, 0.0, 0.01);
}

TEST(LevellingFault, JammedServosStayWhateverTheirPulsesSay) {
  const Heard jammed = heard(LevellingFault::Jammed);
  EXPECT_NEAR(jammed.aim, 0.0, 0.01);
  EXPECT_NEAR(rad_to_deg(jammed.felt), 0.0, 0.5) << "level as before";
}

TEST(LevellingFault, WaitsForTheTiltAskedFor) {
  EXPECT_EQ(heard(LevellingFault::Silent, deg_to_rad(9.0)).aims, 0u);
  EXPECT_GT(heard(LevellingFault::Silent, deg_to_rad(11.0)).aims, 50u);
}

}  // namespace
}  // namespace rubble::sim::test
