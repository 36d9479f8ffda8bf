#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

#include "scoring/measures/sight_lines.h"
#include "scoring/scorecard.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_halls.h"
#include "tests/support/scoring_schemes.h"

/// The laws of the score where next to nothing stands inside: halls, a corridor. The walls around are all that another
/// place may have in common with it by luck.
namespace rubble::scoring {
namespace {

using namespace testing;

struct Hall {
  std::uint64_t seed = 0;
  bool lattice = false;
};

void PrintTo(const Hall& hall, std::ostream* out) { *out << hall.seed << (hall.lattice ? " on the lattice" : ""); }

/// The lines of a hall are found once for all tests.
const SightLines& sights_of(const Hall& hall) {
  static std::map<std::pair<std::uint64_t, bool>, SightLines> known;
  const auto at = known.find({hall.seed, hall.lattice});
  if (at != known.end()) return at->second;
  return known.emplace(std::pair(hall.seed, hall.lattice), SightLines(hall_of(hall.seed, hall.lattice))).first->second;
}

class BareGround : public ::testing::TestWithParam<Hall> {
 protected:
  double at(const OccupancyGrid& map, double shift = 0.0) const {
    return sights.at(map, PlanarTransform({0.8 * shift, 0.6 * shift, 0.0})).score;
  }
  const OccupancyGrid truth = hall_of(GetParam().seed, GetParam().lattice);
  const SightLines& sights = sights_of(GetParam());
};

const std::vector<Hall> kHalls = {{0, false}, {1, false}, {2, false}, {3, false}, {5, true}, {7, true}};

INSTANTIATE_TEST_SUITE_P(Halls, BareGround, ::testing::ValuesIn(kHalls));

TEST_P(BareGround, TheTruthEarnsOneAndWhoeverKnowsNothingNothing) {
  ASSERT_TRUE(sights.usable());
  EXPECT_NEAR(at(truth), 1.0, 1e-9);
  for (const Occupancy all : {Occupancy::Free, Occupancy::Occupied, Occupancy::Unknown})
    EXPECT_EQ(at(OccupancyGrid(truth.frame(), all)), 0.0);
}

TEST_P(BareGround, AnHonestPartEarnsItsShareAndTheRestAsFreeGroundNothing) {
  for (const double angle : {0.3, 1.9, 3.7, 5.2}) {
    const OccupancyGrid part = cut_at(truth, angle);
    EXPECT_NEAR(at(part), share_within(sights, part), 0.05) << "cut at " << angle;
    EXPECT_LE(at(unknown_as_free(part)), at(part));
  }
}

/// Walls of a hall do go on: where it gains, it loses as much at corners, blocks and the other walls.
TEST(BareGrounds, DrawingOnWhatWasSeenGainsNothingInTheMean) {
  double gained = 0.0;
  for (const Hall& hall : kHalls)
    for (const double angle : {0.3, 1.9, 3.7, 5.2}) {
      const OccupancyGrid part = cut_at(hall_of(hall.seed, hall.lattice), angle);
      const SightLines& sights = sights_of(hall);
      gained += sights.at(smeared(part, 0.5), PlanarTransform()).score - sights.at(part, PlanarTransform()).score;
    }
  EXPECT_LE(gained / (4.0 * static_cast<double>(kHalls.size())), 0.01);
}

/// A patch of free ground fits into any hall.
TEST_P(BareGround, FreeGroundWithoutWallsEarnsNextToNothing) {
  EXPECT_LE(at(replaced(truth, OccupancyGrid(truth.frame()),
                        [&](const TPoint2D& p) { return truth[truth.cell(p)] == Occupancy::Occupied; })),
            0.06);
}

TEST_P(BareGround, FatRaggedAndTurnedWallsCostLittle) {
  EXPECT_GE(at(thickened(truth, 1)), 0.95);
  EXPECT_GE(at(thickened(truth, 2)), 0.9);
  EXPECT_GE(at(ragged(truth, 1, GetParam().seed)), 0.95);
  EXPECT_GE(sights.at(moved(truth, 0.6, 0.0, 0.0), PlanarTransform({0.0, 0.0, -0.6})).score, 0.95);
}

TEST_P(BareGround, WallsInTheWrongPlaceCost) {
  EXPECT_GE(at(truth, 0.05), 0.95);
  EXPECT_LT(at(truth, 0.1), at(truth, 0.05));
  EXPECT_LE(at(truth, 0.2), 0.2);
}

/// Two gaps of 0.8 m are no reason to doubt a hall.
TEST_P(BareGround, AMapWithGapsKeepsMostOfTheScore) { EXPECT_GE(at(with_gaps(truth, 2, GetParam().seed)), 0.8); }

double at_best_pose(const OccupancyGrid& map, const OccupancyGrid& truth) {
  const MapScore score = score_map(map, truth);
  EXPECT_FALSE(score.aligned);
  return score.score_at_best_pose;
}

/// Two halls that say so; halls that differ in one side by a pallet earn up to 0.67 (docs/scoring_measured.md, "Bare
/// truths"), since three of four walls are right.
TEST(BareGroundOfStrangers, AnotherHallEarnsNextToNothing) {
  for (const bool lattice : {false, true})
    for (const std::uint64_t seed : {0, 3})
      EXPECT_LE(at_best_pose(hall_of(seed + 1, lattice), hall_of(seed, lattice)), 0.2) << seed;
}

/// A bent corridor with two walls across: in any arena on the lattice there is one like it.
TEST(BareGroundOfStrangers, AnArenaOnTheLatticeEarnsNextToNothingInACorridor) {
  const OccupancyGrid corridor = corridor_of_pallets();
  ASSERT_NEAR(score_map(corridor, corridor).score_at_best_pose, 1.0, 1e-6);
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    EXPECT_LE(at_best_pose(truth_of({"yellow", 6, 6, seed}), corridor), 0.2);
  }
}

}  // namespace
}  // namespace rubble::scoring
