// A pose that falls behind a robot that moves as told, as between bare walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;
using test::exact_mapper;
using test::Maze;
using test::MazeRobot;

/// Its poses fall behind at times: their places stay while the robot drives on; the walls tell its heading.
class LaggingMapper : public slam::PaperMapper {
 public:
  using slam::PaperMapper::PaperMapper;
  void lag(bool lags) {
    if (lags != stays_.has_value()) stays_ = lags ? std::optional(slam::PaperMapper::pose()) : std::nullopt;
  }
  TPose2D pose() const override {
    const TPose2D pose = slam::PaperMapper::pose();
    return stays_ ? TPose2D{stays_->x, stays_->y, pose.phi} : pose;
  }

 private:
  std::optional<TPose2D> stays_;
};

enum class Trouble { PoseLags, WheelsSpin };

struct Ran {
  int troubles = 0;  ///< that befell it
  int backing = 0;   ///< ticks in which it got free of something
  bool felt_its_brake = false;
  double farthest = 0.0;  ///< east of its start [m]
  MissionEnd end = MissionEnd::UnderWay;
};

/// Twice on its way east along a corridor that leads to all the rest something befalls the robot, at speed, until it
/// brakes and backs off or has driven 0.3 m.
Ran run(Trouble trouble, bool accelerometer) {
  const Maze maze = test::maze({"+--+--+--+--+--+--+",  //
                                "| R               |",  //
                                "+--+--+--+--+--+  +",  //
                                "               |  |",  //
                                "+--+--+--+--+--+--+"});
  const robot::RobotModel model;
  MazeRobot robot(maze, model);
  LaggingMapper mapper(model, exact_mapper(), 1);
  PaperExplorer explorer(model, {}, {900.0});
  robot::Commands commands;
  Ran ran;
  double speed = 0.0;
  bool under_way = false;
  double until = 0.0;  // [m]
  while (robot.now().seconds() < 900.0 && !explorer.finished()) {
    const TPose2D before = robot.pose();
    const double x = before.x - maze.start.x;
    const bool at_speed = speed > 0.35 && std::cos(before.phi) > 0.9 && x > 1.5 + 1.5 * ran.troubles && x < 4.0;
    if (!under_way && at_speed && ran.troubles < 2) {
      under_way = true;
      until = x + 0.3;
      ++ran.troubles;
    }
    const bool backs = explorer.state() == ExplorerState::BackingUp;
    if (x > until || backs || (trouble == Trouble::PoseLags && commands.brake)) under_way = false;
    robot.held = under_way && trouble == Trouble::WheelsSpin;
    robot::Inputs inputs = robot.step(commands);
    const double before_that = speed;
    speed = before.inverseComposePoint({robot.pose().x, robot.pose().y}).x / model.tick;
    // What stops it takes its speed softly: it does not strike the body.
    const double felt = robot.held ? 0.0 : (speed - before_that) / model.tick;
    if (accelerometer) inputs.accelerations.push_back({inputs.now, felt, 0.0});
    if (robot.held && !commands.brake)
      for (robot::Odometry& odometry : inputs.odometry) odometry.v = commands.drive.v;
    mapper.update(inputs);
    mapper.lag(under_way && trouble == Trouble::PoseLags);
    commands = explorer.next(mapper, inputs);
    ran.farthest = std::max(ran.farthest, robot.pose().x - maze.start.x);
    ran.backing += explorer.state() == ExplorerState::BackingUp ? 1 : 0;
  }
  ran.end = explorer.end();
  for (const Decision& decision : explorer.decisions())
    ran.felt_its_brake = ran.felt_its_brake || decision.why.find("felt that it moved") != std::string::npos;
  return ran;
}

/// It brakes and feels that it moved: nothing was met, nothing is remembered, and it passes.
TEST(LaggingPose, IsNoObstacleToARobotThatFeelsItsBrake) {
  const Ran ran = run(Trouble::PoseLags, true);
  EXPECT_EQ(ran.troubles, 2);
  EXPECT_TRUE(ran.felt_its_brake);
  EXPECT_EQ(ran.backing, 0);
  EXPECT_EQ(ran.end, MissionEnd::Home);
  EXPECT_GT(ran.farthest, 4.0 * Maze::kPallet);
}

TEST(LaggingPose, IsTakenForAnObstacleWhereNobodyFeelsAnything) {
  const Ran ran = run(Trouble::PoseLags, false);
  EXPECT_GT(ran.backing, 0);
  EXPECT_FALSE(ran.felt_its_brake);
}

TEST(LaggingPose, WheelsThatSpinBeforeSomethingAreHeldAllTheSame) {
  const Ran ran = run(Trouble::WheelsSpin, true);
  EXPECT_GT(ran.troubles, 0);
  EXPECT_GT(ran.backing, 0);
  EXPECT_FALSE(ran.felt_its_brake);
  EXPECT_EQ(ran.end, MissionEnd::Home);
}

}  // namespace
}  // namespace rubble::explore
