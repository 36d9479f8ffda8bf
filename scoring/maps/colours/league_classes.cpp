#include "scoring/maps/colours/league_classes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/league_pixels.h"
#include "scoring/maps/colours/lettering.h"
#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/nearest_ground.h"
#include "scoring/maps/colours/searched_floor.h"

namespace rubble::scoring {
namespace {

using league::Colour;
using league::each_run;
using league::looks_unexplored;
using league::near_colour;
using league::rgb_of;
using league::spread;
using league::wall_share;

using Label = unsigned char;
constexpr double kMostDrawn = 40.0;  // of the pixels of a map [%]
constexpr int kBlack = 30;
constexpr Label kUnknown = static_cast<Label>(Occupancy::Unknown);
constexpr Label kFree = static_cast<Label>(Occupancy::Free);
constexpr Label kWall = static_cast<Label>(Occupancy::Occupied);
constexpr Label kDrawing = 3;  // takes the class around it

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

/// Green enough to be searched floor where that is all that is asked of a pixel; without_searched_floor() asks for
/// more.
bool is_light_green(const Colour& c) {
  return c.g - c.r >= 20 && c.g - c.b >= 20 && std::abs(c.r - c.b) <= 20 && c.g >= 190;
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
    for (int x = 0; x < image.width; ++x) share.at<double>(y, x) = wall_share(rgb_of(image.pixel(x, y)));
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
void smooth(cv::Mat& labels, bool ragged) {
  cv::Mat closed;
  if (ragged) {
    cv::morphologyEx(labels == static_cast<int>(kWall), closed, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
    labels.setTo(static_cast<int>(kWall), closed);
  }
  cv::morphologyEx(labels == static_cast<int>(kFree), closed, cv::MORPH_CLOSE, cv::Mat::ones(5, 5, CV_8U));
  labels.setTo(static_cast<int>(kFree), closed & (labels == static_cast<int>(kUnknown)));
}

/// How many pixels are bluish, further than `reach` from those that are wall, for each that is: many where walls ran
/// into the floor beside them.
double paleness(const RgbImage& image, const cv::Mat& labels, int reach) {
  constexpr double kBluish = 0.12;  // share of wall
  const cv::Mat walls = labels == kWall;
  cv::Mat near = cv::Mat::zeros(walls.size(), CV_8U);
  if (reach > 0) cv::dilate(walls, near, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  std::size_t bluish = 0;
  each_run(image, [&](const Colour& c, int first, int y, int length) {
    if (wall_share(c) < kBluish) return;
    const Label* const row = near.ptr<Label>(y);
    bluish += static_cast<std::size_t>(std::count(row + first, row + first + length, Label{0}));
  });
  return static_cast<double>(bluish) / std::max(1, cv::countNonZero(walls));
}

}  // namespace

LabelImage classify_league(const RgbImage& as_given, const Blur& undone) {
  // Of wall and searched floor blended nobody knows the wall before.
  const RgbImage unsearched = without_searched_floor(as_given);
  const bool exact = league::census(unsearched).exact();
  const RgbImage& image = exact ? as_given : unsearched;
  LabelImage out;
  out.classes = cv::Mat(image.height, image.width, CV_8U);
  out.by_level = exact;
  const bool was_blurred = undone.sigma > 0.0;
  const bool lossy = !exact && (!was_blurred || undone.ripples) && has_run_colours(image);
  const cv::Mat dark_walls = lossy ? walls_by_brightness(as_given) : cv::Mat();
  const cv::Mat unexplored = lossy ? unexplored_by_brightness(image) : cv::Mat();
  std::size_t drawn = 0;
  std::size_t strange = 0;  // without the black canvas of a turned picture
  each_run(image, [&](const Colour& c, int first, int y, int length) {
    Label* const row = out.classes.ptr<Label>(y);
    std::fill_n(row + first, length, label_of(c, exact));
    for (int x = first; x < first + length; ++x) {
      if (lossy && !was_blurred && row[x] == kWall) row[x] = kDrawing;  // blue that ran
      if (lossy && dark_walls.at<Label>(y, x) != 0)
        row[x] = kWall;
      else if (lossy && row[x] != kDrawing && row[x] != kWall)
        row[x] = unexplored.at<Label>(y, x) != 0 ? kUnknown : kFree;
      if (row[x] == kDrawing) ++drawn;
      if (row[x] == kDrawing && std::max({c.r, c.g, c.b}) > kBlack) ++strange;
    }
  });
  if (!exact && !lossy) add_thin_walls(image, out.classes);
  fill_drawings(out.classes);
  drop_lettering(out.classes);
  // Of a palette each pixel has its own colour, as in the exact picture: what is ragged there was so.
  constexpr std::size_t kFewColours = 64;
  if (!exact) smooth(out.classes, !has_few_colours(as_given, kFewColours));
  const int letters = erase_lettering(out.classes);
  const double share =
      100.0 * static_cast<double>(drawn) / static_cast<double>(std::max<std::size_t>(1, out.classes.total()));
  const double astray =
      100.0 * static_cast<double>(strange) / static_cast<double>(std::max<std::size_t>(1, out.classes.total()));
  if (astray > kMostDrawn)
    out.refusal = cv::format(
        "has colours that are none of the league's on %.0f %% of its pixels (noise, a photograph, a dither); give it "
        "as the "
        "robot saved it",
        astray);
  out.recognised = cv::format("league colours%s, drawings removed from %.1f %% of the pixels",
                              exact   ? ""
                              : lossy ? " (compressed with loss)"
                                      : " (resampled)",
                              share);
  if (letters > 0) out.recognised += ", words on free ground removed";
  constexpr double kPale = 3.0, kPaleAfterBlur = 0.15;
  constexpr double kMostBlur = 3.2;  // beyond, walls of a pixel are too pale to be missed [pixels]
  constexpr int kRim = 2;            // of walls that were sharpened again [pixels]
  if (exact) return out;
  if (was_blurred && out.refusal.empty() &&
      (undone.sigma > kMostBlur || paleness(image, out.classes, kRim) > kPaleAfterBlur ||
       cv::countNonZero(out.classes == kWall) == 0))
    out.refusal = cv::format(
        "is a league map that was blurred too much (by %.1f pixels%s): its walls ran into the floor; give it as the "
        "robot saved it",
        undone.sigma, undone.sigma < Blur::kMost ? "" : " or more");
  if (paleness(as_given, out.classes, 0) > kPale) out.recognised += kWallsPale;
  return out;
}

}  // namespace rubble::scoring
