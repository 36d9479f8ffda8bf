#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "base/image/geotiff.h"
#include "base/image/png.h"
#include "base/rng.h"
#include "scenarios/run/run_folder.h"
#include "scoring/maps/league_map.h"
#include "scoring/maps/normalise.h"
#include "scoring/maps/ros_map.h"
#include "scoring/maps/victim_symbols.h"
#include "tests/support/base_files.h"
#include "tests/support/symbols_pictures.h"

/// What the league map shows is what its list of victims says.
namespace rubble::scenarios {
namespace {

using mrpt::math::TPoint2D;
using namespace symbols_test;

/// A room of 10 x 8 m with a wall across, seen once from the middle.
slam::CountMap room_walls() {
  slam::CountMap map(260, 260, 0.05);
  slam::ScanPoints scan;
  scan.beam_width = deg_to_rad(0.25);
  for (int i = 0; i < 1440; ++i) {
    const double angle = deg_to_rad(0.25 * i) - kPi;
    const double x = 5.0 / std::max(1e-9, std::abs(std::cos(angle)));
    const double y = 4.0 / std::max(1e-9, std::abs(std::sin(angle)));
    double range = std::min(x, y);
    const double wall = 2.0 / std::max(1e-9, std::cos(angle));  // at x = 2, y from -2 to 1
    const double meets = wall * std::sin(angle);
    if (std::cos(angle) > 0.0 && meets > -2.0 && meets < 1.0) range = std::min(range, wall);
    scan.hits.push_back({range * std::cos(angle), range * std::sin(angle)});
  }
  map.stamp({}, scan);
  return map;
}

/// Victims anywhere, on walls and on the path too, at least `apart` from each other.
std::vector<scoring::LeagueVictim> victims(std::uint64_t seed, int count, double apart) {
  Rng rng(seed, "victims");
  std::vector<scoring::LeagueVictim> out;
  while (static_cast<int>(out.size()) < count) {
    const TPoint2D p(rng.uniform(-5.0, 5.0), rng.uniform(-4.0, 4.0));
    bool free = true;
    for (const auto& other : out) free = free && (other.p_map - p).norm() >= apart;
    if (!free) continue;
    scoring::LeagueVictim report;
    report.id = static_cast<int>(out.size()) + 1;
    report.p_map = p;
    out.push_back(report);
  }
  return out;
}

scoring::LeagueDrawing drawing(const std::vector<scoring::LeagueVictim>& victims, double resolution) {
  scoring::LeagueDrawing out;
  out.resolution = resolution;
  out.title = "RoboCup-map.tif";
  out.victims = victims;
  for (int i = 0; i < 100; ++i) out.path.push_back({Stamp{}, {-4.0 + 0.08 * i, std::sin(0.2 * i), 0.0}});
  return out;
}

double nearest(const std::vector<scoring::Poi>& symbols, const TPoint2D& p) {
  double out = 1e9;
  for (const scoring::Poi& symbol : symbols) out = std::min(out, (symbol.p_picture - p).norm());
  return out;
}

TEST(LeagueSymbols, LieWhereTheListOfTheSameMapSays) {
  const test::TempFolder folder;
  const slam::CountMap map = room_walls();
  for (const double resolution : {0.0125, 0.025, 0.05})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(std::to_string(resolution) + " m, seed " + std::to_string(seed));
      const auto reports = victims(seed, 12, 0.5);
      write_geotiff(folder / "map.tif", draw_league_map(league_cells(map), drawing(reports, resolution)));
      const scoring::LoadedMap loaded = scoring::load_map(folder / "map.tif");
      EXPECT_EQ(loaded.symbols.size(), reports.size());
      // Drawing rounds to pixels, lettering hides some: a pixel, half a map cell at 0.025 m. Where 12 in white hides
      // most of a circle of 9 pixels it is more.
      const double tolerance = resolution < 0.04 ? resolution : 1.6 * resolution;
      for (const auto& report : reports)
        EXPECT_LE(nearest(loaded.symbols, {-report.p_map.y, report.p_map.x}), tolerance) << report.id;
    }
}

TEST(LeagueSymbols, VictimsAtTheLeastDistanceOfTheirMergingStayApart) {
  // Reports nearer than 0.8 m to each other are merged; circles overlap from 0.35 m on.
  const slam::CountMap map = room_walls();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    auto reports = victims(seed, 5, 1.0);
    for (int i = 0; i < 5; ++i) {
      scoring::LeagueVictim twin = reports[static_cast<std::size_t>(i)];
      twin.id += 5;
      twin.p_map += TPoint2D(0.25 * std::cos(1.3 * i), 0.25 * std::sin(1.3 * i));
      reports.push_back(twin);
    }
    const GeoTiff tiff = draw_league_map(league_cells(map), drawing(reports, 0.025));
    EXPECT_EQ(scoring::find_victim_symbols(tiff.image, 0.025).size(), reports.size()) << "seed " << seed;
  }
}

TEST(LeagueSymbols, SurviveTurningAndJpeg) {
  const slam::CountMap map = room_walls();
  const auto reports = victims(3, 10, 0.6);
  for (const double resolution : {0.0125, 0.025}) {
    const GeoTiff tiff = draw_league_map(league_cells(map), drawing(reports, resolution));
    const auto straight = scoring::find_victim_symbols(tiff.image, resolution);
    ASSERT_EQ(straight.size(), reports.size());
    for (const double degrees : {-8.0, 37.0, 90.0})
      for (const int quality : {100, 85, 75}) {
        SCOPED_TRACE(std::to_string(degrees) + " deg, quality " + std::to_string(quality));
        const Turned turn = turned(tiff.image, degrees, cv::INTER_LINEAR);
        const auto found =
            scoring::find_victim_symbols(quality == 100 ? turn.image : jpeg(turn.image, quality), resolution);
        EXPECT_EQ(found.size(), straight.size());
        for (const auto& symbol : straight) {
          const cv::Point2d p = turn({symbol.column, symbol.row});
          double least = 1e9;
          for (const auto& other : found) least = std::min(least, std::hypot(other.column - p.x, other.row - p.y));
          EXPECT_LE(least, 1.2);
        }
      }
  }
}

TEST(LeagueSymbols, AnyFormatOfTheMapHasTheSame) {
  const test::TempFolder folder;
  const auto reports = victims(5, 6, 0.5);
  const slam::CountMap map = room_walls();
  const GeoTiff tiff = draw_league_map(league_cells(map), drawing(reports, 0.025));
  write_geotiff(folder / "map.tif", tiff);
  write_png(folder / "map.png", tiff.image);
  write_world_file(folder / "map.wld", *tiff.transform);
  const auto of_tiff = scoring::load_map(folder / "map.tif").symbols;
  const auto of_png = scoring::load_map(folder / "map.png").symbols;
  ASSERT_EQ(of_tiff.size(), 6u);
  ASSERT_EQ(of_png.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_LT((of_tiff[i].p_picture - of_png[i].p_picture).norm(), 1e-6);
}

TEST(LeagueSymbols, WhatWasSearchedIsGreenAndReadAsBefore) {
  const test::TempFolder folder;
  const slam::CountMap map = room_walls();
  scoring::LeagueDrawing plain = drawing({}, 0.025), searched = plain;
  searched.searched = [](const TPoint2D& p) { return p.y > 0.0; };
  const GeoTiff tiff = draw_league_map(league_cells(map), searched);
  write_geotiff(folder / "searched.tif", tiff);
  write_geotiff(folder / "plain.tif", draw_league_map(league_cells(map), plain));
  EXPECT_EQ(scoring::load_map(folder / "searched.tif").grid.cells(),
            scoring::load_map(folder / "plain.tif").grid.cells());
  std::size_t green = 0, white = 0;
  for (int row = 0; row < tiff.image.height; ++row)
    for (int column = 0; column < tiff.image.width; ++column) {
      const std::uint8_t* p = tiff.image.pixel(column, row);
      const double y = -(tiff.transform->c + (column + 0.5) * tiff.transform->a);  // easting is -y
      const bool is_green = p[1] == 230 && p[0] == p[2] && p[0] >= 130 && p[0] <= 180;
      const bool is_white = p[0] == 255 && p[1] == 255 && p[2] == 255;
      green += is_green ? 1 : 0;
      white += is_white ? 1 : 0;
      EXPECT_TRUE(!is_green || y > -0.03);
      EXPECT_TRUE(!is_white || y < 0.03);
    }
  EXPECT_GT(green, 20000u);
  EXPECT_GT(white, 20000u);
}

TEST(LeagueSymbols, AGreyMapAndAMapWithoutVictimsHaveNone) {
  const test::TempFolder folder;
  const slam::CountMap map = room_walls();
  const GeoTiff tiff = draw_league_map(league_cells(map), drawing({}, 0.025));
  write_geotiff(folder / "map.tif", tiff);
  EXPECT_TRUE(scoring::load_map(folder / "map.tif").symbols.empty());
  scoring::write_ros_map(folder / "ros", map.classify(), 0.5);
  EXPECT_TRUE(scoring::load_map(folder / "ros.yaml").symbols.empty());
  EXPECT_TRUE(scoring::load_map(folder / "ros.pgm", {0.05}).symbols.empty());
  // A grey picture with red circles is no league map, and they are no victims.
  RgbImage grey(200, 200);
  std::fill(grey.rgb.begin(), grey.rgb.end(), std::uint8_t{205});
  cv::Mat m = view(grey);
  cv::rectangle(m, {50, 50}, {150, 150}, {255, 255, 255}, cv::FILLED);
  cv::rectangle(m, {50, 50}, {150, 150}, {0, 0, 0}, 2);
  cv::circle(m, {80, 80}, 4, {240, 10, 10}, cv::FILLED);
  write_png(folder / "grey.png", grey);
  EXPECT_TRUE(scoring::load_map(folder / "grey.png", {0.05}).symbols.empty());
}

}  // namespace
}  // namespace rubble::scenarios
