#include "scoring/maps/colours/reading_doubts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/added_drawings.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/league_pixels.h"
#include "scoring/maps/colours/lettering.h"
#include "scoring/maps/colours/lossy_colours.h"

namespace rubble::scoring {
namespace {

double share(const cv::Mat& some, const cv::Mat& of) {
  return cv::countNonZero(some & of) / std::max(1.0, static_cast<double>(cv::countNonZero(of)));
}

/// Share of the pixels that lie on a slope along their row: values that go one way, step by step, from one pixel to the
/// one `stride` further on.
double sloping_in_rows(const cv::Mat& plane, int stride) {
  constexpr int kLeastStep = 3;  // of 255: even ground has less, through JPEG too
  constexpr int kSteps = 5;      // edges that were blended have three
  constexpr int kEvery = 3;      // row: slopes are areas, and a third of them tells as much
  std::size_t sloping = 0;
  for (int y = 0; y < plane.rows; y += kEvery) {
    const unsigned char* const row = plane.ptr<unsigned char>(y);
    int way = 0, first = 0;
    const auto end_at = [&](int x) {
      if (way != 0 && x - first >= kSteps * stride) sloping += static_cast<std::size_t>(x - first);
    };
    int last = 0;
    for (int x = stride; x < plane.cols; x += stride) {
      const int step = int{row[x]} - int{row[x - stride]};
      const int now = step >= kLeastStep ? 1 : step <= -kLeastStep ? -1 : 0;
      if (now == way) {
        last = x;
        continue;
      }
      end_at(last);
      way = now;
      first = last;
      last = x;
    }
    end_at(last);
  }
  return kEvery * static_cast<double>(sloping) / static_cast<double>(std::max<std::size_t>(1, plane.total()));
}

/// Larger strides see the slopes of pictures that were drawn larger, pixel by pixel.
double sloping_share(const cv::Mat& plane) {
  constexpr int kStrides = 3;  // [pixels]
  const cv::Mat upright = plane.t();
  double out = 0.0;
  for (int stride = 1; stride <= kStrides; ++stride)
    out = std::max(out, 0.5 * (sloping_in_rows(plane, stride) + sloping_in_rows(upright, stride)));
  return out;
}

/// The same of the channel that has most of them.
double sloping_share_of_channels(const RgbImage& image) {
  std::vector<cv::Mat> planes;
  cv::split(cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())), planes);
  double out = 0.0;
  for (const cv::Mat& plane : planes) out = std::max(out, sloping_share(plane));
  return out;
}

/// A palette that is not the league's: it has others, and lacks the wall's to the digit, or both those of free floor
/// and of the checkerboard, one of which every league map has. What a program's own palette has for them is a mean with
/// the lines that it took in.
bool has_palette_of_no_league(const RgbImage& image) {
  constexpr int kTint = 12;     // of greys; those of league maps may be any
  constexpr int kRounding = 3;  // of league colours that programs draw
  bool others = false, wall = false, free = false, darker = false, lighter = false;
  league::each_run(image, [&](const league::Colour& c, int, int, int) {
    const auto is = [&](const Rgb& own) { return league::near_colour(c, own, 0); };
    const auto is_about = [&](const Rgb& own) { return league::near_colour(c, own, kRounding); };
    others = others || (league::spread(c) > kTint && std::none_of(league::kAll.begin(), league::kAll.end(), is_about));
    wall = wall || is(league::kWall);
    free = free || is(league::kFree) || is(league::kSearched);
    darker = darker || is(league::kUnexplored);
    lighter = lighter || is(league::kUnexploredLight);
  });
  return others && (!wall || (!free && !(darker && lighter)));
}

/// Coloured pixels. Of league maps those of the robot's way: symbols belong on walls, and walls on searched floor are
/// of many tints.
cv::Mat ink_of(const RgbImage& image, bool is_league) {
  constexpr int kRed = 50, kBlue = 60;  // over green: the way has 120 and 140
  cv::Mat out = cv::Mat::zeros(image.height, image.width, CV_8U);
  league::each_run(image, [&](const league::Colour& c, int first, int y, int length) {
    const bool is_ink = is_league ? c.r >= c.g + kRed && c.b >= c.g + kBlue : league::spread(c) > kInkColour;
    if (is_ink) std::fill_n(out.ptr<unsigned char>(y) + first, length, static_cast<unsigned char>(255));
  });
  return out;
}

/// Some of its few colours stand for several that were there before.
bool is_of_small_palette(const RgbImage& image, const Reading& read) {
  constexpr std::size_t kPalette = 16;
  constexpr std::size_t kOwnColours = 5;  // three classes, a canvas and a drawing
  if (!has_few_colours(image, kPalette)) return false;
  return read.is_league ? has_palette_of_no_league(image) : !read.by_level && !has_few_colours(image, kOwnColours);
}

/// Share of the walls that drawings lie over or touch; 0 where coloured lines are no drawings, but walls or areas.
double walls_under_drawings(const RgbImage& image, const Reading& read, const cv::Mat& walls) {
  constexpr double kMostColoured = 0.5;  // of the walls: then they are coloured themselves
  const cv::Mat ink = ink_of(image, read.is_league);
  if (cv::countNonZero(ink) > kMostInk * static_cast<double>(ink.total()) || share(ink, walls) > kMostColoured)
    return 0.0;
  constexpr int kBeside = 5;  // [pixels]: JPEG and smoothing leave pale rims between the ink and the next wall
  cv::Mat near;
  cv::dilate(ink, near, cv::Mat::ones(kBeside, kBeside, CV_8U));
  return share(near, walls);
}

/// Share of the known ground that is wall, of walls that are areas and not lines.
double massive_share(const Reading& read, const cv::Mat& walls) {
  constexpr int kLine = 9;  // wider ones are areas [pixels]
  cv::Mat areas;
  cv::morphologyEx(walls, areas, cv::MORPH_OPEN, cv::Mat::ones(kLine, kLine, CV_8U));
  const double massive = cv::countNonZero(areas);
  return massive / std::max(1.0, massive + cv::countNonZero(read.classes == static_cast<int>(Occupancy::Free)));
}

}  // namespace

std::string doubts_about(const RgbImage& image, const RgbImage& as_drawn, const Reading& read) {
  // Of the pixels: a blurred and noisy JPEG with ragged walls has 0.019; JPEG draws colours out, up to 0.037.
  constexpr double kMostSlopes = 0.02, kMostOfColours = 0.05;
  constexpr double kMostHidden = 0.01;  // of the walls
  constexpr double kMostMassive = 0.5;  // of the known ground
  std::string out;
  const auto say = [&](const std::string& what) { out += kDoubt + what; };
  const cv::Mat walls = read.classes == static_cast<int>(Occupancy::Occupied);
  // Values of a scale waver within each class: of them only slopes that lead from class to class count.
  constexpr double kSteep = 6.0;
  const double slopes = sloping_share(read.by_scale ? cv::Mat(grey_of(image) / kSteep) : grey_of(image)),
               of_colours = read.by_scale ? 0.0 : sloping_share_of_channels(image);
  constexpr std::size_t kPaletteOfCosts = 512;
  const bool told = read.by_costs && has_few_colours(image, kPaletteOfCosts);
  if (!told && (slopes >= kMostSlopes || of_colours >= kMostOfColours))
    say(
        cv::format("greys or colours run into each other on %.0f %% of its pixels, as costs around walls or a blur do: "
                   "where walls end is a guess; of a costmap, give the map that it was made of",
                   100.0 * std::max(slopes, of_colours)));
  if (const double hidden = read.by_costs ? 0.0 : walls_under_drawings(image, read, walls); hidden >= kMostHidden)
    say(cv::format("coloured drawings lie on or beside %.0f %% of the walls: what they hide is a guess",
                   100.0 * hidden));
  if (const double massive = massive_share(read, walls); massive >= kMostMassive)
    say(cv::format("%.0f %% of the known ground are walls that are areas and not lines", 100.0 * massive));
  if (const int words = perhaps_words(read.classes); words > 0)
    say(cv::format("small pieces in a row at %d place%s, as letters: they count as walls", words,
                   words == 1 ? "" : "s"));
  if (is_of_small_palette(as_drawn, read))
    say("it has no more than 16 colours: lines in others may have taken the nearest, that of walls or of floor");
  return out;
}

}  // namespace rubble::scoring
