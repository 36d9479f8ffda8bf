// A map that the mapper draws anew after a correction shows old walls beside victims that have moved already.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using test::exact_mapper;
using test::Maze;
using test::MazeRobot;

/// Draws its map anew until a moment.
class RedrawingMapper : public slam::PaperMapper {
 public:
  using slam::PaperMapper::PaperMapper;
  bool settled() const override { return settles; }
  bool settles = false;
};

constexpr double kNever = std::numeric_limits<double>::infinity();

/// When the explorer told of holes, with a victim behind the wall of a lane, shown to it from the beginning, and a
/// mapper that settles at `settles` [s].
double told_of_holes(double settles) {
  const Maze maze = test::maze({"+--+--+--+--+",  //
                                "|R          |",  //
                                "+--+--+--+--+"});
  const TPoint2D victim{1.5 * Maze::kPallet, 0.5 * Maze::kPallet + 0.15};
  const robot::RobotModel model;
  MazeRobot robot(maze, model);
  RedrawingMapper mapper(model, exact_mapper(), 1);
  PaperExplorer explorer(model, {});
  robot::Commands commands;
  for (int tick = 0; robot.now().seconds() < 60.0 && !explorer.finished(); ++tick) {
    robot::Inputs inputs = robot.step(commands);
    const TPoint2D p_base = robot.pose().inverseComposePoint(victim);
    if (tick % 25 == 0 && std::abs(robot.pose().x - victim.x) < 0.7)
      inputs.cues.push_back(
          {inputs.now, robot::CueKind::Appearance, std::atan2(p_base.y, p_base.x), p_base.norm(), 0.9});
    mapper.update(inputs);
    mapper.settles = inputs.now.seconds() >= settles;
    commands = explorer.next(mapper, inputs);
  }
  EXPECT_EQ(explorer.victims().size(), 1u);
  for (const Decision& decision : explorer.decisions())
    if (decision.why.find("through a hole") != std::string::npos) return decision.stamp.seconds();
  return kNever;
}

TEST(UnsettledMap, TellsOfNoHoles) {
  const double at_once = told_of_holes(0.0);
  EXPECT_LT(at_once, 30.0) << "the victim shows behind the wall";
  EXPECT_EQ(told_of_holes(kNever), kNever);
}

TEST(UnsettledMap, IsJudgedOnceItHasSettled) {
  const double told = told_of_holes(40.0);
  EXPECT_GE(told, 40.0);
  EXPECT_LT(told, 50.0);
}

}  // namespace
}  // namespace rubble::explore
