#include "explore/search/victim_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;
using robot::VictimCue;

VictimCue cue_of(const TPoint2D& victim, const TPose2D& pose, double seconds, CueKind kind = CueKind::Appearance,
                 double confidence = 0.8) {
  const TPoint2D seen = pose.inverseComposePoint(victim);
  return {Stamp::from_seconds(seconds), kind, std::atan2(seen.y, seen.x), std::hypot(seen.x, seen.y), confidence};
}

const TPoint2D kVictim{2.0, 1.0};

TEST(VictimSearch, ThreeConsistentCuesMakeAVictimWhereItIs) {
  VictimSearch search;
  const TPose2D poses[] = {{0.5, 1.0, 0.1}, {1.0, 0.5, 0.6}, {1.2, 1.4, -0.5}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(search.reports().empty());
    search.add(cue_of(kVictim, poses[i], i), poses[i]);
  }
  ASSERT_EQ(search.reports().size(), 1u);
  const VictimReport& report = search.reports()[0];
  EXPECT_EQ(report.id, 1);
  EXPECT_NEAR(report.p_map.x, kVictim.x, 1e-9);
  EXPECT_NEAR(report.p_map.y, kVictim.y, 1e-9);
  EXPECT_EQ(report.stamp, Stamp::from_seconds(2.0));
  EXPECT_GT(report.confidence, 0.5);
  EXPECT_LE(report.confidence, 1.0);
  EXPECT_EQ(report.cues, std::vector<CueKind>{CueKind::Appearance});
}

TEST(VictimSearch, AFaintCueIsNoVictimHoweverOftenItComesAlone) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 3; ++i) search.add(cue_of(kVictim, pose, i, CueKind::Heat, 0.3), pose);
  EXPECT_TRUE(search.reports().empty());
}

TEST(VictimSearch, ScatteredFalseAlarmsMakeNoVictim) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 12; ++i) search.add(cue_of({1.7 * i, 0.0}, pose, i), pose);
  EXPECT_TRUE(search.reports().empty());
}

TEST(VictimSearch, OutliersDoNotMoveAVictim) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 6; ++i) search.add(cue_of(kVictim, pose, i), pose);
  for (int i = 0; i < 3; ++i) search.add(cue_of({kVictim.x + 0.7, kVictim.y}, pose, 10 + i), pose);
  ASSERT_EQ(search.reports().size(), 1u);
  EXPECT_NEAR(search.reports()[0].p_map.x, kVictim.x, 0.03);
}

TEST(VictimSearch, TwoVictimsStayTwoAndKeepTheOrderOfConfirmation) {
  VictimSearch search;
  const TPose2D pose;
  const TPoint2D other{2.0, 2.5};
  search.add(cue_of(other, pose, 0), pose);
  for (int i = 1; i < 4; ++i) search.add(cue_of(kVictim, pose, i), pose);
  for (int i = 4; i < 6; ++i) search.add(cue_of(other, pose, i, CueKind::Heat), pose);
  ASSERT_EQ(search.reports().size(), 2u);
  EXPECT_EQ(search.reports()[0].id, 1);
  EXPECT_NEAR(search.reports()[0].p_map.y, kVictim.y, 1e-9);
  EXPECT_EQ(search.reports()[1].id, 2);
  EXPECT_EQ(search.reports()[1].cues, (std::vector<CueKind>{CueKind::Appearance, CueKind::Heat}));
  EXPECT_EQ(search.reports()[1].stamp, Stamp::from_seconds(5.0));
}

TEST(VictimSearch, ClustersThatGrowTogetherAreOneVictim) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 3; ++i) search.add(cue_of({2.0, 0.0}, pose, i), pose);
  for (int i = 0; i < 3; ++i) search.add(cue_of({2.0, 0.9}, pose, 3 + i), pose);
  ASSERT_EQ(search.reports().size(), 2u);
  for (int i = 0; i < 12; ++i) search.add(cue_of({2.0, 0.55}, pose, 10 + i), pose);
  ASSERT_EQ(search.reports().size(), 1u);
  EXPECT_EQ(search.reports()[0].id, 1) << "the older report stays";
}

/// Two boxes back to back stand at least so far apart as their depths; nearer it is one victim, whatever stands between
/// the places it was seen from.
TEST(VictimSearch, SeenFromBothSidesOfAPostItIsOneVictimAndBackToBackAreTwo) {
  const auto never = [](const TPoint2D&, const TPoint2D&) { return false; };
  const auto reports = [&](double between) {
    VictimSearch search;
    for (int i = 0; i < 8; ++i) {
      const bool west = i % 2 == 0;
      const TPose2D from{west ? 1.0 : 3.0, 1.0, west ? 0.0 : kPi};
      const TPoint2D victim{2.0 + (west ? -0.5 : 0.5) * between, 1.0};
      search.add(cue_of(victim, from, 1.0 + i), {Stamp::from_seconds(1.0 + i), from}, {never, never});
    }
    return search.reports().size();
  };
  EXPECT_EQ(reports(0.0), 1u);
  EXPECT_EQ(reports(0.1), 1u);
  EXPECT_EQ(reports(0.42), 2u) << "boxes of 0.2 m on the two sides of a wall";
}

const auto kAlways = [](const TPoint2D&, const TPoint2D&) { return true; };
const auto kNever = [](const TPoint2D&, const TPoint2D&) { return false; };

/// Two boxes side by side: a look of the camera that shows both shows two, whichever of them it tells first and though
/// one was seen alone before.
TEST(VictimSearch, TwoInOneLookAreTwoHoweverNear) {
  const TPoint2D one{2.0, 1.0};
  for (const double apart : {0.42, 0.6, 0.79})
    for (const bool first : {true, false})
      for (const bool alone_before : {true, false}) {
        VictimSearch search;
        const TPose2D pose{0.6, 1.1, 0.0};
        const TPoint2D other{2.0, 1.0 + apart};
        if (alone_before) search.add(cue_of(other, pose, 0.0), pose);
        for (int i = 1; i < 5; ++i) {
          search.add(cue_of(first ? one : other, pose, i), pose);
          search.add(cue_of(first ? other : one, pose, i), pose);
        }
        SCOPED_TRACE(testing::Message() << apart << " m apart, " << first << ", " << alone_before);
        ASSERT_EQ(search.reports().size(), 2u);
        const double y0 = search.reports()[0].p_map.y, y1 = search.reports()[1].p_map.y;
        EXPECT_NEAR(std::min(y0, y1), one.y, 0.01);
        EXPECT_NEAR(std::max(y0, y1), other.y, 0.01);
      }
}

TEST(VictimSearch, AFalseAlarmBesideAVictimInItsLookMakesNoSecondOne) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 100; ++i) {
    search.add(cue_of(kVictim, pose, i), pose);
    if (i == 5 || i == 60) search.add(cue_of({kVictim.x, kVictim.y - 0.5}, pose, i, CueKind::Appearance, 0.6), pose);
  }
  ASSERT_EQ(search.reports().size(), 1u);
  EXPECT_NEAR(search.reports()[0].p_map.y, kVictim.y, 0.01);
}

/// Two cameras of two looks a second that see something where nothing is twice in a thousand looks do so three times
/// within 40 s in every other mission of 1500 s, now and then in one place; a robot that stops and looks again has
/// three cues of a victim within seconds.
TEST(VictimSearch, FalseAlarmsAQuarterOfAMinuteApartMakeNoVictim) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 3; ++i) search.add(cue_of({kVictim.x, kVictim.y + 0.1 * i}, pose, 13.0 * i), pose);
  EXPECT_TRUE(search.reports().empty());
  for (int i = 0; i < 2; ++i) search.add(cue_of(kVictim, pose, 27.0 + i), pose);
  EXPECT_EQ(search.reports().size(), 1u);
}

/// Ears place a victim so badly that one may be heard in two places.
TEST(VictimSearch, OneHeardTwiceInALookIsOne) {
  VictimSearch search;
  const TPose2D pose;
  for (int i = 0; i < 20; ++i)
    for (const double off : {-0.25, 0.25})
      search.add(cue_of({kVictim.x, kVictim.y + off}, pose, i, CueKind::Sound, 0.8), pose);
  EXPECT_EQ(search.reports().size(), 1u);
}

/// In the corner of the next pallet, behind a wall that the map knows: what is seen there is not the first one.
TEST(VictimSearch, BehindAWallThatHidesTheFirstThereIsASecond) {
  const auto wall = [](const TPoint2D& from, const TPoint2D& to) { return (from.y > 1.2) != (to.y > 1.2); };
  for (const bool walled : {true, false}) {
    VictimSearch search;
    const Sightlines sight{kAlways, walled ? SightFn(wall) : SightFn(kNever)};
    for (int i = 0; i < 8; ++i) {
      const bool south = i < 4;
      const TPose2D from{0.8, south ? 0.8 : 1.6, 0.0};
      search.add(cue_of({2.0, south ? 1.0 : 1.42}, from, i), {Stamp::from_seconds(i), from}, sight);
    }
    EXPECT_EQ(search.reports().size(), walled ? 2u : 1u);
  }
}

/// Through a hole a victim shows behind a wall from everywhere: that says nothing.
TEST(VictimSearch, BehindAHoleOneStaysOne) {
  Rng rng(1, "cues");
  VictimSearch search;
  const TPose2D pose{0.2, 1.0, 0.0};
  for (int i = 0; i < 200; ++i) {
    VictimCue cue = cue_of(kVictim, pose, 0.5 * i);
    const double range_error = rng.gaussian(0.08);
    cue.range *= 1.0 + range_error;
    search.add(cue, {cue.stamp, pose}, {kAlways, kAlways});
  }
  EXPECT_EQ(search.reports().size(), 1u);
}

/// Where walls have holes, boxes of 0.5 m stand side by side behind them.
TEST(VictimSearch, TwoBoxesBehindAWallWithHolesAreTwo) {
  for (const double apart : {0.5, 0.6, 0.79, 0.0, 0.2})
    for (const bool holes : {true, false}) {
      Rng rng(1, "cues");
      VictimSearch search;
      for (int i = 0; i < 24; ++i) {
        const double off = i / 6 % 2 == 0 ? 0.0 : apart;  // the robot comes by twice
        const TPose2D pose{0.7, 1.0 + off, 0.0};
        VictimCue cue = cue_of({2.0, 1.0 + off}, pose, 0.5 * i);
        const double range_error = rng.gaussian(0.05);
        const double bearing_error = rng.gaussian(deg_to_rad(2.0));
        cue.range *= 1.0 + range_error;
        cue.bearing += bearing_error;
        search.add(cue, {cue.stamp, pose}, {kAlways, kAlways, kAlways, holes});
      }
      EXPECT_EQ(search.reports().size(), holes && apart >= 0.5 ? 2u : 1u) << apart << ' ' << holes;
    }
}

/// What tells them apart at first may be the error of a pose.
TEST(VictimSearch, TwoBehindHolesThatComeTooNearForTwoBoxesAreOne) {
  for (const double at_last : {0.3, 0.6}) {
    VictimSearch search;
    for (int i = 0; i < 30; ++i) {
      const double off = i < 6 ? 0.0 : i < 12 ? 0.6 : at_last;
      const TPose2D pose{0.7, 1.0 + off, 0.0};
      search.add(cue_of({2.0, 1.0 + off}, pose, 0.5 * i), {Stamp::from_seconds(0.5 * i), pose},
                 {kAlways, kAlways, kAlways, true});
      if (i == 11) {
        EXPECT_EQ(search.reports().size(), 2u);
      }
    }
    EXPECT_EQ(search.reports().size(), at_last < 0.45 ? 1u : 2u) << at_last;
  }
}

/// The same noise as of one behind a hole, where boxes side by side are told apart.
TEST(VictimSearch, BehindAHoleOneStaysOneThoughThereMayBeTwo) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed, "cues");
    VictimSearch search;
    const TPose2D pose{0.6, 1.0, 0.0};
    for (int i = 0; i < 200; ++i) {
      VictimCue cue = cue_of(kVictim, pose, 0.5 * i);
      const double range_error = rng.gaussian(0.05);
      const double bearing_error = rng.gaussian(deg_to_rad(2.0));
      cue.range *= 1.0 + range_error;
      cue.bearing += bearing_error;
      search.add(cue, {cue.stamp, pose}, {kAlways, kAlways, kAlways, true});
    }
    EXPECT_EQ(search.reports().size(), 1u) << seed;
  }
}

TEST(VictimSearch, MoreKindsOfCuesRaiseTheConfidence) {
  VictimSearch one;
  VictimSearch two;
  const TPose2D pose;
  for (int i = 0; i < 6; ++i) {
    one.add(cue_of(kVictim, pose, i), pose);
    two.add(cue_of(kVictim, pose, i, i % 2 == 0 ? CueKind::Appearance : CueKind::Heat), pose);
  }
  EXPECT_GT(two.reports()[0].confidence, one.reports()[0].confidence);
  EXPECT_LE(two.reports()[0].confidence, 1.0);
}

TEST(VictimSearch, NoisyCuesAverageOut) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Rng rng(seed, "cues");
    VictimSearch search;
    for (int i = 0; i < 40; ++i) {
      const double x = rng.uniform(0.2, 1.2);
      const double y = rng.uniform(0.2, 1.8);
      const double phi = rng.uniform(-0.4, 0.4);
      const double bearing_error = rng.gaussian(deg_to_rad(2.0));
      const double range_error = rng.gaussian(0.05);
      VictimCue cue = cue_of(kVictim, {x, y, phi}, i);
      cue.bearing += bearing_error;
      cue.range *= 1.0 + range_error;
      search.add(cue, {x, y, phi});
    }
    ASSERT_EQ(search.reports().size(), 1u);
    EXPECT_NEAR(std::hypot(search.reports()[0].p_map.x - kVictim.x, search.reports()[0].p_map.y - kVictim.y), 0.0,
                0.05);
  }
}

TEST(VictimSearch, CuesThatAreNoNumbersAreLeftOut) {
  VictimSearch search;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5; ++i) {
    search.add({Stamp{i}, CueKind::Heat, nan, 1.0, 0.9}, {});
    search.add({Stamp{i}, CueKind::Heat, 0.0, nan, 0.9}, {});
    search.add({Stamp{i}, CueKind::Heat, 0.0, 1.0, nan}, {});
    search.add({Stamp{i}, CueKind::Heat, 0.0, 1.0, 0.0}, {});
  }
  EXPECT_TRUE(search.reports().empty());
}

TEST(GeometricMedian, OfCollinearPointsIsTheMiddleOne) {
  const TPoint2D median = geometric_median({{0.0, 0.0}, {1.0, 0.0}, {10.0, 0.0}}, {1.0, 1.0, 1.0});
  EXPECT_NEAR(median.x, 1.0, 0.02);
}

}  // namespace
}  // namespace rubble::explore
