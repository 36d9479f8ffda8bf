#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/maps/colours/map_colours.h"
#include "scoring/measures/sight_lines.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// What a robot has seen: all of the ground, or what lies west of a line through its rooms. Cells of it reach to
/// `margin` cells from each side of the picture.
OccupancyGrid seen_of(const OccupancyGrid& truth, double share, int margin) {
  const int end = static_cast<int>(share * truth.width());
  int west = truth.width(), east = -1, south = truth.height(), north = -1;
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < end; ++x)
      if (truth[{x, y}] != Occupancy::Unknown) {
        west = std::min(west, x), east = std::max(east, x);
        south = std::min(south, y), north = std::max(north, y);
      }
  GridFrame frame = truth.frame();
  frame.width = east - west + 1 + 2 * margin;
  frame.height = north - south + 1 + 2 * margin;
  OccupancyGrid out(frame, Occupancy::Unknown);
  for (int y = south; y <= north; ++y)
    for (int x = west; x <= east; ++x) out[{x - west + margin, y - south + margin}] = truth[{x, y}];
  return out;
}

/// Where what was read of the turned picture lies on the map.
PlanarTransform pose_of(const TurnedImage& picture, const OccupancyGrid& read, const OccupancyGrid& map) {
  cv::Mat back;
  cv::invertAffineTransform(picture.turn, back);
  const double f = map.resolution();
  const auto onto = [&](const mrpt::math::TPoint2D& p) {
    const double column = (p.x - read.frame().x0) / f - 0.5;
    const double row = read.height() - (p.y - read.frame().y0) / f - 0.5;
    const auto at = [&](int i) {
      return back.at<double>(i, 0) * column + back.at<double>(i, 1) * row + back.at<double>(i, 2) + 0.5;
    };
    return mrpt::math::TPoint2D(map.frame().x0 + at(0) * f, map.frame().y0 + (map.height() - at(1)) * f);
  };
  const mrpt::math::TPoint2D o(0, 0), a(5, 0), b(0, 5);
  return PlanarTransform(fit_rigid({o, a, b}, {onto(o), onto(a), onto(b)}));
}

struct Levels {
  int wall, unknown, free;
};

/// A grey map keeps its score when it is turned onto a canvas of any grey, however near the canvas comes to its walls.
TEST(TurnedMap, KeepsItsScoreOnAnyCanvasWhateverItsMargin) {
  int cases = 0;
  std::size_t turn = 0;
  for (const Ground& ground : {Ground{"maze", 6, 5, 3}, Ground{"yellow", 6, 5, 21}})
    for (const double share : {1.0, 0.7})
      for (const int margin : {2, 3, 6, 10})
        for (const Levels& levels : {Levels{0, 205, 254}, Levels{0, 127, 255}, Levels{0, 128, 255}}) {
          const OccupancyGrid map = seen_of(truth_of(ground), share, margin);
          const cv::Mat image = grey_image(map, levels.wall, levels.unknown, levels.free);
          const SightLines sights(map);
          const double untouched = sights.at(map, PlanarTransform()).score;
          ASSERT_GT(untouched, 0.9) << ground.name();
          for (const double degrees : {3.0, 8.0, 17.0, 30.0, 45.0, 52.0, 66.0, 80.0}) {
            ++turn;
            for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR, cv::INTER_CUBIC})
              for (const std::size_t other : {0, 1, 2}) {
                if (!is_tried(turn + static_cast<std::size_t>(interpolation) + other)) continue;
                const int canvas = std::array{0, levels.unknown, 255}[other];
                ++cases;
                const std::string name =
                    ground.name() + cv::format(
                                        ", %.0f %% seen, margin %d, unknown %d, %.0f deg, "
                                        "interpolation %d, canvas %d: ",
                                        100 * share, margin, levels.unknown, degrees, interpolation, canvas);
                const TurnedImage picture = turned(image, degrees, interpolation, cv::Scalar::all(canvas));
                cv::Mat colours;
                cv::cvtColor(picture.image, colours, cv::COLOR_GRAY2BGR);
                const ClassImage read = classify(to_rgb(colours));
                if (!read.refusal.empty()) {
                  ADD_FAILURE() << name << "refused: " << read.refusal;
                  continue;
                }
                OccupancyGrid grid(GridFrame{read.classes.width(), read.classes.height(), map.resolution(), 0.0, 0.0});
                for (int y = 0; y < grid.height(); ++y)
                  for (int x = 0; x < grid.width(); ++x) grid[{x, y}] = read.classes[{x, y}];
                EXPECT_NEAR(sights.at(grid, pose_of(picture, grid, map)).score, untouched, 0.02)
                    << name << read.recognised;
              }
          }
        }
  std::printf("%d cases\n", cases);
  EXPECT_GE(cases, at_least(3456));
}

}  // namespace
}  // namespace rubble::scoring
