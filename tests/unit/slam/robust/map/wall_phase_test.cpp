#include <gtest/gtest.h>

#include <cmath>

#include "slam/robust/map/wall_phase.h"

namespace rubble::slam {
namespace {

/// Hits on one face of a wall, 40 cells long, as a scanner with 0.1 cells of noise gives them.
void add_face(WallPhase& phase, double across, bool up, int hits) {
  for (int i = 0; i < hits; ++i) phase.add(across + 0.1 * std::sin(7.0 * i), 40.0 * i / hits, up);
}

void add_board(WallPhase& phase, double middle, double half, int hits) {
  add_face(phase, middle + half, true, hits);
  add_face(phase, middle - half, false, hits);
}

/// Of a place from the nearest middle of a cell, once the raster that began at 0 has moved.
double off_middle(const WallPhase& phase, double place) {
  const double off = place - phase.shift(0.0) - 0.5;
  return off - std::round(off);
}

TEST(WallPhase, ThinWallsLieInTheMiddleOfCellsHoweverFarApartTheirFacesSeem) {
  for (const double half : {-0.3, -0.1, 0.1, 0.2, 0.3, 0.4})
    for (const double place : {0.0, 0.2, 0.5, 0.9}) {
      WallPhase phase;
      for (const int k : {0, 24, 48}) add_board(phase, k + place, half, 100);
      EXPECT_NEAR(off_middle(phase, place), 0.0, 0.02) << "faces " << 2.0 * half << " apart, at " << place;
    }
}

/// A map that is a little too small: walls around stand 0.2 cells too far inside, boards in between by less.
TEST(WallPhase, WallsAroundThatAreSeenMostDoNotPushItToABorder) {
  WallPhase phase;
  add_face(phase, -96.0 + 0.2 + 0.2, true, 1000);
  add_face(phase, 96.0 - 0.2 - 0.2, false, 1000);
  for (int k = -3; k <= 3; ++k) add_board(phase, 24.0 * k * (1.0 - 0.2 / 96.0), 0.2, 100);
  EXPECT_NEAR(off_middle(phase, 0.0), 0.0, 0.02);
}

TEST(WallPhase, WithoutThinWallsFacesTell) {
  WallPhase phase;
  add_board(phase, 10.2, 1.5, 100);  // both faces at 0.7
  EXPECT_NEAR(off_middle(phase, 0.7), 0.0, 0.02);
}

TEST(WallPhase, OneBoardAmongLongWallsDoesNotTellWhereTheyStand) {
  WallPhase phase;
  for (int k = 0; k < 20; ++k) add_face(phase, 40.0 * k + 0.7, k % 2 == 0, 500);
  add_board(phase, 777.2, 0.2, 100);
  EXPECT_NEAR(off_middle(phase, 0.7), 0.0, 0.02);
}

TEST(WallPhase, WallsThatMayLieAnywhereMoveNothing) {
  WallPhase phase;
  for (int i = 0; i < 1000; ++i) phase.add(0.01 * i, 0.0, true);
  EXPECT_EQ(phase.shift(0.3), 0.0);
  WallPhase few;
  add_board(few, 0.2, 0.1, 9);
  EXPECT_EQ(few.shift(0.0), 0.0);
}

}  // namespace
}  // namespace rubble::slam
