#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/colours/window_frame.h"
#include "scoring/maps/normalise.h"
#include "scoring/maps/wall_drawing.h"
#include "tests/support/base_files.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_windows.h"
#include "tests/support/scoring_grounds.h"

/// Screenshots: a map in a window is read as the same picture without the window is.
namespace rubble::scoring {
namespace {

using namespace testing;

/// How a picture gets larger on its way to a file.
struct Zoom {
  std::string name;
  double scale = 1.0;
  int how = cv::INTER_NEAREST;
  bool with_window = false;  ///< the screenshot, not the map in it
};

std::vector<Zoom> zooms() {
  return {{"as it is"},
          {"twice", 2.0, cv::INTER_NEAREST},
          {"1.5 times, linear", 1.5, cv::INTER_LINEAR},
          {"1.5 times, cubic", 1.5, cv::INTER_CUBIC},
          {"1.5 times with its window, linear", 1.5, cv::INTER_LINEAR, true}};
}

cv::Mat zoomed(const cv::Mat& m, const Zoom& zoom) {
  cv::Mat out;
  cv::resize(m, out, {}, zoom.scale, zoom.scale, zoom.how);
  return out;
}

/// The class that a pixel of the zoomed map shows.
cv::Mat drawn_classes(const OccupancyGrid& map, const cv::Size& size, double scale) {
  cv::Mat out(size, CV_8U);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int column = std::min(map.width() - 1, static_cast<int>((x + 0.5) / scale));
      const int row = std::min(map.height() - 1, static_cast<int>((y + 0.5) / scale));
      out.at<unsigned char>(y, x) = static_cast<unsigned char>(map[{column, map.height() - 1 - row}]);
    }
  return out;
}

cv::Mat read_classes(const OccupancyGrid& grid) {
  cv::Mat out(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      out.at<unsigned char>(y, x) = static_cast<unsigned char>(grid[{x, grid.height() - 1 - y}]);
  return out;
}

/// Free ground covers the same places, and walls stand within two pixels of walls.
bool is_like(const cv::Mat& read, const cv::Mat& drawn) {
  constexpr double kGround = 0.9, kWalls = 0.9;
  const auto of = [](const cv::Mat& classes, Occupancy o) { return cv::Mat(classes == static_cast<int>(o)); };
  const cv::Mat a = of(read, Occupancy::Free), b = of(drawn, Occupancy::Free);
  const cv::Mat v = of(read, Occupancy::Occupied), w = of(drawn, Occupancy::Occupied);
  const auto beside = [](const cv::Mat& some, const cv::Mat& others) {
    cv::Mat near;
    cv::dilate(others, near, cv::Mat::ones(5, 5, CV_8U));
    return cv::countNonZero(some & near) >= kWalls * cv::countNonZero(some);
  };
  return cv::countNonZero(a & b) >= kGround * cv::countNonZero(a | b) && cv::countNonZero(v) > 0 && beside(v, w) &&
         beside(w, v);
}

enum class Read { Right, Refused, Told, Wrong };

struct File {
  std::string name = "png";
  int quality = 0;  ///< of JPEG; 0: PNG
};

struct Answer {
  Read how = Read::Wrong;
  std::string said;
};

/// What is read of a picture with the map at `place`.
Answer answer(const std::string& folder, const File& file, const cv::Mat& image, const cv::Rect& place,
              const cv::Mat& drawn) {
  const std::string path = folder + "map." + (file.quality > 0 ? "jpg" : "png");
  std::vector<int> options;
  if (file.quality > 0) options = {cv::IMWRITE_JPEG_QUALITY, file.quality};
  EXPECT_TRUE(cv::imwrite(path, image, options));
  try {
    const LoadedMap read = load_map(path, {0.025});
    EXPECT_EQ(cv::Size(read.grid.width(), read.grid.height()), image.size());
    cv::Mat expected(image.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Unknown)));
    drawn(cv::Rect({0, 0}, place.size())).copyTo(expected(place));
    const auto says = [&](const char* what) { return read.recognised.find(what) != std::string::npos; };
    const Read how = is_like(read_classes(read.grid), expected)                ? Read::Right
                     : says(kDoubt) || says(kWallsPale) || says(kFreeNotKnown) ? Read::Told
                                                                               : Read::Wrong;
    return {how, read.recognised};
  } catch (const InputError& error) {
    return {Read::Refused, error.what()};
  }
}

/// A ninth of the cases daily, for a picture takes a quarter of a second: by the sum of the entries' numbers, and by
/// another sum of them, so that each entry of a list meets each of another.
bool is_tried_here(std::size_t sum, std::size_t other) { return is_tried(sum) && (is_tried(1) || other % 3 == 0); }

struct Tally {
  int cases = 0;
  int bare_right = 0;                                   ///< the same picture without a window
  int right = 0;                                        ///< with it
  int lost_refused = 0, lost_told = 0, lost_wrong = 0;  ///< of those that are right without
  int wrong = 0;                                        ///< without a word, and wrong or refused without a window, too
  int right_in_window = 0;                              ///< wrong or refused without
};

OccupancyGrid seen_part(const Ground& ground) {
  const OccupancyGrid truth = truth_of(ground);
  return padded(with_coverage(with_gaps(truth, 3, ground.seed), 0.8), 14);
}

Tally tally(const std::vector<Ground>& grounds, const std::vector<MapColours>& colours,
            const std::vector<Window>& windows) {
  const char* const only = std::getenv("RUBBLE_WINDOW");  // a part of the names
  const test::TempFolder folder;
  const std::string base = folder / "";
  Tally out;
  const std::vector<Zoom> all_zooms = zooms();
  const std::vector<File> files{File{}, File{"JPEG 90", 90}, File{"JPEG 75", 75}};
  for (std::size_t g = 0; g < grounds.size(); ++g) {
    const Ground& ground = grounds[g];
    const OccupancyGrid map = seen_part(ground);
    for (std::size_t c = 0; c < colours.size(); ++c)
      for (std::size_t z = 0; z < all_zooms.size(); ++z)
        for (std::size_t f = 0; f < files.size(); ++f) {
          const MapColours& colour = colours[c];
          const Zoom& zoom = all_zooms[z];
          const File& file = files[f];
          const cv::Mat bare = in_colours(map, colour.wall, colour.unknown, colour.free);
          const cv::Mat large = zoomed(bare, zoom), drawn = drawn_classes(map, large.size(), zoom.scale);
          std::optional<Answer> without;
          for (std::size_t w = 0; w < windows.size(); ++w) {
            const Window& window = windows[w];
            const std::string name =
                ground.name() + ", " + colour.name + ", " + zoom.name + ", " + file.name + ", " + window.name;
            if (!is_tried_here(g + c + z + f + w, c + 2 * z + f) ||
                (only != nullptr && name.find(only) == std::string::npos))
              continue;
            if (!without) without = answer(base, file, large, cv::Rect({0, 0}, large.size()), drawn);
            const Styled styled = window.around(zoom.with_window ? bare : large);
            const double scale = zoom.with_window ? zoom.scale : 1.0;
            const cv::Mat shown = zoom.with_window ? zoomed(styled.image, zoom) : styled.image;
            const cv::Rect at(
                {static_cast<int>(std::lround(scale * styled.left)), static_cast<int>(std::lround(scale * styled.top))},
                large.size());
            const Answer within = answer(base, file, shown, at & cv::Rect({0, 0}, shown.size()), drawn);
            ++out.cases;
            const bool is_right = without->how == Read::Right;
            out.bare_right += is_right ? 1 : 0;
            out.right += within.how == Read::Right ? 1 : 0;
            out.right_in_window += !is_right && within.how == Read::Right ? 1 : 0;
            if (within.how == Read::Right) continue;
            const char* what = "no better without";
            if (is_right) {
              (within.how == Read::Refused ? out.lost_refused
               : within.how == Read::Told  ? out.lost_told
                                           : out.lost_wrong)++;
              what = within.how == Read::Refused ? "refused" : within.how == Read::Told ? "told" : "WRONG";
            } else if (within.how == Read::Wrong) {
              ++out.wrong;
              what = "wrong with and without";
            }
            std::printf("%s: %s: %s\n", what, name.c_str(), within.said.c_str());
          }
        }
  }
  std::printf(
      "%d cases; %d right without a window, %d within it; of the former %d refused, %d told, %d wrong without a word; "
      "%d wrong with and without, %d right within only\n",
      out.cases, out.bare_right, out.right, out.lost_refused, out.lost_told, out.lost_wrong, out.wrong,
      out.right_in_window);
  return out;
}

/// Of what is right without a window next to nothing is lost in it, and less without a word.
void expect_few_lost(const Tally& t) {
  if (std::getenv("RUBBLE_WINDOW") != nullptr) return;
  EXPECT_GE(100 * t.bare_right, 77 * t.cases);
  EXPECT_LE(100 * (t.lost_refused + t.lost_told + t.lost_wrong), 2 * t.bare_right);
  EXPECT_LE(200 * t.lost_wrong, std::max(200, t.bare_right)) << "one of two hundred; one in all daily";
}

TEST(WindowFrame, AMapInAWindowIsReadAsTheSamePictureWithout) {
  const Tally t = tally({{"yellow", 6, 7, 401}, {"maze", 6, 5, 402}}, map_colours(), windows());
  expect_few_lost(t);
}

/// Colours and windows with which the reader was not made, on other arenas.
TEST(WindowFrame, InOtherColoursAndWindowsToo) {
  const Tally t = tally({{"orange", 5, 6, 9101}, {"yellow", 7, 5, 9102}, {"maze", 5, 6, 9103}}, other_map_colours(),
                        other_windows());
  expect_few_lost(t);
}

/// Known cells as far as `margin` cells from each side; less than 0: the rim is cut off.
OccupancyGrid cropped(const OccupancyGrid& map, int margin) {
  int west = map.width(), east = -1, south = map.height(), north = -1;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (map[{x, y}] != Occupancy::Unknown) {
        west = std::min(west, x), east = std::max(east, x);
        south = std::min(south, y), north = std::max(north, y);
      }
  GridFrame frame = map.frame();
  frame.width = east - west + 1 + 2 * margin;
  frame.height = north - south + 1 + 2 * margin;
  OccupancyGrid out(frame, Occupancy::Unknown);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (const Cell from{x + west - margin, y + south - margin}; map.inside(from)) out[{x, y}] = map[from];
  return out;
}

/// Maps whose rim is walls, unknown or free ground, of arenas whole and with gaps: none of it is a window's frame.
TEST(WindowFrame, NothingIsTakenOffWhereThereIsNoWindow) {
  int cases = 0;
  std::vector<MapColours> all = map_colours();
  for (const MapColours& more : other_map_colours()) all.push_back(more);
  const std::vector<Zoom> all_zooms = zooms();
  std::size_t drawn = 0;
  for (std::uint64_t seed = 7301; seed < 7301 + 12; ++seed)
    for (const char* const kind : {"yellow", "orange", "red", "maze"}) {
      const OccupancyGrid truth = truth_of({kind, 5 + static_cast<int>(seed % 3), 5, seed});
      for (const int margin : {-1, 0, 1, 4, 12, 40}) {
        const OccupancyGrid map = cropped(seed % 2 == 0 ? with_gaps(truth, 2, seed) : truth, margin);
        ++drawn;
        for (std::size_t c = 0; c < all.size(); ++c)
          for (std::size_t z = 0; z < all_zooms.size(); ++z) {
            const MapColours& colour = all[c];
            const Zoom& zoom = all_zooms[z];
            if (zoom.with_window || !is_tried_here(drawn + c + z, c + 2 * z)) continue;
            const cv::Mat picture = zoomed(in_colours(map, colour.wall, colour.unknown, colour.free), zoom);
            for (const cv::Mat& image : {picture, as_jpeg(picture, 80)}) {
              ++cases;
              const std::optional<cv::Rect> view = view_in_window(to_rgb(image));
              EXPECT_FALSE(view.has_value()) << kind << " of seed " << seed << ", margin " << margin << ", "
                                             << colour.name << ", " << zoom.name << ": " << *view;
            }
          }
        for (const double searched : {0.0, 0.5}) {
          ++cases;
          const std::optional<cv::Rect> view = view_in_window(to_rgb(fine_league_image(map, searched)));
          EXPECT_FALSE(view.has_value()) << "league map of " << kind << " of seed " << seed << ": " << *view;
        }
      }
    }
  std::printf("%d pictures without a window\n", cases);
}

}  // namespace
}  // namespace rubble::scoring
