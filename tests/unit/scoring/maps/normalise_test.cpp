#include "scoring/maps/normalise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/error.h"
#include "base/image/geotiff.h"
#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/map_colours.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/scorecard.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class LoadMap : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "rubble_load_map_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void text(const std::string& name, const std::string& content) const { std::ofstream(path(name)) << content; }
  fs::path folder_;
};

double agreement(const OccupancyGrid& a, const OccupancyGrid& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.cells().size(); ++i) same += a.cells()[i] == b.cells()[i] ? 1u : 0u;
  return static_cast<double>(same) / static_cast<double>(a.cells().size());
}

TEST_F(LoadMap, RosMapKeepsClassesScaleAndOrigin) {
  const OccupancyGrid grid = maze({4, 3, 1});
  cv::imwrite(path("map.pgm"), grey_image(grid, 0, 205, 254));
  text("map.yaml",
       "image: map.pgm\nresolution: 0.05\norigin: [-0.5, -0.5, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
       "free_thresh: 0.196\n");
  const LoadedMap map = load_map(path("map.yaml"));
  EXPECT_EQ(map.grid.frame(), grid.frame());
  EXPECT_EQ(agreement(map.grid, grid), 1.0);
  EXPECT_THAT(map.recognised, ::testing::HasSubstr("ROS map"));
}

/// A picture and the yaml beside it: what they say of each other.
TEST_F(LoadMap, RosMapsAreDoubtedWhereYamlAndPictureDoNotFit) {
  const OccupancyGrid grid = padded(maze({4, 3, 1}), 12);
  const cv::Mat usual = grey_image(grid, 0, 205, 254), per_cent = grey_image(grid, 100, 255, 0);
  const auto said_of = [&](const cv::Mat& picture, const std::string& more) {
    cv::imwrite(path("map.pgm"), picture);
    text("map.yaml", "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n" + more);
    return load_map(path("map.yaml")).recognised;
  };
  for (const auto& [picture, more] : std::vector<std::pair<cv::Mat, std::string>>{
           {usual, ""}, {usual, "mode: scale\n"}, {~usual, "negate: 1\n"}, {per_cent, "mode: raw\n"}})
    EXPECT_THAT(said_of(picture, more), ::testing::Not(::testing::HasSubstr(kDoubt))) << more;
  EXPECT_THAT(said_of(per_cent, "mode: raw\n"), ::testing::HasSubstr(", raw"));
  EXPECT_THAT(said_of(usual, "free_thresh: 0.25\n"), ::testing::HasSubstr("greys 205 and 254 are both free"));
  EXPECT_THAT(said_of(usual, "mode: raw\n"), ::testing::HasSubstr("nothing of it is occupied"));
  EXPECT_THAT(said_of(usual, "negate: 1\n"), ::testing::HasSubstr("areas and not lines"));
  EXPECT_THAT(said_of(per_cent, ""), ::testing::HasSubstr("is it of mode raw?"));

  cv::Mat blurred, named, larger;
  cv::GaussianBlur(grey_image(grid, 0, 128, 254), blurred, {}, 3.0);
  for (const char* mode : {"trinary", "scale"})
    EXPECT_THAT(said_of(blurred, "mode: " + std::string(mode) + "\n"), ::testing::HasSubstr("run into each other"));
  cv::resize(usual, larger, {}, 3, 3, cv::INTER_NEAREST);
  named = larger.clone();
  cv::putText(named, "EXIT", {3 * 40, 3 * 30}, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(0), 1, cv::LINE_AA);
  EXPECT_THAT(said_of(larger, ""), ::testing::Not(::testing::HasSubstr(kDoubt)));
  EXPECT_THAT(said_of(named, ""),
              ::testing::AnyOf(::testing::HasSubstr("words stand on free ground"), ::testing::HasSubstr("as letters")));
}

/// One in league colours is read by these, and says so.
TEST_F(LoadMap, RosMapInLeagueColoursSaysWhatWasRecognised) {
  const OccupancyGrid grid = padded(maze({4, 3, 1}), 12);
  cv::imwrite(path("map.png"), league_image(grid, false));
  text("map.yaml", "image: map.png\nresolution: 0.05\norigin: [0, 0, 0]\n");
  const LoadedMap map = load_map(path("map.yaml"));
  EXPECT_EQ(agreement(map.grid, grid), 1.0);
  EXPECT_THAT(map.recognised, ::testing::HasSubstr(", league colours"));
}

TEST_F(LoadMap, RosMapMayNameATiff) {
  const OccupancyGrid grid = maze({4, 3, 1});
  text("map.yaml", "image: map.tif\nresolution: 0.05\norigin: [-0.5, -0.5, 0.0]\n");
  for (const bool coloured : {false, true}) {
    cv::imwrite(path("map.tif"), coloured ? league_image(grid, false) : grey_image(grid, 0, 205, 254));
    const LoadedMap map = load_map(path("map.yaml"));
    EXPECT_EQ(map.grid.frame(), grid.frame());
    EXPECT_EQ(agreement(map.grid, grid), 1.0) << coloured;
  }
}

/// A run's map: explored ground with a grid, and the robot's way over it, along the grid and across.
TEST(LossyColours, GroundUnderTheWayAndTheGridIsExploredAtAnyAngleAndQuality) {
  OccupancyGrid grid(GridFrame{240, 240, 0.025, 0.0, 0.0});
  for (int y = 20; y < 220; ++y)
    for (int x = 20; x < 220; ++x)
      grid[{x, y}] = x < 22 || y < 22 || x >= 218 || y >= 218 ? Occupancy::Occupied : Occupancy::Free;
  cv::Mat picture = league_image(grid, false);
  std::vector<cv::Point> way;
  for (int i = 0; i < 46; ++i) way.emplace_back(30 + 4 * i, 60 + (i % 7) + (i % 3) * 2);
  for (int i = 0; i < 46; ++i) way.emplace_back(120 + (i % 5), 30 + 4 * i);
  for (int i = 0; i < 46; ++i) way.emplace_back(30 + 4 * i, 200 - 4 * i + (i % 4));
  cv::polylines(picture, way, false, {140, 0, 120}, 1);
  int cases = 0;
  std::size_t turns = 0;
  for (const double degrees : {0.0, 5.0, 13.0, 23.0, 31.0, 45.0}) {
    std::size_t place = turns++;
    for (const int canvas : {-1, 0, 255})
      for (const int quality : {50, 60, 70, 85, 95}) {
        if (!is_tried(place++)) continue;
        const cv::Scalar colour = canvas < 0 ? cv::Scalar(227, 226, 226) : cv::Scalar::all(canvas);
        const TurnedImage t = turned(picture, degrees, cv::INTER_LINEAR, colour);
        std::vector<unsigned char> jpeg;
        cv::imencode(".jpg", t.image, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
        const ClassImage read = classify(to_rgb(cv::imdecode(jpeg, cv::IMREAD_COLOR)));
        // Ground three cells off any wall: where it lies in the picture, and what is said of it there.
        int asked = 0, explored = 0, unexplored = 0;
        for (int y = 0; y < 240; ++y)
          for (int x = 0; x < 240; ++x) {
            const bool inside = x >= 25 && y >= 25 && x < 215 && y < 215;
            const bool outside = x < 15 || y < 15 || x >= 225 || y >= 225;
            if (!inside && !outside) continue;
            const auto turned_to = [&](int i) {
              const double* const m = t.turn.ptr<double>(i);
              return static_cast<int>(std::lround(m[0] * x + m[1] * (239 - y) + m[2]));
            };
            const int column = turned_to(0), row = turned_to(1);
            const Occupancy said = read.classes[{column, t.image.rows - 1 - row}];
            if (inside) ++asked, explored += said == Occupancy::Free ? 1 : 0;
            if (outside) unexplored += said != Occupancy::Unknown ? 1 : 0;
          }
        ++cases;
        EXPECT_GE(explored, 0.995 * asked) << degrees << " deg, canvas " << canvas << ", quality " << quality;
        EXPECT_LE(unexplored, 0.02 * 240 * 240) << degrees << " deg, canvas " << canvas << ", quality " << quality;
      }
  }
  EXPECT_EQ(cases, at_least(90));
}

TEST_F(LoadMap, RosMapHonoursNegate) {
  const OccupancyGrid grid = maze({3, 3, 1});
  cv::imwrite(path("map.png"), grey_image(grid, 255, 128, 0));
  text("map.yaml",
       "image: map.png\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.2\n");
  EXPECT_EQ(agreement(load_map(path("map.yaml")).grid, grid), 1.0);
}

TEST_F(LoadMap, PlacesAndWordsThatNoMapHasAreRefused) {
  cv::imwrite(path("map.png"), grey_image(maze({3, 3, 1}), 0, 205, 254));
  const auto error = [&](const std::string& lines) -> std::string {
    text("map.yaml", lines + "\nresolution: 0.05\n");
    try {
      load_map(path("map.yaml"));
      return "";
    } catch (const InputError& refusal) {
      return refusal.what();
    }
  };
  for (const char* origin : {"[0, 0, 0]", "[-1e6, 5e6, 0]", "[-10, 20]"})
    EXPECT_EQ(error("image: map.png\norigin: " + std::string(origin)), "") << origin;
  for (const char* origin : {"[1e15, 1e15, 0]", "[1e308, 0, 0]", "[0, -1e9, 0]"})
    EXPECT_THAT(error("image: map.png\norigin: " + std::string(origin)),
                ::testing::HasSubstr("farther off than any place on Earth"));
  for (const char* word : {"0", "1", "true", "false", "True", "False"})
    EXPECT_EQ(error("image: map.png\nnegate: " + std::string(word)), "") << word;
  for (const char* word : {"2", "-1", "x", "1e308", ".nan"})
    EXPECT_THAT(error("image: map.png\nnegate: " + std::string(word)), ::testing::HasSubstr("there are 0 and 1"));
  EXPECT_THAT(error("image: \"\""), ::testing::HasSubstr("give the name of the picture"));
  EXPECT_THAT(error("image: \"a\\0b\""), ::testing::HasSubstr("a\\x00b: holds a zero byte"));
  for (const char* corner : {"1e15", "-1e308"}) {
    text("map.pgw", "0.05\n0\n0\n-0.05\n" + std::string(corner) + "\n0\n");
    EXPECT_THROW(load_map(path("map.png")), InputError) << corner;
  }
}

TEST_F(LoadMap, GreyImagesAreUnderstoodWhateverGreyMeansUnknown) {
  const OccupancyGrid grid = maze({5, 4, 2});
  for (const int unknown : {127, 178, 205}) {
    cv::imwrite(path("map.png"), grey_image(grid, 0, unknown, 255));
    EXPECT_EQ(agreement(load_map(path("map.png"), {0.05}).grid, grid), 1.0) << "unknown " << unknown;
  }
}

TEST_F(LoadMap, LeagueMapLosesItsDrawings) {
  const OccupancyGrid grid = maze({6, 5, 3});
  cv::imwrite(path("map.png"), league_image(grid, false));
  EXPECT_EQ(agreement(load_map(path("map.png"), {0.05}).grid, grid), 1.0);
  cv::imwrite(path("drawn.png"), league_image(grid, true));
  const LoadedMap drawn = load_map(path("drawn.png"), {0.05});
  EXPECT_GT(agreement(drawn.grid, grid), 0.993);
  EXPECT_THAT(drawn.recognised, ::testing::HasSubstr("league colours"));
}

TEST_F(LoadMap, APictureOfOneColourShowsNothing) {
  for (const int grey : {0, 205, 255}) {
    cv::imwrite(path("blank.png"), cv::Mat(60, 80, CV_8U, cv::Scalar(grey)));
    const LoadedMap blank = load_map(path("blank.png"), {0.05});
    EXPECT_THAT(blank.recognised, ::testing::HasSubstr("of one colour"));
    for (const Occupancy cell : blank.grid.cells()) ASSERT_EQ(cell, Occupancy::Unknown);
  }
}

TEST_F(LoadMap, GeoTiffBringsItsOwnScaleAndPlace) {
  const OccupancyGrid grid = maze({4, 4, 4});
  GeoTiff tiff;
  tiff.image = to_rgb(league_image(grid, true));
  tiff.transform = georeference(grid.frame().x0, grid.frame().y0 + grid.height() * 0.05, 0.05, std::nullopt, tiff.epsg);
  write_geotiff(path("map.tif"), tiff);
  const LoadedMap map = load_map(path("map.tif"));
  EXPECT_NEAR(map.grid.resolution(), 0.05, 1e-12);
  EXPECT_NEAR(map.grid.frame().x0, grid.frame().x0, 1e-9);
  EXPECT_NEAR(map.grid.frame().y0, grid.frame().y0, 1e-9);
  EXPECT_GT(agreement(map.grid, grid), 0.99);
}

/// Web Mercator stretches lengths by the secant of the latitude, seen from a sphere; on the ellipsoid by 0.4 % less
/// here.
TEST_F(LoadMap, WebMercatorIsScaledToTheGround) {
  const OccupancyGrid grid = maze({4, 4, 4});
  constexpr double kRadius = 6378137.0;
  for (const double latitude_deg : {-60.0, 0.0, 50.0}) {
    const double latitude = latitude_deg * kPi / 180.0;
    GeoTiff tiff;
    tiff.image = to_rgb(league_image(grid, false));
    tiff.epsg = 3857;
    tiff.transform = PixelToModel{0.1, 0.0, 800000.0, 0.0, -0.1, kRadius * std::asinh(std::tan(latitude))};
    write_geotiff(path("map.tif"), tiff);
    const LoadedMap map = load_map(path("map.tif"));
    EXPECT_NEAR(map.grid.resolution(), 0.1 * std::cos(latitude), 0.1 * std::cos(latitude) * 0.0051);
    EXPECT_EQ(map.origin, MapOrigin::Earth);
    EXPECT_THAT(map.recognised, ::testing::HasSubstr("Mercator"));
    // A point in the file's coordinates is found at its pixel.
    const mrpt::math::TPoint2D p =
        in_grid(map, {tiff.transform->c + 0.1 * 12.0, tiff.transform->f - 0.1 * (grid.height() - 5.0)});
    EXPECT_NEAR((p.x - map.grid.frame().x0) / map.grid.resolution(), 12.0, 1e-4);
    EXPECT_NEAR((p.y - map.grid.frame().y0) / map.grid.resolution(), 5.0, 1e-4);
  }
}

TEST_F(LoadMap, WhatIsNoMapOfOccupancyIsRefusedByName) {
  cv::Mat labels(200, 300, CV_8U, cv::Scalar(0));
  for (int i = 0; i < 6; ++i)
    cv::rectangle(labels, {10 + 45 * i, 20}, {45 + 45 * i, 180}, cv::Scalar(40 + 30 * i), cv::FILLED);
  cv::imwrite(path("rooms.png"), labels);
  cv::imwrite(path("map.pgm"), grey_image(maze({4, 3, 1}), 0, 205, 254));
  text("map.yaml", "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nmode: raster\n");
  text("double.png.aux.xml", "<PAMDataset><GeoTransform>0, 0.05, 0, 4</GeoTransform></PAMDataset>");
  cv::imwrite(path("double.png"), grey_image(maze({4, 3, 1}), 0, 205, 254));
  for (const auto& [file, words] : {std::pair{"rooms.png", "room labels"},
                                    {"map.yaml", "trinary, scale and raw"},
                                    {"double.png", "GeoTransform is no list of six numbers"}}) {
    SCOPED_TRACE(file);
    try {
      load_map(path(file), {std::string(file) == "rooms.png" ? std::optional<double>(0.05) : std::nullopt});
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(words));
    }
  }
}

/// Programs set a no-data value of 0 unasked, and walls are 0 too.
TEST_F(LoadMap, AreasOfNoDataAreUnknownButWallsStay) {
  const OccupancyGrid grid = maze({6, 5, 3});
  RgbImage image = to_rgb([&] {
    cv::Mat bgr;
    cv::cvtColor(grey_image(grid, 0, 0, 254), bgr, cv::COLOR_GRAY2BGR);
    return bgr;
  }());
  SampleNotes notes;
  notes.no_data.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < notes.no_data.size(); ++i) notes.no_data[i] = image.rgb[3 * i] == 0 ? 1 : 0;
  const ClassImage read = classify(image, notes);
  // The outer walls are one with what is unknown outside of them.
  const auto is_inside = [&](Cell c) {
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx)
        if (grid.inside({c.x + dx, c.y + dy}) && grid[{c.x + dx, c.y + dy}] == Occupancy::Unknown) return false;
    return true;
  };
  int walls = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] == Occupancy::Unknown) {
        ASSERT_EQ((read.classes[{x, y}]), Occupancy::Unknown);
      }
      if (grid[{x, y}] != Occupancy::Occupied || !is_inside({x, y})) continue;
      ++walls;
      ASSERT_EQ((read.classes[{x, y}]), Occupancy::Occupied);
    }
  EXPECT_GT(walls, 300);
}

TEST_F(LoadMap, TurnedWithInterpolationItScoresTheSame) {
  const OccupancyGrid grid = maze({7, 7, 5});
  for (const bool league : {false, true}) {
    cv::Mat image = league ? league_image(padded(grid, 20), true) : grey_image(padded(grid, 20), 0, 205, 254);
    const int side = static_cast<int>(1.5 * std::max(image.cols, image.rows));
    cv::Mat turn = cv::getRotationMatrix2D(cv::Point2d(0.5 * image.cols, 0.5 * image.rows), 37.0, 1.0);
    turn.at<double>(0, 2) += 0.5 * (side - image.cols);
    turn.at<double>(1, 2) += 0.5 * (side - image.rows);
    for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR}) {
      for (const cv::Scalar& canvas : {cv::Scalar::all(0), cv::Scalar::all(255)}) {
        SCOPED_TRACE(std::string(league ? "league" : "grey") +
                     (interpolation == cv::INTER_LINEAR ? ", linear" : ", nearest") + ", canvas " +
                     std::to_string(canvas[0]));
        cv::Mat turned;
        cv::warpAffine(image, turned, turn, {side, side}, interpolation, cv::BORDER_CONSTANT, canvas);
        cv::imwrite(path("turned.png"), turned);
        const MapScore score = score_map(load_map(path("turned.png"), {0.05}).grid, grid);
        EXPECT_TRUE(score.aligned) << score.note;
        EXPECT_GT(score.score, 0.97);
      }
    }
  }
}

// JPEG halves the colours' resolution and smears them over blocks of 16 pixels; brightness still shows the walls.
TEST_F(LoadMap, JpegKeepsTheScoreOfALeagueMap) {
  std::size_t turns = 0;
  for (const std::uint64_t seed : {5u, 6u}) {
    const OccupancyGrid grid = maze({7, 7, seed});
    const cv::Mat straight = league_image(padded(grid, 20), true);
    for (const double degrees : {0.0, 13.0, 37.0}) {
      std::size_t place = turns++;
      const int side = static_cast<int>(1.5 * std::max(straight.cols, straight.rows));
      cv::Mat turn = cv::getRotationMatrix2D(cv::Point2d(0.5 * straight.cols, 0.5 * straight.rows), degrees, 1.0);
      turn.at<double>(0, 2) += 0.5 * (side - straight.cols);
      turn.at<double>(1, 2) += 0.5 * (side - straight.rows);
      cv::Mat turned;
      cv::warpAffine(straight, turned, turn, {side, side}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, {227, 226, 226});
      cv::imwrite(path("clean.png"), turned);
      const MapScore clean = score_map(load_map(path("clean.png"), {0.05}).grid, grid);
      for (const int quality : {60, 75, 85, 95}) {
        if (!is_tried(place++)) continue;
        SCOPED_TRACE(std::to_string(degrees) + " deg, quality " + std::to_string(quality));
        cv::imwrite(path("map.jpg"), turned, {cv::IMWRITE_JPEG_QUALITY, quality});
        const MapScore score = score_map(load_map(path("map.jpg"), {0.05}).grid, grid);
        EXPECT_TRUE(score.aligned) << score.note;
        EXPECT_NEAR(score.overlap, clean.overlap, 0.02);
        EXPECT_NEAR(score.score, clean.score, 0.02);
      }
    }
  }
}

TEST_F(LoadMap, OnlyCompressionMakesColoursRun) {
  const cv::Mat clean = league_image(padded(maze({6, 6, 2}), 10), true);
  EXPECT_FALSE(has_run_colours(to_rgb(clean)));
  const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2d(0.5 * clean.cols, 0.5 * clean.rows), 20.0, 0.9);
  for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR, cv::INTER_CUBIC, cv::INTER_LANCZOS4}) {
    cv::Mat turned;
    cv::warpAffine(clean, turned, turn, clean.size(), interpolation, cv::BORDER_CONSTANT, {255, 255, 255});
    EXPECT_FALSE(has_run_colours(to_rgb(turned))) << interpolation;
    cv::imwrite(path("map.jpg"), turned, {cv::IMWRITE_JPEG_QUALITY, 80});
    EXPECT_TRUE(has_run_colours(to_rgb(cv::imread(path("map.jpg"))))) << interpolation;
  }
  EXPECT_FALSE(has_run_colours(RgbImage()));
}

TEST_F(LoadMap, DeepImagesAreScaledByTheRangeTheyUse) {
  const OccupancyGrid grid = maze({5, 4, 2});
  const cv::Mat grey = grey_image(grid, 0, 205, 254);
  const cv::Mat league = league_image(grid, false);
  for (const double factor : {1.0, 260.0 / 254.0, 4.0, 16.0, 30000.0 / 254.0, 50000.0 / 254.0, 257.0})
    for (const char* name : {"deep.png", "deep.pgm"}) {
      SCOPED_TRACE(std::string(name) + " times " + std::to_string(factor));
      cv::Mat deep;
      grey.convertTo(deep, CV_16U, factor);
      cv::imwrite(path(name), deep);
      const LoadedMap map = load_map(path(name), {0.05});
      EXPECT_EQ(agreement(map.grid, grid), 1.0);
      EXPECT_EQ(map.recognised.find("brightest") != std::string::npos,
                factor != 1.0 && factor != 4.0 && factor != 16.0 && factor != 257.0)
          << map.recognised;
      if (std::string(name) != "deep.png") continue;
      league.convertTo(deep, CV_16U, factor == 1.0 ? 1.0 : 257.0);
      cv::imwrite(path(name), deep);
      EXPECT_EQ(agreement(load_map(path(name), {0.05}).grid, grid), 1.0);
    }
}

TEST_F(LoadMap, RosMapsInLeagueColoursAreReadByThese) {
  const OccupancyGrid grid = maze({5, 4, 2});
  text("map.yaml", "image: map.png\nresolution: 0.05\norigin: [-1, 2, 0]\n");
  cv::imwrite(path("map.png"), league_image(grid, false));
  const OccupancyGrid read = load_map(path("map.yaml")).grid;
  EXPECT_EQ(agreement(read, grid), 1.0);
  EXPECT_EQ(read.frame().x0, -1.0);
}

TEST_F(LoadMap, TransparentPixelsAreUnknown) {
  // Unknown cells transparent, whatever colour lies below, in grey maps and league maps of 8 and 16 bits.
  const OccupancyGrid grid = maze({5, 4, 2});
  for (const bool league : {false, true})
    for (const int below : {0, 255})
      for (const bool deep : {false, true}) {
        SCOPED_TRACE(std::to_string(league) + " " + std::to_string(below) + " " + std::to_string(deep));
        cv::Mat bgr = league ? league_image(grid, false) : grey_image(grid, 0, 205, 254);
        if (!league) cv::cvtColor(bgr, bgr, cv::COLOR_GRAY2BGR);
        cv::Mat image;
        cv::cvtColor(bgr, image, cv::COLOR_BGR2BGRA);
        for (int y = 0; y < image.rows; ++y)
          for (int x = 0; x < image.cols; ++x)
            if (grid[{x, grid.height() - 1 - y}] == Occupancy::Unknown) {
              const auto b = static_cast<unsigned char>(below);
              image.at<cv::Vec4b>(y, x) = {b, b, b, 0};
            }
        if (deep) image.convertTo(image, CV_16U, 257.0);
        cv::imwrite(path("map.png"), image);
        EXPECT_EQ(agreement(load_map(path("map.png"), {0.05}).grid, grid), 1.0);
      }
}

TEST_F(LoadMap, BlurredAndShrunkenPicturesAreNoticed) {
  for (const std::uint64_t seed : {3u, 4u}) {
    MazeSpec spec;
    spec.seed = seed;
    const cv::Mat sharp = grey_image(maze(spec), 0, 128, 255);
    cv::Mat blurred, smaller, larger, turned;
    cv::GaussianBlur(sharp, blurred, {9, 9}, 1.8);
    cv::resize(sharp, smaller, {}, 0.37, 0.37, cv::INTER_AREA);
    cv::resize(sharp, larger, {}, 2.0, 2.0, cv::INTER_LINEAR);
    cv::warpAffine(sharp, turned, cv::getRotationMatrix2D({100, 100}, 13.0, 1.0), sharp.size(), cv::INTER_CUBIC,
                   cv::BORDER_CONSTANT, 128);
    const auto told = [&](const cv::Mat& image, const std::string& name) {
      cv::imwrite(path(name), image);
      return load_map(path(name), {0.05}).recognised.find("pale") != std::string::npos;
    };
    EXPECT_TRUE(told(blurred, "blurred.png")) << "seed " << seed;
    EXPECT_TRUE(told(smaller, "smaller.png")) << "seed " << seed;
    EXPECT_FALSE(told(sharp, "sharp.png")) << "seed " << seed;
    EXPECT_FALSE(told(larger, "larger.png")) << "seed " << seed;
    EXPECT_FALSE(told(turned, "turned.png")) << "seed " << seed;
    EXPECT_FALSE(told(sharp, "sharp.jpg")) << "seed " << seed;
  }
}

TEST_F(LoadMap, BadInputIsOneLineWithTheRemedy) {
  const auto message = [&](const std::string& file, const LoadOptions& options = {}) {
    try {
      load_map(file, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const OccupancyGrid grid = maze({2, 2, 1});
  cv::imwrite(path("plain.png"), grey_image(grid, 0, 205, 254));
  text("broken.png", "not a picture");
  text("broken.tif", "not a picture");
  text("broken.yaml", "image: [");
  text("lonely.yaml", "image: nowhere.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  GeoTiff bare;
  bare.image = to_rgb(league_image(grid, false));
  write_geotiff(path("bare.tif"), bare);
  EXPECT_THAT(message(path("plain.png")), ::testing::HasSubstr("--resolution"));
  EXPECT_THAT(message(path("bare.tif")), ::testing::HasSubstr("--resolution"));
  EXPECT_THAT(message(path("plain.png"), {50.0}), ::testing::HasSubstr("50"));
  EXPECT_THAT(message(path("lonely.yaml")), ::testing::HasSubstr("nowhere.pgm"));
  for (const std::string& file : {path("absent.png"), path("absent.tif"), path("absent.yaml"), path("broken.png"),
                                  path("broken.tif"), path("broken.yaml"), path("plain.png")}) {
    const std::string what = message(file);
    EXPECT_THAT(what, ::testing::HasSubstr(fs::path(file).filename().string()));
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace rubble::scoring
