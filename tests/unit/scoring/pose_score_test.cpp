#include "scoring/pose_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

TEST(PoseScore, AtThePoseFoundItIsTheScoreOfTheSearch) {
  const OccupancyGrid truth = maze({});
  const OccupancyGrid map = with_phantoms(moved(truth, 0.4, 1.0, -2.0), 4, 1);
  const MapScore found = score_map(map, truth);
  ASSERT_TRUE(found.aligned);
  const MapScore there = score_at(map, truth, found.T_truth_map);
  EXPECT_EQ(there.score, found.score);
  EXPECT_EQ(there.precision, found.precision);
  EXPECT_EQ(there.psi_m, found.psi_m);
  EXPECT_EQ(there.psi_literal_m, found.psi_literal_m);
  EXPECT_EQ(there.known, found.known);
}

/// Lines of sight do not cross the walls around an arena, and who sees a drawn way does not see a wall in it.
TEST(PoseScore, WhatTheScoreCannotTellIsSaid) {
  const OccupancyGrid truth = maze({});
  EXPECT_EQ(score_map(truth, truth).note, "");
  const GridFrame& f = truth.frame();
  const auto rim = static_cast<int>(std::lround(0.8 / f.resolution));  // the margin and the wall around
  OccupancyGrid open = truth;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      if ((x < rim || y < rim || x >= f.width - rim || y >= f.height - rim) && open[{x, y}] == Occupancy::Occupied)
        open[{x, y}] = Occupancy::Free;
  EXPECT_NE(score_at(open, truth, {}).note.find("around the arena"), std::string::npos)
      << score_at(open, truth, {}).note;
  OccupancyGrid crossed = truth;
  for (int y = rim; y < f.height - rim; ++y)
    for (int x = rim; x < f.width - rim; ++x)
      if ((x + y) % 24 < 2 && crossed[{x, y}] == Occupancy::Free) crossed[{x, y}] = Occupancy::Occupied;
  EXPECT_NE(score_at(crossed, truth, {}).note.find("cross free floor"), std::string::npos)
      << score_at(crossed, truth, {}).note;
  OccupancyGrid ringed = truth;  // as somebody marks a place, with several rings
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double metres = std::hypot(x - 0.5 * f.width, y - 0.5 * f.height) * f.resolution;
      if (std::fmod(metres, 0.9) < 0.1 && ringed[{x, y}] == Occupancy::Free) ringed[{x, y}] = Occupancy::Occupied;
    }
  EXPECT_NE(score_at(ringed, truth, {}).note.find("arrows"), std::string::npos) << score_at(ringed, truth, {}).note;
}

/// Nearest neighbour to pixels wider than the walls drops whole walls; averages and fine pixels need no such word.
TEST(PoseScore, PixelsWiderThanTheTruthsWallsAreSaidWhereWallsAreMissing) {
  const OccupancyGrid truth = maze({});
  const auto small_by = [&](int every, int from) {
    GridFrame f = truth.frame();
    f.width /= every;
    f.height /= every;
    f.resolution *= every;
    OccupancyGrid small(f);
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) small[{x, y}] = truth[{every * x + from, every * y + from}];
    return score_at(small, truth, {});
  };
  const auto says = [](const MapScore& score) {
    return score.note.find("wider than the truth's walls") != std::string::npos;
  };
  EXPECT_FALSE(says(small_by(1, 0)));
  int lost = 0;
  for (int from = 0; from < 3; ++from) {  // walls a pixel thick lie in one of them
    const MapScore score = small_by(3, from);
    if (score.recall < 0.9) ++lost;
    EXPECT_EQ(says(score), score.recall < 0.98 && score.score < 0.98)
        << from << ' ' << score.recall << ' ' << score.note;
  }
  EXPECT_GE(lost, 1);
}

TEST(PoseScore, TrueScaleGivesBackAPerfectScore) {
  const OccupancyGrid truth = maze({});
  const OccupancyGrid half = scaled_frame(truth, 0.5);
  EXPECT_LT(score_at(half, truth, {}).score, 0.5);
  EXPECT_EQ(score_at(scaled_frame(half, 2.0), truth, {}).score, 1.0);
}

TEST(PoseScore, MapsWithoutAnythingScoreNothing) {
  const OccupancyGrid truth = maze({});
  const OccupancyGrid blank(truth.frame());
  for (const auto& [a, b] : {std::pair(blank, truth), std::pair(truth, blank), std::pair(blank, blank)}) {
    const MapScore score = score_at(a, b, {1.0, 2.0, 3.0});
    EXPECT_EQ(score.score, 0.0);
    EXPECT_TRUE(std::isfinite(score.psi_m));
  }
}

}  // namespace
}  // namespace rubble::scoring
