#include "explore/paper/rounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

/// Rounds in a room where something can be failed at as often as a test likes.
struct Played {
  Rounds rounds;
  LeftAlone left_alone{FeltConfig{}, 0.5};
  FloorSearch search{SearchConfig{}, 0.4, 0.4};
  Traversable floor = test::measured(test::room(4.0, 4.0));
  std::size_t victims = 0;
  std::size_t frontier_left = 1;
  Stamp now = Stamp::from_seconds(10.0);

  void fail() { left_alone.bar({1.0, 1.0}, {now, {}}); }
  /// There are faces to be looked at squarely.
  void leave_faces() {
    search.expect_holes();
    search.sources(floor, Subjects::Squarely, [](const TPoint2D&) { return std::nullopt; });
  }
  void feel(double x = 2.0) { left_alone.feel({now, {x, 2.0, 0.0}}, false, {}, floor.cells, {}); }
  Resort resort(bool homeward = false, bool may_push = false) {
    now = now + 1.0;
    return rounds.next_resort(homeward, may_push, left_alone, now);
  }
  bool another() {
    now = now + 1.0;
    return rounds.another(standing(frontier_left), search, left_alone).has_value();
  }
  bool before_all_faces(std::size_t frontiers, bool more = false) {
    now = now + 1.0;
    return rounds.before_all_faces(standing(frontiers), more, search, left_alone).has_value();
  }
  Rounds::Standing standing(std::size_t frontiers) const {
    const auto left = [frontiers] { return frontiers; };
    return {now, floor, victims, left, left};
  }
};

TEST(Rounds, ResortsComeFromTheLeastToTheLastAndToAnEnd) {
  Played play;
  std::vector<Resort> taken;
  for (int i = 0; i < 20; ++i) {
    play.fail();  // whatever is tried again fails again
    play.rounds.no_way(true);
    taken.push_back(play.resort());
  }
  EXPECT_TRUE(std::is_sorted(taken.begin(), taken.end()));
  EXPECT_EQ(taken.front(), Resort::LookAround);
  EXPECT_EQ(std::count(taken.begin(), taken.end(), Resort::TryAgain), 3);
  EXPECT_EQ(taken.back(), Resort::GiveUp);
}

TEST(Rounds, ItLooksAroundTwiceUnlessTwoMapsShowedNoWay) {
  for (const bool new_map : {true, false}) {
    Played play;
    play.rounds.no_way(new_map);
    EXPECT_EQ(play.resort(), Resort::LookAround);
    play.rounds.no_way(new_map);
    EXPECT_EQ(play.resort(), new_map ? Resort::GiveUp : Resort::LookAround);
    play.rounds.way_found();
    play.rounds.no_way(new_map);
    EXPECT_EQ(play.resort(), Resort::LookAround) << "a way was found meanwhile";
  }
}

/// Where no other ground can be had, whatever is forgiven, it looks around and goes on to the search.
TEST(Rounds, NothingIsTriedAgainForNothing) {
  Played play;
  play.fail();
  play.rounds.no_way(true);
  play.rounds.no_way(true);
  EXPECT_EQ(play.rounds.next_resort(false, true, play.left_alone, play.now, false), Resort::LookAround);
  EXPECT_EQ(play.rounds.next_resort(false, true, play.left_alone, play.now, false), Resort::GiveUp);
  EXPECT_TRUE(play.left_alone.barred({1.0, 1.0}, play.now)) << "nothing was forgiven";
}

TEST(Rounds, ThingsArePushedBeforeAllIsGivenUpAndAfterAllIsForgiven) {
  Played play;
  play.rounds.go_home();
  play.rounds.no_way(true);
  play.rounds.no_way(true);
  play.fail();
  EXPECT_EQ(play.resort(false, true), Resort::TryAgain);
  EXPECT_EQ(play.resort(false, true), Resort::Push);
  EXPECT_EQ(play.resort(false, false), Resort::GiveUp);
}

TEST(Rounds, OnTheWayHomeAllThatWasFeltIsForgottenAFewTimes) {
  Played play;
  play.rounds.go_home();
  int forgotten = 0;
  Resort last = Resort::LookAround;
  for (int i = 0; i < 30 && last != Resort::GiveUp; ++i) {
    for (int k = 0; k < 3; ++k) play.feel();
    play.rounds.no_way(true);
    last = play.resort(true);
    if (last != Resort::ForgetAll) continue;
    ++forgotten;
    EXPECT_TRUE(play.left_alone.obstacles(play.now).empty());
  }
  EXPECT_EQ(forgotten, 6);
  EXPECT_EQ(last, Resort::GiveUp);
}

TEST(Rounds, TwoThatGainNothingAreTheLast) {
  Played play;
  int rounds = 0;
  for (; rounds < 20; ++rounds) {
    play.fail();
    if (!play.another()) break;
  }
  EXPECT_EQ(rounds, 2) << "the first one gained the room";
}

TEST(Rounds, GoOnForAsLongAsTheyGainGroundOrAVictim) {
  Played play;
  double depth = 4.0;
  for (int i = 0; i < 10; ++i) {
    play.fail();
    if (i % 2 == 0) {
      ++play.victims;
    } else {
      play.floor = test::measured(test::room(4.0, depth += 0.5));
    }
    ASSERT_TRUE(play.another()) << i;
  }
}

TEST(Rounds, WithoutAnythingThatFailedThereIsNoOther) {
  Played play;
  EXPECT_FALSE(play.another());
}

/// How often all that was felt is forgotten while `frontiers` are left, and `faces`; it is felt in the same place or in
/// others.
int times_forgotten(std::size_t frontiers, bool same_place, bool faces = false) {
  Played play;
  if (faces) play.leave_faces();
  play.frontier_left = frontiers;
  int forgotten = 0;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 3; ++k) play.feel(same_place ? 2.0 : 2.0 + i);
    if (!play.another()) break;
    forgotten += play.left_alone.obstacles(play.now).empty() ? 1 : 0;
  }
  return forgotten;
}

TEST(Rounds, WhatWasFeltIsForgottenForTheSakeOfGroundBehindIt) {
  EXPECT_EQ(times_forgotten(0, true), 0);
  EXPECT_EQ(times_forgotten(0, false), 0);
  EXPECT_EQ(times_forgotten(2, true), 1) << "felt again it is no mistake";
  EXPECT_EQ(times_forgotten(2, false), 4) << "others are, four times at most";
  for (const std::size_t frontiers : {0u, 2u}) {
    EXPECT_EQ(times_forgotten(frontiers, true, true), 1) << "for the sake of faces likewise";
    EXPECT_EQ(times_forgotten(frontiers, false, true), 4);
  }
}

/// As good a one as ground behind what was felt, and not only after two rounds in vain.
TEST(Rounds, FacesOutOfReachAreAReasonToForgetAtOnce) {
  for (const std::size_t frontiers : {0u, 1u})
    for (const bool faces : {false, true}) {
      Played play;
      play.frontier_left = frontiers;
      if (faces) play.leave_faces();
      ASSERT_EQ(play.search.faces_left(), faces);
      play.fail();
      for (int k = 0; k < 3; ++k) play.feel();
      ASSERT_TRUE(play.another());
      EXPECT_EQ(play.left_alone.obstacles(play.now).empty(), faces) << frontiers << " frontiers";
      EXPECT_FALSE(play.left_alone.barred({1.0, 1.0}, play.now)) << "what failed is tried again with it";
    }
}

/// Before they are looked at at all, nothing that was felt is forgotten for them.
TEST(Rounds, FacesAreNoReasonToForgetBeforeTheirSearch) {
  Played play;
  play.leave_faces();
  ASSERT_TRUE(play.search.faces_left());
  for (int k = 0; k < 3; ++k) play.feel();
  EXPECT_FALSE(play.before_all_faces(0));
  EXPECT_FALSE(play.left_alone.obstacles(play.now).empty());
}

TEST(Rounds, BeforeTheSearchOfAllFacesFrontiersAreTriedOnceARound) {
  Played play;
  play.fail();
  EXPECT_FALSE(play.before_all_faces(0)) << "there is no frontier";
  EXPECT_TRUE(play.before_all_faces(1));
  EXPECT_FALSE(play.left_alone.barred({1.0, 1.0}, play.now));
  play.fail();
  EXPECT_FALSE(play.before_all_faces(1)) << "it was tried in this round";
  ASSERT_TRUE(play.another());
  play.fail();
  EXPECT_TRUE(play.before_all_faces(1));
}

TEST(Rounds, WhatWasNotTriedSoFarIsAReasonAsWell) {
  Played play;
  EXPECT_FALSE(play.before_all_faces(1)) << "nothing failed";
  EXPECT_FALSE(play.before_all_faces(0, true)) << "there is no frontier";
  EXPECT_FALSE(play.rounds.tried_before_search());
  EXPECT_TRUE(play.before_all_faces(1, true));
  EXPECT_TRUE(play.rounds.tried_before_search());
  EXPECT_FALSE(play.before_all_faces(1, true)) << "it was tried in this round";
}

TEST(Rounds, ForSeveralFrontiersEvenWhatIsCertainIsForgottenOnce) {
  Played play;
  play.frontier_left = 5;
  play.fail();
  ASSERT_TRUE(play.before_all_faces(5));
  for (int k = 0; k < 3; ++k) play.feel();
  EXPECT_TRUE(play.before_all_faces(5));
  EXPECT_TRUE(play.left_alone.obstacles(play.now).empty());
  int more = 0;
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 3; ++k) play.feel();
    more += play.before_all_faces(5) ? 1 : 0;
  }
  EXPECT_EQ(more, 1) << "the pardon of the round that has begun with it";
}

}  // namespace
}  // namespace rubble::explore
