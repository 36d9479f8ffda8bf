#include "scoring/maps/colours/lettering.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "scoring/measures/sight_lines.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

cv::Mat classes_of(const OccupancyGrid& grid) {
  cv::Mat out(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      out.at<unsigned char>(grid.height() - 1 - y, x) = static_cast<unsigned char>(grid[{x, y}]);
  return out;
}

cv::Mat with_words(cv::Mat classes, const std::string& words, const cv::Point& at, int font, double size, int pen) {
  cv::putText(classes, words, at, font, size, cv::Scalar(static_cast<int>(Occupancy::Occupied)), pen, cv::LINE_8);
  return classes;
}

OccupancyGrid grid_of(const cv::Mat& classes, const OccupancyGrid& like) {
  OccupancyGrid out(like.frame());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out[{x, y}] = static_cast<Occupancy>(classes.at<unsigned char>(out.height() - 1 - y, x));
  return out;
}

/// A hall of 12 m with a wall of 1.2 m, cells of 0.05 m.
cv::Mat hall() {
  cv::Mat out(260, 260, CV_8U, cv::Scalar(static_cast<int>(Occupancy::Unknown)));
  cv::rectangle(out, {10, 10}, {249, 249}, cv::Scalar(static_cast<int>(Occupancy::Occupied)), cv::FILLED);
  cv::rectangle(out, {12, 12}, {247, 247}, cv::Scalar(static_cast<int>(Occupancy::Free)), cv::FILLED);
  cv::rectangle(out, {60, 200}, {84, 201}, cv::Scalar(static_cast<int>(Occupancy::Occupied)), cv::FILLED);
  return out;
}

TEST(Lettering, WordsOnFreeGroundGoAndNothingElse) {
  const cv::Mat before = hall();
  for (const char* words : {"HECTOR", "Team 7", "start", "arena 2026", "GETBOTS", "Victim 1", "robin"})
    for (const int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_COMPLEX})
      for (const bool upright : {false, true}) {
        SCOPED_TRACE(words + std::string(upright ? " upright" : "") + ", font " + std::to_string(font));
        cv::Mat expected = before.clone();
        cv::Mat map = with_words(before.clone(), words, {20, 120}, font, 1.0, 1);
        if (upright) {
          cv::rotate(map, map, cv::ROTATE_90_COUNTERCLOCKWISE);
          cv::rotate(before, expected, cv::ROTATE_90_COUNTERCLOCKWISE);
        }
        EXPECT_GE(erase_lettering(map), 3);
        EXPECT_EQ(cv::countNonZero(map != expected), 0);
      }
}

/// What cannot be told from walls stays: single strokes, two letters.
TEST(Lettering, WhatMayBeAWallStays) {
  for (const auto& [words, at] :
       std::vector<std::pair<std::string, cv::Point>>{{"LLL", {60, 120}}, {"IIIII", {60, 120}}, {"EA", {60, 120}}}) {
    cv::Mat map = with_words(hall(), words, at, cv::FONT_HERSHEY_SIMPLEX, 1.0, 1);
    EXPECT_EQ(erase_lettering(map), 0) << words;
  }
}

/// A name between the walls of an arena costs lines of sight, unless it is known for one.
TEST(Lettering, ANameInAnArenaDoesNotCostItsScore) {
  const OccupancyGrid truth = truth_of({"maze", 7, 7, 3});
  const SightLines sights(truth);
  double written = 0.0;
  double read = 0.0;
  int places = 0;
  for (int y = 30; y < truth.height() - 30; y += 6)
    for (int x = 30; x < truth.width() - 60 && places < 20; x += 8) {
      const cv::Mat plain = classes_of(truth);
      cv::Mat map = with_words(plain.clone(), "ROB7", {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, 1);
      const cv::Rect around(x - 3, y - 13, 42, 17);
      if (cv::countNonZero(plain(around) != static_cast<int>(Occupancy::Free)) > 0) continue;
      written += sights.at(grid_of(map, truth), PlanarTransform()).score;
      erase_lettering(map);
      EXPECT_EQ(cv::countNonZero(map != plain), 0) << x << ", " << y;
      read += sights.at(grid_of(map, truth), PlanarTransform()).score;
      ++places;
    }
  ASSERT_GE(places, 3);
  EXPECT_LT(written / places, 0.995);
  EXPECT_NEAR(read / places, 1.0, 1e-9);
}

TEST(Lettering, WallsBlocksAndNoiseStay) {
  const auto untouched = [](const OccupancyGrid& grid, const std::string& what) {
    cv::Mat map = classes_of(grid);
    EXPECT_EQ(erase_lettering(map), 0) << what;
  };
  for (const char* kind : {"maze", "yellow", "orange", "red"})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Ground ground{kind, 5 + static_cast<int>(seed % 5), 8, seed};
      const OccupancyGrid truth = truth_of(ground);
      untouched(truth, ground.name());
      untouched(with_gaps(with_phantoms(truth, 12, seed), 30, seed), ground.name() + " worn");
      untouched(ragged(truth, 1, seed), ground.name() + " ragged");
      for (const double share : {0.01, 0.05, 0.2}) untouched(with_salt(truth, share, seed), ground.name() + " salted");
      untouched(moved(truth, 0.3 + 0.1 * static_cast<double>(seed), 0.0, 0.0), ground.name() + " turned");
      untouched(moved(truth, 0.0, 0.0, 0.0, 0.02), ground.name() + " fine");
    }
}

cv::Mat larger(const cv::Mat& classes, int pixels) {
  cv::Mat out;
  cv::resize(classes, out, {}, pixels, pixels, cv::INTER_NEAREST);
  return out;
}

/// Pieces of ragged walls are as high as letters there, but of whole cells.
TEST(Lettering, RaggedWallsStayAlsoWhereEachCellIsASquareOfPixels) {
  for (const auto& [kind, columns, seed] : std::vector<std::tuple<const char*, int, std::uint64_t>>{
           {"maze", 5, 25}, {"yellow", 5, 29}, {"maze", 5, 39}, {"maze", 7, 50}, {"maze", 5, 57}, {"maze", 7, 106}})
    for (const int pixels : {2, 3, 4}) {
      const Ground ground{kind, columns, 6, seed};
      cv::Mat map = larger(classes_of(ragged(truth_of(ground), 1, seed + 1)), pixels);
      EXPECT_EQ(erase_lettering(map), 0) << ground.name() << ", " << pixels << " pixels a cell";
    }
}

/// In a pen finer than the cells, over walls of any kind: it goes, or what is left of it is told.
TEST(Lettering, WordsFinerThanTheCellsGoOrAreTold) {
  for (const std::uint64_t seed : {401U, 402U, 403U})
    for (const bool worn : {false, true})
      for (const int pixels : {2, 3}) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << (worn ? ", ragged, " : ", ") << pixels << " pixels");
        const OccupancyGrid truth = truth_of({"maze", 6, 6, seed});
        const cv::Mat before = larger(classes_of(worn ? ragged(truth, 1, seed) : truth), pixels);
        EXPECT_EQ(perhaps_words(before), 0);
        for (const char* words : {"EXIT", "kitchen", "Lab 4", "goal"}) {
          cv::Mat map =
              with_words(before.clone(), words, pixels * cv::Point(38, 46), cv::FONT_HERSHEY_SIMPLEX, 0.17 * pixels, 1);
          ASSERT_GT(cv::countNonZero(map != before), 0);
          erase_lettering(map);
          EXPECT_TRUE(cv::countNonZero(map != before) == 0 || perhaps_words(map) > 0) << words;
        }
      }
}

}  // namespace
}  // namespace rubble::scoring
