#include "slam/mrpt/module/match_target.h"

#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <map>

#include "base/rng.h"

namespace rubble::slam {
namespace {

using mrpt::maps::CSimplePointsMap;
using mrpt::tfest::TMatchingPairList;

/// Two clouds of points, each on the sides of a room `size` metres wide and strewn by `spread`.
void fill(CSimplePointsMap& map, Rng& draw, int count, double size, double spread) {
  map.clear();
  for (int i = 0; i < count; ++i) {
    const double along = draw.uniform(-0.5, 0.5) * size;
    const double side = draw.uniform(0.0, 1.0) < 0.5 ? -0.5 : 0.5;
    const double across = side * size + draw.gaussian(spread);
    const bool upright = draw.uniform(0.0, 1.0) < 0.5;
    map.insertPointFast(static_cast<float>(upright ? across : along), static_cast<float>(upright ? along : across), 0);
  }
  map.mark_as_modified();
}

struct Found {
  TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults result;
};

Found match(const mrpt::maps::CMetricMap& target, const CSimplePointsMap& other, const mrpt::poses::CPose2D& pose,
            float reach) {
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = reach;
  Found found;
  target.determineMatching2D(&other, pose, found.pairs, params, found.result);
  return found;
}

TEST(MatchTarget, FindsThePairsOfMrptsOwnPointMap) {
  constexpr std::uint64_t kSeed = 17;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Rng draw(kSeed, "points");
  for (int round = 0; round < 200; ++round) {
    // MRPT answers "no pairs" at once when the boxes around the two clouds do not overlap, however near they are; in
    // rooms like these they always do.
    const double size = draw.uniform(2.0, 30.0);
    const int count = static_cast<int>(draw.uniform(30.0, 600.0));
    MatchTarget target;
    fill(target, draw, count, size, 0.02);
    target.index();
    CSimplePointsMap oracle;
    oracle.insertAnotherMap(&target, mrpt::poses::CPose3D());
    CSimplePointsMap other;
    fill(other, draw, 200, size, 0.02);
    const double x = draw.gaussian(0.2);
    const double y = draw.gaussian(0.2);
    const mrpt::poses::CPose2D pose(x, y, draw.gaussian(0.3));
    const float reach = static_cast<float>(draw.uniform(0.02, 0.6));

    const Found ours = match(target, other, pose, reach);
    const Found theirs = match(oracle, other, pose, reach);
    std::map<std::uint32_t, const mrpt::tfest::TMatchingPair*> by_local;
    for (const auto& pair : theirs.pairs) by_local[pair.localIdx] = &pair;
    // Both compute in float, in another order: pairs at the very rim of the reach may differ, so may equal distances.
    std::size_t only_ours = 0;
    for (const auto& pair : ours.pairs) {
      const auto same = by_local.find(pair.localIdx);
      if (same == by_local.end()) {
        ++only_ours;
        EXPECT_NEAR(std::sqrt(pair.errorSquareAfterTransformation), reach, 1e-4f);
        continue;
      }
      EXPECT_NEAR(pair.errorSquareAfterTransformation, same->second->errorSquareAfterTransformation, 2e-6f);
      EXPECT_EQ(pair.local, same->second->local);
    }
    EXPECT_LE(theirs.pairs.size(), ours.pairs.size() - only_ours + 1);
    EXPECT_NEAR(ours.result.correspondencesRatio, theirs.result.correspondencesRatio, 0.011f);
  }
}

TEST(MatchTarget, NothingWithinReachIsNoPair) {
  MatchTarget target;
  target.insertPointFast(0.0f, 0.0f, 0.0f);
  target.index();
  CSimplePointsMap other;
  other.insertPointFast(0.31f, 0.0f, 0.0f);
  other.insertPointFast(1e6f, -1e6f, 0.0f);
  EXPECT_TRUE(match(target, other, mrpt::poses::CPose2D(), 0.3f).pairs.empty());
  EXPECT_EQ(match(target, other, mrpt::poses::CPose2D(), 0.32f).pairs.size(), 1u);
}

TEST(MatchTarget, AnEmptyTargetMatchesNothing) {
  MatchTarget target;
  target.index();
  CSimplePointsMap other;
  other.insertPointFast(0.0f, 0.0f, 0.0f);
  EXPECT_TRUE(match(target, other, mrpt::poses::CPose2D(), 0.3f).pairs.empty());
}

TEST(MatchTarget, RefusesWhatItDoesNotDo) {
  MatchTarget target;
  target.index();
  CSimplePointsMap other;
  mrpt::maps::TMatchingParams params;
  params.maxAngularDistForCorrespondence = 0.01f;
  TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults result;
  EXPECT_THROW(target.determineMatching2D(&other, mrpt::poses::CPose2D(), pairs, params, result),
               std::invalid_argument);
}

}  // namespace
}  // namespace rubble::slam
