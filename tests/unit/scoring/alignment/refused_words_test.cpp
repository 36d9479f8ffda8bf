#include <gtest/gtest.h>

#include <string>

#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// What a judge reads of a map that was refused.
std::string refusal(const OccupancyGrid& map, const OccupancyGrid& truth) {
  const MapScore score = score_map(map, truth);
  EXPECT_FALSE(score.aligned) << score.note;
  EXPECT_EQ(score.score, 0.0);
  EXPECT_EQ(score.note.find("not aligned: "), 0u) << score.note;
  EXPECT_EQ(score.note, "not aligned: " + reason_of(score.note));
  return score.note;
}

bool says(const std::string& note, const char* words) { return note.find(words) != std::string::npos; }

TEST(RefusedWords, AnotherArenaAgreesNowhere) {
  for (const std::uint64_t seed : {7604u, 7605u, 7606u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::string note = refusal(moved(maze_of(seed + 500, 8, 6), 0.4, 1.0, 2.0), maze_of(seed, 8, 6));
    EXPECT_TRUE(says(note, "probably another arena")) << note;
    EXPECT_FALSE(says(note, "agrees well") || says(note, "--start")) << note;
  }
}

TEST(RefusedWords, AnArenaThatRepeatsItselfAgreesWellAtSeveralPoses) {
  for (const std::uint64_t seed : {7601u, 7602u, 7603u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    OccupancyGrid truth = maze_of(seed, 8, 6);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width() / 2; ++x)
        truth[{truth.width() - 1 - x, truth.height() - 1 - y}] = truth[{x, y}];
    const std::string note = refusal(moved(with_gaps(truth, 8, seed), 0.7, 1.0, 2.0), truth);
    EXPECT_TRUE(says(note, "agrees well at several poses") && says(note, "--start or --pose")) << note;
    EXPECT_FALSE(says(note, "another arena")) << note;
  }
}

TEST(RefusedWords, AnArenaThatIsItsOwnMirrorImageAgreesAsWellMirrored) {
  for (const std::uint64_t seed : {7611u, 7612u, 7613u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    OccupancyGrid truth = maze_of(seed, 8, 6);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width() / 2; ++x) truth[{truth.width() - 1 - x, y}] = truth[{x, y}];
    const std::string note = refusal(moved(with_gaps(truth, 8, seed), 0.7, 1.0, 2.0), truth);
    EXPECT_TRUE(says(note, "agrees well") && says(note, "as well mirrored")) << note;
    EXPECT_FALSE(says(note, "several poses") || says(note, "another arena")) << note;
  }
}

}  // namespace
}  // namespace rubble::scoring
