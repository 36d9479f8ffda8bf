#include "sim/victim_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

VictimSensorParameters sure() {
  VictimSensorParameters parameters;
  parameters.miss = 0.0;
  parameters.false_alarm = 0.0;
  return parameters;
}

/// Looks from `pose` at one victim at (1.5, 0), 0.2 m high, open towards the origin.
std::vector<robot::VictimCue> look(const mrpt::math::TPose2D& pose, arenas::Arena arena = flat_floor(-5, -5, 5, 5),
                                   arenas::Victim victim = {"v", {1.5, 0.0, 0.2}, kPi, true, true, false, false}) {
  const RayWalk walk(arenas::faces(arena));
  VictimSensor sensor({victim}, sure(), 1);
  WorldState state;
  state.pose = pose;
  return sensor.look(state, walk);
}

TEST(VictimSensor, SeesAVictimAheadWithBothCameras) {
  const auto cues = look({0, 0, 0});
  ASSERT_EQ(cues.size(), 2u);
  EXPECT_EQ(cues[0].kind, robot::CueKind::Appearance);
  EXPECT_EQ(cues[1].kind, robot::CueKind::Heat);
  for (const auto& cue : cues) {
    EXPECT_NEAR(cue.bearing, 0.0, deg_to_rad(8.0));
    EXPECT_NEAR(cue.range, 1.5, 0.3);
  }
}

TEST(VictimSensor, GivesOnlyTheCuesTheVictimHas) {
  EXPECT_EQ(look({0, 0, 0}, flat_floor(-5, -5, 5, 5), {"v", {1.5, 0, 0.2}, kPi, false, true, true, true}).size(), 1u);
}

TEST(VictimSensor, SeesNothingOutsideItsViewItsRangeOrTheOpenSide) {
  EXPECT_EQ(look({0, 0, deg_to_rad(25.0)}).size(), 2u);
  EXPECT_TRUE(look({0, 0, deg_to_rad(35.0)}).empty());        // outside 60 deg
  EXPECT_TRUE(look({-0.6, 0, 0}).empty());                    // 2.1 m away
  EXPECT_TRUE(look({2.9, 0, kPi}).empty());                   // behind it
  EXPECT_TRUE(look({1.2, 1.4, deg_to_rad(-78.0)}).empty());   // 78 deg off its facing
  EXPECT_EQ(look({0.8, 1.2, deg_to_rad(-60.0)}).size(), 2u);  // 60 deg off
}

TEST(VictimSensor, AWallHidesTheVictimALowOneDoesNot) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  add_wall(arena, 0.8, -2, 0.82, 2, 0.2);
  EXPECT_EQ(look({0, 0, 0}, arena).size(), 2u);  // the camera looks over it from 0.5 m
  arena.solids[0].z_top = 1.2;
  EXPECT_TRUE(look({0, 0, 0}, arena).empty());
}

TEST(VictimSensor, ErrorsMissesAndFalseAlarmsHaveTheStatedSize) {
  const arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  const RayWalk walk(arenas::faces(arena));
  const VictimSensorParameters parameters;
  const arenas::Victim victim{"v", {1.5, 0.0, 0.2}, kPi, true, false, false, false};
  VictimSensor sensor({victim}, parameters, 4);
  VictimSensor blind({}, parameters, 4);
  WorldState state;
  const int looks = 20000;
  int seen = 0;
  int alarms = 0;
  double bearing2 = 0.0;
  double range2 = 0.0;
  for (int i = 0; i < looks; ++i) {
    for (const auto& cue : sensor.look(state, walk)) {
      if (cue.kind != robot::CueKind::Appearance || cue.confidence < 0.6) continue;
      ++seen;
      bearing2 += cue.bearing * cue.bearing;
      range2 += std::pow(cue.range / 1.5 - 1.0, 2);
    }
    alarms += static_cast<int>(blind.look(state, walk).size());
  }
  std::cout << "seen " << 1.0 * seen / looks << ", bearing sigma " << rad_to_deg(std::sqrt(bearing2 / seen))
            << " deg, range sigma " << std::sqrt(range2 / seen) << ", false alarms a look " << 1.0 * alarms / looks
            << '\n';
  EXPECT_NEAR(1.0 * seen / looks, 1.0 - parameters.miss, 0.01);
  EXPECT_NEAR(std::sqrt(bearing2 / seen), parameters.bearing_sigma, 0.1 * parameters.bearing_sigma);
  EXPECT_NEAR(std::sqrt(range2 / seen), parameters.range_sigma, 0.1 * parameters.range_sigma);
  EXPECT_NEAR(1.0 * alarms / looks, 2.0 * parameters.false_alarm, 0.002);
}

}  // namespace
}  // namespace rubble::sim::test
