#include "sim/victim_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

VictimSensorParameters sure() {
  VictimSensorParameters parameters;
  for (CueSense* sense : {&parameters.appearance, &parameters.heat, &parameters.sound, &parameters.co2}) {
    sense->miss = 0.0;
    sense->false_alarm = 0.0;
  }
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
  const VictimSensorParameters all;
  const CueSense& parameters = all.appearance;
  const arenas::Victim victim{"v", {1.5, 0.0, 0.2}, kPi, true, false, false, false};
  VictimSensor sensor({victim}, all, 4);
  VictimSensor blind({}, all, 4);
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

/// Ears and nose only.
VictimSensorParameters without_cameras() {
  VictimSensorParameters parameters = sure();
  parameters.appearance.fitted = parameters.heat.fitted = false;
  parameters.sound.fitted = parameters.co2.fitted = true;
  return parameters;
}

std::vector<robot::CueKind> kinds_sensed(const mrpt::math::TPose2D& pose, const arenas::Arena& arena) {
  const RayWalk walk(arenas::faces(arena));
  VictimSensor sensor({{"v", {1.5, 0.0, 0.2}, kPi, true, true, true, true}}, without_cameras(), 1);
  WorldState state;
  state.pose = pose;
  std::vector<robot::CueKind> kinds;
  for (const auto& cue : sensor.look(state, walk)) kinds.push_back(cue.kind);
  return kinds;
}

TEST(VictimSensor, SoundIsHeardAllRoundAndThroughWallsCloseBy) {
  const std::vector<robot::CueKind> sound{robot::CueKind::Sound};
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  EXPECT_EQ(kinds_sensed({-1.4, 0, 0}, arena), sound);     // 2.9 m ahead
  EXPECT_EQ(kinds_sensed({-1.4, 0, kPi}, arena), sound);   // behind the robot
  EXPECT_EQ(kinds_sensed({4.0, 0, 0}, arena), sound);      // from behind the victim
  EXPECT_TRUE(kinds_sensed({-1.6, 0, 0}, arena).empty());  // 3.1 m
  add_wall(arena, 0.8, -2, 0.82, 2);
  EXPECT_EQ(kinds_sensed({0.1, 0, 0}, arena), sound);      // 1.4 m, wall between
  EXPECT_TRUE(kinds_sensed({-0.1, 0, 0}, arena).empty());  // 1.6 m
}

TEST(VictimSensor, Co2IsSmeltOnlyBeforeTheOpenBox) {
  const std::vector<robot::CueKind> both{robot::CueKind::Sound, robot::CueKind::Co2};
  const std::vector<robot::CueKind> sound{robot::CueKind::Sound};
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  EXPECT_EQ(kinds_sensed({0.7, 0, 0}, arena), both);
  EXPECT_EQ(kinds_sensed({0.5, 0, 0}, arena), sound);    // 1.0 m
  EXPECT_EQ(kinds_sensed({0.7, 0, kPi}, arena), sound);  // behind the robot
  EXPECT_EQ(kinds_sensed({2.3, 0, kPi}, arena), sound);  // behind the victim
  add_wall(arena, 1.0, -2, 1.02, 2);
  EXPECT_EQ(kinds_sensed({0.7, 0, 0}, arena), sound);
}

TEST(VictimSensor, ARobotInBetweenHidesTheVictim) {
  const arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  const RayWalk walk(arenas::faces(arena));
  VictimSensor sensor({{"v", {1.5, 0.0, 0.2}, kPi, true, true, false, false}}, sure(), 1);
  std::vector<arenas::Face> other;
  arenas::add_prism(rectangle(0.7, -0.25, 1.2, 0.25), 0.0, 0.4, other);
  EXPECT_EQ(sensor.look(WorldState{}, walk).size(), 2u);
  EXPECT_TRUE(sensor.look(WorldState{}, walk, other).empty());
}

/// Twenty looks from two sides: cameras place the victim to centimetres, ears to decimetres; a single cue of an ear may
/// be a metre off.
TEST(VictimSensor, CuesFromSeveralPlacesFindTheVictim) {
  const arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  const RayWalk walk(arenas::faces(arena));
  VictimSensorParameters parameters;
  parameters.sound.fitted = true;
  struct Tally {
    mrpt::math::TPoint2D sum;
    double worst = 0.0;
    int n = 0;
  };
  Tally seen, heard;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    VictimSensor sensor({{"v", {1.5, 0.0, 0.2}, kPi, true, true, true, false}}, parameters, seed);
    for (int i = 0; i < 20; ++i) {
      WorldState state;
      state.pose = i % 2 == 0 ? mrpt::math::TPose2D{0.0, -0.6, 0.38} : mrpt::math::TPose2D{0.0, 0.6, -0.38};
      for (const auto& cue : sensor.look(state, walk)) {
        const double bearing = state.pose.phi + cue.bearing;
        const mrpt::math::TPoint2D p{state.pose.x + cue.range * std::cos(bearing),
                                     state.pose.y + cue.range * std::sin(bearing)};
        Tally& tally = cue.kind == robot::CueKind::Sound ? heard : seen;
        tally.sum = tally.sum + p;
        tally.worst = std::max(tally.worst, std::hypot(p.x - 1.5, p.y));
        ++tally.n;
      }
    }
  }
  for (const auto& [name, tally] : {std::pair<const char*, Tally>{"cameras", seen}, {"microphones", heard}}) {
    const auto mean = tally.sum * (1.0 / tally.n);
    std::cout << name << ": mean off by " << std::hypot(mean.x - 1.5, mean.y) << " m, a single cue by up to "
              << tally.worst << " m\n";
  }
  const auto mean_seen = seen.sum * (1.0 / seen.n);
  const auto mean_heard = heard.sum * (1.0 / heard.n);
  EXPECT_LT(std::hypot(mean_seen.x - 1.5, mean_seen.y), 0.05);
  EXPECT_LT(std::hypot(mean_heard.x - 1.5, mean_heard.y), 0.2);
  EXPECT_GT(heard.worst, 1.0);
}

}  // namespace
}  // namespace rubble::sim::test
