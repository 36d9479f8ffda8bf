// What lies in a niche beside the way is looked at on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using test::Maze;

/// A corridor of ten pallets with a box at the north wall of the fourth that is open to the south.
Maze corridor_with_niche() {
  Maze maze = test::maze({"+--+--+--+--+--+--+--+--+--+--+",  //
                          "| R                           |",  //
                          "+--+--+--+--+--+--+--+--+--+--+"});
  const TPoint2D c = maze.centre(3, 0);
  for (const double side : {-0.19, 0.19}) maze.walls.push_back({{c.x + side, c.y + 0.2}, {c.x + side, c.y + 0.6}});
  return maze;
}

/// How far along the corridor the robot had come when it first looked into the niche [m].
std::optional<double> farthest_before_looking(PaperExplorerConfig config) {
  const Maze maze = corridor_with_niche();
  const TPoint2D back{maze.centre(3, 0).x, maze.centre(3, 0).y + 0.5};
  const robot::RobotModel model;
  test::MazeRobot robot(maze, model);
  slam::PaperMapper mapper(model, test::exact_mapper(), 1);
  PaperExplorer explorer(model, config);
  robot::Commands commands;
  double farthest = 0.0;
  double looked = 0.0;  // [s]
  while (robot.now().seconds() < 600.0 && !explorer.finished()) {
    const robot::Inputs inputs = robot.step(commands);
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    const TPose2D& pose = robot.pose();
    farthest = std::max(farthest, pose.x);
    const double bearing = std::atan2(back.y - pose.y, back.x - pose.x);
    // Seen as its back can be inspected, for long enough to look twice.
    const bool before_it = bearing > deg_to_rad(30.0) && bearing < deg_to_rad(150.0);
    const bool turned_to_it = pose.phi > deg_to_rad(15.0) && pose.phi < deg_to_rad(165.0);
    const bool faces_it = turned_to_it && std::abs(wrap_angle(bearing - pose.phi)) < deg_to_rad(25.0);
    const bool near = distance(back, {pose.x, pose.y}) < SearchConfig().range;
    if (before_it && faces_it && near && std::abs(commands.drive.w) < deg_to_rad(40.0)) looked += model.tick;
    if (looked > 0.35) return farthest;
  }
  return std::nullopt;
}

TEST(Niche, IsLookedIntoBeforeTheRobotGoesOn) {
  const auto farthest = farthest_before_looking({});
  ASSERT_TRUE(farthest);
  EXPECT_LT(*farthest, 6 * Maze::kPallet) << "the corridor ends at " << 9.5 * Maze::kPallet;
}

TEST(Niche, IsLeftAloneWhereNobodyAsksForVictims) {
  PaperExplorerConfig config;
  config.search.on = false;
  EXPECT_FALSE(farthest_before_looking(config));
}

}  // namespace
}  // namespace rubble::explore
