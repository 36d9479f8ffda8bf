#include "scoring/maps/colours/reading_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/map_style_hard.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string said_of(const cv::Mat& picture) {
  const ClassImage read = classify(to_rgb(picture));
  return read.refusal.empty() ? read.recognised : "refused: " + read.refusal;
}

OccupancyGrid arena() { return padded(maze_of(3, 6, 6), 12); }

TEST(ReadingDoubts, PlainPicturesHaveNone) {
  const OccupancyGrid map = arena();
  for (const cv::Mat& picture :
       {in_ros_greys(map), in_ros_greys(map, 3), league_image(map, true), with_searched_floor(league_image(map, false)),
        as_jpeg(in_ros_greys(map, 2), 70), as_jpeg(fine_league_image(map, 0.5), 80)})
    EXPECT_THAT(said_of(picture), Not(HasSubstr(kDoubt)));
}

TEST(ReadingDoubts, CostsAroundWallsAreSeenByTheirSlopesAtAnyScale) {
  const OccupancyGrid map = arena();
  for (const int scale : {1, 2, 3}) {
    const cv::Mat costs = costmap(map, scale, {0.15, 0.7, 4.0},
                                  [](int cost) { return cost < 0 ? grey(205) : grey(254 - 200 * cost / 100); });
    EXPECT_THAT(said_of(costs), AnyOf(HasSubstr("run into each other"), HasSubstr("blended"))) << scale;
  }
}

TEST(ReadingDoubts, AWayIsDoubtedWhereItRunsOverWallsOnly) {
  const OccupancyGrid map = arena();
  cv::Mat beside = in_ros_greys(map, 2), over = beside.clone();
  cv::polylines(beside, way_of(map, 2), false, cv::Scalar(0, 0, 255), 2);
  cv::polylines(over, way_over_walls(map, 2, 1), false, cv::Scalar(0, 0, 255), 4);
  EXPECT_THAT(said_of(beside), Not(HasSubstr("what they hide")));
  EXPECT_THAT(said_of(over), HasSubstr("what they hide"));
}

TEST(ReadingDoubts, APaletteThatIsNotTheLeaguesIsNamed) {
  const cv::Mat league = league_image(arena(), true);
  EXPECT_THAT(said_of(with_own_palette(league, 7)), HasSubstr("no more than 16 colours"));
  EXPECT_THAT(said_of(league), Not(HasSubstr("no more than 16 colours")));
}

/// The colours were the league's to the digit: no line had to take another's.
TEST(ReadingDoubts, AnExactPictureInFewColoursIsNotDoubtedForALineOfItsOwnOrAChangeThatWasUndone) {
  const cv::Mat league = league_image(arena(), true);
  ASSERT_TRUE(has_few_colours(to_rgb(league), 16));
  cv::Mat exchanged, gamma, curve(1, 256, CV_8U), lined = league.clone();
  cv::cvtColor(league, exchanged, cv::COLOR_BGR2RGB);
  for (int value = 0; value < 256; ++value)
    curve.at<unsigned char>(value) = cv::saturate_cast<unsigned char>(255.0 * std::pow(value / 255.0, 1.4));
  cv::LUT(league, curve, gamma);
  cv::line(lined, {8, 4}, {lined.cols - 8, 4}, cv::Scalar(0, 128, 0));
  for (const auto& [name, picture] : std::vector<std::pair<std::string, cv::Mat>>{
           {"exchanged", exchanged}, {"inverted", ~league}, {"gamma", gamma}, {"a line of its own", lined}}) {
    const std::string said = said_of(picture);
    EXPECT_THAT(said, HasSubstr("league")) << name;
    EXPECT_THAT(said, Not(HasSubstr("no more than 16 colours"))) << name;
    EXPECT_THAT(said, Not(HasSubstr("refused"))) << name;
  }
  EXPECT_THAT(said_of(exchanged), HasSubstr("exchanged"));
  EXPECT_THAT(said_of(~league), HasSubstr("inverted"));
  EXPECT_THAT(said_of(gamma), HasSubstr("tones had been changed"));
}

/// A gamma makes colours stronger, too, but moves the greys: strength does not.
TEST(ReadingDoubts, AGammaIsNotTakenForStrongerColours) {
  const cv::Mat league = league_image(arena(), true);
  for (const double power : {0.6, 0.7, 0.8, 0.9})
    for (const bool own_palette : {false, true}) {
      SCOPED_TRACE(::testing::Message() << power << (own_palette ? ", own palette" : ""));
      cv::Mat picture, curve(1, 256, CV_8U);
      for (int value = 0; value < 256; ++value)
        curve.at<unsigned char>(value) = cv::saturate_cast<unsigned char>(255.0 * std::pow(value / 255.0, power));
      cv::LUT(own_palette ? with_own_palette(league, 8) : league, curve, picture);
      const std::string said = said_of(picture);
      EXPECT_THAT(said, HasSubstr("tones had been changed"));
      EXPECT_THAT(said, Not(HasSubstr("stronger")));
      EXPECT_EQ(said.find(kDoubt) != std::string::npos, own_palette);
    }
}

TEST(ReadingDoubts, LowWordsAreNamedAndRaggedWallsAreNot) {
  const OccupancyGrid map = arena();
  cv::Mat named = in_ros_greys(map, 2);
  for (int k = 0; k < 3; ++k) write_on(named, "START", 2 * open_place(map, 8, k) - P(14, -6), 0.3, kBlack);
  const std::string said = said_of(named);
  EXPECT_TRUE(said.find("as letters") != std::string::npos || said.find("words on free") != std::string::npos) << said;
  for (const int seed : {1, 2, 3})
    EXPECT_THAT(said_of(in_ros_greys(ragged(map, 1, static_cast<std::uint64_t>(seed)), 2)),
                Not(HasSubstr("as letters")))
        << seed;
}

}  // namespace
}  // namespace rubble::scoring
