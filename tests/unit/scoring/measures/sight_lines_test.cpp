#include "scoring/measures/sight_lines.h"

#include <gtest/gtest.h>

#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

TEST(SightDuel, AMapAgainstItselfIsATie) {
  const OccupancyGrid truth = truth_of({"yellow", 7, 7, 5});
  const SightMap map(truth);
  const SightDuel duel = SightLines(truth).duel(map, PlanarTransform(), map, PlanarTransform());
  EXPECT_EQ(duel.first, 0);
  EXPECT_EQ(duel.second, 0);
  EXPECT_EQ(duel.sigmas(), 0.0);
}

TEST(SightDuel, TheTrueMapBeatsItsMirrorImageAndAShiftByAPallet) {
  for (const std::uint64_t seed : {5u, 6u, 7u}) {
    const OccupancyGrid truth = truth_of({"yellow", 8, 8, seed});
    const SightLines lines(truth);
    const SightMap map(truth);
    const OccupancyGrid flipped = mirrored(truth);
    EXPECT_GE(lines.duel(map, PlanarTransform(), SightMap(flipped), PlanarTransform()).sigmas(), 3.0) << seed;
    EXPECT_GE(lines.duel(map, PlanarTransform(), map, PlanarTransform({1.2, 0.0, 0.0})).sigmas(), 3.0) << seed;
    EXPECT_LE(lines.duel(SightMap(flipped), PlanarTransform(), map, PlanarTransform()).sigmas(), -3.0) << seed;
  }
}

TEST(SightDuel, WhatOnlyOneKnowsCountsForNeither) {
  const OccupancyGrid truth = truth_of({"yellow", 7, 7, 5});
  const SightMap whole(truth);
  const OccupancyGrid part = half_of(truth);
  const SightDuel duel = SightLines(truth).duel(whole, PlanarTransform(), SightMap(part), PlanarTransform());
  EXPECT_LE(duel.first, 2) << "at the edge of the half a line may be known by its end alone";
  EXPECT_EQ(duel.second, 0);
}

}  // namespace
}  // namespace rubble::scoring
