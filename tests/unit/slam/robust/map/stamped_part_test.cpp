#include "slam/robust/map/stamped_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rng.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kCell = 0.05;
constexpr int kBeams = 360;

/// A scan of a full turn, its beams as long as `length` says of their bearing.
template <class Length>
ScanPoints scan_of(const Length& length) {
  ScanPoints points;
  points.origin = {0.2, -0.1};
  points.beam_width = 2.0 * kPi / kBeams;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double bearing = beam * points.beam_width;
    const double r = length(bearing);
    const TPoint2D end(points.origin.x + r * std::cos(bearing), points.origin.y + r * std::sin(bearing));
    points.rays.push_back({end, true, beam + 1 < kBeams, beam});
  }
  return points;
}

ScanPoints random_scan(std::uint64_t seed, double longest) {
  Rng rng(seed, "beams");
  return scan_of([&](double) { return rng.uniform(0.5, longest); });
}

/// Of the sectors of all beams [cells].
double cells_of(const ScanPoints& points) {
  double area = 0.0;
  for (const ScanRay& ray : points.rays)
    area += 0.5 * points.beam_width * std::pow(distance(ray.end, points.origin), 2);
  return area / (kCell * kCell);
}

TEST(StampedPart, WhatIsSmallEnoughStaysAsItIs) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const ScanPoints all = random_scan(seed, 30.0);
    ScanPoints cut = all;
    cut_to({cells_of(all) * 1.001, 1000.0}, kCell, cut);
    for (std::size_t i = 0; i < all.rays.size(); ++i) {
      ASSERT_EQ(cut.rays[i].end, all.rays[i].end);
      ASSERT_TRUE(cut.rays[i].hit);
    }
  }
}

/// Those cut are equally long, the longest, and met nothing; the others stay.
TEST(StampedPart, LongBeamsAreCutToOneLengthUntilTheRestFits) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const double share : {0.9, 0.5, 0.1}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", share " + std::to_string(share));
      const ScanPoints all = random_scan(seed, 200.0);
      const double most = share * cells_of(all);
      ScanPoints cut = all;
      cut_to({most, 1e6}, kCell, cut);
      EXPECT_NEAR(cells_of(cut), most, 1e-6 * most);
      double longest = 0.0;
      for (const ScanRay& ray : cut.rays) longest = std::max(longest, distance(ray.end, cut.origin));
      for (std::size_t i = 0; i < all.rays.size(); ++i) {
        const bool beyond = distance(all.rays[i].end, all.origin) > longest + 1e-6;
        EXPECT_EQ(cut.rays[i].hit, !beyond);
        EXPECT_EQ(cut.rays[i].joined, all.rays[i].joined);
        if (beyond)
          EXPECT_NEAR(distance(cut.rays[i].end, cut.origin), longest, 1e-9);
        else
          EXPECT_EQ(cut.rays[i].end, all.rays[i].end);
        const TPoint2D before = all.rays[i].end - all.origin;
        const TPoint2D after = cut.rays[i].end - cut.origin;
        EXPECT_NEAR(std::atan2(before.y, before.x), std::atan2(after.y, after.x), 1e-9);
      }
    }
}

/// However little a corridor without an end shows, the raster it is drawn in grows with its length.
TEST(StampedPart, NoBeamIsLongerThanItsReach) {
  ScanPoints corridor = scan_of([](double bearing) { return std::min(500.0, 1.0 / std::abs(std::sin(bearing))); });
  cut_to({}, kCell, corridor);
  for (const ScanRay& ray : corridor.rays)
    EXPECT_LT(distance(ray.end, corridor.origin), StampedPart().reach * kCell + 1e-9);
  EXPECT_FALSE(corridor.rays.front().hit);
  EXPECT_TRUE(corridor.rays[kBeams / 4].hit);
}

/// A scanner of 30 m sees no more of an open ground than enters the map.
TEST(StampedPart, AllThatAScannerOf30MSeesEntersTheMap) {
  const ScanPoints all = scan_of([](double) { return 30.0; });
  ScanPoints cut = all;
  cut_to({}, kCell, cut);
  for (std::size_t i = 0; i < all.rays.size(); ++i) ASSERT_EQ(cut.rays[i].end, all.rays[i].end);
}

TEST(StampedPart, AScanWithoutBeamsStaysEmpty) {
  ScanPoints none;
  cut_to({}, kCell, none);
  EXPECT_TRUE(none.rays.empty());
}

}  // namespace
}  // namespace rubble::slam
