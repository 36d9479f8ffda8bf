#include "scoring/alignment/examiner.h"

#include <gtest/gtest.h>

#include "scoring/proposals/correlation.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

bool same_bits(const TPose2D& a, const TPose2D& b) { return a.x == b.x && a.y == b.y && a.phi == b.phi; }

/// A list that was asked before, or that shares guesses with one, gets the answer that it gets alone.
TEST(Examiner, RemembersWithoutChangingABit) {
  for (const std::uint64_t seed : {31u, 32u}) {
    const OccupancyGrid truth = crop_to_known(maze_of(seed, 7, 5), 0.0);
    const OccupancyGrid map = crop_to_known(moved(bent(maze_of(seed, 7, 5), 0.3), 0.6, 2.0, 1.0), 0.0);
    const SearchConfig config;
    const WallMatch match(map, truth, config.reach, config.max_points);
    const std::vector<PoseGuess> by_walls = correlate(map, truth, {});
    std::vector<PoseGuess> more = by_walls;
    for (int i = 0; i < 6; ++i) more.push_back({TPose2D(0.7 * i, 1.0 - 0.3 * i, 0.5 * i), 0.0, AlignBy::Features});
    Examiner examiner(match, config);
    for (const std::vector<PoseGuess>& guesses : {by_walls, more, by_walls}) {
      const std::vector<Hypothesis> remembered = examiner.examine(guesses);
      const std::vector<Hypothesis> alone = examine(guesses, match, config);
      ASSERT_EQ(remembered.size(), alone.size()) << "seed " << seed;
      for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_TRUE(same_bits(remembered[i].T_wide, alone[i].T_wide)) << "seed " << seed << ", " << i;
        EXPECT_TRUE(same_bits(remembered[i].T_best, alone[i].T_best)) << "seed " << seed << ", " << i;
        EXPECT_EQ(remembered[i].quality, alone[i].quality);
        EXPECT_EQ(remembered[i].by, alone[i].by);
      }
    }
  }
}

}  // namespace
}  // namespace rubble::scoring
