#include "scoring/maps/victim_symbols.h"

#include <gtest/gtest.h>

#include "scoring/maps/colours/map_colours.h"
#include "tests/support/symbols_pictures.h"

namespace rubble::scoring {
namespace {

using namespace symbols_test;

const cv::Scalar kRed(240, 10, 10), kOrange(240, 100, 10), kHazard(255, 100, 30), kBlue(10, 10, 240);
const cv::Scalar kHazardOfCrosbot(30, 30, 255);

/// Each drawn victim has one symbol within `tolerance` pixels, and there are no others.
void expect_found(const std::vector<VictimSymbol>& found, const std::vector<cv::Point2d>& drawn, double tolerance) {
  EXPECT_EQ(found.size(), drawn.size());
  for (const cv::Point2d& p : drawn) {
    double nearest = 1e9;
    for (const VictimSymbol& s : found) nearest = std::min(nearest, std::hypot(s.column - p.x, s.row - p.y));
    EXPECT_LE(nearest, tolerance) << "the one at " << p.x << ", " << p.y;
  }
}

/// Victims in the open, on a wall, at the wall around, on the path, and out in unexplored space.
const std::vector<cv::Point2d> kPlaces = {{2.013, 2.491}, {4.02, 2.204}, {6.93, 1.737}, {3.512, 3.111}, {0.42, 5.527}};

struct Picture {
  RgbImage image;
  std::vector<cv::Point2d> victims;  ///< [pixels]
};

/// As hector_geotiff draws it: three pixels a cell of 0.05 m, smooth circles, hazards as diamonds of 0.35 m.
Picture hectors(double resolution, const cv::Scalar& colour = kRed) {
  Picture out{floor_plan(resolution), {}};
  draw_path(out.image, resolution);
  const auto at = [&](double x, double y) { return cv::Point2d(x / resolution, y / resolution); };
  draw_symbol(out.image, resolution, at(5.31, 2.22), kHazard, Shape::Diamond, "A");
  draw_symbol(out.image, resolution, at(2.6, 4.3), kBlue, Shape::Circle, "7");
  int number = 8;
  for (const cv::Point2d& p : kPlaces) {
    out.victims.push_back(p * (1.0 / resolution));
    draw_symbol(out.image, resolution, out.victims.back(), colour, Shape::Circle, std::to_string(++number));
  }
  return out;
}

TEST(VictimSymbols, AnInvertedMapKeepsItsVictims) {
  const Picture map = hectors(0.025);
  RgbImage inverted = map.image;
  for (std::uint8_t& value : inverted.rgb) value = static_cast<std::uint8_t>(255 - value);
  const ClassImage read = classify(inverted);
  ASSERT_TRUE(read.restored);
  EXPECT_EQ(read.restored->rgb, map.image.rgb);
  expect_found(find_victim_symbols(*read.restored, 0.025), map.victims, 0.75);
}

TEST(VictimSymbols, HectorsMapGivesItsVictims) {
  for (const double resolution : {0.05 / 3.0, 0.025, 0.05}) {
    SCOPED_TRACE(resolution);
    const Picture map = hectors(resolution);
    const auto found = find_victim_symbols(map.image, resolution);
    expect_found(found, map.victims, 0.75);
    for (const VictimSymbol& s : found) EXPECT_TRUE(s.confirmed);
    const Picture unconfirmed = hectors(resolution, kOrange);
    const auto orange = find_victim_symbols(unconfirmed.image, resolution);
    expect_found(orange, unconfirmed.victims, 0.75);
    for (const VictimSymbol& s : orange) EXPECT_FALSE(s.confirmed);
  }
}

TEST(VictimSymbols, CrosbotsMapGivesItsVictims) {
  // One pixel a cell, hard edges, hazards as blue squares of 0.30 m, floor searched for victims green.
  for (const double resolution : {0.025, 0.05}) {
    SCOPED_TRACE(resolution);
    RgbImage image = floor_plan(resolution);
    cv::Mat m = view(image);
    const auto px = [&](double metres) { return static_cast<int>(std::floor(metres / resolution)); };
    cv::rectangle(m, {px(1.2), px(3.6)}, {px(3.6), px(4.8)}, {130, 230, 130}, cv::FILLED);
    draw_path(image, resolution);
    cv::rectangle(m, {px(5.0), px(2.0)}, {px(5.3), px(2.3)}, kHazardOfCrosbot, cv::FILLED);
    std::vector<cv::Point2d> victims;
    for (const cv::Point2d& p : kPlaces) {
      const cv::Point centre(px(p.x), px(p.y));
      victims.push_back(cv::Point2d(centre) + cv::Point2d(0.5, 0.5));
      cv::circle(m, centre, static_cast<int>(std::lround(0.175 / resolution)), victims.size() % 2 == 0 ? kOrange : kRed,
                 cv::FILLED);
    }
    expect_found(find_victim_symbols(image, resolution), victims, 0.6);
  }
}

TEST(VictimSymbols, TurningAndCompressionKeepThem) {
  for (const double resolution : {0.025, 0.05}) {
    const Picture map = hectors(resolution);
    for (const double degrees : {0.0, 13.0, 37.0, 90.0})
      for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR, cv::INTER_CUBIC})
        for (const int quality : {100, 85, 75, 60}) {
          if (resolution > 0.04 && quality < 85) continue;  // seven pixels in colours of four: all is orange
          SCOPED_TRACE(std::to_string(resolution) + " m, turned " + std::to_string(degrees) + ", interpolation " +
                       std::to_string(interpolation) + ", quality " + std::to_string(quality));
          const Turned turn = symbols_test::turned(map.image, degrees, interpolation);
          std::vector<cv::Point2d> victims;
          for (const cv::Point2d& p : map.victims) victims.push_back(turn(p));
          expect_found(find_victim_symbols(quality == 100 ? turn.image : jpeg(turn.image, quality), resolution),
                       victims, 1.3);
        }
  }
}

TEST(VictimSymbols, TouchingAndOverlappingCirclesAreCountedOneByOne) {
  constexpr double kResolution = 0.025;
  for (const double apart : {0.36, 0.30, 0.24, 0.20}) {
    SCOPED_TRACE(apart);
    RgbImage image = floor_plan(kResolution);
    std::vector<cv::Point2d> victims = {
        {2.0, 2.0}, {2.0 + apart, 2.0}, {5.0, 3.0}, {5.0 + 0.7 * apart, 3.0 + 0.7 * apart}};
    for (cv::Point2d& p : victims) {
      p *= 1.0 / kResolution;
      draw_symbol(image, kResolution, p, kRed, Shape::Circle, "3");
    }
    expect_found(find_victim_symbols(image, kResolution), victims, 2.0);
  }
  // Three in a row, and one under the lettering of its neighbour.
  RgbImage image = floor_plan(kResolution);
  std::vector<cv::Point2d> row;
  for (int i = 0; i < 3; ++i) {
    row.push_back({(2.0 + 0.28 * i) / kResolution, 2.5 / kResolution});
    draw_symbol(image, kResolution, row.back(), kRed, Shape::Circle, std::to_string(i));
  }
  expect_found(find_victim_symbols(image, kResolution), row, 2.0);
}

TEST(VictimSymbols, LetteringThatCutsTheCircleDoesNotMoveIt) {
  // Lettering of 14 x 9 pixels over circles of 9: at 0.05 m a pixel little of them is left above and below.
  constexpr double kResolution = 0.05;
  RgbImage image = floor_plan(kResolution);
  cv::Mat m = view(image);
  std::vector<cv::Point2d> victims;
  for (const auto& [centre, lettering] : {std::pair{cv::Point(40, 40), "1"},
                                          {cv::Point(60, 60), "7"},
                                          {cv::Point(120, 40), "10"},
                                          {cv::Point(120, 70), "12"}}) {
    cv::circle(m, centre, 4, kRed, cv::FILLED);
    const std::string text = lettering;
    cv::putText(m, text, centre + cv::Point(-4 * static_cast<int>(text.size()), 4), cv::FONT_HERSHEY_SIMPLEX, 0.35,
                {255, 255, 255}, 1);
    victims.push_back(cv::Point2d(centre) + cv::Point2d(0.5, 0.5));
  }
  expect_found(find_victim_symbols(image, kResolution), victims, 1.5);
}

TEST(VictimSymbols, OtherDrawingsAreNone) {
  for (const double resolution : {0.0125, 0.025, 0.05})
    for (const double degrees : {0.0, 21.0})
      for (const int quality : {100, 75}) {
        SCOPED_TRACE(std::to_string(resolution) + " turned " + std::to_string(degrees) + " quality " +
                     std::to_string(quality));
        RgbImage image = floor_plan(resolution);
        draw_path(image, resolution);
        const auto at = [&](double x, double y) { return cv::Point2d(x / resolution, y / resolution); };
        draw_symbol(image, resolution, at(2.0, 4.0), kBlue, Shape::Circle, "4");
        draw_symbol(image, resolution, at(5.0, 4.0), {255, 200, 0}, Shape::Circle, "");
        draw_symbol(image, resolution, at(6.0, 2.0), {120, 0, 140}, Shape::Circle, "5");
        if (resolution < 0.04 || quality == 100)  // else the corners of the diamond are lost in the blocks
          draw_symbol(image, resolution, at(5.0, 2.0), kHazard, Shape::Diamond, "2");
        cv::Mat m = view(image);
        cv::line(m, at(1.5, 4.5), at(6.5, 3.2), kRed, std::max(1, static_cast<int>(0.05 / resolution)));
        if (resolution < 0.04) cv::rectangle(m, at(4.3, 1.3), at(4.8, 1.4), kRed, cv::FILLED);
        cv::rectangle(m, at(1.5, 2.2), at(3.1, 3.4), kRed, cv::FILLED);
        const RgbImage away = symbols_test::turned(image, degrees, cv::INTER_LINEAR).image;
        const auto found = find_victim_symbols(quality == 100 ? away : jpeg(away, quality), resolution);
        EXPECT_TRUE(found.empty()) << found.size() << ", first at " << found.front().column << ", "
                                   << found.front().row;
      }
}

TEST(VictimSymbols, CoarsePicturesHaveNone) {
  EXPECT_TRUE(find_victim_symbols(hectors(0.05).image, 0.2).empty());
  EXPECT_TRUE(find_victim_symbols(RgbImage(), 0.05).empty());
  EXPECT_TRUE(find_victim_symbols(RgbImage(1, 1), 0.05).empty());
}

}  // namespace
}  // namespace rubble::scoring
