#include "scoring/trajectory/relative_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPose2D;

/// n + 1 poses, `step` apart, one a second, turning by `turn` each.
Trajectory arc(int n, double step, double turn) {
  Trajectory out;
  TPose2D pose;
  for (int i = 0; i <= n; ++i) {
    out.push_back({Stamp::from_seconds(i), pose});
    pose = pose + TPose2D(step, 0.0, turn);
  }
  return out;
}

Trajectory random_run(std::uint64_t seed, int n) {
  Rng rng(seed, "run");
  Trajectory out;
  TPose2D pose;
  for (int i = 0; i <= n; ++i) {
    out.push_back({Stamp::from_seconds(i), pose});
    const double forward = rng.uniform(0.1, 0.4);
    const double turn = rng.uniform(-0.5, 0.5);
    pose = pose + TPose2D(forward, 0.0, turn);
  }
  return out;
}

Trajectory moved_run(Trajectory trajectory, const TPose2D& T) {
  for (StampedPose& stamped : trajectory) stamped.pose = T + stamped.pose;
  return trajectory;
}

TEST(RelativeError, RigidMotionOfTheRunIsNoError) {
  const Trajectory truth = random_run(1, 200);
  const Trajectory estimate = moved_run(truth, {3.0, -8.0, 2.0});
  for (const RelativeError& error : {rpe_frames(estimate, truth), rpe_path(estimate, truth, 1.0)}) {
    EXPECT_GT(error.pairs, 10u);
    EXPECT_NEAR(error.rmse_m, 0.0, 1e-9);
    EXPECT_NEAR(error.rmse_rad, 0.0, 1e-9);
  }
  const RelationError relations = relation_error(estimate, relations_of(truth));
  EXPECT_GT(relations.relations, 10u);
  EXPECT_NEAR(relations.mean_m + relations.mean_rad, 0.0, 1e-9);
}

TEST(RelativeError, ClaimsFarFromTheTruthAreFalse) {
  const Trajectory truth = random_run(2, 300);
  const Trajectory seen = moved_run(truth, {-4.0, 1.0, -1.2});
  std::vector<Relation> claimed = relations_of(truth);
  ASSERT_GT(claimed.size(), 12u);
  EXPECT_EQ(false_relations(claimed, seen), 0u) << "where the truth's frame lies does not matter";
  claimed[1].delta = claimed[1].delta + TPose2D(0.29, 0.0, 0.0);
  claimed[3].delta = claimed[3].delta + TPose2D(0.0, 0.0, -0.19);
  EXPECT_EQ(false_relations(claimed, seen), 0u);
  claimed[5].delta = claimed[5].delta + TPose2D(0.0, -0.31, 0.0);
  claimed[7].delta = claimed[7].delta + TPose2D(0.0, 0.0, 0.21);
  EXPECT_EQ(false_relations(claimed, seen), 2u);
  claimed[9].to = truth.back().stamp + 1.0;
  claimed[9].delta = TPose2D(50.0, 0.0, 0.0);
  EXPECT_EQ(false_relations(claimed, seen), 2u) << "the truth does not know it";
  for (Relation& claim : claimed) claim.delta = TPose2D() - claim.delta;
  EXPECT_GT(false_relations(claimed, seen), claimed.size() / 2) << "seen the other way round";
}

TEST(RelativeError, ScaleErrorOfOdometryIsItsShareOfEveryStep) {
  // Steps of 0.55 m instead of 0.5 m on a straight line: 0.05 m a frame; a pair of 1.1 m is 0.1 m too long.
  const Trajectory truth = arc(40, 0.5, 0.0);
  const Trajectory estimate = arc(40, 0.55, 0.0);
  EXPECT_NEAR(rpe_frames(estimate, truth).rmse_m, 0.05, 1e-12);
  const RelativeError path = rpe_path(estimate, truth, 1.0);
  EXPECT_EQ(path.pairs, 19u);  // taken at poses 2, 4, ... 40
  EXPECT_NEAR(path.rmse_m, 0.1, 1e-12);
}

TEST(RelativeError, ConstantTurnErrorIsThatAngle) {
  const Trajectory truth = arc(50, 0.2, 0.0);
  const Trajectory estimate = arc(50, 0.2, 0.03);
  EXPECT_NEAR(rpe_frames(estimate, truth).rmse_rad, 0.03, 1e-12);
  EXPECT_NEAR(rpe_frames(estimate, truth).rmse_m, 0.0, 1e-12);  // the turn follows the step
}

TEST(RelativeError, OneJumpCountsOnceHoweverLongTheRunAfterIt) {
  const int n = 100;
  const Trajectory truth = arc(n, 0.3, 0.1);
  Trajectory estimate = truth;
  for (int i = 60; i <= n; ++i) estimate[static_cast<std::size_t>(i)].pose.x += 0.7;
  EXPECT_NEAR(rpe_frames(estimate, truth).rmse_m, 0.7 / std::sqrt(n), 1e-12);
}

TEST(RelativeError, TruthIsInterpolatedAtTheStampsOfTheEstimate) {
  const Trajectory truth = arc(10, 1.0, 0.0);
  Trajectory estimate;
  for (const double t : {-1.0, 0.25, 3.5, 9.75, 12.0}) estimate.push_back({Stamp::from_seconds(t), TPose2D(t, 0, 0)});
  const RelativeError error = rpe_frames(estimate, truth);
  EXPECT_EQ(error.pairs, 2u);  // the first and the last lie outside
  EXPECT_NEAR(error.rmse_m, 0.0, 1e-9);
  EXPECT_EQ(rpe_frames({}, truth).pairs, 0u);
  EXPECT_EQ(rpe_path(truth, {}, 1.0).pairs, 0u);
}

TEST(Relations, ErrorIsTrueDeltaInverseComposedWithDelta) {
  // Truth: 2 m ahead, turned left by 90 deg. Estimate: 2 m ahead, 1 m to the left, turned by 100 deg. Seen from the
  // true second pose, whose x axis points left, the error is 1 m ahead.
  const std::vector<Relation> relations = {{Stamp::from_seconds(0), Stamp::from_seconds(1), {2.0, 0.0, kPi / 2}}};
  const Trajectory estimate = {{Stamp::from_seconds(0), TPose2D(5.0, 5.0, 0.3)},
                               {Stamp::from_seconds(1), TPose2D(5.0, 5.0, 0.3) + TPose2D(2.0, 1.0, deg_to_rad(100))}};
  const RelationError error = relation_error(estimate, relations);
  EXPECT_EQ(error.relations, 1u);
  EXPECT_NEAR(error.mean_m, 1.0, 1e-12);
  EXPECT_NEAR(error.mean_m2, 1.0, 1e-12);
  EXPECT_NEAR(error.std_m, 0.0, 1e-6);
  EXPECT_NEAR(error.mean_rad, deg_to_rad(10.0), 1e-12);
}

TEST(Relations, SwappedStampsGiveAnotherTranslationError) {
  const TPose2D truth(4.0, 0.0, 0.0);
  const TPose2D estimate(4.0, 0.0, 0.2);  // seen from the first pose only the angle is wrong
  const Trajectory run = {{Stamp::from_seconds(0), TPose2D()}, {Stamp::from_seconds(1), estimate}};
  const Stamp a = Stamp::from_seconds(0);
  const Stamp b = Stamp::from_seconds(1);
  EXPECT_NEAR(relation_error(run, {{a, b, truth}}).mean_m, 0.0, 1e-12);
  EXPECT_NEAR(relation_error(run, {{b, a, TPose2D() - truth}}).mean_m, 2.0 * 4.0 * std::sin(0.1), 1e-12);
}

TEST(Relations, MomentsAreThoseOfTheErrors) {
  const Trajectory run = arc(2, 1.0, 0.0);
  std::vector<Relation> relations;
  for (const double off : {0.1, 0.3})
    relations.push_back({Stamp::from_seconds(0), Stamp::from_seconds(1), TPose2D(1.0 + off, 0.0, 0.0)});
  relations.push_back({Stamp::from_seconds(0), Stamp::from_seconds(99), TPose2D()});
  const RelationError error = relation_error(run, relations);
  EXPECT_EQ(error.missing, 1u);
  EXPECT_NEAR(error.mean_m, 0.2, 1e-12);
  EXPECT_NEAR(error.std_m, 0.1, 1e-9);
  EXPECT_NEAR(error.mean_m2, 0.05, 1e-12);
}

TEST(Relations, LoopClosuresOfTheTruthAreAmongThem) {
  const Trajectory twice_round = arc(80, 0.5, 2.0 * kPi / 40);  // a circle of 20 m, two laps
  int closures = 0;
  for (const Relation& relation : relations_of(twice_round))
    if (relation.to - relation.from > 30.0) ++closures;
  EXPECT_GT(closures, 10);
}

/// The definition, pose by pose: each one taken with the earliest one near it that is far back on the path.
std::vector<Relation> relations_one_by_one(const Trajectory& taken, double near, std::size_t back) {
  std::vector<Relation> out;
  const auto add = [&](const StampedPose& from, const StampedPose& to) {
    out.push_back({from.stamp, to.stamp, to.pose - from.pose});
  };
  for (std::size_t k = 1; k < taken.size(); ++k) {
    add(taken[k - 1], taken[k]);
    for (std::size_t m = 0; m + back <= k; ++m) {
      const TPose2D delta = taken[k].pose - taken[m].pose;
      if (std::hypot(delta.x, delta.y) > near) continue;
      add(taken[m], taken[k]);
      break;
    }
  }
  return out;
}

TEST(Relations, AreThoseOfASearchThroughAllPosesToTheBit) {
  std::vector<Trajectory> runs = {arc(800, 1.5, 2.0 * kPi / 40),   // twenty laps over each other
                                  arc(300, 1.5, 0.0),              // never back
                                  arc(300, 1.5, kPi / 2 + 1e-3)};  // a square of one step, slowly turning
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Rng rng(seed, "walk");
    Trajectory run;
    TPose2D pose(rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0), 0.0);
    for (int i = 0; i < 700; ++i) {
      run.push_back({Stamp::from_seconds(i), pose});
      const double forward = rng.uniform(1.0, 1.6);
      const double turn = rng.uniform(-1.0, 1.0);
      pose = pose + TPose2D(forward, 0.0, turn);
    }
    runs.push_back(run);
  }
  std::size_t closures = 0;
  for (const Trajectory& run : runs) {
    for (const double near : {0.0, 1.0, 2.5}) {
      // Every step is longer than `length`, so each pose but the first is taken.
      const std::vector<Relation> found = relations_of(run, 0.9, near, 10.0);
      const std::vector<Relation> all = relations_one_by_one(Trajectory(run.begin() + 1, run.end()), near, 12);
      ASSERT_EQ(found.size(), all.size());
      closures += found.size() - (run.size() - 2);
      for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_TRUE(found[i].from == all[i].from && found[i].to == all[i].to);
        ASSERT_TRUE(found[i].delta.x == all[i].delta.x && found[i].delta.y == all[i].delta.y &&
                    found[i].delta.phi == all[i].delta.phi);
      }
    }
  }
  EXPECT_GT(closures, 1000u);
  EXPECT_TRUE(relations_of({}).empty());
  EXPECT_TRUE(relations_of(arc(0, 1.0, 0.0)).empty());
}

/// Relations are of a log where their moments are those of its scans; a millisecond is rounding.
TEST(RelationsAtScans, CountsThoseOfOtherMoments) {
  Trajectory scans;
  for (int i = 0; i < 100; ++i) scans.push_back({Stamp::from_seconds(0.2 * i), {0.1 * i, 0.0, 0.0}});
  const auto shifted = [&](double by) {
    std::vector<Relation> relations;
    for (int i = 0; i + 5 < 100; ++i)
      relations.push_back({Stamp::from_seconds(0.2 * i + by), Stamp::from_seconds(0.2 * (i + 5) + by), {}});
    return relations_at_scans(scans, relations);
  };
  EXPECT_EQ(shifted(0.0).relations, 95u);
  for (const double rounding : {0.0, 0.0005, -0.0005}) EXPECT_EQ(shifted(rounding).between, 0u);
  EXPECT_EQ(shifted(0.1).between, shifted(0.1).relations);
  EXPECT_TRUE(shifted(0.1).doubtful());
  EXPECT_FALSE(shifted(0.0).doubtful());
  EXPECT_EQ(shifted(0.1).relations, 94u) << "those that lie outside are of nobody";
  EXPECT_EQ(relations_at_scans({}, {{Stamp{}, Stamp{}, {}}}).relations, 0u);
}

}  // namespace
}  // namespace rubble::scoring
