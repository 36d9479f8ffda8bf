#include "explore/search/faint_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/planar.h"
#include "base/rng.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;
using robot::VictimCue;

const auto kOpen = [](const TPoint2D&, const TPoint2D&) { return false; };

/// Senses that err as the search takes them to.
struct Senses {
  explicit Senses(std::uint64_t seed) : rng(seed, "faint") {}
  Rng rng;
  FaintSearchConfig config;

  VictimCue cue(const TPoint2D& victim, const TPose2D& pose, double seconds, CueKind kind) {
    const FaintSense& sense = kind == CueKind::Sound ? config.sound : config.co2;
    const TPoint2D at = pose.inverseComposePoint(victim);
    const double bearing = std::atan2(at.y, at.x) + rng.gaussian(sense.bearing_sigma);
    const double range = std::hypot(at.x, at.y) * (1.0 + rng.gaussian(sense.range_sigma));
    return {Stamp::from_seconds(seconds), kind, bearing, std::max(0.0, range), 0.25};
  }
};

/// A robot that drives to and fro past victims, two looks a second: what its senses tell of them.
struct Drive {
  Drive(std::uint64_t seed, std::vector<TPoint2D> heard, std::vector<TPoint2D> smelt)
      : senses(seed), heard_(std::move(heard)), smelt_(std::move(smelt)) {}
  Senses senses;
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;

  /// Straight on at 0.4 m/s.
  void go(const TPoint2D& from, const TPoint2D& to) {
    const TPoint2D way = to - from;
    const int looks = static_cast<int>(way.norm() / 0.2);
    for (int i = 0; i < looks; ++i) {
      const TPoint2D p = from + way * (static_cast<double>(i) / looks);
      look({p.x, p.y, std::atan2(way.y, way.x)});
    }
  }
  /// A false alarm of the probe that stands at `pose`, as if `place` was smelt.
  void smell_what_is_not(const TPose2D& pose, const TPoint2D& place) {
    seconds_ += 0.5;
    const TPoint2D at = pose.inverseComposePoint(place);
    add({Stamp::from_seconds(seconds_), CueKind::Co2, std::atan2(at.y, at.x), at.norm(), 0.2}, pose);
  }
  void stand(const TPose2D& pose, int looks) {
    for (int i = 0; i < looks; ++i) look(pose);
  }

 private:
  void look(const TPose2D& pose) {
    seconds_ += 0.5;
    search.stood({Stamp::from_seconds(seconds_), pose});
    const auto sense = [&](const std::vector<TPoint2D>& victims, CueKind kind, double range, double miss,
                           double alarm) {
      for (const TPoint2D& victim : victims) {
        const double missed = senses.rng.uniform();
        const VictimCue cue = senses.cue(victim, pose, seconds_, kind);
        if (distance(victim, position(pose)) < range && missed >= miss) add(cue, pose);
      }
      const double draw = senses.rng.uniform(), bearing = senses.rng.uniform(-kPi, kPi);
      const double far = senses.rng.uniform(0.3, range);
      if (draw < alarm) add({Stamp::from_seconds(seconds_), kind, bearing, far, 0.1}, pose);
    };
    sense(heard_, CueKind::Sound, 3.0, 0.3, 0.005);
    sense(smelt_, CueKind::Co2, 0.9, 0.2, 0.002);
  }
  void add(const VictimCue& cue, const TPose2D& pose) {
    search.add(cue, {cue.stamp, pose});
    for (FaintSearch::Seen& victim : seen) victim.sound = victim.co2 = 0;
    search.sort(seen, kOpen);
  }

  std::vector<TPoint2D> heard_, smelt_;
  double seconds_ = 0.0;
};

std::vector<FaintSearch::Place> sure(const FaintSearch& search) {
  std::vector<FaintSearch::Place> places;
  for (const FaintSearch::Place& place : search.places())
    if (place.sure) places.push_back(place);
  return places;
}

TEST(FaintSearch, ExactCuesFromThreePlacesMeetInOne) {
  FaintSearch search;
  const TPoint2D victim{2.0, 1.0};
  const TPose2D poses[] = {{0.5, 1.0, 0.1}, {1.0, 0.0, 0.6}, {2.2, 2.4, -0.5}};
  std::vector<FaintSearch::Seen> seen;
  for (int i = 0; i < 12; ++i) {
    if (i == 11) {
      EXPECT_FALSE(search.places()[0].sure) << "eleven may be of false alarms";
    }
    const TPose2D& pose = poses[i % 3];
    const TPoint2D at = pose.inverseComposePoint(victim);
    search.add({Stamp::from_seconds(i), CueKind::Sound, std::atan2(at.y, at.x), std::hypot(at.x, at.y), 0.2},
               {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  }
  ASSERT_EQ(search.places().size(), 1u);
  EXPECT_NEAR(distance(search.places()[0].p_map, victim), 0.0, 0.01);
  EXPECT_TRUE(search.places()[0].sure);
}

/// One passage by a victim that is only heard, 1 m beside the way: it is found once, and as near to where it is as its
/// covariance says.
TEST(FaintSearch, WhatIsHeardOnTheWayIsPlacedWithItsCovariance) {
  double squares = 0.0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    const TPoint2D victim{3.0, 1.0};
    Drive drive(seed, {victim}, {});
    drive.go({0.0, 0.0}, {6.0, 0.0});
    drive.go({6.0, 0.0}, {0.0, 0.0});
    const auto places = sure(drive.search);
    ASSERT_EQ(places.size(), 1u);
    ++found;
    const TPoint2D error = places[0].p_map - victim;
    EXPECT_LT(error.norm(), 0.6);
    const PlaceCovariance& c = places[0].covariance;
    const double det = c.xx * c.yy - c.xy * c.xy;
    squares += (c.yy * error.x * error.x - 2.0 * c.xy * error.x * error.y + c.xx * error.y * error.y) / det;
  }
  EXPECT_GT(squares / found, 0.8) << "two degrees of freedom: 2 in the mean";
  EXPECT_LT(squares / found, 4.0);
}

/// Two or three that cry at once, and false alarms.
TEST(FaintSearch, SeveralVictimsStayAsManyAsTheyAre) {
  int found = 0, placed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<TPoint2D> victims{{2.0, 0.7}, {5.5, -0.7}, {6.0, 3.2}};
    Drive drive(seed, victims, {});
    for (int i = 0; i < 2; ++i) {
      drive.go({0.0, 0.0}, {7.0, 0.0});
      drive.go({7.0, 0.0}, {7.0, 4.0});
      drive.go({7.0, 4.0}, {0.0, 4.0});
      drive.go({0.0, 4.0}, {0.0, 0.0});
    }
    for (const FaintSearch::Place& place : sure(drive.search)) {
      const bool right = std::any_of(victims.begin(), victims.end(),
                                     [&](const TPoint2D& v) { return distance(v, place.p_map) < 1.0; });
      ++placed;
      EXPECT_TRUE(right) << place.p_map.x << " " << place.p_map.y << ", " << place.sound << " cues";
    }
    for (const TPoint2D& v : victims)
      for (const FaintSearch::Place& place : sure(drive.search))
        if (distance(v, place.p_map) < 1.0) {
          ++found;
          break;
        }
  }
  EXPECT_EQ(found, 120);
  EXPECT_EQ(placed, 120) << "each of them once";
}

/// In neighbouring pallets, nearer to each other than a single cue errs.
TEST(FaintSearch, TwoThatCrySideBySideAreTwo) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Drive drive(seed, {{3.0, 0.7}, {3.9, 0.8}}, {});
    for (int i = 0; i < 2; ++i) {
      drive.go({0.0, 0.0}, {7.0, 0.0});
      drive.go({7.0, 0.0}, {7.0, 1.6});
      drive.go({7.0, 1.6}, {0.0, 1.6});
      drive.go({0.0, 1.6}, {0.0, 0.0});
    }
    const auto places = sure(drive.search);
    EXPECT_LE(places.size(), 2u);
    for (const TPoint2D& v : {TPoint2D(3.0, 0.7), TPoint2D(3.9, 0.8)})
      found += std::any_of(places.begin(), places.end(),
                           [&](const FaintSearch::Place& place) { return distance(v, place.p_map) < 0.6; })
                   ? 1
                   : 0;
  }
  EXPECT_GE(found, 58);
}

TEST(FaintSearch, WhatIsSmeltFromNearIsAVictimAndAFalseAlarmIsNone) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    const TPoint2D victim{3.0, 0.6};
    Drive drive(seed, {}, {victim});
    drive.go({0.0, 0.0}, {3.0, 0.0});
    drive.stand({3.0, 0.0, 1.5}, 8);
    drive.go({3.0, 0.0}, {30.0, 0.0});
    const auto places = sure(drive.search);
    ASSERT_EQ(places.size(), 1u);
    EXPECT_LT(distance(places[0].p_map, victim), 0.6);
  }
}

/// The cues of a victim that was seen are its own; none is left for another one nearby.
TEST(FaintSearch, AVictimThatWasSeenTakesItsCues) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const TPoint2D victim{3.0, 1.0};
    Drive drive(seed, {victim}, {victim});
    drive.seen.push_back({1, victim});
    drive.go({0.0, 0.0}, {6.0, 0.0});
    drive.stand({3.0, 0.2, 1.5}, 20);
    EXPECT_TRUE(sure(drive.search).empty());
    EXPECT_GT(drive.seen[0].sound, 10);
    EXPECT_GT(drive.seen[0].co2, 5);
  }
}

/// First heard, then seen: one victim, which keeps the older number.
TEST(FaintSearch, AVictimThatIsSeenLaterIsTheOneThatWasHeard) {
  const TPoint2D victim{3.0, 1.0};
  Drive drive(3, {victim}, {});
  drive.go({0.0, 0.0}, {6.0, 0.0});
  ASSERT_EQ(sure(drive.search).size(), 1u);
  for (FaintSearch::Place& place : drive.search.places())
    if (place.sure) place.id = 7;
  std::vector<FaintSearch::Seen> seen{{9, victim}};
  drive.search.sort(seen, kOpen);
  EXPECT_TRUE(sure(drive.search).empty());
  EXPECT_EQ(seen[0].is_also, 7);
}

/// What is smelt on this side of a wall is not the victim that was seen on its other side.
TEST(FaintSearch, NothingIsSmeltThroughAWall) {
  Senses senses(1);
  FaintSearch search;
  const TPoint2D seen_there{3.0, 1.0}, smelt_here{3.0, 0.5};
  const auto wall = [](const TPoint2D& a, const TPoint2D& b) { return (a.y < 0.75) != (b.y < 0.75); };
  std::vector<FaintSearch::Seen> seen{{1, seen_there}};
  const TPose2D pose{3.0, 0.0, 1.5};
  for (int i = 0; i < 8; ++i) {
    search.add(senses.cue(smelt_here, pose, i, CueKind::Co2), {Stamp::from_seconds(i), pose});
    search.sort(seen, wall);
  }
  EXPECT_EQ(sure(search).size(), 1u);
}

/// Before a wall it is placed a little behind it as often as not, and stays one victim.
TEST(FaintSearch, WhatIsSmeltRightBeforeAWallIsOne) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Senses senses(seed);
    FaintSearch search;
    std::vector<FaintSearch::Seen> seen;
    const auto wall = [](const TPoint2D& a, const TPoint2D& b) { return (a.y < 0.6) != (b.y < 0.52); };
    for (int i = 0; i < 20; ++i) {
      const TPose2D pose{0.02 * i, 0.0, 1.0};
      search.add(senses.cue({0.3, 0.45}, pose, i, CueKind::Co2), {Stamp::from_seconds(i), pose});
      search.sort(seen, wall);
    }
    EXPECT_EQ(sure(search).size(), 1u);
  }
}

/// However much is heard of one victim, the few cues of CO2 that do not fit it are of another.
TEST(FaintSearch, WhatIsSmeltIsNotTakenForWhatIsHeardNearby) {
  int two = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Drive drive(seed, {{3.0, 0.9}}, {{3.0, -0.5}});
    drive.go({0.0, 0.0}, {3.0, 0.0});
    drive.stand({3.0, 0.0, -1.5}, 10);
    drive.go({3.0, 0.0}, {6.0, 0.0});
    const auto places = sure(drive.search);
    const auto has = [&](const TPoint2D& v) {
      return std::any_of(places.begin(), places.end(),
                         [&](const FaintSearch::Place& place) { return distance(v, place.p_map) < 0.7; });
    };
    two += places.size() == 2 && has({3.0, 0.9}) && has({3.0, -0.5}) ? 1 : 0;
  }
  EXPECT_GE(two, 28);
}

/// Each of its cues may well be of the victim that cries a metre away; together they are not.
TEST(FaintSearch, WhatIsSmeltFromOneStandIsSetApartFromWhatCriesNearby) {
  int two = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const TPoint2D heard{3.3, 0.75}, smelt{3.7, -0.1};
    Drive drive(seed, {heard}, {smelt});
    drive.go({0.0, 0.0}, {2.9, 0.0});
    drive.stand({2.95, 0.0, 0.2}, 14);
    drive.go({2.9, 0.0}, {0.0, 0.0});
    const auto places = sure(drive.search);
    const auto has = [&](const TPoint2D& v) {
      return std::any_of(places.begin(), places.end(),
                         [&](const FaintSearch::Place& place) { return distance(v, place.p_map) < 0.5; });
    };
    two += places.size() == 2 && has(heard) && has(smelt) ? 1 : 0;
  }
  EXPECT_GE(two, 34);
}

/// What two false alarms leave beside a victim that cries takes a share of its cues, and gives it back.
TEST(FaintSearch, StrayCo2DoesNotMakeTwoOfOneThatCries) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Drive drive(seed, {{3.0, 1.0}}, {});
    drive.go({0.0, 0.0}, {3.0, 0.0});
    drive.smell_what_is_not({3.0, 0.0, 0.0}, {3.6, 0.3});
    for (int i = 0; i < 3; ++i) {
      drive.go({3.0, 0.0}, {6.0, 0.0});
      drive.go({6.0, 0.0}, {0.0, 0.0});
      drive.go({0.0, 0.0}, {3.0, 0.0});
      drive.smell_what_is_not({3.0, 0.0, 0.0}, {3.5, 0.4});
    }
    const auto places = sure(drive.search);
    ASSERT_EQ(places.size(), 1u);
    EXPECT_LT(distance(places[0].p_map, {3.0, 1.0}), 0.5);
  }
}

/// Stray cues of two senses that meet somewhere are no victim.
TEST(FaintSearch, AFewCuesOfTwoSensesAreNoVictim) {
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;
  const TPoint2D place{1.0, 0.5};
  int i = 0;
  const auto sense = [&](CueKind kind, const TPose2D& pose) {
    const TPoint2D at = pose.inverseComposePoint(place);
    search.add({Stamp::from_seconds(++i), kind, std::atan2(at.y, at.x), std::hypot(at.x, at.y), 0.3},
               {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  };
  for (const double x : {0.0, 0.7, 1.4, 2.0}) sense(CueKind::Sound, {x, 0.0, 0.0});
  for (const double x : {0.6, 1.2}) sense(CueKind::Co2, {x, 0.0, 0.0});
  ASSERT_EQ(search.places().size(), 1u);
  EXPECT_GE(search.places()[0].evidence, 1.0);
  EXPECT_FALSE(search.places()[0].sure);
  sense(CueKind::Co2, {1.0, 0.0, 0.0});
  EXPECT_FALSE(search.places()[0].sure);
  sense(CueKind::Co2, {0.8, 0.0, 0.0});
  EXPECT_TRUE(search.places()[0].sure);
}

/// What cries beside one that is smelt, and is seen later, gets its cues; the smelt one keeps its number for itself.
TEST(FaintSearch, OneThatIsSeenDoesNotTakeTheNumberOfOneThatIsSmelt) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const TPoint2D cries{3.0, 1.3}, smelt{3.0, -0.1};
    Drive drive(seed, {cries}, {smelt});
    drive.go({0.0, 0.0}, {2.5, 0.0});
    drive.stand({2.5, 0.0, 0.0}, 12);
    int number = 0;
    for (FaintSearch::Place& place : drive.search.places())
      if (place.sure) place.id = ++number;
    drive.seen.push_back({100, cries});
    for (int i = 0; i < 3; ++i) {
      drive.go({2.5, 0.0}, {0.0, 0.0});
      drive.go({0.0, 0.0}, {2.5, 0.0});
    }
    const auto places = sure(drive.search);
    for (const FaintSearch::Place& place : places) {
      EXPECT_TRUE(place.id == 0 || place.id != drive.seen[0].is_also) << place.id;
      for (const FaintSearch::Place& other : places)
        EXPECT_TRUE(&place == &other || place.id == 0 || place.id != other.id);
    }
  }
}

/// Cues may go from a place to one that explains them better: the victim stays the one it was.
TEST(FaintSearch, AVictimWhosePlaceIsGoneKeepsItsNumber) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Drive drive(seed, {{3.0, 0.9}}, {{3.0, 0.9}});
    int next = 0;
    const auto number = [&] {
      for (FaintSearch::Place& place : drive.search.places())
        if (place.sure && place.id == 0) place.id = ++next;
    };
    for (int i = 0; i < 30; ++i) {
      drive.go({2.0, 0.0}, {2.8, 0.2});
      number();
      drive.stand({2.8, 0.2, 0.5}, 1);
      number();
      drive.go({2.8, 0.2}, {4.0, 0.3});
      number();
    }
    const auto places = sure(drive.search);
    ASSERT_EQ(places.size(), 1u);
    EXPECT_EQ(places[0].id, 1);
  }
}

/// What was smelt before a victim was seen, and placed a little off, is that victim.
TEST(FaintSearch, WhatIsSmeltBesideOneThatIsSeenIsNoOther) {
  Senses senses(1);
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;
  const TPose2D pose{3.0, 0.0, 1.5};
  int i = 0;
  const auto smell = [&] {
    search.add(senses.cue({2.6, 0.5}, pose, ++i, CueKind::Co2), {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  };
  while (sure(search).empty()) smell();
  search.places()[0].id = 1;
  seen.push_back({2, {3.4, 0.6}});
  smell();
  EXPECT_TRUE(sure(search).empty());
  EXPECT_EQ(seen[0].is_also, 1) << "it keeps the number that people know";
  for (int k = 0; k < 20; ++k) smell();
  EXPECT_TRUE(sure(search).empty());
}

/// However long the robot waits beside it: only the newest cues are kept, and only what was silent meanwhile counts.
TEST(FaintSearch, OneThatCriesForLongIsFound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Drive drive(seed, {{3.0, 0.8}}, {});
    drive.stand({3.0, 0.0, 0.0}, 400);
    EXPECT_TRUE(sure(drive.search).empty()) << "heard from one place alone";
    drive.go({3.0, 0.0}, {4.5, 0.0});
    EXPECT_EQ(sure(drive.search).size(), 1u);
  }
}

/// A cue of CO2 from elsewhere does not stand for a second place to hear from.
TEST(FaintSearch, ASingleCueOfCo2SaysNothing) {
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;
  const TPoint2D place{0.7, 0.2};
  const TPose2D pose{0.0, 0.0, 0.0};
  int i = 0;
  const auto sense = [&](CueKind kind) {
    search.add({Stamp::from_seconds(++i), kind, std::atan2(place.y, place.x), place.norm(), 0.3},
               {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  };
  for (int k = 0; k < 7; ++k) sense(CueKind::Sound);
  sense(CueKind::Co2);
  ASSERT_EQ(search.places().size(), 1u);
  EXPECT_GE(search.places()[0].evidence, 1.0);
  EXPECT_FALSE(search.places()[0].sure);
}

/// False alarms of hours meet somewhere; a victim there would be told of whenever the robot is close.
TEST(FaintSearch, APlaceThatIsSilentFromNearIsNoVictim) {
  for (const CueKind kind : {CueKind::Sound, CueKind::Co2})
    for (const bool silent : {false, true}) {
      SCOPED_TRACE(silent);
      FaintSearch search;
      std::vector<FaintSearch::Seen> seen;
      const TPoint2D place{1.0, 0.4};
      int i = 0;
      for (const double x : {0.6, 1.4, 0.7, 1.3, 0.65, 1.35, 0.75, 1.25, 0.8, 1.2, 0.85, 1.15}) {
        const TPose2D pose{x, 0.0, 0.5 * kPi};
        for (int look = 0; look < (silent ? 8 : 2); ++look) search.stood({Stamp::from_seconds(++i), pose});
        const TPoint2D at = pose.inverseComposePoint(place);
        search.add({Stamp::from_seconds(i), kind, std::atan2(at.y, at.x), at.norm(), 0.3},
                   {Stamp::from_seconds(i), pose});
        search.sort(seen, kOpen);
      }
      EXPECT_EQ(sure(search).size(), silent ? 0u : 1u);
    }
}

/// A place that was visited in vain is not visited again until more is told of it.
TEST(FaintSearch, ASuspectIsVisitedOnce) {
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;
  const TPose2D pose{0.0, 0.0, 0.0};
  const auto smell = [&](int i) {
    search.add({Stamp::from_seconds(i), CueKind::Co2, 0.1, 0.6, 0.4}, {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  };
  smell(0);
  ASSERT_EQ(search.places().size(), 1u);
  EXPECT_FALSE(search.suspect(search.places()[0])) << "a single cue";
  EXPECT_TRUE(search.undecided(Stamp::from_seconds(1.0), 1.2)) << "but it is worth a moment";
  EXPECT_FALSE(search.undecided(Stamp::from_seconds(2.0), 1.2));
  smell(1);
  EXPECT_TRUE(search.suspect(search.places()[0]));
  search.visited({0.6, 0.0}, {Stamp::from_seconds(1.0), pose});
  EXPECT_FALSE(search.suspect(search.places()[0]));
  EXPECT_FALSE(search.undecided(Stamp::from_seconds(1.0), 1.2));
}

TEST(FaintSearch, PlacesFollowThePosesTheyWereHeardFrom) {
  test::PlantedMapper mapper;
  const TPoint2D victim{1.5, 1.0};
  FaintSearch search;
  Senses senses(2);
  std::vector<FaintSearch::Seen> seen;
  for (int i = 0; i < 12; ++i) {
    const TPose2D pose{0.2 * i, 0.0, 0.1 * i};
    mapper.plant(Stamp::from_seconds(i), pose);
    search.add(senses.cue(victim, pose, i, CueKind::Sound), {Stamp::from_seconds(i), pose});
    search.sort(seen, kOpen);
  }
  ASSERT_EQ(search.places().size(), 1u);
  const TPoint2D before = search.places()[0].p_map;
  const TPose2D shift{0.4, -0.3, deg_to_rad(12.0)};
  mapper.correct(Stamp::from_seconds(100.0), shift);
  search.follow(mapper);
  EXPECT_NEAR(distance(search.places()[0].p_map, shift.composePoint(before)), 0.0, 0.01);
}

TEST(FaintSearch, WhereAPlaceWasVisitedFromFollowsTheMap) {
  test::PlantedMapper mapper;
  FaintSearch search;
  std::vector<FaintSearch::Seen> seen;
  const TPose2D pose{1.0, 0.0, 0.0};
  mapper.plant(Stamp::from_seconds(1.0), pose);
  for (int i = 0; i < 2; ++i) {
    search.add({Stamp::from_seconds(1.0), CueKind::Co2, 0.1, 0.6, 0.4}, {Stamp::from_seconds(1.0), pose});
    search.sort(seen, kOpen);
  }
  search.visited(search.places()[0].p_map, {Stamp::from_seconds(1.0), pose});
  const TPose2D shift{0.4, -0.3, deg_to_rad(12.0)};
  mapper.correct(Stamp::from_seconds(100.0), shift);
  search.follow(mapper);
  ASSERT_EQ(search.places()[0].visited_from.size(), 1u);
  EXPECT_NEAR(distance(position(search.places()[0].visited_from[0].T_map_base), shift.composePoint({1.0, 0.0})), 0.0,
              1e-9);
}

}  // namespace
}  // namespace rubble::explore
