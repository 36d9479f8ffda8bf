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
#include "scoring/maps/colours/tint.h"

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
    if (std::none_of(greys.begin(), greys.end(),
                     [&, c = colour](const Rgb& g) { return std::abs(g[1] - c[1]) < kNearest; }))
      greys.push_back(colour);
  }
  if (greys.size() < 2 || std::abs(greys[0][1] - greys[1][1]) > kFarthest) return std::nullopt;
  if (greys[0][1] > greys[1][1]) std::swap(greys[0], greys[1]);
  return Squares{greys[0], greys[1]};
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

/// What each brightness was. A curve that clips leaves many values at the end of the scale; of what is lighter than the
/// squares the league has white alone, and mixtures of both, which lie between them as they did.
std::array<double, 256> brightness_before(const ToneCurve& curve) {
  std::array<double, 256> out{};
  for (int value = 0; value < 256; ++value) {
    const auto nearer = [value](int a, int b) { return std::abs(a - value) < std::abs(b - value); };
    out[static_cast<std::size_t>(value)] =
        static_cast<double>(std::min_element(curve.of.begin(), curve.of.end(), nearer) - curve.of.begin());
  }
  const int square = league::kUnexploredLight[1], white = league::kFree[1];
  const int square_now = curve.of[static_cast<std::size_t>(square)],
            white_now = curve.of[static_cast<std::size_t>(white)];
  for (int value = square_now + 1; value < 256; ++value)
    out[static_cast<std::size_t>(value)] =
        value >= white_now
            ? white
            : square + (white - square) * (value - square_now) / static_cast<double>(white_now - square_now);
  return out;
}

/// Searched floor is no white, which fits any curve that clips it.
bool is_green(const Rgb& c) {
  constexpr int kGreener = 12;  // than the other channels
  return c[1] >= std::max(c[0], c[2]) + kGreener;
}

/// How far a curve misses the green that most of the searched floor has; 0 where there is none.
int misfit_of_green(const ToneCurve& curve, const std::vector<std::pair<Rgb, int>>& colours) {
  const auto green = std::find_if(colours.begin(), colours.end(), [](const auto& c) { return is_green(c.first); });
  if (green == colours.end()) return 0;
  int out = std::numeric_limits<int>::max();
  for (const Rgb& own : {league::kSearched, league::kSearchedUnsure}) {
    int off = 0;
    for (std::size_t i = 0; i < 3; ++i) off += std::abs(int{curve.of[own[i]]} - int{green->first[i]});
    out = std::min(out, off);
  }
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
  const Tint own = tint_of(league::kWall), now = tint_of(through(curve, league::kWall));
  return std::hypot(now.blue, now.red) / std::hypot(own.blue, own.red);
}

int white_over_squares(const ToneCurve& curve) {
  return curve.of[league::kFree[1]] - curve.of[league::kUnexploredLight[1]];
}

RgbImage before_tones_and_loss(const RgbImage& image, const ToneCurve& curve) {
  constexpr double kLeastArea = 1.0;  // two colours that lie on one line, or are grey: nothing tells their shares
  const Tint wall = tint_of(league::kWall), floor = tint_of(league::kSearched);
  const Tint wall_now = tint_of(through(curve, league::kWall)), floor_now = tint_of(through(curve, league::kSearched));
  const double area = wall_now.blue * floor_now.red - floor_now.blue * wall_now.red;
  const bool are_told = std::abs(area) >= kLeastArea;
  const std::array<double, 256> before = brightness_before(curve);
  RgbImage out = image;
  league::each_run(image, [&](const league::Colour&, int first, int y, int length) {
    const Tint c = tint_of(league::rgb_of(image.pixel(first, y)));
    const double walls = are_told ? (c.blue * floor_now.red - floor_now.blue * c.red) / area : 0.0;
    const double floors = are_told ? (wall_now.blue * c.red - c.blue * wall_now.red) / area : 0.0;
    const Rgb now = rgb_of(Tint{before[static_cast<std::size_t>(std::clamp(std::lround(c.light), 0L, 255L))],
                                walls * wall.blue + floors * floor.blue, walls * wall.red + floors * floor.red});
    for (int x = first; x < first + length; ++x) std::copy(now.begin(), now.end(), out.pixel(x, y));
  });
  return out;
}

std::optional<ToneCurve> tone_curve_before_loss(const RgbImage& image) {
  constexpr int kLossyRounding = 2;
  constexpr int kDarkerWeighsLess = 4;  // JPEG and blending move lines more than areas
  constexpr int kWhiterThan = 12;       // difference of the channels of white
  constexpr int kByChance = 3;          // what it counts that contrast and brightness leave white where it was
  constexpr double kLeastColour = 0.6;  // of walls: a gamma of 1.5 leaves 0.7, one of 2.2 0.4
  const std::optional<Squares> squares = squares_of(image);
  if (!squares || !squares->have_moved()) return std::nullopt;
  const int darkest = darkest_lines(image);
  std::optional<ToneCurve> best;
  int least = std::numeric_limits<int>::max();
  const std::vector<std::pair<Rgb, int>> colours = even_colours(image);
  for (const auto& [now, pixels] : colours) {
    std::vector<Rgb> own;
    if (now[1] > squares->lighter[1] && league::spread(now) < kWhiterThan) own.push_back(league::kFree);
    if (is_green(now)) {
      own.push_back(league::kSearched);
      own.push_back(league::kSearchedUnsure);
    }
    for (const Rgb& floor : own)
      for (const ToneCurve& curve : tone_curves(squares->darker, squares->lighter, {now, floor}, kLossyRounding)) {
        // Curves that are alike in what became of light tones differ in what became of walls.
        const int wall = league::brightness(through(curve, league::kWall));
        const int chance = curve.kind == ToneCurve::Kind::Gamma ? 0 : kByChance;
        const int green = floor == league::kFree ? misfit_of_green(curve, colours) : 0;
        const int off =
            misfit(curve, *squares, {now, floor}) + green + std::abs(wall - darkest) / kDarkerWeighsLess + chance;
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
