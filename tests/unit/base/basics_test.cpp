#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/angle.h"
#include "base/grid.h"
#include "base/lists.h"
#include "base/rng.h"
#include "base/stamp.h"
#include "base/text/number_text.h"
#include "base/text/words.h"

namespace rubble {
namespace {

TEST(Angle, WrapsIntoTheHalfOpenTurn) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
  Rng rng(1, "angles");
  for (int i = 0; i < 10000; ++i) {
    const double a = rng.uniform(-50.0, 50.0);
    const double w = wrap_angle(a);
    ASSERT_GT(w, -kPi);
    ASSERT_LE(w, kPi);
    ASSERT_NEAR(std::sin(w), std::sin(a), 1e-12);
    ASSERT_NEAR(std::cos(w), std::cos(a), 1e-12);
  }
}

TEST(Angle, DegreesAndRadiansAreInverse) {
  EXPECT_EQ(deg_to_rad(180.0), kPi);
  EXPECT_EQ(rad_to_deg(kPi), 180.0);
}

TEST(Stamp, SecondsAreExactToTheNanosecond) {
  EXPECT_EQ(Stamp::from_seconds(0.1).ns, 100000000);
  EXPECT_EQ((Stamp{5} + 1e-9).ns, 6);
  EXPECT_EQ((Stamp{1700000000000000000} - 0.5).ns, 1699999999500000000);
  EXPECT_DOUBLE_EQ(Stamp{1700000000300000000} - Stamp{1700000000000000000}, 0.3);
  EXPECT_LT(Stamp::never(), Stamp{-1000000000000000000});
}

TEST(Grid, TheCentreOfACellLiesInTheCell) {
  const GridFrame frame{40, 30, 0.05, -1.3, 2.7};
  for (int y = -5; y < 40; ++y)
    for (int x = -5; x < 50; ++x) EXPECT_EQ(frame.cell(frame.centre({x, y})), (Cell{x, y}));
}

TEST(Grid, PointsLeftOfTheOriginFallIntoNegativeCells) {
  const GridFrame frame{10, 10, 0.1, 0.0, 0.0};
  EXPECT_EQ(frame.cell({-0.01, 0.01}), (Cell{-1, 0}));
  EXPECT_FALSE(frame.inside({-1, 0}));
  EXPECT_TRUE(frame.inside({9, 9}));
  EXPECT_FALSE(frame.inside({9, 10}));
}

TEST(Grid, RowsAndCellsSeeTheSameValues) {
  Grid<int> grid(GridFrame{7, 5, 0.1, 0.0, 0.0}, 3);
  grid[{6, 4}] = 9;
  EXPECT_EQ(grid.row(4)[6], 9);
  EXPECT_EQ(grid.cells().back(), 9);
  EXPECT_EQ(grid.cells().size(), 35u);
  EXPECT_EQ((grid[{0, 0}]), 3);
}

TEST(Grid, NothingIsKnownBeyondTheMap) {
  OccupancyGrid map({2, 1, 0.5, 0.0, 0.0}, Occupancy::Free);
  map[{1, 0}] = Occupancy::Occupied;
  EXPECT_EQ(occupancy_at(map, {0.2, 0.2}), Occupancy::Free);
  EXPECT_EQ(occupancy_at(map, {0.7, 0.2}), Occupancy::Occupied);
  for (const mrpt::math::TPoint2D& p : {mrpt::math::TPoint2D{-0.1, 0.2}, {1.1, 0.2}, {0.2, -0.1}, {0.2, 0.6}})
    EXPECT_EQ(occupancy_at(map, p), Occupancy::Unknown);
}

TEST(Lists, WhatHasTheSameStampStaysInItsOrder) {
  struct Said {
    Stamp stamp;
    int number;
  };
  std::vector<Said> said{{{20}, 0}, {{10}, 1}, {{20}, 2}};
  append(said, std::vector<Said>{{{10}, 3}, {{5}, 4}});
  sort_by_stamp(said);
  std::vector<int> numbers;
  for (const Said& one : said) numbers.push_back(one.number);
  EXPECT_EQ(numbers, (std::vector<int>{4, 1, 3, 0, 2}));
}

TEST(NumberText, PlacesHaveATenthOfAMillimetre) {
  EXPECT_EQ(metres_text(1.0 / 3.0), "0.3333");
  EXPECT_EQ(metres_text(1.2), "1.2");
  EXPECT_EQ(metres_text(0.84024905), "0.8402");
}

TEST(NumberText, ReadsWholeFiniteDecimalsOnly) {
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("+2."), 2.0);
  EXPECT_EQ(parse_number("1e-3"), 0.001);
  for (const char* bad :
       {"", "-", "+", ".", "e3", "1x", " 1", "1 ", "inf", "-nan", "0x1", "1e999", "+-1", "++1", "1,5"})
    EXPECT_FALSE(parse_number(bad)) << bad;
  EXPECT_EQ(parse_integer("-9223372036854775808"), INT64_MIN);
  EXPECT_EQ(parse_integer("+7"), 7);
  for (const char* bad : {"", "9223372036854775808", "1.0", "1e3", "0x1", "+-1", " 1"})
    EXPECT_FALSE(parse_integer(bad)) << bad;
}

TEST(NumberText, WritesTheShortestTextThatReadsBackTheSame) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-45.0), "-45");
  Rng rng(4, "numbers");
  for (int i = 0; i < 10000; ++i) {
    const double exponent = rng.uniform(-300.0, 300.0);
    const double value = rng.gaussian() * std::pow(10.0, exponent);
    ASSERT_EQ(parse_number(number_text(value)), value);
  }
}

TEST(Words, TheEditDistanceIsAMetricOnSlipsOfTheFinger) {
  EXPECT_EQ(edit_distance("slope", "slope"), 0u);
  EXPECT_EQ(edit_distance("sloep", "slope"), 1u);  // two neighbours swapped
  EXPECT_EQ(edit_distance("slop", "slope"), 1u);
  EXPECT_EQ(edit_distance("slopes", "slope"), 1u);
  EXPECT_EQ(edit_distance("slape", "slope"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(Words, OnlyANearNeighbourIsSuggested) {
  EXPECT_EQ(did_you_mean("sloep", {"height", "slope"}), ", did you mean 'slope'?");
  EXPECT_EQ(did_you_mean("zzz", {"height", "slope"}), "");
  EXPECT_EQ(did_you_mean("x", {"y"}), "");  // one letter is near to every other
  EXPECT_EQ(did_you_mean("max_rang", {"max_rate", "max_range"}), ", did you mean 'max_range'?");
}

TEST(Words, AnEndingNeedsSomethingBeforeIt) {
  EXPECT_TRUE(ends_with("map.tif", ".tif"));
  EXPECT_FALSE(ends_with(".tif", ".tif"));
  EXPECT_FALSE(ends_with("map.tiff", ".tif"));
  EXPECT_FALSE(ends_with("f", ".tif"));
  EXPECT_FALSE(ends_with("", ""));
}

TEST(Words, MessagesStayOnOneLine) {
  EXPECT_EQ(one_line("a\nb\t\x01"), "a\\nb\\t\\x01");
  EXPECT_EQ(in_quotes("abc", 2), "'ab...'");
  EXPECT_EQ(in_quotes("a\xc3\xa4", 2), "'a...'");  // a letter of two bytes is not cut in half
}

}  // namespace
}  // namespace rubble
