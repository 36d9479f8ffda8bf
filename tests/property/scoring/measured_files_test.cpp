#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/planar.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/normalise.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/overlap.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/tiff_pages.h"

/// Maps that are no pictures: masks of free ground, labels, probabilities. What a value stands for is told by the shape
/// and place of what has it.
namespace rubble::scoring {
namespace {

using namespace testing;
namespace fs = std::filesystem;

/// How samples are stored.
struct Kind {
  const char* name;
  std::uint16_t bits, format;
  bool can_hold(double value) const {
    if (format == SAMPLEFORMAT_UINT) return value >= 0.0;
    return format != SAMPLEFORMAT_INT || bits > 8 || value < 128.0;
  }
};

constexpr Kind kFloat{"float", 32, SAMPLEFORMAT_IEEEFP}, kDouble{"double", 64, SAMPLEFORMAT_IEEEFP};

/// What stands for the classes.
struct Values {
  double wall, unknown, free;
  std::string no_data{};
};

class MeasuredFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "rubble_measured_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string tiff_of(const OccupancyGrid& map, const Kind& kind, const Values& values) const {
    TiffStyle style;
    style.bits = kind.bits;
    style.format = kind.format;
    style.no_data = values.no_data;
    style.value = [&](int level) { return level == 0 ? values.wall : level == 255 ? values.free : values.unknown; };
    const std::string path = (folder_ / "map.tif").string();
    TIFF* const t = TIFFOpen(path.c_str(), "w");
    write_page(t, grey_image(map, 0, 128, 255), style);
    TIFFClose(t);
    return path;
  }
  std::string picture_of(const OccupancyGrid& map, int free, int rest, const std::string& ending) const {
    const std::string path = (folder_ / ("map." + ending)).string();
    EXPECT_TRUE(cv::imwrite(path, grey_image(map, rest, rest, free)));
    return path;
  }
  fs::path folder_;
};

/// A truth, and a map of it.
struct Pair {
  explicit Pair(const Ground& ground, int gaps = 5, int margin = 10)
      : truth(truth_of(ground)),
        sights(truth),
        map(padded(with_gaps(with_phantoms(truth, 3, 5), gaps, 5), margin)),
        score(score_of(map)),
        walls(walls_of(map)) {}
  PlanarTransform pose_of(const OccupancyGrid& read) const {
    return PlanarTransform({map.frame().x0 - read.frame().x0, map.frame().y0 - read.frame().y0, 0.0});
  }
  double score_of(const OccupancyGrid& read) const { return sights.at(read, pose_of(read)).score; }
  double walls_of(const OccupancyGrid& read) const { return overlap(read, truth, pose_of(read).pose(), 0.5).score; }
  OccupancyGrid truth;
  SightLines sights;
  OccupancyGrid map;
  double score, walls;
};

std::string refusal_of(const std::string& path) {
  try {
    load_map(path, {0.05});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::vector<Ground> kGrounds = {{"maze", 7, 7, 5}, {"yellow", 6, 7, 11}, {"orange", 6, 6, 13}};

/// A mask does not tell walls from ground that was never seen; the walls around may have gaps or none.
TEST_F(MeasuredFiles, MasksOfFreeGroundHaveTheScoreOfTheirMapAndSayWhatTheyLeaveOpen) {
  const std::vector<int> all_gaps = {0, 5, 12, 30}, margins = {0, 10, 50};
  const std::vector<std::pair<int, int>> greys = {{255, 0}, {0, 255}, {254, 205}, {200, 90}};
  for (std::size_t g = 0; g < kGrounds.size(); ++g)
    for (std::size_t i = 0; i < all_gaps.size(); ++i)
      for (std::size_t m = 0; m < margins.size(); ++m) {
        const Ground& ground = kGrounds[g];
        const int gaps = all_gaps[i], margin = margins[m];
        const Pair pair(ground, gaps, margin);
        for (std::size_t k = 0; k < greys.size(); ++k) {
          if (!is_tried(g + i + m + k)) continue;
          const auto& [free, rest] = greys[k];
          const LoadedMap read = load_map(picture_of(pair.map, free, rest, "png"), {0.05});
          SCOPED_TRACE(ground.name() + ", " + std::to_string(gaps) + " gaps, margin " + std::to_string(margin) + ", " +
                       std::to_string(free) + " on " + std::to_string(rest) + ": " + read.recognised);
          EXPECT_NEAR(pair.score_of(read.grid), pair.score, 0.02);
          EXPECT_GE(pair.walls_of(read.grid), pair.walls - 0.05);  // walls at the gaps are none of the map's
          EXPECT_THAT(read.recognised, ::testing::HasSubstr("wherever free ground ends a wall was taken"));
        }
      }
}

/// Where half an arena was seen, the mask has a wall along the end of it, and says so.
TEST_F(MeasuredFiles, MasksOfPartOfAnArenaAreDoubted) {
  for (const Ground& ground : kGrounds) {
    const OccupancyGrid map = padded(with_coverage(truth_of(ground), 0.5), 10);
    EXPECT_THAT(load_map(picture_of(map, 255, 0, "png"), {0.05}).recognised, ::testing::HasSubstr(kDoubt))
        << ground.name();
  }
}

TEST_F(MeasuredFiles, LabelsAreToldByTheirShapesInAnyOrder) {
  const std::vector<Kind> kinds = {{"signed bytes", 8, SAMPLEFORMAT_INT},
                                   {"signed 16 bit", 16, SAMPLEFORMAT_INT},
                                   {"signed 32 bit", 32, SAMPLEFORMAT_INT},
                                   {"bytes", 8, SAMPLEFORMAT_UINT},
                                   {"unsigned 16 bit", 16, SAMPLEFORMAT_UINT},
                                   {"unsigned 32 bit", 32, SAMPLEFORMAT_UINT},
                                   kFloat,
                                   kDouble};
  std::vector<Values> all;
  for (const auto& [a, b, c] :
       std::vector<std::array<double, 3>>{{0, 1, 2}, {1, 2, 3}, {-1, 0, 1}, {-1, 0, 100}, {0, 50, 100}, {0, 1, 255}})
    for (const auto& order : std::vector<Values>{{a, b, c}, {a, c, b}, {b, a, c}, {b, c, a}, {c, a, b}, {c, b, a}})
      all.push_back(order);
  all.insert(all.end(),
             {{1, 0, 2, "0"}, {2, 0, 1, "0"}, {0, 255, 1, "255"}, {1, 255, 0, "255"}, {1, 127, 2}, {10, 0, 20}});
  for (std::size_t g = 0; g < kGrounds.size(); ++g) {
    const Ground& ground = kGrounds[g];
    const Pair pair(ground);
    for (std::size_t k = 0; k < kinds.size(); ++k)
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_tried(g + k + i)) continue;
        const Kind& kind = kinds[k];
        const Values& v = all[i];
        if (!kind.can_hold(v.wall) || !kind.can_hold(v.unknown) || !kind.can_hold(v.free)) continue;
        SCOPED_TRACE(ground.name() + ", " + kind.name + ": wall " + std::to_string(v.wall) + ", unknown " +
                     std::to_string(v.unknown) + ", free " + std::to_string(v.free) + ", no data " + v.no_data);
        const std::string path = tiff_of(pair.map, kind, v);
        ASSERT_EQ(refusal_of(path), "");
        const LoadedMap read = load_map(path, {0.05});
        EXPECT_NEAR(pair.score_of(read.grid), pair.score, 0.02) << read.recognised;
        EXPECT_NEAR(pair.walls_of(read.grid), pair.walls, 0.02) << read.recognised;
      }
  }
}

/// Ground that no shape tells apart: said in one sentence.
TEST_F(MeasuredFiles, LabelsWithoutLinesAreRefused) {
  OccupancyGrid map(GridFrame{120, 90, 0.05, 0.0, 0.0});
  for (int y = 20; y < 70; ++y)
    for (int x = 20; x < 100; ++x) map[{x, y}] = x < 60 ? Occupancy::Free : Occupancy::Occupied;
  EXPECT_THAT(refusal_of(tiff_of(map, {"signed 32 bit", 32, SAMPLEFORMAT_INT}, {2, 0, 1})),
              ::testing::HasSubstr("holds the labels 0, 1, 2, and the shapes of what has them do not tell"));
  // What such samples usually mean stays so.
  EXPECT_THAT(load_map(tiff_of(map, kFloat, {100, -1, 0}), {0.05}).recognised,
              ::testing::HasSubstr("per cent occupied from 0 to 100"));
}

/// Tunnels of half a metre in solid rock are thin lines of free ground, and the rock goes on to the rim.
TEST_F(MeasuredFiles, ShapesDoNotOverruleWhatSamplesUsuallyMeanWhereRockIsAllAround) {
  OccupancyGrid rock(GridFrame{200, 160, 0.05, 0.0, 0.0}, Occupancy::Occupied);
  for (int y = 10; y < 150; ++y)
    for (int x = 10; x < 190; ++x)
      if (x % 40 < 10 || y % 40 < 10) rock[{x, y}] = Occupancy::Free;
  const LoadedMap read = load_map(tiff_of(rock, kFloat, {1.0, 0.5, 0.0}), {0.05});
  EXPECT_EQ(read.grid[read.grid.cell({0.1, 0.1})], Occupancy::Occupied) << read.recognised;
  EXPECT_EQ(read.grid[read.grid.cell({2.2, 3.0})], Occupancy::Free) << read.recognised;
}

/// A hall cropped to its walls, with specks or dashes of unknown ground: dots are no walls.
TEST_F(MeasuredFiles, DotsOfUnknownGroundAreNoWalls) {
  OccupancyGrid hall(GridFrame{240, 180, 0.05, 0.0, 0.0}, Occupancy::Free);
  for (int y = 0; y < hall.height(); ++y)
    for (int x = 0; x < hall.width(); ++x)
      if (x < 2 || y < 2 || x >= hall.width() - 2 || y >= hall.height() - 2 || (x >= 60 && x < 90 && y >= 40 && y < 44))
        hall[{x, y}] = Occupancy::Occupied;
  OccupancyGrid specks = hall, dashes = hall;
  for (int i = 0; i < 150; ++i) specks[{10 + (i * 37) % 220, 50 + (i * 53) % 120}] = Occupancy::Unknown;
  for (int y = 8; y < 170; y += 14)
    for (int x = 10; x < 230; ++x)
      if (x / 7 % 3 == 0 && dashes[{x, y}] == Occupancy::Free) dashes[{x, y}] = Occupancy::Unknown;
  for (const OccupancyGrid* const map : {&specks, &dashes}) {
    const LoadedMap read = load_map(tiff_of(*map, {"signed bytes", 8, SAMPLEFORMAT_INT}, {100, -1, 0}), {0.05});
    EXPECT_EQ(read.grid[read.grid.cell({3.5, 2.1})], Occupancy::Occupied) << read.recognised;
    EXPECT_EQ(read.grid[read.grid.cell({1.0, 1.0})], Occupancy::Free) << read.recognised;
  }
}

TEST_F(MeasuredFiles, ProbabilitiesOfFreeGroundAreToldFromThoseOfWalls) {
  const double none = std::nan("");
  for (const Ground& ground : kGrounds) {
    const Pair pair(ground);
    for (const Kind& kind : {kFloat, kDouble})
      for (const double scale : {1.0, 100.0})
        for (const auto& [wall, unknown, free] : std::vector<std::array<double, 3>>{
                 {0.05, 0.5, 0.95}, {0.05, none, 0.95}, {0.0, none, 1.0}, {0.1, -1.0 / scale, 0.8}, {0.3, 0.45, 0.7}})
          for (const bool is_free : {true, false}) {
            const auto p = [&](double v) { return is_free || v < 0.0 ? scale * v : scale * (1.0 - v); };
            const LoadedMap read = load_map(tiff_of(pair.map, kind, {p(wall), p(unknown), p(free)}), {0.05});
            SCOPED_TRACE(ground.name() + ", " + kind.name + ", wall " + std::to_string(p(wall)) + ", unknown " +
                         std::to_string(p(unknown)) + ", free " + std::to_string(p(free)) + ": " + read.recognised);
            EXPECT_NEAR(pair.score_of(read.grid), pair.score, 0.02);
            EXPECT_NEAR(pair.walls_of(read.grid), pair.walls, 0.02);
          }
    // Unknown ground as little free as walls.
    for (const double low : {0.05, 0.95}) {
      const LoadedMap read = load_map(tiff_of(pair.map, kFloat, {low, low, 1.0 - low}), {0.05});
      EXPECT_NEAR(pair.score_of(read.grid), pair.score, 0.02) << read.recognised;
      EXPECT_THAT(read.recognised, ::testing::HasSubstr(kDoubt));
    }
  }
}

}  // namespace
}  // namespace rubble::scoring
