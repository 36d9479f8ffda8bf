// While a mapper doubts its pose, what the victim sensors tell cannot be placed: through the whole explorer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/planar.h"
#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Another mapper, with a covariance that a test plants.
class Doubtful : public slam::Mapper {
 public:
  explicit Doubtful(slam::Mapper& mapper) : mapper_(mapper) {}
  double sigma = 0.0;  ///< of x and y [m]
  double blind = 0.0;  ///< [m]
  double ahead = 0.0;  ///< its pose is so far ahead of the robot [m]

  void update(const robot::Inputs& inputs) override { mapper_.update(inputs); }
  const slam::CountMap& map() const override { return mapper_.map(); }
  TPose2D pose() const override { return mapper_.pose() + TPose2D(ahead, 0.0, 0.0); }
  PoseCovariance covariance() const override {
    PoseCovariance covariance;
    covariance(0, 0) = covariance(1, 1) = sigma * sigma;
    return covariance;
  }
  double blind_way() const override { return blind; }
  std::uint64_t revision() const override { return mapper_.revision(); }
  std::optional<TPose2D> pose_at(Stamp stamp) const override { return mapper_.pose_at(stamp); }
  const Trajectory& trajectory() const override { return mapper_.trajectory(); }
  const Trajectory& live_trajectory() const override { return mapper_.live_trajectory(); }
  const std::vector<TPoint2D>& last_hits() const override { return mapper_.last_hits(); }
  const slam::MapperCounts& counts() const override { return mapper_.counts(); }

 private:
  slam::Mapper& mapper_;
};

struct Seen {
  std::size_t victims = 0;
  bool searched = false;  ///< all there is
  int places = 0;         ///< driven to for a look
};

/// A mission in a corridor with a victim at its wall, 400 s at most. `lost_from` [s] on the pose is off by more than a
/// metre.
Seen mission(double lost_from) {
  const test::Maze maze = test::maze({"+--+--+--+",  //
                                      "| R      |",  //
                                      "+--+--+--+"});
  const TPoint2D victim{maze.centre(1, 0).x + 0.3, maze.centre(1, 0).y + 0.55};
  const robot::RobotModel model;
  test::MazeRobot robot(maze, model);
  slam::PaperMapper paper(model, test::exact_mapper(), 1);
  Doubtful mapper(paper);
  PaperExplorer explorer(model, {}, {400.0});
  robot::Commands commands;
  while (robot.now().seconds() < 400.0 && !explorer.finished()) {
    robot::Inputs inputs = robot.step(commands);
    const TPoint2D seen = robot.pose().inverseComposePoint(victim);
    const double bearing = std::atan2(seen.y, seen.x), range = std::hypot(seen.x, seen.y);
    if (!inputs.scans.empty() && range < 1.8 && std::abs(bearing) < 0.5)
      inputs.cues.push_back({inputs.now, robot::CueKind::Heat, bearing, range, 0.9});
    mapper.sigma = inputs.now.seconds() < lost_from ? 0.0 : 1.5;
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
  }
  Seen run;
  run.victims = explorer.victims().size();
  run.searched = explorer.reason().find("all visible floor searched") != std::string::npos;
  for (const Decision& decision : explorer.decisions())
    if (decision.why.find("drives to a place") != std::string::npos) ++run.places;
  return run;
}

TEST(Doubt, WithAPoseThatIsSureTheVictimIsFoundAndTheFloorSearched) {
  const Seen run = mission(1e9);
  EXPECT_EQ(run.victims, 1u);
  EXPECT_TRUE(run.searched);
}

/// Doubt fades by 0.0025 m2 a second: 4.5 m2 outlast the mission.
TEST(Doubt, ALostPoseMakesNoVictim) { EXPECT_EQ(mission(0.0).victims, 0u); }

/// What is passed on the way does not count as looked at, so that more places must be driven to.
TEST(Doubt, WhatALostRobotPassesIsNotSearchedByThat) {
  const Seen sure = mission(1e9), lost = mission(0.0);
  EXPECT_GT(lost.places, sure.places);
}

TEST(Doubt, TheRobotWaitsForItsMapperAndThenGoesOn) {
  const test::Maze maze = test::random_maze(5, 5, 0.2, 4);
  const robot::RobotModel model;
  test::MazeRobot robot(maze, model);
  slam::PaperMapper paper(model, test::exact_mapper(), 1);
  Doubtful mapper(paper);
  PaperExplorer explorer(model, {});
  robot::Commands commands;
  int told = 0;         ///< to move, in the first three seconds of doubt
  double driven = 0.0;  ///< after these [m]
  while (robot.now().seconds() < 22.0) {
    const TPose2D before = robot.pose();
    const robot::Inputs inputs = robot.step(commands);
    const double t = inputs.now.seconds();
    mapper.sigma = t < 12.0 ? 0.0 : 1.5;
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    if (t > 12.2 && t < 14.9 && (commands.drive.v != 0.0 || commands.drive.w != 0.0)) ++told;
    if (t > 15.2) driven += distance(position(before), position(robot.pose()));
  }
  EXPECT_EQ(told, 0) << "while there is hope";
  EXPECT_GT(driven, 0.5) << "not for ever";
}

PaperExplorerConfig all_that_can_be_known() {
  PaperExplorerConfig config;
  config.search.on = false;
  config.return_home = false;
  return config;
}

/// A corridor of ten pallets whose walls tell nothing of the way along them, and who is in it.
struct BareCorridor {
  const test::Maze maze = test::maze({"+--+--+--+--+--+--+--+--+--+--+",  //
                                      "| R                           |",  //
                                      "+--+--+--+--+--+--+--+--+--+--+"});
  const robot::RobotModel model;
  test::MazeRobot robot{maze, model};
  slam::PaperMapper paper{model, test::exact_mapper(), 1};
  Doubtful mapper{paper};
  PaperExplorer explorer{model, all_that_can_be_known()};
};

/// A mission in a bare corridor: where the robot looked back, as the way that odometry alone tells [m].
/// `blow_at`: something jolts it there.
std::vector<double> looks_back(bool bare, std::optional<double> blow_at) {
  BareCorridor corridor;
  auto& [maze, model, robot, paper, mapper, explorer] = corridor;
  robot::Commands commands;
  TPose2D last = robot.pose();
  std::vector<double> looks;
  std::size_t told = 0;
  int jolted = 0;
  double v = 0.0;
  while (robot.now().seconds() < 200.0 && !explorer.finished()) {
    robot::Inputs inputs = robot.step(commands);
    mapper.blind += bare ? distance(position(last), position(robot.pose())) : 0.0;
    last = robot.pose();
    // Half of its speed in two samples.
    const bool jolt = blow_at && mapper.blind >= *blow_at && jolted < 2;
    jolted += jolt ? 1 : 0;
    if (!inputs.odometry.empty()) v = inputs.odometry.back().v;
    inputs.accelerations = {{inputs.now, jolt ? std::min(-3.2, -0.5 * v / 0.04) : 0.0}};
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    for (; told < explorer.decisions().size(); ++told)
      if (explorer.decisions()[told].why.find("looks back") != std::string::npos) looks.push_back(mapper.blind);
  }
  EXPECT_TRUE(explorer.finished());
  return looks;
}

TEST(Doubt, BetweenBareWallsTheRobotLooksBackSoonAfterABlow) {
  const std::vector<double> calm = looks_back(true, {}), jolted = looks_back(true, 1.5);
  ASSERT_FALSE(calm.empty());
  EXPECT_NEAR(calm.front(), 5.0, 0.1);
  ASSERT_FALSE(jolted.empty());
  EXPECT_NEAR(jolted.front(), 2.5, 0.1);
  EXPECT_TRUE(looks_back(false, 1.5).empty()) << "scans tell how far it came";
}

/// How often it looks back on its way home through a bare corridor, when so much of its time is left then [s].
int looks_on_the_way_home(double left) {
  constexpr double kLimit = 400.0;
  const BareCorridor corridor;
  test::MazeRobot robot(corridor.maze, corridor.model);
  slam::PaperMapper paper(corridor.model, test::exact_mapper(), 1);
  Doubtful mapper(paper);
  PaperExplorerConfig config;
  config.search.on = false;
  PaperExplorer explorer(corridor.model, config, {kLimit});
  robot::Commands commands;
  TPose2D last = robot.pose();
  bool goes_home = false;
  int looks = 0;
  std::size_t told = 0;
  while (robot.now().seconds() < kLimit && !explorer.finished()) {
    const robot::Inputs inputs = robot.step(commands);
    mapper.blind += distance(position(last), position(robot.pose()));
    last = robot.pose();
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
    for (; told < explorer.decisions().size(); ++told) {
      const std::string& why = explorer.decisions()[told].why;
      looks += goes_home && why.find("looks back") != std::string::npos ? 1 : 0;
      if (goes_home || why.find("drives to home") == std::string::npos) continue;
      goes_home = true;
      mapper.blind = 4.0;
      robot.wait(kLimit - left - robot.now().seconds());
    }
  }
  EXPECT_TRUE(goes_home);
  return looks;
}

TEST(Doubt, WithNoTimeForItTheRobotDoesNotLookBackOnItsWayHome) {
  EXPECT_GT(looks_on_the_way_home(200.0), 0);
  EXPECT_EQ(looks_on_the_way_home(15.0), 0);
}

/// A mission in a bare corridor in which the robot is held, softly, after 2.3 m, while its wheels roll on and the pose
/// with them. `feels`: its accelerometer feels it brake.
struct Held {
  double rolled = 0.0;       ///< by its wheels in vain until it knew [m]
  bool knew = false;         ///< ... that it stands
  bool looked_back = false;  ///< soon after that
};

Held held_softly(bool feels) {
  BareCorridor corridor;
  auto& [maze, model, robot, paper, mapper, explorer] = corridor;
  robot::Commands commands;
  Held held;
  std::size_t told = 0;
  double last_v = 0.0;
  Stamp soft_until = Stamp::never();
  std::optional<Stamp> knew_at;
  while (robot.now().seconds() < 60.0 && !explorer.finished()) {
    const TPose2D before = robot.pose();
    robot::Inputs inputs = robot.step(commands);
    const double v = before.inverseComposePoint(position(robot.pose())).x / model.tick;
    const double wheels = !robot.held || commands.brake ? 0.0 : commands.drive.v;
    const bool soft = soft_until != Stamp::never() && inputs.now < soft_until;
    inputs.accelerations = {{inputs.now, feels && !soft ? (v - last_v) / model.tick : 0.0}};
    last_v = v;
    paper.update(inputs);
    mapper.blind += (std::abs(v) + std::abs(wheels)) * model.tick;
    mapper.ahead += wheels * model.tick;
    if (!held.knew) held.rolled += std::abs(wheels) * model.tick;
    if (robot.held && !inputs.odometry.empty()) {
      inputs.odometry.back().v = wheels;
      inputs.odometry.back().pose = inputs.odometry.back().pose + TPose2D(mapper.ahead, 0.0, 0.0);
    }
    if (!robot.held && !held.knew && mapper.blind > 2.3) {
      robot.held = true;
      soft_until = inputs.now + 0.5;
    }
    commands = explorer.next(mapper, inputs);
    for (; told < explorer.decisions().size(); ++told) {
      const std::string& why = explorer.decisions()[told].why;
      if (why.find("braking it felt that it stands") != std::string::npos && !held.knew) {
        held.knew = true;
        knew_at = inputs.now;
        robot.held = false;
      }
      if (knew_at && why.find("looks back") != std::string::npos && inputs.now - *knew_at < 10.0)
        held.looked_back = true;
    }
  }
  return held;
}

TEST(Doubt, BetweenBareWallsARobotThatIsHeldSoftlyLearnsItFromItsBrake) {
  const Held held = held_softly(true);
  EXPECT_TRUE(held.knew);
  EXPECT_LT(held.rolled, 1.2);
  EXPECT_TRUE(held.looked_back);
}

/// A base that cannot stop at once feels nothing of it either.
TEST(Doubt, ABrakeThatNeverToldOfAMotionIsNotBelieved) { EXPECT_FALSE(held_softly(false).knew); }

}  // namespace
}  // namespace rubble::explore
