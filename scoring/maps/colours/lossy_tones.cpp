#include "scoring/maps/colours/lossy_tones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/checkerboard.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/league_pixels.h"
#include "scoring/maps/colours/reading_doubts.h"

namespace rubble::scoring {
namespace {

constexpr int kMovedSquares = 2;  // of 255: JPEG and rounding move them less

/// The two greys where nobody has been.
struct Squares {
  Rgb darker{}, lighter{};
  bool have_moved() const {
    return std::abs(darker[1] - league::kUnexplored[1]) > kMovedSquares ||
           std::abs(lighter[1] - league::kUnexploredLight[1]) > kMovedSquares;
  }
};

/// Colours of even ground, the most frequent first, and how many pixels they have.
std::vector<std::pair<Rgb, int>> even_colours(const RgbImage& image) {
  constexpr int kEvenRun = 4;  // [pixels]
  constexpr std::size_t kAmongEven = 8;
  std::map<Rgb, int> count;
  league::each_run(image, [&](const league::Colour&, int first, int y, int length) {
    if (length >= kEvenRun) count[league::rgb_of(image.pixel(first, y))] += length;
  });
  std::vector<std::pair<Rgb, int>> out(count.begin(), count.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (out.size() > kAmongEven) out.resize(kAmongEven);
  return out;
}

/// By the corners of the checkerboard; where too few of them are seen, the two greys that cover most of the picture.
std::optional<Squares> squares_of(const RgbImage& image) {
  constexpr int kUnevenBoard = 4;
  constexpr std::size_t kOneOfEither = 40;  // pixels
  constexpr int kGreyTint = 2;
  constexpr int kNearest = 4, kFarthest = 30;  // squares of a gamma of 2.2 are 21 apart
  const Checkerboard board = find_checkerboard(image);
  if (board.is_there())
    return board.unevenness > kUnevenBoard ? std::nullopt : std::optional(Squares{board.darker, board.lighter});
  std::vector<Rgb> greys;
  for (const auto& [colour, pixels] : even_colours(image)) {
    const bool grey = league::spread(colour) <= kGreyTint && colour[1] < 250;
    if (!grey || kOneOfEither * static_cast<std::size_t>(pixels) < image.rgb.size() / 3) continue;
    if (std::none_of(greys.begin(), greys.end(), [&](const Rgb& g) { return std::abs(g[1] - colour[1]) < kNearest; }))
      greys.push_back(colour);
  }
  if (greys.size() < 2 || std::abs(greys[0][1] - greys[1][1]) > kFarthest) return std::nullopt;
  if (greys[0][1] > greys[1][1]) std::swap(greys[0], greys[1]);
  return Squares{greys[0], greys[1]};
}

/// Differences of colour of YCbCr, and brightness.
struct Tinted {
  double light = 0.0, blue = 0.0, red = 0.0;
};

Tinted tinted(const Rgb& c) {
  const double light = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
  return {light, 0.564 * (c[2] - light), 0.713 * (c[0] - light)};
}

Rgb through(const ToneCurve& curve, const Rgb& c) { return {curve.of[c[0]], curve.of[c[1]], curve.of[c[2]]}; }

/// How far a curve misses the squares and the floor.
int misfit(const ToneCurve& curve, const Squares& squares, const FloorTone& floor) {
  int out = 0;
  for (const auto& [own, now] : {std::pair(league::kUnexplored, squares.darker),
                                 std::pair(league::kUnexploredLight, squares.lighter), std::pair(floor.own, floor.now)})
    for (std::size_t i = 0; i < 3; ++i) out += std::abs(int{curve.of[own[i]]} - int{now[i]});
  return out;
}

/// Brightness of the darkest lines: those of league maps are walls.
int darkest_lines(const RgbImage& image) {
  constexpr std::size_t kDarkerOneIn = 300;  // pixels
  std::array<std::size_t, 256> count{};
  league::each_run(image, [&](const league::Colour& c, int, int, int length) {
    count[static_cast<std::size_t>(league::brightness(c))] += static_cast<std::size_t>(length);
  });
  int out = 0;
  for (std::size_t below = count[0]; out < 255 && kDarkerOneIn * below < image.rgb.size() / 3;)
    below += count[static_cast<std::size_t>(++out)];
  return out;
}

}  // namespace

double wall_colour_left(const ToneCurve& curve) {
  const Tinted own = tinted(league::kWall), now = tinted(through(curve, league::kWall));
  return std::hypot(now.blue, now.red) / std::hypot(own.blue, own.red);
}

RgbImage before_tones_and_loss(const RgbImage& image, const ToneCurve& curve) {
  const Tinted wall = tinted(league::kWall), floor = tinted(league::kSearched);
  const Tinted wall_now = tinted(through(curve, league::kWall)), floor_now = tinted(through(curve, league::kSearched));
  const double area = wall_now.blue * floor_now.red - floor_now.blue * wall_now.red;
  std::array<int, 256> before{};
  for (int value = 0; value < 256; ++value)
    before[static_cast<std::size_t>(value)] =
        static_cast<int>(std::min_element(curve.of.begin(), curve.of.end(),
                                          [value](int a, int b) { return std::abs(a - value) < std::abs(b - value); }) -
                         curve.of.begin());
  RgbImage out = image;
  league::each_run(image, [&](const league::Colour&, int first, int y, int length) {
    const Tinted c = tinted(league::rgb_of(image.pixel(first, y)));
    const double walls = (c.blue * floor_now.red - floor_now.blue * c.red) / area;
    const double floors = (wall_now.blue * c.red - c.blue * wall_now.red) / area;
    const double light = before[static_cast<std::size_t>(std::clamp(std::lround(c.light), 0L, 255L))];
    const double blue = walls * wall.blue + floors * floor.blue, red = walls * wall.red + floors * floor.red;
    const auto value = [](double v) { return static_cast<std::uint8_t>(std::clamp(std::lround(v), 0L, 255L)); };
    const Rgb now{value(light + red / 0.713), value(light - (0.114 * blue / 0.564 + 0.299 * red / 0.713) / 0.587),
                  value(light + blue / 0.564)};
    for (int x = first; x < first + length; ++x) std::copy(now.begin(), now.end(), out.pixel(x, y));
  });
  return out;
}

std::optional<ToneCurve> tone_curve_before_loss(const RgbImage& image) {
  constexpr int kLossyRounding = 2;
  constexpr int kDarkerWeighsLess = 4;  // JPEG and blending move lines more than areas
  constexpr int kGreener = 12;          // searched floor, over its other channels
  constexpr int kByChance = 3;          // what it counts that contrast and brightness leave white where it was
  constexpr double kLeastColour = 0.6;  // of walls: a gamma of 1.5 leaves 0.7, one of 2.2 0.4
  const std::optional<Squares> squares = squares_of(image);
  if (!squares || !squares->have_moved()) return std::nullopt;
  const int darkest = darkest_lines(image);
  std::optional<ToneCurve> best;
  int least = std::numeric_limits<int>::max();
  for (const auto& [now, pixels] : even_colours(image)) {
    std::vector<Rgb> own;
    if (now[1] > squares->lighter[1] && league::spread(now) < kGreener) own.push_back(league::kFree);
    if (now[1] >= std::max(now[0], now[2]) + kGreener) {
      own.push_back(league::kSearched);
      own.push_back(league::kSearchedUnsure);
    }
    for (const Rgb& floor : own)
      for (const ToneCurve& curve : tone_curves(squares->darker, squares->lighter, {now, floor}, kLossyRounding)) {
        // Curves that are alike in what became of light tones differ in what became of walls.
        const int wall = league::brightness(through(curve, league::kWall));
        const int chance = curve.name.rfind("gamma", 0) == 0 ? 0 : kByChance;
        const int off = misfit(curve, *squares, {now, floor}) + std::abs(wall - darkest) / kDarkerWeighsLess + chance;
        if (off >= least) continue;
        least = off;
        best = curve;
      }
  }
  return best && wall_colour_left(*best) >= kLeastColour ? best : std::nullopt;
}

std::string doubt_about_tones(const RgbImage& image) {
  const Checkerboard board = find_checkerboard(image);
  if (!board.is_there() || !Squares{board.darker, board.lighter}.have_moved()) return "";
  return kDoubt + cv::format(
                      "the squares of its checkerboard are %d and %d instead of %d and %d: its tones were "
                      "changed, and which of its dark lines are walls is a guess",
                      board.darker[1], board.lighter[1], league::kUnexplored[1], league::kUnexploredLight[1]);
}

}  // namespace rubble::scoring
