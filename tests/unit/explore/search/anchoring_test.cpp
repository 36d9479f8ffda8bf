// What the explorer keeps lies where it was found, also after the map was corrected.
#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/caution/left_alone.h"
#include "explore/paper/agenda.h"
#include "explore/search/floor_search.h"
#include "explore/search/victim_search.h"
#include "explore/stuck/recovery.h"
#include "explore/stuck/straight_on.h"
#include "tests/support/explore_grids.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const TPose2D kShift{0.4, -0.3, deg_to_rad(12.0)};

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

/// Half of the poses are moved by a planted loop closure at 5 s.
struct Anchoring : testing::Test {
  Anchoring() {
    for (int i = 0; i < 10; ++i) mapper.plant(at(i), TPose2D{0.5 * i, 0.1 * i, 0.2 * i});
  }
  test::PlantedMapper mapper;
  const robot::RobotModel model;
};

TEST_F(Anchoring, FeltObstaclesFollowThePosesAtWhichTheyWereFelt) {
  FeltObstacles felt;
  for (const double t : {2.0, 8.0}) felt.feel({at(t), *mapper.pose_at(at(t))}, false, model);
  const std::vector<TPoint2D> before = felt.points(at(9.0));
  mapper.correct(at(5.0), kShift);
  felt.follow(mapper);
  const std::vector<TPoint2D> after = felt.points(at(9.0));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const TPoint2D expected = i < before.size() / 2 ? kShift.composePoint(before[i]) : before[i];
    EXPECT_NEAR(distance(after[i], expected), 0.0, 1e-9);
  }
}

TEST_F(Anchoring, BarredTargetsFollowThePosesFromWhichTheyWereBarred) {
  LeftAlone left_alone({}, 0.5);
  const TPoint2D target{9.0, 4.0};
  left_alone.bar_for_good(target, {at(2.0), *mapper.pose_at(at(2.0))});
  mapper.correct(at(5.0), kShift);
  left_alone.follow(mapper);
  EXPECT_TRUE(left_alone.barred(kShift.composePoint(target), at(9.0)));
  EXPECT_FALSE(left_alone.barred(target, at(9.0))) << "there is another place now";
}

TEST_F(Anchoring, VictimsFollowThePosesFromWhichTheyWereSeen) {
  VictimSearch search;
  const TPoint2D victim{1.5, 1.0};
  for (const double t : {1.0, 2.0, 3.0}) {
    const TPose2D pose = *mapper.pose_at(at(t));
    const TPoint2D seen = pose.inverseComposePoint(victim);
    const robot::VictimCue cue{at(t), robot::CueKind::Heat, std::atan2(seen.y, seen.x), std::hypot(seen.x, seen.y),
                               0.9};
    search.add(cue, pose);
  }
  ASSERT_EQ(search.reports().size(), 1u);
  mapper.correct(at(5.0), kShift);
  search.follow(mapper);
  EXPECT_NEAR(distance(search.reports()[0].p_map, kShift.composePoint(victim)), 0.0, 1e-6);
}

TEST_F(Anchoring, ThePlaceThatHeldItFollowsThePoseThatWasHeld) {
  Recovery recovery(model, deg_to_rad(60.0));
  const TPose2D held = *mapper.pose_at(at(2.0));
  EXPECT_FALSE(recovery.begin(Escape::Met::Forwards, held, at(2.0)));
  const TPose2D far{3.0, 0.0, 0.0};
  mapper.correct(at(5.0), far);
  recovery.follow(mapper);
  EXPECT_TRUE(recovery.begin(Escape::Met::Forwards, far + held, at(8.0)));
}

/// A robot that is held fast is not free because a loop closed.
TEST_F(Anchoring, AnEscapeFollowsThePoseThatWasHeld) {
  const Escape::Around room{[](const TPose2D&) { return true; }, [](const TPose2D&) { return 1.0; }};
  Escape escape(deg_to_rad(60.0));
  const TPose2D held = *mapper.pose_at(at(2.0));
  escape.begin(Escape::Met::Forwards, held, at(2.0));
  const auto step = [&](const TPose2D& pose, double seconds) {
    return escape.step(pose, escape.drive(), false, {}, false, 0.02, at(seconds), {}, {}, room);
  };
  EXPECT_EQ(step(held, 2.02), Escape::Result::UnderWay);
  const TPose2D far{0.6, 0.3, 0.2};
  mapper.correct(at(5.0), far);
  escape.follow(mapper);
  EXPECT_EQ(step(far + held, 2.04), Escape::Result::UnderWay);
  EXPECT_LT(escape.roamed(), 0.01);
  // Half a metre from there is what it was before.
  EXPECT_EQ(step(far + held + TPose2D(-0.45, 0.0, 0.0), 2.06), Escape::Result::UnderWay);
  EXPECT_EQ(step(far + held + TPose2D(-0.51, 0.0, 0.0), 2.08), Escape::Result::Free);
}

TEST_F(Anchoring, WhereItDroveStraightOnFollowsThePoseFromWhichItDid) {
  StraightOn straight_on(model);
  const TPose2D tried = *mapper.pose_at(at(2.0));
  straight_on.begin(tried, at(2.0));
  const TPose2D far{3.0, 1.5, 0.0};
  mapper.correct(at(5.0), far);
  straight_on.follow(mapper);
  const Traversable floor = test::measured(test::room(8.0, 4.0));
  EXPECT_FALSE(straight_on.worth(far + tried, floor, {}, at(9.0))) << "it was tried here";
  EXPECT_TRUE(straight_on.worth({1.0, 1.2, 0.0}, floor, {}, at(9.0))) << "another place lies there now";
}

/// The frontier stays, and the robot looked at it from here: no second look round because the map was corrected.
TEST_F(Anchoring, WhereItLookedRoundFollowsThePoseFromWhichItDid) {
  PaperExplorerConfig config;
  config.search.on = false;
  config.felt.pallet = 0.0;
  Agenda agenda(config);
  LeftAlone left_alone(config.felt, config.planner.same_target);
  FloorSearch search(config.search, 0.46, 0.4);
  slam::CountMap map(10, 10, 0.05);
  mapper.plant(at(20.0), TPose2D{2.0, 2.0, 0.0});
  agenda.set_home({at(20.0), *mapper.pose_at(at(20.0))});
  const auto ask = [&](const TPoint2D& unknown, Stamp now) {
    OccupancyGrid cells = test::room(8.0, 4.0);
    test::fill(cells, unknown.x - 0.2, unknown.y - 0.2, unknown.x + 0.2, unknown.y + 0.2, Occupancy::Unknown);
    Traversable floor = test::measured(std::move(cells));
    map.stamp({}, {});
    const bool new_map = agenda.begin_plan(map, now);
    const Agenda::Situation situation{now, *mapper.pose_at(at(20.0)), floor, false, 0, left_alone, search};
    Plan plan = agenda.choose(situation);
    return agenda.decide(std::move(plan), new_map, situation);
  };
  ASSERT_EQ(ask({2.2, 2.35}, at(20.0)).kind, Order::Kind::Turn);
  const TPose2D shift{3.0, 0.0, 0.0};
  mapper.correct(at(25.0), shift);
  agenda.follow(mapper, 0.0);
  EXPECT_EQ(ask({5.2, 2.35}, at(30.0)).kind, Order::Kind::Stay) << "left alone, without another turn";
  EXPECT_TRUE(left_alone.barred({5.2, 2.3}, at(1e6)));
}

/// The place to face lies elsewhere after a correction: there it is looked at.
TEST_F(Anchoring, ThePlaceToFaceFollowsTheLastLook) {
  FloorSearch search({}, 0.46, 0.4);
  const Traversable floor = test::measured(test::room(8.0, 4.0));
  const TPose2D here{2.0, 2.8, 0.0};
  mapper.plant(at(20.0), here);
  ASSERT_TRUE(search.look(floor, here, 0.0, at(20.0)));
  const Cell viewpoint = floor.cells.cell({here.x, here.y});
  for (const Source& source : search.sources(floor, Subjects::All, [](const TPoint2D&) { return 0.0; }))
    if (source.cell == viewpoint) search.choose_subject(viewpoint);
  const auto turn = search.turn_to_subject(floor, here);
  ASSERT_TRUE(turn);
  search.start_dwell(at(20.1));
  const TPose2D shift{3.0, 0.0, 0.0};
  mapper.correct(at(25.0), shift);
  search.follow(mapper);
  const TPose2D facing = shift + here + TPose2D{0.0, 0.0, *turn};
  EXPECT_FALSE(search.subject_seen(floor));
  for (const double t : {26.0, 27.0}) ASSERT_TRUE(search.look(floor, facing, 0.0, at(t)));
  EXPECT_TRUE(search.subject_seen(floor));
}

}  // namespace
}  // namespace rubble::explore
