#include "scoring/pictures/picture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "scoring/pictures/sight_picture.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

struct Tints {
  int red = 0;     ///< clearly more red than blue
  int blue = 0;    ///< clearly more blue than red
  int orange = 0;  ///< red, and green between
  int dark = 0;
};

/// A free room with one wall in its middle, `shift` metres further right.
OccupancyGrid room(double shift, bool wall = true) {
  OccupancyGrid grid(GridFrame{100, 60, 0.05, 0.0, 0.0}, Occupancy::Free);
  if (wall) draw_wall(grid, {2.5 + shift, 0.5}, {2.5 + shift, 2.5}, 2);
  return grid;
}

/// Above the legend, which is on lighter ground and as high as its rows.
int rows_of_map(const cv::Mat& image) {
  int rows = image.rows;
  while (rows > 0 && image.at<cv::Vec3b>(rows - 1, 0) == cv::Vec3b(250, 250, 250)) --rows;
  return rows;
}

class Picture : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  /// Of the picture above the legend, between `from` and `to` of its height.
  Tints tints(double from = 0.0) const {
    const cv::Mat image = cv::imread(path_);
    Tints out;
    const int height = rows_of_map(image);
    for (int y = static_cast<int>(from * height); y < height; ++y)
      for (int x = 0; x < image.cols; ++x) {
        const cv::Vec3b c = image.at<cv::Vec3b>(y, x);
        const int red = c[2];
        const int blue = c[0];
        if (red - blue > 120 && c[1] < 100) ++out.red;
        if (red - blue > 120 && c[1] >= 120) ++out.orange;
        if (blue - red > 120) ++out.blue;
        if (red < 60 && blue < 60) ++out.dark;
      }
    return out;
  }
  const std::string path_ =
      (std::filesystem::temp_directory_path() /
       (std::string("rubble_picture_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png"))
          .string();
};

TEST_F(Picture, WallsAgreeWithinFiveCentimetresAndAreNearWithinFifteen) {
  for (const double shift : {0.0, 0.05}) {
    write_overlay(path_, room(shift), room(0.0), {});
    EXPECT_GT(tints().dark, 0) << shift;
    EXPECT_EQ(tints().orange + tints().red + tints().blue, 0) << shift;
  }
  write_overlay(path_, room(0.2), room(0.0), {});
  EXPECT_GT(tints().orange, 0);
  write_overlay(path_, room(0.6), room(0.0), {});
  EXPECT_EQ(tints().orange + tints().dark, 0);
  EXPECT_GT(tints().red, 0);
  EXPECT_GT(tints().blue, 0);
}

/// Small arenas too: the picture is as wide as the map, and the legend takes the rows it needs below.
TEST_F(Picture, TheMapFillsThePictureAndTheLegendIsBelow) {
  for (const int cells : {20, 60, 200, 700}) {
    OccupancyGrid grid(GridFrame{cells, cells, 0.05, 0.0, 0.0}, Occupancy::Free);
    draw_wall(grid, {0.3, 0.2}, {0.3, 0.8}, 1);
    for (const bool error : {false, true}) {
      error ? write_error_map(path_, grid, grid, {}, 0.5) : write_overlay(path_, grid, grid, {});
      const cv::Mat image = cv::imread(path_);
      const int rows = rows_of_map(image);
      EXPECT_EQ(image.cols, rows) << cells << ": a square map in a square picture";
      EXPECT_GT(image.rows - rows, 20) << cells;
      EXPECT_LT(image.rows - rows, image.rows / 3) << cells;
    }
  }
}

TEST_F(Picture, TheErrorMapTellsPhantomFromMissing) {
  write_error_map(path_, room(0.0), room(0.0, false), {}, 0.5);
  EXPECT_GT(tints().red, 0);
  EXPECT_EQ(tints().blue, 0);
  write_error_map(path_, room(0.0, false), room(0.0), {}, 0.5);
  EXPECT_EQ(tints().red, 0);
  EXPECT_GT(tints().blue, 0);
  write_error_map(path_, room(0.0), room(0.0), {}, 0.5);
  EXPECT_EQ(tints().red + tints().blue, 0);
}

TEST_F(Picture, TheSightMapShowsErasedAndPhantomWallsWhereTheyAre) {
  const OccupancyGrid truth = maze_of(1, 7, 7);
  write_sight_map(path_, truth, truth, {});
  EXPECT_EQ(tints().red + tints().blue, 0);
  EXPECT_EQ(tints().orange, 0);
  write_sight_map(path_, with_gaps(truth, 4, 1), truth, {});
  EXPECT_EQ(tints().red, 0);
  EXPECT_GT(tints().blue, 100);
  write_sight_map(path_, with_phantoms(truth, 4, 1), truth, {});
  EXPECT_GT(tints().red, 100);
  EXPECT_EQ(tints().blue, 0);
  write_sight_map(path_, half_of(truth), truth, {});
  EXPECT_GT(tints().orange, 100);  // yellow
  EXPECT_EQ(tints().red + tints().blue, 0);
}

TEST_F(Picture, TheSightMapOfAGroundWithoutLinesSaysSo) {
  const OccupancyGrid bare(GridFrame{60, 60, 0.05, 0.0, 0.0}, Occupancy::Unknown);
  write_sight_map(path_, bare, bare, {});
  EXPECT_GT(tints().red, 1000);
}

/// The room with a title, an axis and a box of symbols beside it, as plotting programs draw them.
OccupancyGrid plotted(const OccupancyGrid& map) {
  OccupancyGrid out = padded(map, 30);
  draw_wall(out, {-1.0, -1.0}, {6.0, -1.0}, 1);
  draw_wall(out, {-1.0, -1.0}, {-1.0, 4.0}, 1);
  for (const double x : {0.5, 1.0, 1.5, 2.0}) draw_wall(out, {x, 3.6}, {x + 0.2, 4.0}, 2);
  return out;
}

TEST_F(Picture, LegendsAndAxesBesideTheMapAreNoWrongWalls) {
  write_overlay(path_, plotted(room(0.0)), room(0.0), {});
  EXPECT_EQ(tints().red + tints().orange, 0);
  write_error_map(path_, plotted(room(0.0)), room(0.0), {}, 0.5);
  EXPECT_EQ(tints().red + tints().orange, 0);
  write_overlay(path_, plotted(room(0.6)), room(0.0), {});
  EXPECT_GT(tints().red, 0);  // where the truth knows the place it is one
}

TEST_F(Picture, FoundFalseAndMissedVictimsAreToldApart) {
  const OccupancyGrid plain = room(0.0, false);
  const Mark here{{1.0, 1.0}, "v", std::nullopt};
  const auto green = [&] {
    const cv::Mat image = cv::imread(path_);
    int count = 0;
    for (int y = 0; y < rows_of_map(image); ++y)
      for (int x = 0; x < image.cols; ++x) {
        const cv::Vec3b c = image.at<cv::Vec3b>(y, x);
        count += c[1] - c[0] > 80 && c[1] - c[2] > 80 ? 1 : 0;
      }
    return count;
  };
  write_overlay(path_, plain, plain, {}, "", {"victims", {{here, here}}, {}, {}});
  EXPECT_GT(green(), 0);
  EXPECT_EQ(tints().red + tints().blue, 0);
  write_overlay(path_, plain, plain, {}, "", {"victims", {}, {here}, {}});
  EXPECT_GT(tints().red, 0);
  EXPECT_EQ(green() + tints().blue, 0);
  write_overlay(path_, plain, plain, {}, "", {"victims", {}, {}, {here}});
  EXPECT_GT(tints().blue, 0);
  EXPECT_EQ(green() + tints().red, 0);
  // Where there is no list of the true ones.
  write_overlay(path_, plain, plain, {}, "", {"victims", {}, {}, {}});
  const auto above_the_legend = [&] {
    const cv::Mat image = cv::imread(path_);
    return image.rowRange(0, rows_of_map(image)).clone();
  };
  const cv::Mat without = above_the_legend();
  write_overlay(path_, plain, plain, {}, "", {"victims", {}, {}, {}, {here}});
  EXPECT_EQ(green() + tints().red + tints().blue, 0);
  EXPECT_GT(cv::norm(without, above_the_legend()), 0.0) << "the report is not shown";
  // Nobody knows at a pose that is not trusted.
  write_overlay(path_, plain, plain, {}, "NOT TRUSTED", {"victims", {{here, here}}, {here}, {here}});
  EXPECT_EQ(green() + tints(0.3).blue + tints(0.3).red, 0);
}

/// What is drawn round and on victims stands in the legend, as it is drawn, and nothing else does.
TEST_F(Picture, TheLegendNamesWhatIsDrawnOfVictims) {
  const OccupancyGrid plain = room(0.0, false);
  const Mark here{{1.0, 1.0}, "v", std::nullopt};
  const auto legend = [&](const Marks& marks, const std::string& warning = "") {
    write_overlay(path_, plain, plain, {}, warning, marks);
    const cv::Mat image = cv::imread(path_);
    const int rows = rows_of_map(image);
    return image.rowRange(rows, image.rows).clone();
  };
  const auto tinted = [](const cv::Mat& strip, int more, int less) {
    int count = 0;
    for (int y = 0; y < strip.rows; ++y)
      for (int x = 0; x < strip.cols; ++x) {
        const cv::Vec3b c = strip.at<cv::Vec3b>(y, x);
        count += c[more] - c[less] > 80 ? 1 : 0;
      }
    return count;
  };
  const cv::Mat none = legend({"victims", {}, {}, {}});
  const auto more_than_none = [&](const cv::Mat& strip, int more, int less) {
    return tinted(strip, more, less) - tinted(none, more, less);
  };
  const cv::Mat missed = legend({"victims", {}, {}, {here}});
  EXPECT_GT(more_than_none(missed, 0, 2), 15) << "a blue ring";
  EXPECT_LT(more_than_none(missed, 0, 2), 120) << "no field";
  EXPECT_EQ(more_than_none(missed, 2, 0), 0);
  EXPECT_GT(more_than_none(legend({"victims", {}, {here}, {}}), 2, 0), 15) << "a red cross";
  EXPECT_GT(more_than_none(legend({"victims", {{here, here}}, {}, {}}), 1, 0), 15) << "a green ring";
  const cv::Mat doubted = legend({"victims", {{here, here}}, {here}, {here}}, "NOT TRUSTED");
  EXPECT_EQ(more_than_none(doubted, 0, 2) + more_than_none(doubted, 2, 0), 0) << "all are grey";
  EXPECT_NE(
      tinted(doubted, 0, 2) == tinted(none, 0, 2) && doubted.size() == none.size() && cv::norm(doubted, none) == 0.0,
      true)
      << "and said to be";
}

/// Nothing of the picture shows them: the legend says how many they are.
TEST_F(Picture, VictimsReportedOutsideThePictureAreToldInTheLegend) {
  const OccupancyGrid plain = room(0.0, false);
  const Mark here{{1.0, 1.0}, "v", std::nullopt}, far{{50.0, -30.0}, "w", std::nullopt};
  const auto drawn = [&](const std::string& warning, const Marks& marks) {
    write_overlay(path_, plain, plain, {}, warning, marks);
    return cv::imread(path_);
  };
  const auto is_told = [&](const cv::Mat& without, const cv::Mat& with) {
    const int rows = rows_of_map(without);
    EXPECT_EQ(rows_of_map(with), rows);
    EXPECT_EQ(cv::norm(without.rowRange(0, rows), with.rowRange(0, rows)), 0.0);
    return without.size() != with.size() || cv::norm(without, with) > 0.0;
  };
  for (const std::string warning : {"", "NOT TRUSTED"}) {
    const cv::Mat none = drawn(warning, {"victims", {}, {}, {}});
    EXPECT_TRUE(is_told(none, drawn(warning, {"victims", {}, {far}, {}})));
    EXPECT_TRUE(is_told(none, drawn(warning, {"victims", {}, {}, {}, {far}})));
  }
  const cv::Mat one = drawn("", {"victims", {}, {here}, {}}), two = drawn("", {"victims", {}, {here, far}, {}});
  EXPECT_TRUE(is_told(one, two));
  EXPECT_TRUE(is_told(two, drawn("", {"victims", {}, {here, far, far}, {}})));
}

TEST_F(Picture, TheLegendOfTheErrorMapNamesItsPaleGrounds) {
  OccupancyGrid half = room(0.0);
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < 30; ++x) half[{x, y}] = Occupancy::Unknown;
  OccupancyGrid other = room(0.0);
  for (int y = 0; y < other.height(); ++y)
    for (int x = 70; x < 100; ++x) other[{x, y}] = Occupancy::Unknown;
  write_error_map(path_, half, other, {}, 0.5);
  const cv::Mat image = cv::imread(path_);
  const int rows = rows_of_map(image);
  for (const int x : {image.cols / 5, image.cols * 4 / 5}) {
    const cv::Vec3b ground = image.at<cv::Vec3b>(rows / 2, x);
    int there = 0;
    for (int y = rows; y < image.rows; ++y)
      for (int column = 0; column < image.cols; ++column) there += image.at<cv::Vec3b>(y, column) == ground ? 1 : 0;
    EXPECT_GE(there, 50) << ground;
  }
}

/// As Fig. 12 (h): the outliers of each map on its own side.
TEST_F(Picture, SideBySideOutliersLieOnTheirMap) {
  const OccupancyGrid plain = room(0.0, false);
  const Mark here{{1.0, 1.0}, "", std::nullopt};
  const auto east = [&](bool red) {
    const cv::Mat image = cv::imread(path_);
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < rows_of_map(image); ++y)
      for (int x = 0; x < image.cols; ++x) {
        const cv::Vec3b c = image.at<cv::Vec3b>(y, x);
        if ((red ? c[2] - c[0] : c[0] - c[2]) <= 100) continue;
        sum += x;
        ++count;
      }
    return count == 0 ? -1.0 : sum / count / image.cols;
  };
  write_side_by_side(path_, plain, plain, TPose2D(), {"SURF", {}, {here}, {}});
  EXPECT_GT(east(true), 0.0);
  EXPECT_LT(east(true), 0.5);
  EXPECT_EQ(east(false), -1.0);
  write_side_by_side(path_, plain, plain, TPose2D(), {"SURF", {}, {}, {here}});
  EXPECT_GT(east(false), 0.3);
  EXPECT_EQ(east(true), -1.0);
  write_side_by_side(path_, plain, plain, std::nullopt, {}, "no pose was proposed");
  EXPECT_GT(tints().red, 5000);
}

TEST_F(Picture, AWarningStandsOverAMapThatIsNotTrusted) {
  write_overlay(path_, room(0.0), room(0.0), {}, "NOT TRUSTED: another pose fits about as well");
  EXPECT_GT(tints().red, 5000);
  EXPECT_EQ(tints(0.5).red, 0) << "only at the top";
}

TEST_F(Picture, TheSeamOfABrokenMapIsDrawnInDashes) {
  const auto violet = [&](const Marks& marks) {
    write_overlay(path_, room(0.0), room(0.0), {}, "", marks);
    const cv::Mat image = cv::imread(path_);
    int pixels = 0;
    int dashes = 0;
    for (int y = 0; y < rows_of_map(image); ++y) {
      bool last = false;
      for (int x = 0; x < image.cols; ++x) {
        const cv::Vec3b c = image.at<cv::Vec3b>(y, x);
        const bool here = c[0] > 120 && c[1] < 80 && c[2] > 110;
        pixels += here ? 1 : 0;
        dashes += here && !last ? 1 : 0;
        last = here;
      }
    }
    return std::pair(pixels, dashes);
  };
  Marks marks;
  EXPECT_EQ(violet(marks).first, 0);
  marks.seam = {{0.5, 1.0}, {2.0, 1.0}};
  const auto [pixels, runs] = violet(marks);
  EXPECT_GT(pixels, 100);
  EXPECT_GT(runs, 6);  // gaps between the dashes
}

}  // namespace
}  // namespace rubble::scoring
