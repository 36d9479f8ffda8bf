#include "explore/search/victim_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "tests/support/explore_grids.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

PoseCovariance off_by(double sigma) {
  PoseCovariance covariance;
  covariance(0, 0) = covariance(1, 1) = sigma * sigma;
  return covariance;
}

/// A robot in a room of 6 x 4 m, its victim sensors on one thing.
SearchConfig staring_at(int places) {
  SearchConfig config;
  config.stares = places;
  return config;
}

struct Watching {
  VictimWatch watch{VictimSearchConfig{}, staring_at(2), 0.46, 0.4};
  test::PlantedMapper mapper;
  Traversable floor = test::measured(test::room(6.0, 4.0));
  TPose2D pose{2.0, 2.0, 0.0};
  double seconds = 0.0;

  Stamp now() const { return Stamp::from_seconds(seconds); }
  void moved(double sigma) { watch.moved(pose, off_by(sigma), 0.02); }
  /// Whether holes in walls are to be expected then. `hits`: of 20 scans that looked at each wall.
  bool judges_holes(int hits = 20) {
    seconds += 10.0;
    const std::size_t cells = floor.cells.frame().size();
    std::vector<std::uint16_t> seen(cells, 20), occupied(cells, 0);
    for (int y = 0; y < floor.cells.height(); ++y)
      for (int x = 0; x < floor.cells.width(); ++x)
        if (floor.cells[{x, y}] == Occupancy::Occupied)
          occupied[floor.cells.frame().index({x, y})] = static_cast<std::uint16_t>(hits);
    slam::CountMap map(1, 1, 0.05);
    map.assign(floor.cells.frame(), std::move(seen), std::move(occupied));
    watch.judge_holes(floor, map, now());
    return watch.search().squarely();
  }
  bool hear(const TPoint2D& victim) {
    seconds += 0.1;
    mapper.plant(now(), pose);
    const TPoint2D seen = pose.inverseComposePoint(victim);
    return watch.hear({now(), robot::CueKind::Heat, std::atan2(seen.y, seen.x), std::hypot(seen.x, seen.y), 0.9},
                      mapper, pose, floor);
  }
};

TEST(VictimWatch, ConfirmsAVictimOnceAndSaysSo) {
  Watching robot;
  robot.moved(0.05);
  int confirmed = 0;
  for (int i = 0; i < 10; ++i) confirmed += robot.hear({3.0, 2.5}) ? 1 : 0;
  EXPECT_EQ(confirmed, 1);
  ASSERT_EQ(robot.watch.reports().size(), 1u);
}

TEST(VictimWatch, WhileThePoseIsInDoubtNeitherCuesNorLooksCount) {
  Watching robot;
  robot.moved(0.05);
  robot.moved(0.8);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(robot.hear({3.0, 2.5}));
  EXPECT_FALSE(robot.watch.holds_still(robot.floor, robot.pose, robot.now())) << "nor do they hold the robot";
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(robot.watch.look(robot.floor, robot.pose, 0.0, robot.now() + i));
  robot.moved(0.05);
  EXPECT_TRUE(robot.watch.look(robot.floor, robot.pose, 0.0, robot.now() + 5.0));
  bool confirmed = false;
  for (int i = 0; i < 10; ++i) confirmed = robot.hear({3.0, 2.5}) || confirmed;
  EXPECT_TRUE(confirmed);
}

TEST(VictimWatch, AFirstCueHoldsTheRobotForAMoment) {
  Watching robot;
  robot.moved(0.05);
  EXPECT_FALSE(robot.watch.holds_still(robot.floor, robot.pose, robot.now()));
  robot.hear({3.0, 2.5});
  EXPECT_TRUE(robot.watch.holds_still(robot.floor, robot.pose, robot.now()));
  EXPECT_FALSE(robot.watch.holds_still(robot.floor, robot.pose, robot.now() + 2.0));
}

/// It was one false alarm in the wrong moment that took a victim in a corner out of a whole search.
TEST(VictimWatch, AFalseAlarmTakesNoStareFromWhatShowsElsewhere) {
  Watching robot;
  robot.moved(0.05);
  robot.hear({3.0, 1.0});
  EXPECT_TRUE(robot.watch.holds_still(robot.floor, robot.pose, robot.now()));
  robot.seconds += 3.0;
  EXPECT_FALSE(robot.watch.holds_still(robot.floor, robot.pose, robot.now()));
  robot.hear({3.1, 1.1});
  EXPECT_FALSE(robot.watch.holds_still(robot.floor, robot.pose, robot.now())) << "there it stood a moment ago";
  robot.hear({3.0, 3.0});
  EXPECT_TRUE(robot.watch.holds_still(robot.floor, robot.pose, robot.now()));
}

TEST(VictimWatch, FalseAlarmsEverywhereLeaveHalfOfTheTimeToDrive) {
  Watching robot;
  robot.moved(0.05);
  int held = 0;
  constexpr int kSeconds = 60;
  for (int i = 0; i < kSeconds; ++i) {
    robot.seconds += 1.0;
    robot.hear({0.8 + 0.7 * (i % 5), 0.8 + 0.7 * (i / 5 % 5)});
    held += robot.watch.holds_still(robot.floor, robot.pose, robot.now()) ? 1 : 0;
  }
  EXPECT_LE(held, kSeconds / 2 + 2);
  EXPECT_GE(held, kSeconds / 4);
}

/// Two boxes back to back on the two sides of a wall.
TEST(VictimWatch, TheFloorTellsTheSidesOfAWall) {
  for (const bool wall : {true, false}) {
    Watching robot;
    if (wall) {
      OccupancyGrid cells = test::room(6.0, 4.0);
      test::fill(cells, 2.95, 0.0, 3.05, 4.0, Occupancy::Occupied);
      robot.floor = test::measured(std::move(cells));
    }
    robot.moved(0.05);
    for (int i = 0; i < 4; ++i) robot.hear({2.75, 2.0});
    robot.pose = {4.0, 2.0, kPi};
    robot.moved(0.05);
    for (int i = 0; i < 4; ++i) robot.hear({3.25, 2.0});
    EXPECT_EQ(robot.watch.reports().size(), wall ? 2u : 1u);
  }
}

/// A victim in a niche lies before its back. One that shows behind a wall lies in a box behind a hole: there will be
/// more, so faces are looked at squarely too.
TEST(VictimWatch, AVictimBehindAWallTellsThatThereAreHoles) {
  for (const double depth : {-0.25, -0.03, 0.12, 0.3}) {
    Watching robot;
    OccupancyGrid cells = test::room(6.0, 4.0);
    test::fill(cells, 3.5, 0.0, 3.55, 4.0, Occupancy::Occupied);
    robot.floor = test::measured(std::move(cells));
    robot.moved(0.05);
    EXPECT_FALSE(robot.judges_holes());
    for (int i = 0; i < 10; ++i) robot.hear({3.55 + depth, 2.2});
    ASSERT_EQ(robot.watch.reports().size(), 1u);
    EXPECT_EQ(robot.judges_holes(), depth > 0.0) << depth;
  }
}

/// So it does where the scanner looked through the hole; what lies in a box that is open on one side shows through a
/// wider gap.
TEST(VictimWatch, AVictimBehindAHoleThatWasSeenTellsThatThereAreMore) {
  for (const double wide : {0.15, 0.4}) {
    Watching robot;
    OccupancyGrid cells = test::room(6.0, 4.0);
    test::fill(cells, 3.5, 0.0, 3.55, 4.0, Occupancy::Occupied);
    test::fill(cells, 3.5, 2.2 - 0.5 * wide, 3.55, 2.2 + 0.5 * wide, Occupancy::Free);
    robot.floor = test::measured(std::move(cells));
    robot.pose.y = 2.2;
    robot.moved(0.05);
    for (int i = 0; i < 10; ++i) robot.hear({3.7, 2.2});
    ASSERT_EQ(robot.watch.reports().size(), 1u);
    EXPECT_EQ(robot.judges_holes(), wide < 0.2) << wide;
  }
}

/// Driving along a wall for the first time it may see a victim before the map shows the wall.
TEST(VictimWatch, AWallThatShowsLaterTellsOfItsHoleAsWell) {
  for (const bool wall : {true, false}) {
    Watching robot;
    robot.moved(0.05);
    for (int i = 0; i < 4; ++i) robot.hear({3.7, 2.2});
    ASSERT_EQ(robot.watch.reports().size(), 1u);
    EXPECT_FALSE(robot.judges_holes());
    OccupancyGrid cells = test::room(6.0, 4.0);
    if (wall) test::fill(cells, 3.5, 0.0, 3.55, 4.0, Occupancy::Occupied);
    robot.floor = test::measured(std::move(cells));
    EXPECT_EQ(robot.judges_holes(), wall);
  }
}

/// Walls that the map shows twice, and the floor of a slope, are seen by a part of the scans alone.
TEST(VictimWatch, AWallThatManyScansSawNothingOfTellsOfNoHole) {
  for (const int hits : {12, 16, 18, 20}) {
    Watching robot;
    test::fill(robot.floor.cells, 3.5, 0.0, 3.55, 4.0, Occupancy::Occupied);
    robot.moved(0.05);
    for (int i = 0; i < 6; ++i) robot.hear({3.75, 2.2});
    ASSERT_EQ(robot.watch.reports().size(), 1u);
    EXPECT_EQ(robot.judges_holes(hits), hits > 17) << hits;
  }
}

/// What is shorter than a panel of a wall may be the side of a box or a scrap of the floor of a slope.
TEST(VictimWatch, WhatIsShortOrFarBeforeTheVictimTellsOfNoHole) {
  for (const double length : {0.5, 0.8, 1.2, 2.4})
    for (const double before : {0.25, 1.0}) {
      Watching robot;
      test::fill(robot.floor.cells, 3.5, 2.2 - 0.5 * length, 3.55, 2.2 + 0.5 * length, Occupancy::Occupied);
      robot.moved(0.05);
      for (int i = 0; i < 6; ++i) robot.hear({3.5 + before, 2.2});
      ASSERT_EQ(robot.watch.reports().size(), 1u);
      EXPECT_EQ(robot.judges_holes(), length > 1.0 && before < 0.6) << length << ' ' << before;
    }
}

/// Past the edge of a niche a line of sight may cut a cell of its side; most do not.
TEST(VictimWatch, AFewCuesPastTheEdgeOfANicheTellOfNoHole) {
  Watching robot;
  OccupancyGrid cells = test::room(6.0, 4.0);
  test::fill(cells, 3.0, 2.3, 3.05, 2.6, Occupancy::Occupied);
  robot.floor = test::measured(std::move(cells));
  robot.moved(0.05);
  for (int i = 0; i < 12; ++i) {
    robot.pose = i % 3 == 0 ? TPose2D{2.0, 2.5, 0.0} : TPose2D{3.2, 1.2, 1.5};  // through the side; from the front
    robot.moved(0.05);
    robot.hear({3.3, 2.4});
  }
  ASSERT_EQ(robot.watch.reports().size(), 1u);
  EXPECT_FALSE(robot.judges_holes());
}

/// The robot stood for a dozen cues where it saw into a box aslant, past the edge of its side.
TEST(VictimWatch, AVictimPastAnEdgeTellsOfNoHoleHoweverOftenItShows) {
  Watching robot;
  OccupancyGrid cells = test::room(6.0, 4.0);
  test::fill(cells, 3.0, 2.3, 3.05, 2.6, Occupancy::Occupied);
  robot.floor = test::measured(std::move(cells));
  robot.pose = {2.0, 2.08, 0.24};
  robot.moved(0.05);
  for (int i = 0; i < 12; ++i) robot.hear({3.3, 2.4});
  ASSERT_EQ(robot.watch.reports().size(), 1u);
  EXPECT_FALSE(robot.judges_holes());
}

/// Of two boxes side by side the one hides behind the other from where that one's victim shows.
TEST(VictimWatch, ACueIsOfTheNearestVictimAloneAndTellsOfNoHoleBeforeAnother) {
  Watching robot;
  OccupancyGrid cells = test::room(6.0, 4.0);
  test::fill(cells, 3.2, 2.0, 3.25, 4.0, Occupancy::Occupied);
  robot.floor = test::measured(std::move(cells));
  robot.pose = {4.5, 2.5, kPi};
  robot.moved(0.05);
  for (int i = 0; i < 4; ++i) robot.hear({3.4, 2.5});
  robot.pose = {2.0, 2.5, 0.0};
  robot.moved(0.05);
  for (int i = 0; i < 20; ++i) robot.hear({3.05, 2.5});
  ASSERT_EQ(robot.watch.reports().size(), 2u);
  EXPECT_FALSE(robot.judges_holes());
}

TEST(VictimWatch, LookingSquarelyCanBeAskedForOrRefused) {
  SearchConfig config;
  config.squarely = SquareLook::Always;
  EXPECT_TRUE(VictimWatch({}, config, 0.46, 0.4).search().squarely());
  config.squarely = SquareLook::Never;
  VictimWatch never({}, config, 0.46, 0.4);
  never.search().expect_holes();
  EXPECT_FALSE(never.search().squarely());
}

/// What the cues scatter and what the pose errs add up; the second does not shrink with the number of cues.
TEST(VictimWatch, AVictimHasTheCovarianceOfItsCuesAndOfThePose) {
  Watching robot;
  robot.moved(0.2);
  for (int i = 0; i < 40; ++i) robot.hear({3.0, 2.5 + (i % 2 == 0 ? 0.1 : -0.1)});
  ASSERT_EQ(robot.watch.reports().size(), 1u);
  const PlaceCovariance& covariance = robot.watch.reports()[0].covariance;
  EXPECT_NEAR(covariance.xx, 0.04, 0.001);
  EXPECT_GT(covariance.yy, 0.04);
  EXPECT_LT(covariance.yy, 0.042);
}

/// Floor that the cameras have searched is still to be smelt: from 1.5 m away nothing is.
TEST(VictimWatch, EachSenseHasToSearchTheFloor) {
  const Traversable floor = test::measured(test::room(2.4, 1.2));
  const auto all = [](const TPoint2D&) { return 0.0; };
  for (const bool probe : {false, true}) {
    SearchConfig config;
    config.faces = false;
    config.field_of_view = 2.0 * kPi;
    config.range = 3.0;
    config.other_senses = OtherSearch::Everywhere;
    FloorSearch search(config, 0.3, 0.3, {false, probe});
    double t = 0.0;
    const auto stand = [&](double x, double heading) {
      for (int i = 0; i < 3; ++i) search.look(floor, {x, 0.6, heading}, 0.0, Stamp::from_seconds(t += 0.5));
    };
    stand(0.6, kPi);
    EXPECT_EQ(search.sources(floor, Subjects::All, all).empty(), !probe);
    EXPECT_EQ(search.done(), probe ? "all visible floor searched and smelt" : "all visible floor searched");
    for (const double x : {0.5, 1.2, 1.9})
      for (const double heading : {0.0, 1.57, 3.14, -1.57}) stand(x, heading);
    EXPECT_TRUE(search.sources(floor, Subjects::All, all).empty());
  }
}

TEST(VictimWatch, VictimsAndLooksFollowTheMap) {
  Watching robot;
  robot.moved(0.05);
  for (int i = 0; i < 4; ++i) robot.hear({3.0, 2.5});
  ASSERT_EQ(robot.watch.reports().size(), 1u);
  EXPECT_TRUE(robot.watch.look(robot.floor, robot.pose, 0.0, robot.now()));
  EXPECT_FALSE(robot.watch.follow(robot.mapper)) << "nothing moved";
  robot.mapper.correct(Stamp::from_seconds(100.0), {0.5, 0.0, 0.0});
  EXPECT_TRUE(robot.watch.follow(robot.mapper));
  EXPECT_NEAR(robot.watch.reports()[0].p_map.x, 3.5, 1e-6);
}

}  // namespace
}  // namespace rubble::explore
