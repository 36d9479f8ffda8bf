#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/angle.h"
#include "explore/paper/paper_explorer.h"
#include "robot/hardware_units.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using test::exact_mapper;
using test::Maze;
using test::MazeRobot;

struct Outcome {
  bool finished = false;
  std::string reason;
  double seconds = 0.0;
  double way = 0.0;              ///< [m]
  double least_clearance = 1e9;  ///< [m]
  int touches = 0;               ///< ticks in which a wall reached into the body
  int pallets_seen = 0;
  TPose2D end;  ///< arena frame
};

int pallets_seen(const slam::CountMap& map, const Maze& maze) {
  int count = 0;
  for (int row = 0; row < maze.rows; ++row)
    for (int column = 0; column < maze.columns; ++column) {
      const Cell c = map.frame().cell(maze.start.inverseComposePoint(maze.centre(column, row)));
      if (map.frame().inside(c) && map.seen(c) > 0) ++count;
    }
  return count;
}

Outcome explore_maze(const Maze& maze, const PaperExplorerConfig& config, const slam::PaperConfig& mapping,
                     double time_limit = 1200.0, const Mission& mission = {}) {
  const robot::RobotModel model;
  MazeRobot robot(maze, model);
  slam::PaperMapper mapper(model, mapping, 1);
  PaperExplorer explorer(model, config, mission);
  robot::Commands commands;
  Outcome run;
  while (robot.now().seconds() < time_limit && !explorer.finished()) {
    const TPose2D before = robot.pose();
    const robot::Inputs inputs = robot.step(commands);
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    run.way += std::hypot(robot.pose().x - before.x, robot.pose().y - before.y);
    run.least_clearance = std::min(run.least_clearance, robot.clearance());
    run.touches += robot.touches() ? 1 : 0;
  }
  run.finished = explorer.finished();
  run.reason = explorer.reason();
  run.seconds = robot.now().seconds();
  run.pallets_seen = pallets_seen(mapper.map(), maze);
  run.end = robot.pose();
  return run;
}

/// A robot that was held while a device was away, and whose motors are off for a while after, is not stuck: nothing is
/// barred for it.
TEST(PaperExplorer, AHeldRobotIsNotTakenForStuck) {
  const Maze maze = test::random_maze(5, 5, 0.2, 4);
  const robot::RobotModel model;
  MazeRobot robot(maze, model);
  slam::PaperMapper mapper(model, exact_mapper(), 1);
  PaperExplorer explorer(model, {});
  robot::Commands commands;
  int holds = 0;
  Stamp held_until = Stamp::never();
  for (int tick = 0; tick < 6000 && holds < 5; ++tick) {
    if (commands.drive.v > 0.3 && (held_until == Stamp::never() || robot.now() > held_until + 3.0)) {
      robot.wait(3.5);
      held_until = robot.now() + 1.2;
      ++holds;
    }
    robot.held = held_until != Stamp::never() && robot.now() < held_until;
    const robot::Inputs inputs = robot.step(commands);
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    ASSERT_NE(explorer.state(), ExplorerState::BackingUp) << "after " << inputs.now.seconds() << " s";
  }
  EXPECT_EQ(holds, 5);
}

/// Only the order of the frontiers differs.
TEST(PaperExplorer, SeesTheWholeMazeWhateverTheNextFrontierIsChosenBy) {
  std::vector<double> ways, ways_of_6;
  for (const FrontierChoice by :
       {FrontierChoice::Transform, FrontierChoice::Nearest, FrontierChoice::Gain, FrontierChoice::Value}) {
    PaperExplorerConfig config;
    config.search.on = false;
    config.choice.by = by;
    double way = 0.0;
    for (const std::uint64_t seed : {5u, 6u, 7u}) {
      const Outcome run = explore_maze(test::random_maze(4, 4, 0.3, seed), config, exact_mapper());
      EXPECT_TRUE(run.finished) << static_cast<int>(by) << ", seed " << seed;
      EXPECT_EQ(run.pallets_seen, 16) << static_cast<int>(by) << ", seed " << seed;
      EXPECT_EQ(run.touches, 0) << static_cast<int>(by) << ", seed " << seed;
      way += run.way;
      if (seed == 6) ways_of_6.push_back(run.way);
    }
    ways.push_back(way);
  }
  EXPECT_GT(ways[2], ways[0]) << "for the sake of gain it drives to and fro";
  EXPECT_GT(ways_of_6[2], ways_of_6[0]) << "the same, seed 6 alone";
}

/// Short missions choose by value, others by the transform, unless another choice is asked for.
TEST(PaperExplorer, ChoosesByTheTimeOfItsMission) {
  const Maze maze = test::random_maze(5, 5, 0.3, 6);
  const auto end_of = [&](FrontierChoice by, double limit) {
    PaperExplorerConfig config;
    config.search.on = config.return_home = false;
    config.choice.by = by;
    return explore_maze(maze, config, exact_mapper(), 100.0, {limit}).way;
  };
  const double value = end_of(FrontierChoice::Value, 200.0), transform = end_of(FrontierChoice::Transform, 200.0);
  ASSERT_NE(value, transform);
  EXPECT_EQ(end_of(FrontierChoice::ByTime, 200.0), value);
  EXPECT_EQ(end_of(FrontierChoice::ByTime, 1200.0), transform);
}

/// Faster than what slopes and rough ground allow.
FollowerConfig hasty() {
  FollowerConfig config;
  config.cruise_speed = 0.6;
  config.passed_speed = 0.7;
  config.slope_speed = 0.4;
  return config;
}

/// A robot in a straight lane of ten pallets, whose servos hold the laser level and tell how it leans.
struct InALane {
  Maze maze = test::maze({"+--+--+--+--+--+--+--+--+--+--+",  //
                          "| R                           |",  //
                          "+--+--+--+--+--+--+--+--+--+--+"});
  robot::RobotModel model;
  MazeRobot robot{maze, model};
  slam::PaperMapper mapper{model, exact_mapper(), 1};
  PaperExplorer explorer;
  robot::Commands commands;

  explicit InALane(bool goes_home = false) : explorer(model, config(goes_home)) {}
  /// Nothing that it feels shuts the lane.
  static PaperExplorerConfig config(bool goes_home) {
    PaperExplorerConfig out;
    out.search.on = false;
    out.return_home = goes_home;
    out.felt.memory = out.felt.pallet = 0.0;
    out.follower = hasty();
    return out;
  }
  /// Along the lane, from the start [m].
  double at() const { return robot.pose().x - maze.start.x; }
  /// One tick on a slope of `lean` [rad]; the platform itself is `tilted` [rad].
  void step(double lean, double tilted = 0.0) {
    robot::Inputs inputs = robot.step(commands);
    inputs.aims.push_back({inputs.now, -lean, 0.0});
    inputs.accelerations.push_back({inputs.now, robot::kGravity * std::sin(tilted), 0.0});
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
  }
};

TEST(PaperExplorer, IsSlowerOnASlope) {
  InALane lane;
  double fastest = 0.0;
  while (lane.robot.now().seconds() < 15.0) {
    lane.step(deg_to_rad(10.0));
    fastest = std::max(fastest, lane.commands.drive.v);
  }
  EXPECT_NEAR(fastest, hasty().slope_speed, 0.02);
}

/// From ramp to ramp the platform lags behind, and its angles do not tell how the body leans.
TEST(PaperExplorer, StaysSlowWhileItsPlatformLagsBehind) {
  InALane lane;
  double fastest = 0.0;
  while (lane.robot.now().seconds() < 15.0) {
    const bool lags = lane.robot.now().seconds() > 8.0;
    lane.step(lags ? 0.0 : deg_to_rad(10.0), lags ? deg_to_rad(8.0) : 0.0);
    if (lane.robot.now().seconds() > 8.5) fastest = std::max(fastest, lane.commands.drive.v);
  }
  EXPECT_GT(fastest, 0.2);
  EXPECT_LT(fastest, hasty().slope_speed + 0.06);
}

/// How fast it comes back to where the floor leant by `lean` [rad] on the way out, between 2 and 4 m.
double speed_before_slope(double lean) {
  InALane lane(true);
  double fastest = 0.0, farthest = 0.0;
  while (lane.robot.now().seconds() < 400.0 && !lane.explorer.finished()) {
    const double at = lane.at();
    farthest = std::max(farthest, at);
    lane.step(at > 2.0 && at < 4.0 ? lean : 0.0);
    if (farthest > 6.0 && at > 4.0 && at < 4.2) fastest = std::max(fastest, lane.commands.drive.v);
  }
  EXPECT_TRUE(lane.explorer.finished());
  return fastest;
}

TEST(PaperExplorer, BrakesBeforeASlopeThatItMetBefore) {
  EXPECT_GT(speed_before_slope(0.0), hasty().cruise_speed);
  const double slow = speed_before_slope(deg_to_rad(10.0));
  EXPECT_GT(slow, 0.2);
  EXPECT_LT(slow, hasty().slope_speed + 0.05);
}

TEST(PaperExplorer, IsSlowerOnceItWasHeldSeveralTimes) {
  InALane lane;
  double before = 0.0, after = 0.0;
  int times = 0;
  Stamp again = Stamp::never();
  while (lane.robot.now().seconds() < 400.0 && lane.at() < 8.0 && !lane.explorer.finished()) {
    const bool backs_up = lane.explorer.state() == ExplorerState::BackingUp;
    if (lane.robot.held && backs_up) {
      ++times;
      again = lane.robot.now() + 4.0;
    }
    const bool waits = again != Stamp::never() && lane.robot.now() < again;
    lane.robot.held = times < 4 && !backs_up && !waits && lane.commands.drive.v > 0.25;
    lane.step(0.0);
    if (times == 0) before = std::max(before, lane.commands.drive.v);
    if (times == 4 && !waits && !backs_up) after = std::max(after, lane.commands.drive.v);
  }
  EXPECT_EQ(times, 4);
  EXPECT_GT(before, hasty().rough_speed + 0.1);
  EXPECT_GT(after, 0.2);
  EXPECT_LT(after, hasty().rough_speed + 0.01);
}

/// Eqs. (3) and (4) with nothing around them, as scenarios/sweeps/transform.yaml sets it.
TEST(PaperExplorer, SeesTheWholeMazeByTheTransformAsPrinted) {
  PaperExplorerConfig config;
  config.search.on = false;
  config.bar_targets = false;
  config.planner.transform.discomfort = Discomfort::PerCell;
  config.planner.transform.alpha = 1.0;
  config.planner.d_min_floor = config.planner.transform.d_min;
  config.planner.min_frontier_cells = 1;
  config.felt.pallet = 0.0;
  const Outcome run = explore_maze(test::random_maze(4, 4, 0.3, 6), config, exact_mapper());
  EXPECT_TRUE(run.finished);
  EXPECT_EQ(run.pallets_seen, 16);
  EXPECT_EQ(run.touches, 0);
}

class RandomMaze : public testing::TestWithParam<int> {};

TEST_P(RandomMaze, IsSeenWholeWithoutATouchAndTheExplorerFinishesByItself) {
  const std::uint64_t seed = static_cast<std::uint64_t>(GetParam());
  const int columns = 4 + GetParam() % 5;
  const int rows = 4 + (GetParam() / 2) % 5;
  SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << columns << " x " << rows);
  const Maze maze = test::random_maze(columns, rows, 0.2, seed);
  const Outcome run = explore_maze(maze, {}, exact_mapper());
  RecordProperty("seconds", std::to_string(run.seconds));
  std::cout << "  " << columns << "x" << rows << " " << run.seconds << " s, " << run.way << " m, clearance "
            << run.least_clearance << ", touches " << run.touches << ", " << run.reason << "\n";
  EXPECT_TRUE(run.finished);
  EXPECT_FALSE(run.reason.empty());
  EXPECT_EQ(run.pallets_seen, columns * rows);
  EXPECT_GE(run.least_clearance, 0.5 * robot::RobotModel().width);
  EXPECT_EQ(run.touches, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMaze, testing::Range(1, 11));

}  // namespace
}  // namespace rubble::explore
