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

#include "base/grid.h"
#include "scoring/maps/colours/checkerboard.h"
#include "scoring/maps/colours/colour_strength.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/nearest_ground.h"
#include "scoring/maps/colours/searched_floor.h"
#include "scoring/maps/colours/tone_curve.h"

namespace rubble::scoring {
namespace {

using Label = unsigned char;
constexpr double kMostDrawn = 40.0;  // of the pixels of a map [%]
constexpr int kBlack = 30;
constexpr Label kUnknown = static_cast<Label>(Occupancy::Unknown);
constexpr Label kFree = static_cast<Label>(Occupancy::Free);
constexpr Label kWall = static_cast<Label>(Occupancy::Occupied);
constexpr Label kDrawing = 3;  // takes the class around it

struct Colour {
  int r = 0, g = 0, b = 0;
  constexpr Colour(const Rgb& c) : r(c[0]), g(c[1]), b(c[2]) {}
};

struct NamedColour {
  Colour colour;
  Label label;
};

constexpr std::array<NamedColour, 13> kPalette{{
    {league::kWall, kWall},
    {league::kUnexplored, kUnknown},
    {league::kUnexploredLight, kUnknown},
    {league::kGridLine, kFree},  // explored grid, only drawn in free space
    {league::kPath, kDrawing},
    {league::kStart, kDrawing},
    {league::kVictim, kDrawing},
    {league::kUnconfirmedVictim, kDrawing},
    {league::kHazard, kDrawing},
    {league::kQrCode, kDrawing},
    {league::kScale, kDrawing},
    {league::kTitle, kDrawing},
    {league::kFree, kFree},
}};

Rgb rgb_of(const std::uint8_t* p) { return {p[0], p[1], p[2]}; }

Colour colour_of(const std::uint8_t* p) { return rgb_of(p); }

int spread(const Colour& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); }

bool near_colour(const Colour& a, const Colour& b, int tolerance) {
  return std::abs(a.r - b.r) <= tolerance && std::abs(a.g - b.g) <= tolerance && std::abs(a.b - b.b) <= tolerance;
}

bool is_checkerboard(const Colour& c) {
  return near_colour(c, league::kUnexplored, 0) || near_colour(c, league::kUnexploredLight, 0);
}

/// Light grey as in the checkerboard, or a mixture of its two shades.
bool looks_unexplored(const Colour& c) { return spread(c) <= 6 && c.g >= 216 && c.g <= 245; }

/// Walls as a sharp filter leaves them (bicubic, Lanczos): it exaggerates their contrast with what is beside them,
/// white or searched floor, and the darkest colours end at 0.
bool is_exaggerated_wall(const Colour& c) { return c.r <= 10 && c.g <= 52 && c.b >= 85 && c.b <= 122; }

/// As bright as a colour looks.
constexpr int brightness(const Colour& c) { return (299 * c.r + 587 * c.g + 114 * c.b) / 1000; }

constexpr int kBlueOfWall = league::kWall[2] - league::kWall[0];           // blue over red
constexpr int kWallDarker = league::kFree[0] - brightness(league::kWall);  // than white

/// Share of wall blue in a mixture with a grey: blue over red grows from grey to wall, green over red a third as fast.
/// With white it is lightest: what is lighter is a symbol's blue on searched floor.
double wall_share(const Colour& c) {
  constexpr int kSlack = 35;  // of brightness
  if (is_exaggerated_wall(c)) return 1.0;
  const int blue = c.b - c.r;
  const int green = c.g - c.r;
  if (blue < 24 || 100 * green < 25 * blue || 100 * green > 55 * blue) return 0.0;
  if (kBlueOfWall * (brightness(c) - 255 - kSlack) > -kWallDarker * std::min(blue, kBlueOfWall)) return 0.0;
  return blue / static_cast<double>(kBlueOfWall);
}

/// Green enough to be searched floor where that is all that is asked of a pixel; without_searched_floor() asks for
/// more.
bool is_light_green(const Colour& c) {
  return c.g - c.r >= 20 && c.g - c.b >= 20 && std::abs(c.r - c.b) <= 20 && c.g >= 190;
}

struct Census {
  std::size_t walls = 0;
  std::size_t pure_walls = 0;
  std::size_t blended_walls = 0;  ///< with other ground
  std::size_t checkerboard = 0;
  std::size_t darker = 0;      ///< of the checkerboard's squares
  std::size_t unexplored = 0;  ///< checkerboard or as light
  std::size_t pixels = 0;
  /// Never turned, scaled or compressed with loss: the colours of the table hold to the digit.
  bool exact() const {
    return checkerboard > 0 && 10 * checkerboard >= 9 * unexplored && 10 * pure_walls >= 9 * walls &&
           5 * blended_walls <= walls;
  }
};

/// Calls visit(colour, x, y, length) for each run of pixels of one colour in a row: maps are areas, and to ask what
/// each pixel means by itself takes most of the time of reading one.
template <class Visit>
void each_run(const RgbImage& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y) {
    int first = 0;
    const auto same = [&](int x) {
      const std::uint8_t* const p = image.pixel(first, y);
      const std::uint8_t* const q = image.pixel(x, y);
      return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    };
    for (int x = 1; x <= image.width; ++x) {
      if (x < image.width && same(x)) continue;
      visit(colour_of(image.pixel(first, y)), first, y, x - first);
      first = x;
    }
  }
}

/// The white of a picture whose contrast was taken down: 255 where the league's two greys do not lie below it as they
/// do below white.
int dimmed_white(const RgbImage& image) {
  std::array<std::size_t, 256> levels{};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    if (high - low <= 3) ++levels[image.rgb[i + 1]];
  }
  const std::size_t pixels = std::max<std::size_t>(1, image.rgb.size() / 3);
  int white = 255;
  while (white > 200 && 50 * levels[static_cast<std::size_t>(white)] < pixels) --white;
  // Contrast is scaled about a middle grey or about black.
  const auto is_there = [&](int grey, int pivot) {
    const double at = pivot + (grey - pivot) * static_cast<double>(white - pivot) / (255 - pivot);
    std::size_t near = 0;
    for (int level = static_cast<int>(at) - 1; level <= static_cast<int>(at) + 2; ++level)
      near += levels[static_cast<std::size_t>(std::clamp(level, 0, 255))];
    return 25 * near >= pixels;
  };
  if (white >= 250 || white <= 200) return 255;
  for (const int pivot : {0, 128})
    if (is_there(league::kUnexplored[0], pivot) && is_there(league::kUnexploredLight[0], pivot)) return white;
  return 255;
}

void count_colour(const Colour& c, std::size_t count, Census& out) {
  out.pixels += count;
  if (is_checkerboard(c)) out.checkerboard += count;
  if (near_colour(c, league::kUnexplored, 0)) out.darker += count;
  if (looks_unexplored(c) && c.b > c.r) out.unexplored += count;
  const double share = wall_share(c);
  if (share > 0.2 && share < 0.9) out.blended_walls += count;
  if (share <= 0.5 || !near_colour(c, league::kWall, 45)) return;
  out.walls += count;
  if (near_colour(c, league::kWall, 0)) out.pure_walls += count;
}

/// Of the picture as `change` makes its colours: large ones are not copied for a question.
template <class Change>
Census census_of(const RgbImage& image, const Change& change) {
  Census out;
  each_run(image, [&](const Colour&, int first, int y, int length) {
    auto count = static_cast<std::size_t>(length);
    if (!image.alpha.empty())
      for (int x = first; x < first + length; ++x) count -= image.alpha[image.index(x, y)] < 128 ? 1 : 0;
    count_colour(change(rgb_of(image.pixel(first, y))), count, out);
  });
  return out;
}

Census census(const RgbImage& image) {
  return census_of(image, [](const Rgb& colour) { return colour; });
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

bool is_unchanged(const Census& c) {
  return 20 * c.checkerboard >= c.pixels && 5000 * c.pure_walls >= c.pixels && c.exact();
}

/// Whether a colour is one of the table's, or a mixture of it with searched floor.
bool is_of_table(const Colour& c, const Colour& own) {
  constexpr int kSlack = 25;
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
    constexpr int kDark = 100;
    if (c.g >= kDark || c.r >= kDark + 50) return;
    all += pixels;
    const auto near = [&](const NamedColour& named) { return is_of_table(c, named.colour); };
    if (wall_share(c) > 0.45 || std::any_of(kPalette.begin(), kPalette.end(), near)) known += pixels;
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
  constexpr int kGreen = 15;
  std::vector<FloorTone> out;
  if (colour[1] >= lighter[1]) out.push_back({colour, league::kFree});
  if (colour[1] >= std::max(colour[0], colour[2]) + kGreen)
    for (const Rgb& own : {league::kSearched, league::kSearchedUnsure}) out.push_back({colour, own});
  return out;
}

/// The picture with the tones of before, where `curve` makes of the league's colours those that cover most of it.
std::optional<RestoredColours> undone(const ToneCurve& curve, const RgbImage& image,
                                      const std::vector<std::pair<Rgb, std::size_t>>& colours) {
  Census c;
  Ink ink;
  for (const auto& [colour, count] : colours) {
    const Rgb was = without(curve, colour);
    count_colour(was, count, c);
    ink.count(was, count);
  }
  if (!is_unchanged(c) || !ink.is_known()) return std::nullopt;
  std::map<Rgb, Rgb> before;
  for (const auto& [colour, count] : colours) before[colour] = without(curve, colour);
  RgbImage out = recoloured(image, [&](const Rgb& colour) { return before.at(colour); });
  return RestoredColours{std::move(out), "tones had been changed (" + curve.name + ")"};
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

std::optional<RestoredColours> with_paler_colours(const RgbImage& image) {
  const double by = colour_strength(image);
  if (by == 1.0 || !find_checkerboard(image).is_there()) return std::nullopt;
  return RestoredColours{recoloured(image, [by](const Rgb& c) { return before_strengthening(c, by); }),
                         cv::format("colours had been made stronger (%.2g times)", by)};
}

Label label_of(const Colour& c, bool exact) {
  const int tolerance = exact ? 0 : 3;
  for (const NamedColour& named : kPalette)
    if (near_colour(c, named.colour, tolerance)) return named.label;
  const double wall = wall_share(c);
  if (wall >= 0.45) return wall <= 1.3 ? kWall : kDrawing;
  if (is_light_green(c)) return kFree;
  if (spread(c) > 12 || c.g < 100) return kDrawing;
  return !exact && looks_unexplored(c) ? kUnknown : kFree;
}

/// Drawings lie on free or unknown ground: each of their pixels takes the class of the nearest such pixel.
void fill_drawings(cv::Mat& labels) {
  const cv::Mat no_ground = (labels != static_cast<int>(kFree)) & (labels != static_cast<int>(kUnknown));
  cv::Mat ground = labels.clone();
  ground.setTo(static_cast<int>(kUnknown), no_ground);  // where there is no ground at all
  carry_ground(no_ground, ground);
  ground.copyTo(labels, labels == static_cast<int>(kDrawing));
}

/// Pictures made coarser blend a wall thinner than a pixel with the floor, over one pixel or two, and none of them may
/// be wall enough. Where a line of such pixels runs between pixels without any blue, the bluer one of the two is wall.
void add_thin_walls(const RgbImage& image, cv::Mat& labels) {
  constexpr double kSome = 0.2;      // share of wall that a pixel of the line has
  constexpr double kTogether = 0.4;  // and both that share the wall
  constexpr double kNone = 0.12;     // share beside the line
  cv::Mat share(labels.size(), CV_64F);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) share.at<double>(y, x) = wall_share(colour_of(image.pixel(x, y)));
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= image.width || y >= image.height ? 0.0 : share.at<double>(y, x);
  };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double own = at(x, y);
      if (own < kSome || own >= 0.45) continue;
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
        const double before = at(x - dx, y - dy), after = at(x + dx, y + dy);
        const bool alone = before < kNone && after < kNone;
        const bool first = before < kNone && own >= after && at(x + 2 * dx, y + 2 * dy) < kNone;
        const bool second = after < kNone && own > before && at(x - 2 * dx, y - 2 * dy) < kNone;
        const double together = own + (first ? after : second ? before : 0.0);
        if ((alone || first || second) && together >= kTogether) labels.at<Label>(y, x) = kWall;
      }
    }
  }
}

/// Blurred lettering and scales look like wall, but lie in unexplored space: a wall that no free pixel touches is none.
/// A drawing of walls alone has no free pixel.
void drop_lettering(cv::Mat& labels) {
  if (cv::countNonZero(labels == static_cast<int>(kFree)) == 0) return;
  cv::Mat components;
  const int count = cv::connectedComponents(labels == static_cast<int>(kWall), components, 8, CV_32S);
  cv::Mat beside_free;
  cv::dilate(labels == static_cast<int>(kFree), beside_free, cv::Mat::ones(5, 5, CV_8U));
  std::vector<bool> is_wall(static_cast<std::size_t>(count), false);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (beside_free.at<Label>(y, x) != 0) is_wall[static_cast<std::size_t>(components.at<int>(y, x))] = true;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels.at<Label>(y, x) == kWall && !is_wall[static_cast<std::size_t>(components.at<int>(y, x))])
        labels.at<Label>(y, x) = kUnknown;
}

/// Turned pictures have ragged walls; a ragged rim is a long one, which makes walls seem thinner than they are
/// (wall_half_thickness()). Notches of a pixel are filled. Their grid lines, blended with white, look unexplored:
/// unknown lines of up to four pixels inside free space are free.
void smooth(cv::Mat& labels) {
  cv::Mat closed;
  cv::morphologyEx(labels == static_cast<int>(kWall), closed, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  labels.setTo(static_cast<int>(kWall), closed);
  cv::morphologyEx(labels == static_cast<int>(kFree), closed, cv::MORPH_CLOSE, cv::Mat::ones(5, 5, CV_8U));
  labels.setTo(static_cast<int>(kFree), closed & (labels == static_cast<int>(kUnknown)));
}

/// More than lines of it are coloured: maps of greys may have walls that look like squares.
bool has_colour(const RgbImage& image) {
  constexpr int kColoured = 20;
  std::size_t coloured = 0;
  each_run(image, [&](const Colour& c, int, int, int length) {
    if (spread(c) > kColoured) coloured += static_cast<std::size_t>(length);
  });
  return 500 * coloured >= image.rgb.size() / 3;
}

/// Pixels of thin lines in black: the walls of maps in greys, on which something may be drawn in blue.
std::size_t black_lines(const RgbImage& image) {
  constexpr int kDark = 60, kGrey = 24, kThick = 9;
  cv::Mat black = cv::Mat::zeros(image.height, image.width, CV_8U);
  each_run(image, [&](const Colour& c, int first, int y, int length) {
    if (c.g < kDark && c.r < kDark && c.b < kDark && spread(c) <= kGrey)
      std::fill_n(black.ptr<Label>(y) + first, length, Label{255});
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
    constexpr int kLight = 150, kGrey = 12, kNear = 5;
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

/// Greys alone, with both of the checkerboard.
bool is_grey_league_map(const RgbImage& image) {
  std::array<std::size_t, 256> levels{};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    if (image.rgb[i] != image.rgb[i + 1] || image.rgb[i] != image.rgb[i + 2]) return false;
    ++levels[image.rgb[i]];
  }
  const std::size_t pixels = image.rgb.size() / 3;
  // White floor, or what was searched.
  constexpr auto kSearched = static_cast<std::size_t>(brightness(league::kSearched));
  const std::size_t floor = std::max(levels[255], levels[kSearched] + levels[kSearched + 1]);
  return 20 * levels[226] >= pixels && 20 * levels[237] >= pixels && 100 * floor >= pixels;
}

/// Much that is bluish and little that is blue enough: walls that ran into the floor beside them.
bool has_pale_walls(const RgbImage& image, const cv::Mat& labels) {
  constexpr double kBluish = 0.12;  // share of wall
  constexpr std::size_t kMost = 3;  // bluish pixels a pixel of wall
  std::size_t bluish = 0;
  each_run(image, [&](const Colour& c, int, int, int length) {
    if (wall_share(c) >= kBluish) bluish += static_cast<std::size_t>(length);
  });
  return bluish > kMost * static_cast<std::size_t>(cv::countNonZero(labels == kWall));
}

}  // namespace

std::optional<RestoredColours> restored_league_colours(const RgbImage& image) {
  const Census as_is = census(image);
  if (as_is.exact() && as_is.pure_walls > 0) return std::nullopt;
  if (auto restored = with_paler_colours(image)) return restored;
  if (as_is.exact()) return std::nullopt;
  const auto exchanged = [](const Rgb& c) { return Rgb{c[2], c[1], c[0]}; };
  if (is_unchanged(census_of(image, exchanged)))
    return RestoredColours{recoloured(image, exchanged), "red and blue were exchanged"};
  const auto inverted = [](const Rgb& c) {
    const auto other = [](std::uint8_t value) { return static_cast<std::uint8_t>(255 - value); };
    return Rgb{other(c[0]), other(c[1]), other(c[2])};
  };
  if (is_unchanged(census_of(image, inverted)))
    return RestoredColours{recoloured(image, inverted), "colours were inverted"};
  // Greys alone have a curve to the squares and white of the league wherever they were blended.
  if (has_colour(image) && 40 * std::min(as_is.darker, as_is.checkerboard - as_is.darker) < as_is.pixels)
    if (auto restored = with_tones_of_old(image)) return restored;
  const int white = dimmed_white(image);
  if (white == 255) return std::nullopt;
  const auto brightened = [white](const Rgb& c) {
    const auto of_old = [white](std::uint8_t value) {
      return static_cast<std::uint8_t>(std::min(255, (255 * value + white / 2) / white));
    };
    return Rgb{of_old(c[0]), of_old(c[1]), of_old(c[2])};
  };
  return RestoredColours{recoloured(image, brightened), "white was " + std::to_string(white)};
}

std::string why_colours_are_lost(const RgbImage& image, bool is_league) {
  constexpr int kUneven = 12;  // of the checkerboard's squares, beyond JPEG's
  if (is_grey_league_map(image))
    return "is a league map without its colours: the robot's way and victims are as dark as walls; save it in colour";
  if (is_league && census(image).exact()) return "";
  if (is_league && !has_even_ground(image))
    return "is a league map that is not evenly bright (most of its ground has none of the league's greys, as in a "
           "photograph); give "
           "it as the robot saved it";
  const Checkerboard board = find_checkerboard(image);
  if (!board.is_there()) return "";
  if (!is_league && has_colour(image))
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
  if (40 * std::min(c.darker, c.checkerboard - c.darker) >= c.pixels) return true;
  const auto are_walls = [&](std::size_t count) { return count >= 20 && 5000 * count >= c.pixels; };
  if (c.exact()) return are_walls(c.walls);
  // Colours that ran out of walls leave them black.
  const bool lossy = has_run_colours(without_searched_floor(image));
  const std::size_t walls = lossy ? static_cast<std::size_t>(cv::countNonZero(walls_by_brightness(image))) : c.walls;
  return are_walls(walls) && walls >= black_lines(image);
}

LabelImage classify_league(const RgbImage& as_given) {
  // Of wall and searched floor blended nobody knows the wall before.
  const RgbImage unsearched = without_searched_floor(as_given);
  const bool exact = census(unsearched).exact();
  const RgbImage& image = exact ? as_given : unsearched;
  LabelImage out;
  out.classes = cv::Mat(image.height, image.width, CV_8U);
  const bool lossy = !exact && has_run_colours(image);
  const cv::Mat dark_walls = lossy ? walls_by_brightness(as_given) : cv::Mat();
  const cv::Mat unexplored = lossy ? unexplored_by_brightness(image) : cv::Mat();
  std::size_t drawn = 0;
  std::size_t strange = 0;  // without the black canvas of a turned picture
  each_run(image, [&](const Colour& c, int first, int y, int length) {
    Label* const row = out.classes.ptr<Label>(y);
    std::fill_n(row + first, length, label_of(c, exact));
    for (int x = first; x < first + length; ++x) {
      if (lossy && row[x] == kWall) row[x] = kDrawing;
      if (lossy && dark_walls.at<Label>(y, x) != 0)
        row[x] = kWall;
      else if (lossy && row[x] != kDrawing)
        row[x] = unexplored.at<Label>(y, x) != 0 ? kUnknown : kFree;
      if (row[x] == kDrawing) ++drawn;
      if (row[x] == kDrawing && std::max({c.r, c.g, c.b}) > kBlack) ++strange;
    }
  });
  if (!exact && !lossy) add_thin_walls(image, out.classes);
  fill_drawings(out.classes);
  drop_lettering(out.classes);
  if (!exact) smooth(out.classes);
  const double share =
      100.0 * static_cast<double>(drawn) / static_cast<double>(std::max<std::size_t>(1, out.classes.total()));
  const double astray =
      100.0 * static_cast<double>(strange) / static_cast<double>(std::max<std::size_t>(1, out.classes.total()));
  if (astray > kMostDrawn)
    out.refusal = cv::format(
        "has colours that are none of the league's on %.0f %% of its pixels (noise, a photograph); give it as the "
        "robot saved it",
        astray);
  out.recognised = cv::format("league colours%s, drawings removed from %.1f %% of the pixels",
                              exact   ? ""
                              : lossy ? " (compressed with loss)"
                                      : " (resampled)",
                              share);
  if (!exact && has_pale_walls(as_given, out.classes)) out.recognised += kWallsPale;
  return out;
}

}  // namespace rubble::scoring
