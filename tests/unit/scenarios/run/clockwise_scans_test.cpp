#include <gtest/gtest.h>

#include <limits>

#include "robot/beam_order.h"
#include "scenarios/run/core.h"
#include "tests/support/slam_floor.h"

namespace rubble::scenarios {
namespace {

using robot::Inputs;
using robot::LaserScan;

/// Angles whose sums are exact.
robot::RobotModel counter_clockwise_model() {
  robot::RobotModel model;
  model.laser.beams = 257;
  model.laser.angle_min = -2.0;
  model.laser.angle_step = 1.0 / 64.0;
  model.laser.range_max = 20.0;
  return model;
}

std::vector<Inputs> drive_of(const robot::RobotModel& model) {
  const slam_test::Floor floor(3, 2, 2);
  const auto drive = slam_test::drive_through(floor.way({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}), 0.0);
  return slam_test::record(floor.world(), drive, model, 1.0, 0.01, 3);
}

TEST(ClockwiseScans, AreMappedAsIfTheirBeamsRanTheOtherWay) {
  const robot::RobotModel model = counter_clockwise_model();
  robot::RobotModel clockwise = model;
  clockwise.laser.angle_min += model.laser.field_of_view();
  clockwise.laser.angle_step = -model.laser.angle_step;
  const Scenario scenario;
  Core expected(scenario, model, false, "");
  Core core(scenario, clockwise, false, "");
  for (const Inputs& tick : drive_of(model)) {
    Inputs turned = tick;
    for (LaserScan& scan : turned.scans) robot::reverse_beams(scan);
    expected.step(tick);
    core.step(turned);
  }
  expected.finish();
  core.finish();
  ASSERT_GT(expected.mapper().counts().mapped, 20u);
  EXPECT_EQ(core.mapper().counts().mapped, expected.mapper().counts().mapped);
  EXPECT_EQ(core.mapper().counts().out_of_order, 0u);
  EXPECT_NEAR(known_area(core.mapper().map()), known_area(expected.mapper().map()), 0.5);
  ASSERT_EQ(core.mapper().trajectory().size(), expected.mapper().trajectory().size());
  for (std::size_t i = 0; i < core.mapper().trajectory().size(); ++i) {
    const auto& [stamp, pose] = core.mapper().trajectory()[i];
    EXPECT_NEAR(pose.x, expected.mapper().trajectory()[i].pose.x, 0.01);
    EXPECT_NEAR(pose.y, expected.mapper().trajectory()[i].pose.y, 0.01);
  }
}

/// What no sweep can be is left to the mapper, which leaves it out.
TEST(ClockwiseScans, OfNoTimeOrNoBeamAreLeftOut) {
  Core core({}, {}, false, "");
  Inputs tick;
  for (const double period :
       {1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    LaserScan scan;
    scan.angle_step = -0.01;
    scan.beam_period = period;
    scan.range_max = 4.0;
    scan.ranges.assign(100, 1.0f);
    tick.scans.push_back(scan);
  }
  tick.scans.push_back({});
  tick.scans.back().angle_step = -0.01;
  core.step(tick);
  EXPECT_EQ(core.mapper().counts().out_of_order, 4u);
}

TEST(BeamOrder, ReversedTwiceAScanIsTheSame) {
  LaserScan scan;
  scan.stamp = Stamp::from_seconds(3.0);
  scan.angle_min = -1.0;
  scan.angle_step = 0.25;
  scan.beam_period = 0.001;
  scan.ranges = {1.0f, 2.0f, 3.0f};
  scan.codes = {0, 7, 0};
  LaserScan twice = scan;
  robot::reverse_beams(twice);
  EXPECT_EQ(twice.bearing(0), scan.bearing(2));
  EXPECT_EQ(twice.beam_stamp(2), scan.beam_stamp(0));
  EXPECT_EQ(twice.ranges.front(), scan.ranges.back());
  EXPECT_FALSE(robot::is_clockwise(scan));
  EXPECT_TRUE(robot::is_clockwise(twice));
  robot::reverse_beams(twice);
  EXPECT_EQ(twice.stamp, scan.stamp);
  EXPECT_EQ(twice.angle_min, scan.angle_min);
  EXPECT_EQ(twice.angle_step, scan.angle_step);
  EXPECT_EQ(twice.beam_period, scan.beam_period);
  EXPECT_EQ(twice.ranges, scan.ranges);
  EXPECT_EQ(twice.codes, scan.codes);
}

}  // namespace
}  // namespace rubble::scenarios
