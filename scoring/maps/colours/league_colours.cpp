#include "scoring/maps/colours/league_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/checkerboard.h"
#include "scoring/maps/colours/colour_strength.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/league_pixels.h"
#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/lossy_tones.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/colours/searched_floor.h"
#include "scoring/maps/colours/tone_curve.h"

namespace rubble::scoring {
namespace {

using league::Census;
using league::census;
using league::census_of;
using league::Colour;
using league::each_run;
using league::near_colour;
using league::rgb_of;
using league::spread;
using league::wall_share;

constexpr std::size_t kOneOfWalls = 5000;  // pixels in so many are wall, at the least
constexpr std::size_t kOneOfSquares = 40;  // the same of either grey of the checkerboard

/// The white of a picture whose contrast was taken down: 255 where the league's two greys do not lie below it as they
/// do below white.
int dimmed_white(const RgbImage& image) {
  constexpr int kGrey = 3;                                  // difference of the channels; the league's greys have 1
  constexpr int kDimmest = 200;                             // white of less light would be grey ground
  constexpr int kAsBefore = 250;                            // white that rounding and JPEG leave
  constexpr std::size_t kOneOfWhite = 50, kOneOfGrey = 25;  // pixels in so many that a map has at least of each
  std::array<std::size_t, 256> levels{};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    if (high - low <= kGrey) ++levels[image.rgb[i + 1]];
  }
  const std::size_t pixels = std::max<std::size_t>(1, image.rgb.size() / 3);
  int white = 255;
  while (white > kDimmest && kOneOfWhite * levels[static_cast<std::size_t>(white)] < pixels) --white;
  // Contrast is scaled about a middle grey or about black.
  const auto is_there = [&](int grey, int pivot) {
    const double at = pivot + (grey - pivot) * static_cast<double>(white - pivot) / (255 - pivot);
    std::size_t near = 0;
    for (int level = static_cast<int>(at) - 1; level <= static_cast<int>(at) + 2; ++level)
      near += levels[static_cast<std::size_t>(std::clamp(level, 0, 255))];
    return kOneOfGrey * near >= pixels;
  };
  if (white >= kAsBefore || white <= kDimmest) return 255;
  for (const int pivot : {0, 128})
    if (is_there(league::kUnexplored[0], pivot) && is_there(league::kUnexploredLight[0], pivot)) return white;
  return 255;
}

/// `change` is asked once a run.
template <class Change>
RgbImage recoloured(const RgbImage& image, const Change& change) {
  RgbImage out = image;
  each_run(image, [&](const Colour&, int first, int y, int length) {
    const Rgb now = change(rgb_of(image.pixel(first, y)));
    for (int x = first; x < first + length; ++x) std::copy(now.begin(), now.end(), out.pixel(x, y));
  });
  return out;
}

/// A twentieth of it is checkerboard, and there are walls: pixels of that blue by chance are fewer.
bool is_unchanged(const Census& c) {
  constexpr std::size_t kOneOfBoard = 20;
  return kOneOfBoard * c.checkerboard >= c.pixels && kOneOfWalls * c.pure_walls >= c.pixels && c.exact();
}

/// Whether a colour is one of the table's, or a mixture of it with searched floor.
bool is_of_table(const Colour& c, const Colour& own) {
  constexpr int kSlack = 25;  // of a channel, for rounding and JPEG: wall and way differ by 120
  const Colour floor = league::kSearched;
  const double r = floor.r - own.r, g = floor.g - own.g, b = floor.b - own.b;
  const double along = (c.r - own.r) * r + (c.g - own.g) * g + (c.b - own.b) * b;
  const double share = std::clamp(along / std::max(1.0, r * r + g * g + b * b), 0.0, 1.0);
  const auto mixed = [&](int from, double by) { return static_cast<std::uint8_t>(std::lround(from + share * by)); };
  return near_colour(c, Rgb{mixed(own.r, r), mixed(own.g, g), mixed(own.b, b)}, kSlack);
}

/// Dark colours, and those of them that the table has, blended or not.
struct Ink {
  std::size_t all = 0;
  std::size_t known = 0;
  void count(const Colour& c, std::size_t pixels) {
    constexpr int kDark = 100, kMostRed = 150;
    // What is lighter was blended too far to tell what of.
    if (c.g >= kDark || c.r >= kMostRed) return;
    all += pixels;
    const auto near = [&](const Rgb& own) { return is_of_table(c, own); };
    if (wall_share(c) > 0.45 || std::any_of(league::kAll.begin(), league::kAll.end(), near)) known += pixels;
  }
  /// Most of it is of the table.
  bool is_known() const { return 10 * known >= 9 * all; }
  bool is_strange() const { return all >= kFewest && 2 * known < all; }

 private:
  static constexpr std::size_t kFewest = 60;  ///< pixels that tell: blended at coarser pixels, a small map keeps fewer
};

/// Each colour and how often it is there, the most frequent first; nothing of pictures with more than a few thousand.
std::vector<std::pair<Rgb, std::size_t>> colours_of(const RgbImage& image) {
  constexpr std::size_t kMost = 4096;
  std::map<Rgb, std::size_t> count;
  each_run(image, [&](const Colour&, int first, int y, int length) {
    if (count.size() <= kMost) count[rgb_of(image.pixel(first, y))] += static_cast<std::size_t>(length);
  });
  if (count.size() > kMost) return {};
  std::vector<std::pair<Rgb, std::size_t>> out(count.begin(), count.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

/// What the floor of a picture with such squares may look like: white, or the green of what was searched.
std::vector<FloorTone> floor_tones(const Rgb& colour, const Rgb& lighter) {
  constexpr int kGreen = 15;  // over the other channels; searched floor has 50 or 100
  std::vector<FloorTone> out;
  if (colour[1] >= lighter[1]) out.push_back({colour, league::kFree});
  if (colour[1] >= std::max(colour[0], colour[2]) + kGreen)
    for (const Rgb& own : {league::kSearched, league::kSearchedUnsure}) out.push_back({colour, own});
  return out;
}

/// Of a curve that leaves white less than `told` over the squares.
std::string doubt_about_white(const ToneCurve& curve, int told) {
  const int apart = white_over_squares(curve);
  if (apart >= told) return {};
  return kDoubt + cv::format(
                      "that left white %d of 255 over the lighter squares of the checkerboard: free floor and "
                      "unexplored ground may be taken for each other",
                      apart);
}

/// The picture with the tones of before, where `curve` makes of the league's colours those that cover most of it.
std::optional<RestoredColours> undone(const ToneCurve& curve, const RgbImage& image,
                                      const std::vector<std::pair<Rgb, std::size_t>>& colours) {
  constexpr int kTold = 3;  // rounding of both
  const BeforeCurve was_before(curve);
  Census c;
  for (const auto& [colour, count] : colours) c.count(was_before(colour), count);
  if (!is_unchanged(c)) return std::nullopt;
  Ink ink;
  for (const auto& [colour, count] : colours) ink.count(was_before(colour), count);
  if (!ink.is_known()) return std::nullopt;
  std::map<Rgb, Rgb> before;
  for (const auto& [colour, count] : colours) before[colour] = was_before(colour);
  RgbImage out = recoloured(image, [&](const Rgb& colour) { return before.at(colour); });
  return RestoredColours{
      std::move(out), "tones had been changed (" + curve.name + ")", {}, true, doubt_about_white(curve, kTold)};
}

/// The picture as it was before its brightness, contrast or gamma was changed: where one such change makes of the
/// league's colours those that cover most of it.
std::optional<RestoredColours> with_tones_of_old(const RgbImage& image) {
  constexpr std::size_t kAmong = 6;  // of the most frequent colours are checkerboard and floor
  const auto colours = colours_of(image);
  const std::size_t among = std::min(kAmong, colours.size());
  for (std::size_t dark = 0; dark < among; ++dark)
    for (std::size_t light = 0; light < among; ++light) {
      const Rgb &darker = colours[dark].first, &lighter = colours[light].first;
      if (darker[1] >= lighter[1]) continue;
      for (std::size_t at = 0; at < among; ++at)
        for (const FloorTone& floor : floor_tones(colours[at].first, lighter))
          for (const ToneCurve& curve : tone_curves(darker, lighter, floor))
            if (auto restored = undone(curve, image, colours)) return restored;
    }
  return std::nullopt;
}

/// The same of a picture that went through JPEG afterwards, or was blended.
std::optional<RestoredColours> with_tones_before_loss(const RgbImage& image) {
  const std::optional<ToneCurve> curve = tone_curve_before_loss(image);
  if (!curve) return std::nullopt;
  RgbImage before = before_tones_and_loss(image, *curve);
  if (!is_league_map(before)) return std::nullopt;
  RestoredColours out{std::move(before), "tones had been changed (" + curve->name + ")"};
  constexpr double kPaleWalls = 0.8;
  constexpr int kToldByLoss = 6;  // JPEG moves even ground by half of that
  if (const double left = wall_colour_left(*curve); left < kPaleWalls)
    out.doubt = kDoubt + cv::format(
                             "that left walls %.0f %% of their colour before some of it was lost: pieces of them "
                             "may be taken for other lines",
                             100.0 * left);
  out.doubt += doubt_about_white(*curve, kToldByLoss);
  return out;
}

/// The picture as it was before it was blurred.
std::optional<RestoredColours> with_sharp_lines(const RgbImage& image) {
  const Blur blur = blur_of(image);
  if (blur.sigma == 0.0 || (!find_checkerboard(image).is_there() && !is_league_map(image))) return std::nullopt;
  return RestoredColours{without_blur(image, blur), cv::format("had been blurred (by %.1f pixels)", blur.sigma), blur};
}

/// How to say that colours were `by` times as strong. Strength leaves greys alone: where the squares of the
/// checkerboard have moved it was all tones that were changed, which makes colours of lines stronger or paler as well.
std::string told_of_strength(double by, const Rgb& darker) {
  constexpr int kMoved = 2;  // more than rounding and JPEG move them
  const double was = league::kUnexplored[1], now = darker[1];
  if (std::abs(now - was) <= kMoved || now <= 0.0 || now >= 255.0)
    return cv::format("colours had been made stronger (%.2g times)", by);
  return cv::format("tones had been changed (as by a gamma of %.2g), which made colours %.2g times as strong",
                    std::log(now / 255.0) / std::log(was / 255.0), by);
}

std::optional<RestoredColours> with_paler_colours(const RgbImage& image) {
  const double by = colour_strength(image);
  if (by == 1.0) return std::nullopt;
  const Checkerboard board = find_checkerboard(image);
  if (!board.is_there()) return std::nullopt;
  return RestoredColours{recoloured(image, [by](const Rgb& c) { return before_strengthening(c, by); }),
                         told_of_strength(by, board.darker)};
}

/// More than lines of it are coloured: maps of greys may have walls that look like squares.
bool has_colour(const RgbImage& image) {
  constexpr int kColoured = 20;        // difference of the channels
  constexpr std::size_t kOneIn = 500;  // pixels: fewer are no drawing
  std::size_t coloured = 0;
  each_run(image, [&](const Colour& c, int, int, int length) {
    if (spread(c) > kColoured) coloured += static_cast<std::size_t>(length);
  });
  return kOneIn * coloured >= image.rgb.size() / 3;
}

/// Pixels of thin lines in black: the walls of maps in greys, on which something may be drawn in blue.
std::size_t black_lines(const RgbImage& image) {
  // Brightness of black, blended or through JPEG, and difference of its channels; pixels across areas.
  constexpr int kDark = 60, kGrey = 24, kThick = 9;
  cv::Mat black = cv::Mat::zeros(image.height, image.width, CV_8U);
  each_run(image, [&](const Colour& c, int first, int y, int length) {
    if (c.g < kDark && c.r < kDark && c.b < kDark && spread(c) <= kGrey)
      std::fill_n(black.ptr<unsigned char>(y) + first, length, static_cast<unsigned char>(255));
  });
  cv::Mat areas;
  cv::copyMakeBorder(black, areas, kThick, kThick, kThick, kThick, cv::BORDER_REPLICATE);
  cv::morphologyEx(areas, areas, cv::MORPH_OPEN, cv::Mat::ones(kThick, kThick, CV_8U));
  return static_cast<std::size_t>(
      cv::countNonZero(black & ~areas(cv::Rect(kThick, kThick, image.width, image.height))));
}

/// Most light greys are those of the ground in league maps, also where JPEG or blending moved them a little.
bool has_even_ground(const RgbImage& image) {
  std::size_t all = 0, even = 0;
  each_run(image, [&](const Colour& c, int, int, int length) {
    constexpr int kLight = 150;  // the darkest ground, its grid, has 190; darker greys are lines
    constexpr int kGrey = 12;    // difference of the channels
    constexpr int kNear = 5;     // less than half of the 11 between the two squares
    if (c.g < kLight || spread(c) > kGrey) return;
    all += static_cast<std::size_t>(length);
    for (const Rgb& own : {league::kUnexplored, league::kUnexploredLight, league::kFree, league::kGridLine})
      if (std::abs(c.g - own[1]) <= kNear) {
        even += static_cast<std::size_t>(length);
        break;
      }
  });
  return 2 * even >= all;
}

/// Much of it has colours that no ground of a league map has: neither grey nor the green of what was searched. Asked of
/// the middle of the values in squares of some pixels: lines and noise have no say.
bool is_covered_with_strange_colours(const RgbImage& image) {
  constexpr int kSquare = 6, kEvery = 12;  // [pixels]: a quarter of the picture is asked
  constexpr int kOneIn = 4;                // squares; drawings cover less
  int strange = 0, all = 0;
  for (int top = 0; top + kSquare <= image.height; top += kEvery)
    for (int left = 0; left + kSquare <= image.width; left += kEvery) {
      std::array<int, 3> middle{};
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<std::uint8_t, static_cast<std::size_t>(kSquare * kSquare)> values{};
        auto to = values.begin();
        for (int y = top; y < top + kSquare; ++y)
          for (int x = left; x < left + kSquare; ++x) *to++ = image.pixel(x, y)[i];
        std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
        middle[i] = values[values.size() / 2];
      }
      const auto [low, high] = std::minmax({middle[0], middle[1], middle[2]});
      const bool green = middle[1] >= std::max(middle[0], middle[2]) + 15 && std::abs(middle[0] - middle[2]) <= 25;
      ++all;
      if (high - low > kMostTint && !green) ++strange;
    }
  return all > 0 && kOneIn * strange >= all;
}

/// Squares of two shades, as a tint leaves them. Floors of rooms have colours of their own, and the blocks of a JPEG
/// differ less.
bool is_of_one_tint(const Checkerboard& board) {
  constexpr int kTint = 24;      // by which the squares' tints may differ
  constexpr int kLeastStep = 5;  // between the squares; the league's has 11
  int step = 0;
  for (std::size_t i = 0; i < 3; ++i) step = std::max(step, int{board.lighter[i]} - int{board.darker[i]});
  if (step < kLeastStep) return false;
  const auto tint = [](const Rgb& c, std::size_t i) { return int{c[i]} - int{c[1]}; };
  return std::abs(tint(board.darker, 0) - tint(board.lighter, 0)) <= kTint &&
         std::abs(tint(board.darker, 2) - tint(board.lighter, 2)) <= kTint;
}

/// Greys alone, with both of the checkerboard.
bool is_grey_league_map(const RgbImage& image) {
  std::array<std::size_t, 256> levels{};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    if (image.rgb[i] != image.rgb[i + 1] || image.rgb[i] != image.rgb[i + 2]) return false;
    ++levels[image.rgb[i]];
  }
  const std::size_t pixels = image.rgb.size() / 3;
  // White floor, or what was searched.
  constexpr auto kSearched = static_cast<std::size_t>(league::brightness(league::kSearched));
  const std::size_t floor = std::max(levels[255], levels[kSearched] + levels[kSearched + 1]);
  return 20 * levels[226] >= pixels && 20 * levels[237] >= pixels && 100 * floor >= pixels;
}

}  // namespace

std::optional<RestoredColours> restored_league_colours(const RgbImage& image) {
  const Census as_is = census(image);
  if (as_is.exact() && as_is.pure_walls > 0) return std::nullopt;
  // Greys alone have a curve to the squares and white of the league wherever they were blended. A curve that makes of
  // the league's colours those of the picture to the digit says more than how strong one of them is, which it changes.
  const bool squares_moved = kOneOfSquares * std::min(as_is.darker, as_is.checkerboard - as_is.darker) < as_is.pixels;
  if (!as_is.exact() && squares_moved && has_colour(image))
    for (const auto& with_tones : {with_tones_of_old, with_tones_before_loss})
      if (auto restored = with_tones(image)) return restored;
  if (auto restored = with_paler_colours(image)) return restored;
  if (as_is.exact()) return std::nullopt;
  if (auto restored = with_sharp_lines(image)) return restored;
  const auto exchanged = [](const Rgb& c) { return Rgb{c[2], c[1], c[0]}; };
  if (is_unchanged(census_of(image, exchanged)))
    return RestoredColours{recoloured(image, exchanged), "red and blue were exchanged", {}, true};
  const auto inverted = [](const Rgb& c) {
    const auto other = [](std::uint8_t value) { return static_cast<std::uint8_t>(255 - value); };
    return Rgb{other(c[0]), other(c[1]), other(c[2])};
  };
  if (is_unchanged(census_of(image, inverted)))
    return RestoredColours{recoloured(image, inverted), "colours were inverted", {}, true};
  const int white = dimmed_white(image);
  if (white == 255) return std::nullopt;
  const auto brightened = [white](const Rgb& c) {
    const auto of_old = [white](std::uint8_t value) {
      return static_cast<std::uint8_t>(std::min(255, (255 * value + white / 2) / white));
    };
    return Rgb{of_old(c[0]), of_old(c[1]), of_old(c[2])};
  };
  return RestoredColours{recoloured(image, brightened), "white was " + std::to_string(white), {}, true};
}

std::string why_colours_are_lost(const RgbImage& image, bool is_league) {
  constexpr int kUneven = 12;  // of the checkerboard's squares over the picture; they differ by 11 from each other
  if (is_grey_league_map(image))
    return "is a league map without its colours: the robot's way and victims are as dark as walls; save it in colour";
  if (is_league && census(image).exact()) return "";
  if (is_league && !has_even_ground(image))
    return "is a league map that is not evenly bright (most of its ground has none of the league's greys, as in a "
           "photograph); give "
           "it as the robot saved it";
  const Checkerboard board = find_checkerboard(image);
  if (!board.is_there()) return "";
  if (!is_league && is_of_one_tint(board) && has_colour(image))
    return "is a league map whose colours were changed (tinted, equalised, filtered): which of its dark lines are "
           "walls, only the "
           "league's colours say; give it as the robot saved it";
  if (!is_league) return "";
  if (board.unevenness > kUneven)
    return "is a league map that is not evenly bright (its unexplored ground differs by " +
           std::to_string(board.unevenness) +
           " of 255 over the picture, as in a photograph); give it as the robot saved it";
  Ink ink;
  const RgbImage white = without_searched_floor(image);
  each_run(white, [&](const Colour& c, int, int, int length) { ink.count(c, static_cast<std::size_t>(length)); });
  if (ink.is_strange() && !has_run_colours(white))
    return "is a league map whose lines have other colours than the league's (as sharpened pictures have); give it as "
           "the robot "
           "saved it";
  return "";
}

bool is_league_map(const RgbImage& image) {
  const Census c = census(image);
  if (3 * c.walls > c.pixels) return false;  // a ground of that blue
  // Canvas may have the grey of one square, not of both.
  if (kOneOfSquares * std::min(c.darker, c.checkerboard - c.darker) >= c.pixels) return true;
  if (is_covered_with_strange_colours(image)) return false;
  constexpr std::size_t kFewest = 20;  // of walls: half a metre of a line of two pixels at 0.05 m
  const auto are_walls = [&](std::size_t count) { return count >= kFewest && kOneOfWalls * count >= c.pixels; };
  if (c.exact()) return are_walls(c.walls);
  // Colours that ran out of walls leave them black.
  const bool lossy = has_run_colours(without_searched_floor(image));
  const std::size_t walls = lossy ? static_cast<std::size_t>(cv::countNonZero(walls_by_brightness(image))) : c.walls;
  return are_walls(walls) && walls >= black_lines(image);
}

}  // namespace rubble::scoring
