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

/// The turn towards a place to search carries the robot off its viewpoint: it looks from where it came to stand,
/// instead of driving back and turning again.
TEST(Niche, ATurnThatWandersDoesNotGoOnForEver) {
  for (const double wander : {0.05, 0.1, 0.2, -0.1, -0.15, -0.2}) {
    const Maze maze = corridor_with_niche();
    const robot::RobotModel model;
    test::MazeRobot robot(maze, model);
    robot.wander = wander;
    slam::PaperMapper mapper(model, test::exact_mapper(), 1);
    PaperExplorer explorer(model, {});
    robot::Commands commands;
    TPose2D place = robot.pose();
    double turned = 0.0, most = 0.0;  // there, whichever way [rad]
    while (robot.now().seconds() < 900.0 && !explorer.finished()) {
      const TPose2D before = robot.pose();
      const robot::Inputs inputs = robot.step(commands);
      mapper.update(inputs);
      commands = explorer.next(mapper, inputs);
      if (distance({place.x, place.y}, {robot.pose().x, robot.pose().y}) > 0.5) {
        place = robot.pose();
        turned = 0.0;
      }
      turned += std::abs(wrap_angle(robot.pose().phi - before.phi));
      most = std::max(most, turned);
    }
    EXPECT_TRUE(explorer.finished()) << wander;
    EXPECT_LT(most, 4.0 * 2.0 * kPi) << "within half a metre, at " << wander << " m/rad";
  }
}

TEST(Niche, IsLeftAloneWhereNobodyAsksForVictims) {
  PaperExplorerConfig config;
  config.search.on = false;
  EXPECT_FALSE(farthest_before_looking(config));
}

}  // namespace
}  // namespace rubble::explore
