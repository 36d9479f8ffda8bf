// What the truth says of a drive: its way, and what the body touched on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/rng.h"
#include "robot/body.h"
#include "scenarios/run/mission_figures.h"
#include "tests/support/sim_arena.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPose2D;

constexpr double kTick = 0.02;  ///< [s]

/// A way, a pose each tick.
class Drive {
 public:
  explicit Drive(const TPose2D& start) { truth_.push_back({Stamp{0}, start}); }

  /// Along its heading, backwards where `v` is negative, as it turns.
  Drive& go(double v, double w, double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds / kTick));
    for (int i = 0; i < ticks; ++i) {
      const StampedPose& last = truth_.back();
      const double middle = last.pose.phi + 0.5 * w * kTick;
      truth_.push_back({last.stamp + kTick,
                        {last.pose.x + v * kTick * std::cos(middle), last.pose.y + v * kTick * std::sin(middle),
                         last.pose.phi + w * kTick}});
    }
    return *this;
  }
  Drive& stand(double seconds) { return go(0.0, 0.0, seconds); }
  scoring::DriveFigures in(const arenas::Arena& arena) const { return drive_figures(arena, truth_, {}); }

 private:
  Trajectory truth_;
};

const robot::RobotModel kRobot;
const double kNose = 0.5 * kRobot.length;  ///< from the base [m]
const double kSide = 0.5 * kRobot.width;   ///< from the base [m]
constexpr double kWallAt = 2.0;            ///< [m]

/// So large that its border is out of reach.
arenas::Arena floor() { return sim::test::flat_floor(-4.0, -4.0, 6.0, 4.0); }

/// A wall across the way along x.
arenas::Arena with_wall(double height = 1.2, double bottom = 0.0) {
  arenas::Arena arena = floor();
  sim::test::add_wall(arena, kWallAt, -2.0, kWallAt + 0.02, 2.0, height, bottom);
  return arena;
}

/// The floor beyond x = 2 m stands so high above that before it.
arenas::Arena with_step(double height) {
  arenas::Arena arena = floor();
  arena.floor.push_back({sim::test::rectangle(kWallAt, -2.0, 6.0, 2.0), height, 0.0, 0.0, "platform"});
  return arena;
}

/// Looks at the wall so far before its nose [m].
TPose2D before_it(double gap) { return {kWallAt - kNose - gap, 0.0, 0.0}; }

scoring::DriveFigures standing(const arenas::Arena& arena, const TPose2D& pose) {
  return Drive(pose).stand(2.0).in(arena);
}

TEST(DriveFigures, TouchedIsWhatIsNearerThan12Mm) {
  const scoring::DriveFigures near = standing(with_wall(), before_it(0.011));
  EXPECT_NEAR(near.contact_s, 2.0, 1e-9);
  EXPECT_EQ(near.contacts, 1u);
  EXPECT_EQ(near.contact_speed, 0.0);
  EXPECT_NEAR(near.min_clearance_m, 0.011, 1e-9);
  const scoring::DriveFigures off = standing(with_wall(), before_it(0.013));
  EXPECT_EQ(off.contact_s, 0.0);
  EXPECT_EQ(off.contacts, 0u);
  EXPECT_NEAR(off.min_clearance_m, 0.013, 1e-9);
}

TEST(DriveFigures, WhoPassesAWallAt11MmTouchesItAt13MmNot) {
  arenas::Arena arena = floor();
  sim::test::add_wall(arena, -0.5, 1.0, 0.5, 1.02);
  for (const double gap : {0.011, 0.013}) {
    const scoring::DriveFigures figures = Drive({-2.0, 1.0 - kSide - gap, 0.0}).go(0.2, 0.0, 20.0).in(arena);
    EXPECT_NEAR(figures.min_clearance_m, gap, 1e-9);
    if (gap > 0.012) {
      EXPECT_EQ(figures.contacts, 0u);
      EXPECT_EQ(figures.contact_s, 0.0);
      continue;
    }
    EXPECT_EQ(figures.contacts, 1u);
    EXPECT_NEAR(figures.contact_speed, 0.2, 1e-9);
    // Its flank ends where the corners are cut, of which a millimetre is as near.
    const double flank = 2.0 * (kNose - robot::kCornerCut * kRobot.length);
    EXPECT_NEAR(figures.contact_s, (1.0 + flank) / 0.2, 0.15);
  }
}

/// Heading and flank at once: how far the outline reaches towards a wall is known for every heading.
TEST(DriveFigures, ClearanceIsThatOfTheOutlineWhateverTheHeading) {
  const double cut = robot::kCornerCut * kRobot.length;
  Rng rng(3, "headings");
  for (int i = 0; i < 200; ++i) {
    const double phi = rng.uniform(-kPi, kPi);
    const double x = kWallAt - rng.uniform(0.4, 0.7);
    const double c = std::abs(std::cos(phi)), s = std::abs(std::sin(phi));
    const double reach = std::max(kNose * c + (kSide - cut) * s, (kNose - cut) * c + kSide * s);
    const double expected = std::clamp(kWallAt - x - reach, 0.0, 0.5);
    EXPECT_NEAR(standing(with_wall(), {x, 0.3, phi}).min_clearance_m, expected, 1e-9) << "seed 3: " << x << ", " << phi;
  }
}

TEST(DriveFigures, ABodyThatReachesIntoAWallHasNoClearance) {
  const scoring::DriveFigures figures = standing(with_wall(), before_it(-0.03));
  EXPECT_EQ(figures.min_clearance_m, 0.0);
  EXPECT_NEAR(figures.contact_s, 2.0, 1e-9);
}

TEST(DriveFigures, AStepIsTouchedWhereItIsTooHighToClimb) {
  for (const double height : {0.05, 0.09, 0.099}) {
    const scoring::DriveFigures figures = Drive(before_it(0.3)).go(0.2, 0.0, 5.0).in(with_step(height));
    EXPECT_EQ(figures.contacts, 0u) << height;
    EXPECT_EQ(figures.contact_s, 0.0) << height;
    EXPECT_EQ(figures.min_clearance_m, 0.5) << height;
  }
  for (const double height : {0.101, 0.11, 0.3}) {
    EXPECT_NEAR(standing(with_step(height), before_it(0.011)).contact_s, 2.0, 1e-9) << height;
    EXPECT_EQ(standing(with_step(height), before_it(0.013)).contact_s, 0.0) << height;
    EXPECT_NEAR(standing(with_step(height), before_it(0.013)).min_clearance_m, 0.013, 1e-9) << height;
  }
}

/// Nothing of the step is as high as the body that stands on it.
TEST(DriveFigures, AStepIsNotTouchedFromAbove) {
  const scoring::DriveFigures figures = standing(with_step(0.3), {kWallAt + 0.1, 0.0, 0.0});
  EXPECT_EQ(figures.contacts, 0u);
  EXPECT_EQ(figures.min_clearance_m, 0.5);
}

/// A step that rises along its edge is one from where it is too high on.
TEST(DriveFigures, TheFlankOfARampIsTouchedWhereItIsTooHighToClimb) {
  arenas::Arena arena = floor();
  const double angle = deg_to_rad(10.0);
  const double too_high = kRobot.climbable_step / std::tan(angle);  // from the foot of the ramp, at x = 0
  sim::test::add_ramp(arena, 0.0, 1.0, 1.2, 2.2, angle);
  const double y = 1.0 - kNose - 0.005;
  const double half = kSide - robot::kCornerCut * kRobot.length;  // of the edge of its nose
  EXPECT_EQ(standing(arena, {too_high - half - 0.02, y, 0.5 * kPi}).contacts, 0u);
  EXPECT_EQ(standing(arena, {too_high - half + 0.02, y, 0.5 * kPi}).contacts, 1u);
}

/// The housing of the laser ends 0.4 m above the floor; what comes down by less than 1 cm below that is passed.
TEST(DriveFigures, AWallThatHangsOverTheRobotIsNotTouched) {
  for (const double bottom : {0.8, 0.41, 0.395}) {
    const scoring::DriveFigures figures = Drive(before_it(0.3)).go(0.2, 0.0, 5.0).in(with_wall(1.2, bottom));
    EXPECT_EQ(figures.contacts, 0u) << bottom;
    EXPECT_EQ(figures.min_clearance_m, 0.5) << bottom;
  }
  for (const double bottom : {0.385, 0.2})
    EXPECT_NEAR(standing(with_wall(1.2, bottom), before_it(0.011)).contact_s, 2.0, 1e-9) << bottom;
}

/// The same wall, for a robot that stands higher.
TEST(DriveFigures, HeightsCountFromTheFloorTheRobotStandsOn) {
  for (const double floor_z : {0.0, 0.3}) {
    arenas::Arena arena = sim::test::flat_floor(-4.0, -4.0, 6.0, 4.0, floor_z);
    sim::test::add_wall(arena, kWallAt, -2.0, kWallAt + 0.02, 2.0, 1.2, 0.5);
    EXPECT_EQ(standing(arena, before_it(0.005)).contacts, floor_z > 0.0 ? 1u : 0u) << floor_z;
  }
}

TEST(DriveFigures, TheStripsOfAVeilAreNotTouched) {
  arenas::Arena arena = with_wall();
  arena.solids.front().gives_way = true;
  const scoring::DriveFigures figures = Drive(before_it(0.3)).go(0.2, 0.0, 5.0).in(arena);
  EXPECT_EQ(figures.contacts, 0u);
  EXPECT_EQ(figures.min_clearance_m, 0.5);
}

/// Where the floor ends without a wall, the body touches its edge.
TEST(DriveFigures, AnOpenRimIsTouched) {
  const arenas::Arena arena = sim::test::flat_floor(-4.0, -4.0, kWallAt, 4.0);
  EXPECT_EQ(standing(arena, before_it(0.011)).contacts, 1u);
  EXPECT_EQ(standing(arena, before_it(0.013)).contacts, 0u);
}

TEST(DriveFigures, OneTouchHasItsSpeedAndItsDuration) {
  // Nearer than 12 mm from 3.9 s on; 0.06 m farther it stands for 3 s, then backs off at half the speed.
  const double approach = 0.2 * 3.9, in_touch = 0.06;
  const scoring::DriveFigures figures = Drive(before_it(0.012 + approach))
                                            .go(0.2, 0.0, (approach + in_touch) / 0.2)
                                            .stand(3.0)
                                            .go(-0.1, 0.0, 4.0)
                                            .in(with_wall());
  EXPECT_EQ(figures.contacts, 1u);
  EXPECT_NEAR(figures.contact_s, in_touch / 0.2 + 3.0 + in_touch / 0.1, 0.1 + 1e-6);
  EXPECT_NEAR(figures.contact_speed, 0.2, 1e-6);
  EXPECT_NEAR(figures.way_m, approach + in_touch + 0.4, 1e-6);
}

TEST(DriveFigures, OfTwoTouchesTheFasterTells) {
  const scoring::DriveFigures figures = Drive(before_it(0.112))
                                            .go(0.1, 0.0, 1.1)
                                            .stand(1.0)
                                            .go(-0.2, 0.0, 1.0)
                                            .go(0.4, 0.0, 0.5)
                                            .stand(2.0)
                                            .go(-0.3, 0.0, 1.0)
                                            .in(with_wall());
  EXPECT_EQ(figures.contacts, 2u);
  EXPECT_NEAR(figures.contact_speed, 0.4, 1e-6);
  EXPECT_GT(figures.contact_s, 3.0);
  EXPECT_LT(figures.contact_s, 3.5);
}

TEST(DriveFigures, ATouchByATurnOnTheSpotHasNoSpeed) {
  const double cut = robot::kCornerCut * kRobot.length;
  const double corner = std::hypot(kNose - cut, kSide);
  const scoring::DriveFigures figures =
      Drive({kWallAt - corner - 0.005, 0.0, 0.0}).go(0.0, 0.5, 8.0 * kPi).in(with_wall());
  EXPECT_EQ(figures.contacts, 8u) << "two turns, four corners each";
  EXPECT_NEAR(figures.contact_speed, 0.0, 1e-9);
  EXPECT_NEAR(figures.way_m, 0.0, 1e-9);
}

TEST(DriveFigures, WayIsTheLengthInThePlanView) {
  EXPECT_NEAR(Drive({}).go(0.3, 0.0, 6.0).go(0.0, 1.0, 1.0).go(-0.2, 0.0, 5.0).in(floor()).way_m, 2.8, 1e-6);
  // A circle of 0.5 m, of chords of 0.1 s.
  const double chord = 2.0 * 0.5 * std::sin(0.5 * 0.6 * 0.1);
  EXPECT_NEAR(Drive({}).go(0.3, 0.6, 10.0).in(floor()).way_m, 100 * chord, 1e-4);
}

TEST(DriveFigures, HomeIsFarFromTheStartOfTheArenaAtTheEnd) {
  arenas::Arena arena = floor();
  arena.start = {1.0, -1.0, 0.0};
  EXPECT_NEAR(Drive({1.0, -1.0, 0.5 * kPi}).go(0.2, 0.0, 10.0).in(arena).home_m, 2.0, 1e-9);
  EXPECT_NEAR(Drive({1.0, -1.0, 0.0}).go(0.2, 0.0, 10.0).go(-0.2, 0.0, 10.0).in(arena).home_m, 0.0, 1e-9);
}

TEST(DriveFigures, OfNoDriveAreNone) {
  const scoring::DriveFigures figures = drive_figures(with_wall(), {}, {});
  EXPECT_EQ(figures.way_m, 0.0);
  EXPECT_EQ(figures.contact_s, 0.0);
  EXPECT_EQ(figures.contacts, 0u);
  EXPECT_EQ(figures.min_clearance_m, 0.5);
}

}  // namespace
}  // namespace rubble::scenarios
