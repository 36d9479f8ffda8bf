#include "scenarios/run/packed_map.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace rubble::scenarios {
namespace {

TEST(PackedMap, GivesBackWhatItWasMadeOf) {
  Rng rng{1, "maps"};
  for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {64, 3}, {65, 2}, {300, 200}}) {
    OccupancyGrid map(GridFrame{width, height, 0.1, -3.0, 2.0});
    for (Occupancy& cell : map.cells())  // runs of all lengths, and none
      cell = rng.below(40) == 0 ? static_cast<Occupancy>(rng.below(3)) : (&cell == map.data() ? cell : *(&cell - 1));
    const PackedMap packed = map;
    EXPECT_EQ(packed.unpacked().cells(), map.cells());
    EXPECT_EQ(packed.unpacked().frame(), map.frame());
    EXPECT_LE(packed.bytes(), map.cells().size());
  }
}

TEST(PackedMap, NeverTakesMoreThanTheMapAndLittleOfLargeOnes) {
  OccupancyGrid map(GridFrame{2000, 2000, 0.05, 0.0, 0.0});
  for (int x = 500; x < 1500; ++x) map[{x, 700}] = Occupancy::Occupied;
  EXPECT_LT(PackedMap(map).bytes(), map.cells().size() / 60);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) map[{x, y}] = static_cast<Occupancy>((x + y) % 3);
  EXPECT_LE(PackedMap(map).bytes(), map.cells().size());
}

}  // namespace
}  // namespace rubble::scenarios
