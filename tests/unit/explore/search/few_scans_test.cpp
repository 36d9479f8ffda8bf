#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "base/rng.h"
#include "explore/search/floor_search.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

const auto kAnyPlace = [](const TPoint2D&) { return 0.0; };

/// A room of 8 x 2.4 m, whose floor so many scans saw in the west and in the east, an unknown wall between.
Traversable halves(int west, int east, double resolution = 0.05) {
  OccupancyGrid cells = test::room(8.0, 2.4, resolution);
  test::fill(cells, 3.9, 0.0, 4.1, 2.4, Occupancy::Unknown);
  Traversable floor = test::measured(std::move(cells));
  for (int y = 0; y < floor.cells.height(); ++y)
    for (int x = 0; x < floor.cells.width(); ++x)
      floor.scans[{x, y}] = static_cast<std::uint8_t>(floor.cells.centre({x, y}).x < 4.0 ? west : east);
  return floor;
}

/// The cheapest and the dearest place to look from in each half.
std::pair<std::pair<double, double>, std::pair<double, double>> prices(const Traversable& floor, Subjects subjects) {
  FloorSearch search({}, 0.46, 0.4);
  std::pair<double, double> west{1e9, -1e9}, east{1e9, -1e9};
  for (const Source& source : search.sources(floor, subjects, kAnyPlace)) {
    auto& half = floor.cells.centre(source.cell).x < 4.0 ? west : east;
    half = {std::min(half.first, source.head_start), std::max(half.second, source.head_start)};
  }
  return {west, east};
}

TEST(FewScans, WhatFewScansSawIsLookedAtFirst) {
  Rng rng(1, "scans");
  for (int i = 0; i < 12; ++i) {
    const int few = static_cast<int>(rng.below(60));
    const int many = few + 1 + static_cast<int>(rng.below(static_cast<std::uint32_t>(255 - few)));
    SCOPED_TRACE(testing::Message() << few << " and " << many << " scans");
    const auto [west, east] = prices(halves(few, many), Subjects::All);
    EXPECT_LT(west.second, east.first);
    const auto [there, here] = prices(halves(many, few), Subjects::All);
    EXPECT_EQ(there, east);
    EXPECT_EQ(here, west);
  }
}

/// A box would show to so many: more of them tell nothing.
TEST(FewScans, WhatIsKnownWellIsAllTheSame) {
  const auto [west, east] = prices(halves(100, 255), Subjects::All);
  EXPECT_EQ(west, east);
  EXPECT_EQ(west.first, west.second);
}

/// As in maps that were made of cells alone.
TEST(FewScans, WhereNobodyCountedThemAllIsTheSame) {
  const auto [west, east] = prices(halves(0, 0), Subjects::All);
  EXPECT_EQ(west, std::pair(0.0, 0.0));
  EXPECT_EQ(east, std::pair(0.0, 0.0));
}

/// Walls with holes have them whatever scans say.
TEST(FewScans, SquareLooksDoNotAskForThem) {
  const auto [west, east] = prices(halves(5, 200), Subjects::Squarely);
  ASSERT_LT(west.first, 1e9) << "there are places to look from";
  EXPECT_EQ(west, east);
}

/// What a place costs for having been seen by many scans is no way: frontiers are weighed against the way alone.
TEST(FewScans, ThePriceIsNoWay) {
  for (const double resolution : {0.05, 0.025}) {
    const Traversable floor = halves(20, 90, resolution);
    FloorSearch search({}, 0.46, 0.4);
    std::map<std::pair<int, int>, double> least;
    const auto sources = search.sources(floor, Subjects::All, kAnyPlace);
    for (const Source& source : sources) {
      const auto [at, first] = least.emplace(std::pair(source.cell.x, source.cell.y), source.head_start);
      if (!first) at->second = std::min(at->second, source.head_start);
    }
    ASSERT_FALSE(least.empty());
    for (const auto& [cell, price] : least) EXPECT_EQ(search.choose_subject({cell.first, cell.second}), price);
  }
}

/// Driving there the robot sees it better and better: it does not turn back for that.
TEST(FewScans, ThePlaceBeingDrivenToStaysAsItWasChosen) {
  Rng rng(3, "places");
  for (int i = 0; i < 8; ++i) {
    FloorSearch search({}, 0.46, 0.4);
    const Traversable afar = halves(15, 80), near = halves(200, 200);
    const auto before = search.sources(afar, Subjects::All, kAnyPlace);
    const Cell chosen = before[rng.below(static_cast<std::uint32_t>(before.size()))].cell;
    SCOPED_TRACE(testing::Message() << "from " << chosen.x << ", " << chosen.y);
    const double price = search.choose_subject(chosen);
    for (int again = 0; again < 3; ++again) {
      double most = 0.0;
      for (const Source& source : search.sources(near, Subjects::All, kAnyPlace))
        most = std::max(most, source.head_start);
      EXPECT_EQ(most, prices(near, Subjects::All).first.second) << "others are known by now";
      EXPECT_EQ(search.choose_subject(chosen), price);
    }
  }
}

/// A single ray that passed, or a cell that none did, between floor that many saw says nothing of a place.
TEST(FewScans, NoSingleCellDecides) {
  Traversable floor = halves(200, 200);
  Rng rng(2, "cells");
  for (int y = 0; y < floor.cells.height(); ++y)
    for (int x = 0; x < floor.cells.width(); ++x)
      if (rng.below(3) == 0) floor.scans[{x, y}] = 1;
  const auto [west, east] = prices(floor, Subjects::All);
  EXPECT_EQ(west, prices(halves(200, 200), Subjects::All).first);
  EXPECT_EQ(east, west);
}

}  // namespace
}  // namespace rubble::explore
