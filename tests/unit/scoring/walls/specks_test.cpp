#include "scoring/walls/specks.h"

#include <gtest/gtest.h>

namespace rubble::scoring {
namespace {

OccupancyGrid floor_with_a_wall() {
  GridFrame frame;
  frame.resolution = 0.05;
  frame.width = 100;
  frame.height = 80;
  OccupancyGrid map(frame);
  for (Occupancy& cell : map.cells()) cell = Occupancy::Free;
  for (int x = 10; x < 90; ++x) map[{x, 40}] = Occupancy::Occupied;
  return map;
}

TEST(Specks, SingleAndPairedCellsGoAndTakeWhatIsAround) {
  OccupancyGrid map = floor_with_a_wall();
  const OccupancyGrid clean = map;
  map[{20, 10}] = Occupancy::Occupied;
  map[{60, 20}] = Occupancy::Occupied;
  map[{61, 21}] = Occupancy::Occupied;
  EXPECT_EQ(without_specks(map).cells(), clean.cells());
}

TEST(Specks, WallsAndWhatStandsAtThemStay) {
  OccupancyGrid map = floor_with_a_wall();
  for (int x = 30; x < 33; ++x) map[{x, 60}] = Occupancy::Occupied;  // three cells: a thin post
  map[{50, 43}] = Occupancy::Occupied;                               // 0.15 m beside the wall
  EXPECT_EQ(without_specks(map).cells(), map.cells());
}

TEST(Specks, DotsThatDrawTheWallsStay) {
  OccupancyGrid map = floor_with_a_wall();
  for (int x = 10; x < 90; ++x) map[{x, 40}] = x % 8 == 0 ? Occupancy::Occupied : Occupancy::Free;
  EXPECT_EQ(without_specks(map).cells(), map.cells());
}

}  // namespace
}  // namespace rubble::scoring
