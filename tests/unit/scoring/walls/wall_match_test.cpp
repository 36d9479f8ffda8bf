#include "scoring/walls/wall_match.h"

#include <gtest/gtest.h>

#include "scoring/walls/resample.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

constexpr double kMet = 0.3;  // [m]

/// Two equal wings: only the walls of `more` tell the mirror image apart.
OccupancyGrid two_wings(const std::vector<std::pair<TPoint2D, TPoint2D>>& more) {
  OccupancyGrid out = maze_of(3, 8, 6);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width() / 2; ++x) out[{out.width() - 1 - x, y}] = out[{x, y}];
  for (const auto& [a, b] : more) draw_wall(out, a, b, 2);
  return out;
}

WallDuel with_mirror_image(const OccupancyGrid& map, const OccupancyGrid& truth) {
  const WallMatch match(map, truth, 2.0, 0);
  return match.duels({TPose2D()}, {{TPose2D(), true}}, kMet).front();
}

TEST(WallDuel, OfASymmetricArenaHasNoWalls) {
  const OccupancyGrid truth = two_wings({});
  const WallDuel duel = with_mirror_image(truth, truth);
  EXPECT_NEAR(duel.ours, 0.0, 0.1);
  EXPECT_NEAR(duel.theirs, 0.0, 0.1);
}

TEST(WallDuel, CountsTheWallsInWhichTheTwoDiffer) {
  const OccupancyGrid truth = two_wings({{{5.4, 1.8}, {6.6, 1.8}}});
  const WallDuel duel = with_mirror_image(truth, truth);
  EXPECT_NEAR(duel.ours, 2 * 1.2, 0.8) << "1.2 m of either map, but for ends that touch other walls";
  EXPECT_NEAR(duel.theirs, 0.0, 0.1);
}

TEST(WallDuel, WhatMeetsAtNeitherHasNoSay) {
  const OccupancyGrid truth = two_wings({{{5.4, 1.8}, {6.6, 1.8}}});
  OccupancyGrid furnished = truth;
  for (const double x : {1.8, 4.2, 7.8}) draw_wall(furnished, {x, 4.2}, {x + 0.2, 4.2}, 2);
  const WallDuel bare = with_mirror_image(truth, truth);
  const WallDuel duel = with_mirror_image(furnished, truth);
  EXPECT_NEAR(duel.ours, bare.ours, 0.3);
  EXPECT_NEAR(duel.theirs, bare.theirs, 0.3);
}

TEST(WallDuel, TurnsAboutWithItsPlaces) {
  const OccupancyGrid truth = two_wings({{{5.4, 1.8}, {6.6, 1.8}}});
  const WallMatch match(truth, truth, 2.0, 0);
  const WallMatch::Placement here{TPose2D()};
  const WallMatch::Placement there{TPose2D(), true};
  const WallDuel one = match.duels(here, {there}, kMet).front();
  const WallDuel other = match.duels(there, {here}, kMet).front();
  EXPECT_DOUBLE_EQ(one.ours, other.theirs);
  EXPECT_DOUBLE_EQ(one.theirs, other.ours);
}

/// A mirrored place is that of the mirror image.
TEST(WallDuel, AMirroredPlaceIsThatOfTheMirrorImage) {
  const OccupancyGrid truth = two_wings({{{5.4, 1.8}, {6.6, 1.8}}});
  const WallMatch match(truth, truth, 2.0, 0);
  const WallMatch of_mirrored(mirror_image(truth), truth, 2.0, 0);
  const TPose2D T(0.3, -0.2, 0.1);
  const double ours = match.duels({TPose2D()}, {{T, true}}, kMet).front().ours;
  EXPECT_NEAR(of_mirrored.duels({TPose2D(), true}, {{T}}, kMet).front().ours, ours, 0.02 * ours);
}

}  // namespace
}  // namespace rubble::scoring
