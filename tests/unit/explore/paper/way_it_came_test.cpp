// The only way home, shut behind the robot by something that lies on its trail.
#include <gtest/gtest.h>

#include <algorithm>

#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using test::exact_mapper;
using test::Maze;
using test::MazeRobot;

/// A heap that reaches from the wall across the lane, on the edge of two pallets, where everything looks like a wall.
TEST(WayItCame, LeadsHomeThroughWhatHasRolledIntoIt) {
  for (const bool rolled : {true, false}) {
    const Maze maze = test::maze({"+--+--+--+--+--+--+",  //
                                  "| R               |",  //
                                  "+--+--+--+--+--+--+"});
    const double edge = maze.start.x + 1.5 * Maze::kPallet, wall = maze.start.y - 0.5 * Maze::kPallet;
    const double top = wall + 0.9;
    const std::vector<test::Segment> heap{{{edge - 0.1, wall}, {edge - 0.1, top}},
                                          {{edge - 0.1, top}, {edge + 0.1, top}},
                                          {{edge + 0.1, top}, {edge + 0.1, wall}}};
    const robot::RobotModel model;
    MazeRobot robot(maze, model);
    slam::PaperMapper mapper(model, exact_mapper(), 1);
    PaperExplorer explorer(model, {}, {600.0});
    robot::Commands commands;
    bool lies = false, pushed = false;
    while (robot.now().seconds() < 600.0 && !explorer.finished()) {
      const double east = robot.pose().x - edge;
      if (rolled && !lies && east > 1.5 * Maze::kPallet) {
        lies = true;
        robot.maze().walls.insert(robot.maze().walls.end(), heap.begin(), heap.end());
      }
      // It gives way to a robot that drives at it.
      if (lies && !pushed && std::abs(east) < 0.5 * model.length + 0.25 &&
          explorer.state() == ExplorerState::GoingHome) {
        pushed = true;
        robot.maze().walls.resize(maze.walls.size());
      }
      const robot::Inputs inputs = robot.step(commands);
      mapper.update(inputs);
      commands = explorer.next(mapper, inputs);
    }
    EXPECT_EQ(lies, rolled);
    EXPECT_EQ(pushed, rolled);
    EXPECT_EQ(explorer.end(), MissionEnd::Home);
  }
}

}  // namespace
}  // namespace rubble::explore
