// Missions with victims that no camera finds: they are heard or smelt only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/planar.h"
#include "base/rng.h"
#include "explore/paper/paper_explorer.h"
#include "slam/paper/paper_mapper.h"
#include "tests/support/explore_world.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;

bool cuts(const test::Segment& wall, const TPoint2D& a, const TPoint2D& b) {
  const auto side = [](const TPoint2D& p, const TPoint2D& q, const TPoint2D& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0.0;
  };
  return side(wall.a, wall.b, a) != side(wall.a, wall.b, b) && side(a, b, wall.a) != side(a, b, wall.b);
}

/// Microphones and a probe, two looks a second, with the errors that docs/simulator.md gives them.
struct FaintSenses {
  const test::Maze& maze;
  std::vector<TPoint2D> victims;
  CueKind kind;
  Rng rng;
  int ticks = 0;

  void sense(const TPose2D& pose, robot::Inputs& inputs) {
    if (++ticks % 25 != 0) return;
    const bool sound = kind == CueKind::Sound;
    for (const TPoint2D& victim : victims) {
      const TPoint2D at = pose.inverseComposePoint(victim);
      const double far = std::hypot(at.x, at.y), bearing = std::atan2(at.y, at.x);
      const double missed = rng.uniform(), turn = rng.gaussian(), stretch = rng.gaussian();
      const bool open = std::none_of(maze.walls.begin(), maze.walls.end(),
                                     [&](const test::Segment& wall) { return cuts(wall, position(pose), victim); });
      if (sound ? far > (open ? 3.0 : 1.5) || missed < 0.3 : far > 0.9 || !open || at.x < 0.0 || missed < 0.2) continue;
      inputs.cues.push_back({inputs.now, kind, bearing + turn * deg_to_rad(sound ? 15.0 : 30.0),
                             std::max(0.0, far * (1.0 + stretch * (sound ? 0.4 : 0.3))), sound ? 0.24 : 0.4});
    }
    const double alarm = rng.uniform(), bearing = rng.uniform(-0.5 * kPi, 0.5 * kPi), far = rng.uniform(0.3, 0.9);
    if (alarm < (sound ? 0.005 : 0.002))
      inputs.cues.push_back({inputs.now, kind, bearing, sound ? 3.0 * far : far, 0.1});
  }
};

struct FaintOutcome {
  int found = 0, wrong = 0;
  MissionEnd end = MissionEnd::UnderWay;
  std::string reason;
};

/// Four victims in a maze of 5 x 5 pallets, each at a wall of its pallet.
FaintOutcome faint_mission(CueKind kind, std::uint64_t seed, OtherSearch search = OtherSearch::Everywhere) {
  const test::Maze maze = test::random_maze(5, 5, 0.2, seed);
  FaintSenses senses{maze, {}, kind, Rng(seed, "senses")};
  for (const auto& [column, row] : {std::pair<int, int>{4, 4}, {0, 4}, {4, 0}, {2, 2}}) {
    const TPoint2D c = maze.centre(column, row);
    TPoint2D nearest{c.x, c.y};
    for (const test::Segment& wall : maze.walls) {
      const TPoint2D middle = (wall.a + wall.b) * 0.5;
      if (distance(middle, c) < 0.7) nearest = c + (middle - c) * (0.45 / 0.6);
    }
    senses.victims.push_back(nearest);
  }
  const robot::RobotModel model;
  test::MazeRobot robot(maze, model);
  slam::PaperMapper mapper(model, test::exact_mapper(), 1);
  PaperExplorerConfig config;
  config.search.other_senses = search;
  PaperExplorer explorer(model, config, {1500.0, {kind == CueKind::Sound, kind == CueKind::Co2}});
  robot::Commands commands;
  while (robot.now().seconds() < 1500.0 && !explorer.finished()) {
    robot::Inputs inputs = robot.step(commands);
    senses.sense(robot.pose(), inputs);
    mapper.update(inputs);
    commands = explorer.next(mapper, inputs);
  }
  FaintOutcome run;
  run.end = explorer.end();
  run.reason = explorer.reason();
  std::vector<bool> taken(senses.victims.size(), false);
  for (const VictimReport& report : explorer.victims()) {
    const TPoint2D p = maze.start.composePoint(report.p_map);
    bool right = false;
    for (std::size_t i = 0; i < taken.size() && !right; ++i)
      if (!taken[i] && distance(senses.victims[i], p) < 0.6) taken[i] = right = true;
    run.wrong += right ? 0 : 1;
    EXPECT_TRUE(right) << "at " << p.x << " " << p.y << ", after " << report.stamp.seconds() << " s";
    EXPECT_EQ(report.cues, std::vector<CueKind>{kind});
    EXPECT_LT(worst_sigma(report.covariance), 0.31);
  }
  run.found = static_cast<int>(std::count(taken.begin(), taken.end(), true));
  return run;
}

TEST(FaintMission, VictimsThatAreOnlyHeardAreFoundAndNoOthers) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const FaintOutcome run = faint_mission(CueKind::Sound, seed);
    EXPECT_EQ(run.found, 4);
    EXPECT_EQ(run.wrong, 0);
    EXPECT_EQ(run.end, MissionEnd::Home);
    EXPECT_NE(run.reason.find("all visible floor searched and listened to"), std::string::npos) << run.reason;
  }
}

/// What these senses tell of on the way is visited, and nothing else is driven to for them.
TEST(FaintMission, ByItselfTheRobotGoesWhereTheseSensesPointTo) {
  ASSERT_EQ(PaperExplorerConfig{}.search.other_senses, OtherSearch::Suspects);
  int heard = 0, smelt = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    for (const CueKind kind : {CueKind::Sound, CueKind::Co2}) {
      const FaintOutcome run = faint_mission(kind, seed, OtherSearch::Suspects);
      (kind == CueKind::Sound ? heard : smelt) += run.found;
      EXPECT_EQ(run.wrong, 0);
      EXPECT_EQ(run.end, MissionEnd::Home);
      EXPECT_NE(run.reason.find("all visible floor searched by cameras, home again"), std::string::npos) << run.reason;
    }
  }
  EXPECT_EQ(heard, 12);
  EXPECT_GE(smelt, 6);
}

TEST(FaintMission, VictimsThatAreOnlySmeltAreFoundAndNoOthers) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const FaintOutcome run = faint_mission(CueKind::Co2, seed);
    EXPECT_EQ(run.found, 4);
    EXPECT_EQ(run.wrong, 0);
    EXPECT_EQ(run.end, MissionEnd::Home);
    EXPECT_NE(run.reason.find("all visible floor searched and smelt"), std::string::npos) << run.reason;
  }
}

}  // namespace
}  // namespace rubble::explore
