#include "explore/paper/home_way.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace rubble::explore {
namespace {

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

/// The time left when a robot `way_home` away is first told to turn back.
double turns_back_with(HomeWay& home, double way_home, double limit) {
  for (double t = 0.0; t < limit; t += 1.0)
    if (home.must_turn_back(way_home, at(t))) return limit - t;
  return 0.0;
}

TEST(HomeWay, LeavesTimeForTheWayAndMoreForALongerOne) {
  HomeWay home(1000.0);
  home.begin(at(0.0));
  const double near = turns_back_with(home, 2.0, 1000.0);
  const double far = turns_back_with(home, 40.0, 1000.0);
  EXPECT_GT(far, near);
  EXPECT_GT(far, 40.0 / 0.4);
}

/// An eighth of the time, 12 s at least and 25 s at most: at home for good with half of 100 s left is no mission.
TEST(HomeWay, AShortMissionKeepsLessTimeForNothing) {
  const double way_there = 1.4 * 5.0 / 0.22;
  for (const auto& [limit, spare] :
       {std::pair{60.0, 12.0}, {100.0, 12.5}, {160.0, 20.0}, {200.0, 25.0}, {1800.0, 25.0}}) {
    HomeWay home(limit);
    home.begin(at(0.0));
    EXPECT_NEAR(turns_back_with(home, 5.0, limit), way_there + spare, 1.0) << limit;
    EXPECT_DOUBLE_EQ(home.spare_time(), spare);
  }
}

TEST(HomeWay, ASlowRobotTurnsBackEarlier) {
  HomeWay fast(1000.0), slow(1000.0);
  fast.begin(at(0.0));
  slow.begin(at(0.0));
  fast.moved(120.0, 400.0, true);
  slow.moved(40.0, 400.0, true);
  slow.moved(100.0, 1.0, false);  // not on its way: does not count
  EXPECT_GT(turns_back_with(slow, 20.0, 1000.0), turns_back_with(fast, 20.0, 1000.0));
}

/// A mapper may take its first scan a minute late: the judge's clock runs all the same.
TEST(HomeWay, TheTimeRunsFromTheFirstTickNotFromTheFirstQuestion) {
  HomeWay home(300.0);
  home.begin(at(5.0));
  home.begin(at(6.0));
  EXPECT_TRUE(home.due(at(65.0)));
  EXPECT_DOUBLE_EQ(home.left(at(65.0)), 240.0);
}

/// 10 s for a look, and a fifth more than the way should take.
TEST(HomeWay, HurriesWhereNoTimeIsLeftForALook) {
  HomeWay home(300.0);
  home.begin(at(0.0));
  home.moved(66.0, 300.0, true);  // 0.22 m/s
  const double spare = 1.2 * 11.0 / 0.22 + 10.0;
  EXPECT_FALSE(home.hurries(11.0, at(300.0 - spare - 0.1)));
  EXPECT_TRUE(home.hurries(11.0, at(300.0 - spare + 0.1)));
  HomeWay unlimited(0.0);
  unlimited.begin(at(0.0));
  EXPECT_FALSE(unlimited.hurries(1e6, at(1e6)));
}

TEST(HomeWay, KnowsItsSpeed) {
  HomeWay home(0.0);
  EXPECT_NEAR(home.speed(), 0.22, 1e-9) << "as is usual, until it is known";
  home.moved(400.0, 1000.0, true);
  EXPECT_NEAR(home.speed(), 0.4, 0.02);
  home.moved(0.0, 1e6, true);
  EXPECT_NEAR(home.speed(), 0.08, 1e-9);
}

TEST(HomeWay, WithoutATimeLimitItNeverPresses) {
  HomeWay home(0.0);
  EXPECT_FALSE(home.due(at(1.0)));
  EXPECT_FALSE(home.must_turn_back(1e6, at(1e6)));
  EXPECT_TRUE(std::isinf(home.left(at(5.0))));
}

}  // namespace
}  // namespace rubble::explore
