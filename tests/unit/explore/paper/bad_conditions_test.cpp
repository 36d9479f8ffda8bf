// What can go wrong on a mission: each has a sensible end, none moves the robot blindly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using test::exact_mapper;
using test::Maze;
using test::MazeRobot;

/// A mission whose robot and measurements a test may spoil.
struct Trial {
  explicit Trial(const Maze& maze, double time_limit = 0.0, const PaperExplorerConfig& config = {})
      : robot(maze, model), mapper(model, exact_mapper(), 1), explorer(model, config, {time_limit}) {}

  /// Until it finishes or `seconds` have passed. `before`: what happens to the world; `after`: to what was measured.
  void run(double seconds, const std::function<void()>& before = {},
           const std::function<void(robot::Inputs&)>& after = {}) {
    while (robot.now().seconds() < seconds && !explorer.finished()) {
      if (before) before();
      robot::Inputs inputs = robot.step(commands);
      if (after) after(inputs);
      mapper.update(inputs);
      commands = explorer.next(mapper, inputs);
      touches += robot.touches() ? 1 : 0;
      if (explorer.state() == ExplorerState::BackingUp) ++backing;
    }
  }

  const robot::RobotModel model;
  MazeRobot robot;
  slam::PaperMapper mapper;
  PaperExplorer explorer;
  robot::Commands commands;
  int touches = 0;
  int backing = 0;
};

bool is_seen(const Trial& trial, const TPoint2D& p_arena) {
  const slam::CountMap& map = trial.mapper.map();
  const Cell c = map.frame().cell(trial.robot.maze().start.inverseComposePoint(p_arena));
  return map.frame().inside(c) && map.seen(c) > 0;
}

TEST(BadConditions, AStartNearerToAWallThanItShouldBeIsLeftAndTheRestSeen) {
  Maze maze = test::maze({"+--+--+--+",  //
                          "| R      |",  //
                          "+  +  +  +",  //
                          "|        |",  //
                          "+--+--+--+"});
  maze.start.y += 0.23;  // 0.37 m from the north wall
  Trial trial(maze);
  ASSERT_LT(trial.robot.clearance(), PlannerConfig().transform.d_min);
  trial.run(600.0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home);
  EXPECT_EQ(trial.touches, 0);
  EXPECT_TRUE(is_seen(trial, maze.centre(2, 0)));
}

TEST(BadConditions, ABaseThatIsSilentForAMomentHasMetNoObstacle) {
  const Maze maze = test::maze({"+--+--+--+--+--+",  //
                                "| R            |",  //
                                "+--+--+--+--+--+"});
  Trial trial(maze);
  double silent = 0.0;
  trial.run(600.0, {}, [&](robot::Inputs& inputs) {
    const bool drives = trial.commands.drive.v > 0.3 && trial.robot.now().seconds() > 5.0;
    if ((silent == 0.0 && !drives) || silent > 1.2) return;
    silent += trial.model.tick;
    inputs.odometry.clear();
  });
  EXPECT_GT(silent, 1.2);
  EXPECT_EQ(trial.backing, 0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home);
}

TEST(BadConditions, WithoutFreeFloorAroundItTheRobotEndsWhereItStands) {
  Maze maze = test::maze({"+--+",  //
                          "| R|",  //
                          "+--+"});
  maze.box({maze.start.x, maze.start.y}, 0.70, 0.70);  // room for the body, none to turn or drive
  Trial trial(maze);
  trial.run(300.0);
  EXPECT_TRUE(trial.explorer.finished());
  EXPECT_FALSE(trial.explorer.reason().empty());
  EXPECT_LT(std::hypot(trial.robot.pose().x - maze.start.x, trial.robot.pose().y - maze.start.y), 0.15);
}

/// Nothing but a wall behind the robot: what the scanner reaches of the plain is free, and its edge moves on.
TEST(BadConditions, AFrontierThatMovesAwayForEverIsLeftInTimeForTheWayHome) {
  Maze maze;
  maze.columns = maze.rows = 1;
  maze.walls.push_back({{-0.6, -40.0}, {-0.6, 40.0}});
  for (double y = -40.0; y < 40.0; y += 2.4) maze.walls.push_back({{40.0, y}, {40.0, y + 2.0}});
  for (double x = 0.0; x < 40.0; x += 2.0) {  // posts that the scanner can hold on to
    maze.box({x + 1.0, 1.4}, 0.1, 0.1);
    maze.box({x + 1.0, -1.4}, 0.1, 0.1);
  }
  Trial trial(maze, 120.0);
  trial.run(130.0);
  EXPECT_TRUE(trial.explorer.finished());
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  EXPECT_LE(trial.robot.now().seconds(), 120.0);
}

TEST(BadConditions, ADoorNarrowerThanTheRobotIsNotForced) {
  Maze maze = test::maze({"+--+--+--+",  //
                          "| R   |  |",  //
                          "+  +  +  +",  //
                          "|     |  |",  //
                          "+--+--+--+"});
  // The upper wall of the two is cut down to leave a gap of 0.4 m in its middle.
  const double x = 1.5 * Maze::kPallet, y = 1.0 * Maze::kPallet;
  maze.walls.erase(std::remove_if(maze.walls.begin(), maze.walls.end(),
                                  [&](const test::Segment& s) {
                                    return s.a.x == x && s.b.x == x &&
                                           std::min(s.a.y, s.b.y) > 0.5 * Maze::kPallet - 0.01;
                                  }),
                   maze.walls.end());
  maze.walls.push_back({{x, y - 0.6}, {x, y - 0.2}});
  maze.walls.push_back({{x, y + 0.2}, {x, y + 0.6}});
  Trial trial(maze);
  trial.run(900.0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  EXPECT_EQ(trial.touches, 0);
  EXPECT_TRUE(is_seen(trial, {x + 0.6, y})) << "it can be looked through";
}

TEST(BadConditions, AWallThatAppearsOnThePathIsNotTouched) {
  const Maze maze = test::maze({"+--+--+--+--+",  //
                                "| R         |",  //
                                "+  +--+--+  +",  //
                                "|           |",  //
                                "+--+--+--+--+"});
  Trial trial(maze);
  bool built = false;
  trial.run(600.0, [&] {
    const TPose2D& pose = trial.robot.pose();
    if (built || trial.commands.drive.v < 0.3 || pose.x < 0.6 || std::abs(pose.phi) > 0.3) return;
    built = true;  // right across the corridor, 0.9 m ahead of the middle of a robot at full speed
    trial.robot.maze().walls.push_back({{pose.x + 0.9, 0.6}, {pose.x + 0.9, 1.8}});
  });
  EXPECT_TRUE(built);
  EXPECT_EQ(trial.touches, 0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// Balls of crumpled paper, which the robot pushes along a corridor of one row: too large to pass beside.
struct Balls {
  static constexpr double kRadius = 0.12;
  std::vector<TPoint2D> centres;
  double y = 0.0;         ///< middle of the corridor
  std::size_t walls = 0;  ///< of the maze without them
  bool pushed = false;

  Balls(Maze& maze, std::vector<TPoint2D> at) : centres(std::move(at)), y(maze.start.y), walls(maze.walls.size()) {
    place(maze);
  }
  void place(Maze& maze) const {
    maze.walls.resize(walls);
    for (const TPoint2D& ball : centres) maze.box(ball, 2.0 * kRadius, 2.0 * kRadius);
  }
  /// Moves those that the robot's body has reached.
  void meet(Trial& trial) {
    const TPose2D& pose = trial.robot.pose();
    const double least = 0.5 * trial.model.length + kRadius;
    const double limit = 0.5 * Maze::kPallet - kRadius - 0.01;
    for (TPoint2D& ball : centres) {
      const double way = std::hypot(ball.x - pose.x, ball.y - pose.y);
      if (way >= least) continue;
      pushed = true;
      ball.x = pose.x + (ball.x - pose.x) * least / way;
      ball.y = std::clamp(pose.y + (ball.y - pose.y) * least / way, y - limit, y + limit);
      place(trial.robot.maze());
    }
  }
};

/// Two rooms and a door as wide as a pallet between them: two pieces of wall with a gap.
Maze two_rooms() {
  return test::maze({"+--+--+--+--+",  //
                     "|     |     |",  //
                     "+  +  +  +  +",  //
                     "| R         |",  //
                     "+  +  +  +  +",  //
                     "|     |     |",  //
                     "+--+--+--+--+"});
}

/// With something in the only door: the robot is home in the end, and was in the other room and saw all of it.
void expect_door_pushed_open(const std::vector<TPoint2D>& balls_from_middle) {
  const Maze maze = two_rooms();
  const TPoint2D door{1.5 * Maze::kPallet, maze.start.y};
  std::vector<TPoint2D> at;
  for (const TPoint2D& ball : balls_from_middle) at.push_back(door + ball);
  Maze blocked = maze;
  Balls balls(blocked, at);
  Trial trial(blocked);
  double farthest = maze.start.x;
  trial.run(900.0, [&] {
    balls.meet(trial);
    farthest = std::max(farthest, trial.robot.pose().x);
  });
  EXPECT_TRUE(balls.pushed);
  EXPECT_GT(farthest, door.x + trial.model.length) << "not through the door";
  for (int row = 0; row < maze.rows; ++row)
    for (int column = 0; column < maze.columns; ++column)
      EXPECT_TRUE(is_seen(trial, maze.centre(column, row))) << column << ", " << row;
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  EXPECT_LT(std::hypot(trial.robot.pose().x - maze.start.x, trial.robot.pose().y - maze.start.y), 0.35);
}

TEST(BadConditions, ABallInTheOnlyDoorIsPushedAside) { expect_door_pushed_open({{0.0, 0.03}}); }

/// Three balls abreast, so close that they look like one thing of 0.7 m, which a single ball is not.
TEST(BadConditions, AHeapInTheOnlyDoorIsPushedAside) {
  expect_door_pushed_open({{0.0, -0.24}, {0.05, 0.0}, {0.0, 0.24}});
}

TEST(BadConditions, ABallInACorridorIsPushedAside) {
  Maze maze = test::maze({"+--+--+--+--+",  //
                          "| R         |",  //
                          "+--+--+--+--+"});
  Balls balls(maze, {{1.5 * Maze::kPallet, maze.start.y + 0.03}});
  Trial trial(maze);
  trial.run(900.0, [&] { balls.meet(trial); });
  EXPECT_TRUE(balls.pushed);
  EXPECT_TRUE(is_seen(trial, maze.centre(3, 0)));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// Three balls abreast, as in the door.
TEST(BadConditions, AHeapInACorridorIsPushedAside) {
  Maze maze = test::maze({"+--+--+--+--+--+",  //
                          "| R            |",  //
                          "+--+--+--+--+--+"});
  const double x = 1.5 * Maze::kPallet, y = maze.start.y;
  Balls balls(maze, {{x, y - 0.24}, {x + 0.05, y}, {x, y + 0.24}});
  Trial trial(maze);
  trial.run(900.0, [&] { balls.meet(trial); });
  EXPECT_TRUE(balls.pushed);
  EXPECT_TRUE(is_seen(trial, maze.centre(4, 0)));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// Something rolled into the way by which the robot came: what lies behind it is searched all the same.
TEST(BadConditions, WhatABallCutsOffIsSearchedToo) {
  Maze maze = test::maze({"+--+--+--+--+--+--+",  //
                          "|       R         |",  //
                          "+--+--+--+--+--+--+"});
  const TPoint2D way_back{1.5 * Maze::kPallet, maze.start.y + 0.03};
  Balls balls(maze, {});
  Trial trial(maze);
  bool rolled = false;
  double farthest_back = maze.start.x;  // after that
  trial.run(900.0, [&] {
    const TPose2D& pose = trial.robot.pose();
    if (!rolled && pose.x > maze.start.x + 0.3) {
      rolled = true;
      balls.centres = {way_back};
      balls.place(trial.robot.maze());
    }
    balls.meet(trial);
    if (rolled) farthest_back = std::min(farthest_back, pose.x);
  });
  EXPECT_TRUE(rolled);
  EXPECT_TRUE(balls.pushed);
  EXPECT_LT(farthest_back, 1.4 - 0.5 * Maze::kPallet + 0.2) << "its end was not looked at from 1.4 m";
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// Decisions of a mission in a maze whose scanner gets no answer from what lies east of `pallets`.
std::vector<Decision> decisions_beside_dark_walls(double pallets) {
  const Maze maze = test::maze({"+--+--+--+--+--+--+",  //
                                "|                 |",  //
                                "+  +--+--+--+  +--+",  //
                                "|       R         |",  //
                                "+--+--+--+--+--+--+"});
  const double dark_from = pallets * Maze::kPallet;
  Trial trial(maze);
  trial.run(1800.0, {}, [&](robot::Inputs& inputs) {
    const TPose2D T_arena_laser = trial.robot.pose() + TPose2D(trial.model.T_base_laser.x, 0.0, 0.0);
    for (robot::LaserScan& scan : inputs.scans)
      for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        const double x = T_arena_laser.x + scan.ranges[i] * std::cos(T_arena_laser.phi + scan.bearing(i));
        if (x > dark_from) scan.ranges[i] = std::numeric_limits<float>::infinity();
      }
  });
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  return trial.explorer.decisions();
}

std::vector<Decision>::const_iterator next_decision(const std::vector<Decision>& decisions,
                                                    std::vector<Decision>::const_iterator from,
                                                    const std::string& what) {
  return std::find_if(from, decisions.end(), [&](const Decision& d) { return d.why.find(what) != std::string::npos; });
}

/// What could not be seen may show itself later: it is tried again once the niches are searched, and before all other
/// faces are.
TEST(BadConditions, WhatWasLeftAloneIsTriedAgainBeforeTheRestIsSearched) {
  const std::vector<Decision> decisions = decisions_beside_dark_walls(4.3);
  const auto left = next_decision(decisions, decisions.begin(), "left alone");
  ASSERT_NE(left, decisions.end());
  const auto again = next_decision(decisions, left, "tried again before the rest is searched");
  ASSERT_NE(again, decisions.end());
  EXPECT_NE(next_decision(decisions, again, "drives to the frontier"), decisions.end());
  EXPECT_LT(next_decision(decisions, again, "a place to search from"), next_decision(decisions, again, "round 2"));
  EXPECT_LT(again, next_decision(decisions, left, "round 2"));
}

/// With no prospect of it when the niches are done, as beside walls that are dark from a little farther on, it waits
/// for the next round.
TEST(BadConditions, WhatWasLeftAloneIsTriedAgainInTheNextRoundAtTheLatest) {
  for (const double pallets : {4.45, 4.5, 4.55, 4.6, 4.65, 4.7}) {
    SCOPED_TRACE(pallets);
    const std::vector<Decision> decisions = decisions_beside_dark_walls(pallets);
    const auto left = next_decision(decisions, decisions.begin(), "left alone");
    ASSERT_NE(left, decisions.end());
    const auto again = std::min(next_decision(decisions, left, "tried again before the rest is searched"),
                                next_decision(decisions, left, "round 2"));
    EXPECT_NE(next_decision(decisions, again, "drives to the frontier"), decisions.end());
  }
}

/// Something holds the robot in a corridor again and again, and is no longer there when all else was tried: what was
/// felt for certain is forgotten for the sake of the ground behind it.
TEST(BadConditions, WhatWasFeltForCertainIsTriedOnceMoreBeforeTheEnd) {
  Maze maze = test::maze({"+--+--+--+--+--+--+",  //
                          "|    R            |",  //
                          "+--+--+--+--+--+  +",  //
                          "|                 |",  //
                          "+--+--+--+--+--+--+"});
  Trial trial(maze);
  const auto told = [&](const std::string& what) {
    const std::vector<Decision>& decisions = trial.explorer.decisions();
    return std::any_of(decisions.begin(), decisions.end(),
                       [&](const Decision& d) { return d.why.find(what) != std::string::npos; });
  };
  double farthest = 0.0;
  trial.run(1800.0, [&] {
    const TPose2D& pose = trial.robot.pose();
    farthest = std::max(farthest, pose.x);
    const bool into_it = std::cos(pose.phi) * trial.commands.drive.v > 0.0;
    trial.robot.held = pose.x > maze.start.x + 1.5 && into_it && !told("all that was felt is forgotten");
  });
  EXPECT_GT(trial.backing, 0);
  EXPECT_TRUE(told("all that was felt is forgotten"));
  EXPECT_GT(farthest, maze.start.x + 2.0);
  EXPECT_TRUE(is_seen(trial, maze.centre(3, 1)));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

TEST(BadConditions, WithoutScansForTwoSecondsTheRobotStandsAndThenGoesOn) {
  const Maze maze = test::random_maze(5, 5, 0.2, 7);
  Trial trial(maze);
  Stamp silent_from = Stamp::never();
  int silences = 0;
  double moved_blindly = 0.0;
  TPose2D last = trial.robot.pose();
  trial.run(900.0, [&] {
    const Stamp now = trial.robot.now();
    const bool silent = silent_from != Stamp::never() && now - silent_from < 2.0;
    if (!silent && trial.commands.drive.v > 0.3 && (silences == 0 || now - silent_from > 20.0) && silences < 5) {
      silent_from = now;
      ++silences;
    }
    trial.robot.scanner_works = !(silent_from != Stamp::never() && now - silent_from < 2.0);
    if (!trial.robot.scanner_works && now - silent_from > 1.9)  // it has come to rest by then
      moved_blindly += std::hypot(trial.robot.pose().x - last.x, trial.robot.pose().y - last.y);
    last = trial.robot.pose();
  });
  EXPECT_EQ(silences, 5);
  EXPECT_LT(moved_blindly, 0.01);
  EXPECT_EQ(trial.touches, 0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// The wheels' counters stop, so the mapper takes the robot for standing: it may not go on pushing. Each drive ends
/// after some decimetres, ahead or back, and the way out of each hold it finds comes to an end as well.
TEST(BadConditions, FrozenOdometryIsTakenForBeingStuck) {
  const Maze maze = test::random_maze(5, 5, 0.2, 9);
  Trial trial(maze);
  std::vector<robot::Odometry> frozen;
  double way_since = 0.0;
  double in_one_go = 0.0, longest = 0.0;  // without a stop or a change between ahead and back
  double last_v = 0.0;
  trial.run(400.0, {}, [&](robot::Inputs& inputs) {
    if (inputs.now.seconds() > 30.0 && !inputs.odometry.empty()) {
      if (frozen.empty()) frozen.push_back(inputs.odometry.back());
      inputs.odometry.back().pose = frozen.back().pose;
    }
    if (frozen.empty()) return;
    const double v = trial.commands.drive.v;
    const double way = std::abs(v) * trial.model.tick;
    way_since += way;
    in_one_go = v * last_v > 0.0 ? in_one_go + way : way;
    longest = std::max(longest, in_one_go);
    last_v = v;
  });
  EXPECT_GT(longest, 0.1);
  EXPECT_LT(longest, 0.45);
  EXPECT_LT(way_since, 45.0) << "of ten holds";
  EXPECT_GT(trial.backing, 0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Stuck) << trial.explorer.reason();
  EXPECT_LT(trial.robot.now().seconds(), 400.0);
}

/// On the base's ramp the wheels would turn on for a second, against what holds the robot.
TEST(BadConditions, WhatHoldsTheRobotIsNotPushedOnARamp) {
  Trial trial(test::random_maze(5, 5, 0.2, 11));
  Stamp held_from = Stamp::never();
  int brakes = 0;
  trial.run(60.0, [&] {
    if (held_from == Stamp::never() && trial.commands.drive.v > 0.35) held_from = trial.robot.now();
    trial.robot.held = held_from != Stamp::never() && trial.backing == 0;
    if (trial.commands.brake) {
      EXPECT_EQ(trial.commands.drive.v, 0.0);
      EXPECT_EQ(trial.commands.drive.w, 0.0);
      if (++brakes == 1) {
        EXPECT_EQ(trial.backing, 1);
      }
    }
  });
  EXPECT_GE(brakes, 1);
  EXPECT_GT(trial.backing, 1);
}

bool told(const Trial& trial, const std::string& what) {
  const std::vector<Decision>& decisions = trial.explorer.decisions();
  return std::any_of(decisions.begin(), decisions.end(),
                     [&](const Decision& d) { return d.why.find(what) != std::string::npos; });
}

/// With the angles of a levelling unit that falls silent at `from` [s].
void run_with_unit(Trial& trial, double from) {
  trial.run(900.0, {}, [&](robot::Inputs& inputs) {
    if (inputs.now.seconds() < from) inputs.aims.push_back({inputs.now, 0.0, 0.0});
  });
}

TEST(BadConditions, ALevellingUnitThatFallsSilentSendsItHome) {
  const Maze maze = test::random_maze(5, 5, 0.2, 7);
  Trial trial(maze);
  run_with_unit(trial, 30.0);
  EXPECT_TRUE(told(trial, "the levelling unit is silent"));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  EXPECT_NE(trial.explorer.reason().find("not levelled"), std::string::npos);
  EXPECT_LT(std::hypot(trial.robot.pose().x - maze.start.x, trial.robot.pose().y - maze.start.y), 0.35);
  EXPECT_LT(trial.robot.now().seconds(), 120.0);
}

TEST(BadConditions, ALevellingUnitThatIsBackSoonIsWaitedFor) {
  Trial trial(test::random_maze(5, 5, 0.2, 7));
  double moved = 0.0;
  TPose2D last = trial.robot.pose();
  trial.run(900.0, {}, [&](robot::Inputs& inputs) {
    const double now = inputs.now.seconds();
    if (now < 30.0 || now > 34.0) inputs.aims.push_back({inputs.now, 0.0, 0.0});
    if (now > 33.0 && now < 34.0)  // it has come to rest by then
      moved += std::hypot(trial.robot.pose().x - last.x, trial.robot.pose().y - last.y);
    last = trial.robot.pose();
  });
  EXPECT_LT(moved, 0.01);
  EXPECT_TRUE(told(trial, "the levelling unit talks again"));
  EXPECT_TRUE(told(trial, "all visible floor searched"));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

/// With a battery that has `volts` from `from` to `until` [s], and 12.5 V otherwise.
void run_with_battery(Trial& trial, double volts, double from, double until, double low = 11.5) {
  trial.run(900.0, {}, [&](robot::Inputs& inputs) {
    const double now = inputs.now.seconds();
    inputs.battery = {now >= from && now < until ? volts : 12.5, low};
  });
}

TEST(BadConditions, ABatteryThatStaysLowSendsItHome) {
  const Maze maze = test::random_maze(5, 5, 0.2, 7);
  Trial trial(maze);
  run_with_battery(trial, 11.4, 30.0, 1000.0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
  EXPECT_NE(trial.explorer.reason().find("the battery is low"), std::string::npos);
  EXPECT_LT(std::hypot(trial.robot.pose().x - maze.start.x, trial.robot.pose().y - maze.start.y), 0.35);
  EXPECT_LT(trial.robot.now().seconds(), 120.0);
}

/// Its motors stand, and escapes do not help.
TEST(BadConditions, WithAnEmptyBatteryTheMissionEndsWhereTheRobotStands) {
  Trial trial(test::random_maze(5, 5, 0.2, 7));
  trial.run(900.0, {}, [&](robot::Inputs& inputs) {
    const double now = inputs.now.seconds();
    inputs.battery = {now < 20.0 ? 12.5 : now < 32.0 ? 11.4 : 10.5, 11.5};
    trial.robot.held = now >= 32.0;
  });
  EXPECT_TRUE(told(trial, "the battery is low"));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Stuck) << trial.explorer.reason();
  EXPECT_NE(trial.explorer.reason().find("the battery is empty"), std::string::npos) << trial.explorer.reason();
  EXPECT_LT(trial.robot.now().seconds(), 75.0);
}

TEST(BadConditions, WhereNobodySaysWhenABatteryIsLowNoneIs) {
  Trial trial(test::random_maze(4, 4, 0.2, 7));
  run_with_battery(trial, 8.4, 0.0, 1000.0, 0.0);
  EXPECT_FALSE(told(trial, "the battery is low"));
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Home) << trial.explorer.reason();
}

TEST(BadConditions, ABatteryThatMotorsPullDownForAMomentIsNotLow) {
  Trial trial(test::random_maze(5, 5, 0.2, 7));
  run_with_battery(trial, 11.0, 30.0, 38.0);
  EXPECT_FALSE(told(trial, "the battery is low"));
  EXPECT_TRUE(told(trial, "all visible floor searched"));
}

TEST(BadConditions, WithoutAReturnHomeAFailedLevellingUnitIsTheEnd) {
  PaperExplorerConfig config;
  config.return_home = false;
  Trial trial(test::random_maze(5, 5, 0.2, 7), 0.0, config);
  run_with_unit(trial, 30.0);
  EXPECT_EQ(trial.explorer.end(), MissionEnd::Explored);
  EXPECT_EQ(trial.explorer.reason(), "the laser is not levelled");
  EXPECT_LT(trial.robot.now().seconds(), 40.0);
}

/// Its map bends with the way, and is straight at once when a loop closes: all of the past moves, the half that lies
/// far from the start by most.
class ClosingMapper : public slam::Mapper {
 public:
  /// Heading is lost by `drift` [rad/m].
  ClosingMapper(const robot::RobotModel& model, double drift)
      : bent_(model, exact_mapper(), 1), exact_(model, exact_mapper(), 1), drift_(drift) {}

  void close() { closed_ = true; }

  void update(const robot::Inputs& inputs) override {
    exact_.update(inputs);
    robot::Inputs told = inputs;
    for (robot::Odometry& odometry : told.odometry) {
      const TPose2D step = odometry.pose - last_;
      last_ = odometry.pose;
      last_bent_ = last_bent_ + TPose2D(step.x, step.y, step.phi + drift_ * std::hypot(step.x, step.y));
      odometry.pose = last_bent_;
    }
    bent_.update(told);
  }
  const slam::CountMap& map() const override { return now().map(); }
  TPose2D pose() const override { return now().pose(); }
  PoseCovariance covariance() const override { return {}; }
  std::uint64_t revision() const override { return closed_ ? 1 : 0; }
  std::optional<TPose2D> pose_at(Stamp stamp) const override { return now().pose_at(stamp); }
  const Trajectory& trajectory() const override { return now().trajectory(); }
  const Trajectory& live_trajectory() const override { return now().live_trajectory(); }
  const std::vector<TPoint2D>& last_hits() const override { return now().last_hits(); }
  const slam::MapperCounts& counts() const override { return now().counts(); }

 private:
  const slam::PaperMapper& now() const { return closed_ ? exact_ : bent_; }

  slam::PaperMapper bent_, exact_;
  bool closed_ = false;
  double drift_;
  TPose2D last_, last_bent_;  ///< odometry as it was, and as the bent map has it
};

/// The map of an exact mapper, turned about the start when the test asks for it.
class TurnedMapper : public slam::Mapper {
 public:
  explicit TurnedMapper(const robot::RobotModel& model) : exact_(model, exact_mapper(), 1) {}

  void turn(double angle) {
    T_turned_ = TPose2D(0.0, 0.0, angle);
    ++revision_;
  }

  void update(const robot::Inputs& inputs) override { exact_.update(inputs); }
  const slam::CountMap& map() const override { return exact_.map(); }
  TPose2D pose() const override { return T_turned_ + exact_.pose(); }
  PoseCovariance covariance() const override { return {}; }
  std::uint64_t revision() const override { return revision_; }
  std::optional<TPose2D> pose_at(Stamp stamp) const override {
    const auto pose = exact_.pose_at(stamp);
    return pose ? std::optional(T_turned_ + *pose) : std::nullopt;
  }
  const Trajectory& trajectory() const override { return exact_.trajectory(); }
  const Trajectory& live_trajectory() const override { return exact_.live_trajectory(); }
  const std::vector<TPoint2D>& last_hits() const override { return exact_.last_hits(); }
  const slam::MapperCounts& counts() const override { return exact_.counts(); }

 private:
  slam::PaperMapper exact_;
  TPose2D T_turned_;
  std::uint64_t revision_ = 0;
};

/// A loop that closes while it looks around turns the map, not the robot: it turns on for what it has to see.
TEST(BadConditions, AMapThatTurnsWhileItLooksAroundIsNoTurnOfTheRobot) {
  for (const double correction : {0.0, 1.0, -1.0}) {
    const robot::RobotModel model;
    MazeRobot robot(test::random_maze(5, 5, 0.3, 1), model);
    TurnedMapper mapper(model);
    PaperExplorer explorer(model, {}, {1500.0});
    robot::Commands commands;
    double turned = 0.0;  // [rad]
    bool begun = false, corrected = false;
    while (robot.now().seconds() < 30.0) {
      const TPose2D before = robot.pose();
      const robot::Inputs inputs = robot.step(commands);
      turned += std::abs(wrap_angle(robot.pose().phi - before.phi));
      if (!corrected && turned > 0.5) {
        mapper.turn(correction);
        corrected = true;
      }
      mapper.update(inputs);
      commands = explorer.next(mapper, inputs);
      const bool turns = commands.drive.w != 0.0 && commands.drive.v == 0.0;
      if (begun && !turns) break;
      begun = begun || turns;
    }
    EXPECT_TRUE(corrected);
    EXPECT_NEAR(rad_to_deg(turned), 130.0, 10.0) << correction;
  }
}

/// A loop closes while it drives: everything it keeps moves with the map, so it touches nothing, sees all, finds home,
/// and the victim lies where it was.
TEST(BadConditions, AMapThatJumpsWhileItDrivesTakesAllThatIsKeptWithIt) {
  double largest_jump = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Maze maze = test::random_maze(5, 5, 0.3, seed);
    const robot::RobotModel model;
    MazeRobot robot(maze, model);
    ClosingMapper mapper(model, 0.015);
    PaperExplorer explorer(model, {}, {1500.0});
    robot::Commands commands;
    std::optional<TPoint2D> victim;  // in the maze
    int touches = 0;
    while (robot.now().seconds() < 1500.0 && !explorer.finished()) {
      robot::Inputs inputs = robot.step(commands);
      const TPose2D pose = robot.pose();
      const bool drives = commands.drive.v > 0.3;
      if (!victim && drives && robot.now().seconds() > 60.0) victim = pose.composePoint({0.6, 0.0});
      if (victim && std::fmod(robot.now().seconds(), 0.5) < model.tick) {
        const TPoint2D seen = pose.inverseComposePoint(*victim);
        if (seen.x > 2.0 * std::abs(seen.y) && seen.norm() < 1.0)
          inputs.cues.push_back(
              {inputs.now, robot::CueKind::Heat, std::atan2(seen.y, seen.x), std::hypot(seen.x, seen.y), 0.9});
      }
      mapper.update(inputs);
      if (mapper.revision() == 0 && drives && robot.now().seconds() > 80.0) {
        const TPose2D before = mapper.pose();
        mapper.close();
        largest_jump = std::max(largest_jump, std::hypot(mapper.pose().x - before.x, mapper.pose().y - before.y));
        ASSERT_EQ(explorer.victims().size(), 1u) << "found before the map jumps";
      }
      commands = explorer.next(mapper, inputs);
      touches += robot.touches() ? 1 : 0;
    }
    EXPECT_EQ(mapper.revision(), 1u);
    EXPECT_EQ(explorer.end(), MissionEnd::Home) << explorer.reason();
    EXPECT_LT(std::hypot(robot.pose().x - maze.start.x, robot.pose().y - maze.start.y), 0.35);
    EXPECT_EQ(touches, 0);
    for (int row = 0; row < maze.rows; ++row)
      for (int column = 0; column < maze.columns; ++column) {
        const Cell c = mapper.map().frame().cell(maze.start.inverseComposePoint(maze.centre(column, row)));
        EXPECT_TRUE(mapper.map().frame().inside(c) && mapper.map().seen(c) > 0) << column << ", " << row;
      }
    ASSERT_EQ(explorer.victims().size(), 1u);
    const TPoint2D found = maze.start.composePoint(explorer.victims()[0].p_map);
    EXPECT_LT(std::hypot(found.x - victim->x, found.y - victim->y), 0.1);
  }
  EXPECT_GT(largest_jump, 0.3);
}

}  // namespace
}  // namespace rubble::explore
