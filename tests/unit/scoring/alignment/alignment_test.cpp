#include "scoring/alignment/alignment.h"

#include <gtest/gtest.h>

#include "scoring/walls/resample.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

OccupancyGrid hall(std::uint64_t seed) {
  MazeSpec spec;
  spec.columns = 8;
  spec.rows = 6;
  spec.seed = seed;
  return crop_to_known(maze(spec), 0.0);
}

/// Rooms that propose what they are told, and count how often they are asked.
struct ToldRooms {
  std::vector<PoseGuess> guesses;
  int asked = 0;
  Proposer proposer() {
    return [this](const OccupancyGrid&, const OccupancyGrid&) {
      ++asked;
      return guesses;
    };
  }
};

TEST(Alignment, AutoAsksRoomsOnlyWhereWallsAndFeaturesAreRefused) {
  ToldRooms rooms;
  AlignmentConfig config;
  config.rooms = rooms.proposer();
  const OccupancyGrid truth = hall(21);
  const Alignment clean = align(moved(truth, 0.7, 1.0, 2.0), truth, config);
  EXPECT_TRUE(clean.aligned) << clean.note;
  EXPECT_EQ(names_of(clean.contest.tried), "walls");
  EXPECT_EQ(rooms.asked, 0);
  // Of strangers whose pallets are as large some pose agrees to the decimetre by chance, and walls alone decide; these
  // are larger by an eighth.
  int asked_for = 0;
  for (std::uint64_t seed = 22; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const int before = rooms.asked;
    const Alignment stranger = align(scaled(hall(seed), 1.13), truth, config);
    EXPECT_FALSE(stranger.aligned);
    EXPECT_EQ(names_of(stranger.contest.tried), stranger.contest.by_agreement ? "walls" : "walls+features+rooms");
    EXPECT_EQ(rooms.asked - before, stranger.contest.by_agreement ? 0 : 1);
    asked_for += rooms.asked - before;
    if (asked_for == 2) break;
  }
  EXPECT_EQ(asked_for, 2);
}

TEST(Alignment, JoinedMethodsProposeTogether) {
  const OccupancyGrid truth = hall(23);
  const OccupancyGrid map = moved(truth, 0.4, 3.0, -1.0);
  ToldRooms rooms;
  AlignmentConfig config;
  config.rooms = rooms.proposer();
  config.by = AlignBy::Rooms;
  EXPECT_FALSE(align(map, truth, config).aligned);  // rooms say nothing, and walls may not win
  config.by = AlignBy::Rooms | AlignBy::Features;
  const Alignment features = align(map, truth, config);
  EXPECT_TRUE(features.aligned) << features.note;
  EXPECT_TRUE(includes(features.by, AlignBy::Features));
  EXPECT_EQ(names_of(features.contest.tried), "features+rooms");
  config.by = AlignBy::Rooms | AlignBy::Walls;
  const Alignment walls = align(map, truth, config);
  EXPECT_TRUE(walls.aligned);
  EXPECT_EQ(names_of(walls.contest.tried), "walls+rooms");
  rooms.guesses = {{walls.T_truth_map, 1.0, AlignBy::Rooms}};
  const Alignment both = align(map, truth, config);
  EXPECT_TRUE(both.aligned);
  EXPECT_TRUE(includes(both.by, AlignBy::Rooms)) << names_of(both.by);
  EXPECT_EQ(rooms.asked, 4);
}

TEST(Alignment, TellsByHowMuchItWonAndOverWhat) {
  const OccupancyGrid truth = hall(24);
  const Alignment found = align(moved(with_gaps(truth, 10, 1), -0.5, 0.5, 0.5), truth);
  ASSERT_TRUE(found.aligned) << found.note;
  const Contest& contest = found.contest;
  EXPECT_TRUE(contest.by_agreement);
  EXPECT_GT(contest.margin, 0.0);
  EXPECT_GT(contest.agreement, contest.margin);
  EXPECT_LE(contest.agreement, 2.0);
  EXPECT_NEAR(found.runner_up, 1.0 - contest.margin / contest.agreement, 1e-9);
  EXPECT_EQ(names_of(contest.runner_up_by), "walls");
  const TPoint2D centre(4.8, 3.6);
  const TPoint2D p_map = found.T_truth_map.inverseComposePoint(centre);
  const bool turned = std::abs(wrap_angle(found.T_truth_map.phi - contest.T_runner_up.phi)) >= 0.1;
  EXPECT_TRUE(turned || (contest.T_runner_up.composePoint(p_map) - centre).norm() >= 1.0);
}

/// Each wall cell takes memory and time: a picture that is one wall is refused before it is looked at.
TEST(Alignment, WhatIsAllWallIsRefusedAtOnce) {
  const OccupancyGrid truth(GridFrame{20, 20, 0.05, 0.0, 0.0}, Occupancy::Free);
  const OccupancyGrid wall(GridFrame{4000, 3000, 0.05, 0.0, 0.0}, Occupancy::Occupied);
  const Alignment alignment = align(wall, truth, {});
  EXPECT_FALSE(alignment.aligned);
  EXPECT_NE(alignment.note.find("12000000 cells of the map are walls"), std::string::npos) << alignment.note;
  EXPECT_NE(align(truth, wall, {}).note.find("cells of the truth"), std::string::npos);
}

TEST(Alignment, MethodsHaveNames) {
  EXPECT_EQ(names_of(AlignBy::Rooms | AlignBy::Walls), "walls+rooms");
  EXPECT_EQ(names_of(AlignBy::Auto), "");
}

}  // namespace
}  // namespace rubble::scoring
