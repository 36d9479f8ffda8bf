#include "scoring/maps/colours/coloured_areas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/half_width.h"
#include "scoring/maps/colours/lossy_colours.h"
#include "scoring/maps/colours/nearest_ground.h"

namespace rubble::scoring {
namespace {

constexpr int kEvenSteps = 10;        // between pixels of an even area in a channel, with JPEG's ripples
constexpr int kBin = 16;              // width of a bin of colours: finer than two grounds that anybody tells apart
constexpr int kOneColour = 24;        // a channel of pixels of one area: a bin and a half
constexpr float kSameArea = 28.0F;    // the same, noise with it
constexpr double kLeastArea = 0.004;  // of the picture
constexpr std::size_t kMostAreaColours = 24;
constexpr double kLeastColoured = 0.12;  // of the picture: less is drawn on a map of greys
constexpr double kMostEven = 0.5;        // of the picture, at the least, are even areas
constexpr int kBlends = 3;               // pixels that blend two grounds: edges drawn twice as large have two or three
constexpr float kMixture = 22.0F;        // off the mixtures of two grounds, at the most
constexpr double kWallLike = 0.45;       // share of wall in a pixel that is wall
constexpr double kOffWall = 0.3;         // off the mixtures of wall and ground, of their difference
constexpr double kThinLines = 3.0;       // mean distance of a wall's pixels to its rim [pixels]
constexpr double kFewestWalls = 0.001;   // of the picture
constexpr double kMostWalls = 0.3;
constexpr double kOnRim = 0.5;      // of the picture's rim
constexpr double kAllAround = 0.8;  // of what lies beside a ground
constexpr float kSmeared = 0.5F;    // weight of colour beside brightness where JPEG smeared it
constexpr unsigned char kLine = 255;

/// Brightness and two differences of colour.
using Tone = cv::Vec3f;

Tone tone_of(const cv::Vec3f& rgb, float colour_weight) {
  const float light = 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
  return {light, colour_weight * (rgb[2] - light), colour_weight * (rgb[0] - light)};
}

cv::Mat colours_of_image(const RgbImage& image) {
  cv::Mat out(image.height, image.width, CV_8UC3);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.pixel(0, y), 3 * image.width, out.ptr(y));
  return out;
}

cv::Mat even_pixels(const cv::Mat& colours) {
  cv::Mat least, most, steps;
  cv::erode(colours, least, cv::Mat::ones(3, 3, CV_8U));
  cv::dilate(colours, most, cv::Mat::ones(3, 3, CV_8U));
  cv::subtract(most, least, steps);
  std::vector<cv::Mat> planes;
  cv::split(steps, planes);
  return (planes[0] <= kEvenSteps) & (planes[1] <= kEvenSteps) & (planes[2] <= kEvenSteps);
}

struct Bin {
  double count = 0.0;
  cv::Vec3d sum{};
};

/// Colours by their frequency, each with all that nobody can tell from it.
std::vector<std::pair<cv::Vec3f, double>> frequent(const cv::Mat& colours, const cv::Mat& of, double least,
                                                   std::size_t most_colours) {
  constexpr int kSide = 256 / kBin;
  std::vector<Bin> bins(static_cast<std::size_t>(kSide * kSide * kSide));
  const auto bin_of = [](int r, int g, int b) { return static_cast<std::size_t>((r * kSide + g) * kSide + b); };
  for (int y = 0; y < colours.rows; ++y)
    for (int x = 0; x < colours.cols; ++x) {
      if (of.at<unsigned char>(y, x) == 0) continue;
      const cv::Vec3b& c = colours.at<cv::Vec3b>(y, x);
      Bin& bin = bins[bin_of(c[0] / kBin, c[1] / kBin, c[2] / kBin)];
      bin.count += 1.0;
      bin.sum += cv::Vec3d(c[0], c[1], c[2]);
    }
  std::vector<std::pair<cv::Vec3f, double>> out;
  while (out.size() < most_colours) {
    const auto best =
        std::max_element(bins.begin(), bins.end(), [](const Bin& a, const Bin& b) { return a.count < b.count; });
    if (best->count < 0.5 * least || best->count <= 0.0) break;  // a colour may lie half in the next bin
    const cv::Vec3d centre = best->sum * (1.0 / best->count);
    Bin all;
    for (Bin& bin : bins) {
      if (bin.count <= 0.0) continue;
      const cv::Vec3d off = bin.sum * (1.0 / bin.count) - centre;
      if (std::max({std::abs(off[0]), std::abs(off[1]), std::abs(off[2])}) > kOneColour) continue;
      all.count += bin.count;
      bin = {};
    }
    if (all.count < least) continue;
    out.emplace_back(cv::Vec3f(centre), all.count);  // not the mean: what was merged is near it
  }
  return out;
}

float off(const cv::Vec3f& a, const cv::Vec3f& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

float spread_of_channels(const cv::Vec3f& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }

/// The area that each pixel is of; kLine: of none.
cv::Mat areas_of(const cv::Mat& colours, const std::vector<cv::Vec3f>& grounds) {
  cv::Mat out(colours.size(), CV_8U, cv::Scalar(kLine));
  for (int y = 0; y < colours.rows; ++y)
    for (int x = 0; x < colours.cols; ++x) {
      const cv::Vec3f c = colours.at<cv::Vec3b>(y, x);
      float least = kSameArea;
      for (std::size_t i = 0; i < grounds.size(); ++i)
        if (const float here = off(c, grounds[i]); here < least) {
          least = here;
          out.at<unsigned char>(y, x) = static_cast<unsigned char>(i);
        }
    }
  return out;
}

/// Those that cover areas: thick walls and ways are even, too.
std::vector<cv::Vec3f> broad_among(const cv::Mat& colours, const std::vector<cv::Vec3f>& grounds) {
  const cv::Mat label = areas_of(colours, grounds);
  std::vector<cv::Vec3f> out;
  for (std::size_t i = 0; i < grounds.size(); ++i)
    if (mean_half_width(label == static_cast<int>(i)) > kThinLines) out.push_back(grounds[i]);
  return out;
}

/// Labels without lines of an area's colour: the blended border of two rooms may have that of a third ground.
cv::Mat broad_labels(const cv::Mat& label, const cv::Mat& lines, std::size_t areas) {
  constexpr int kLeastWidth = 5;  // [pixels]
  cv::Mat out(label.size(), CV_8U, cv::Scalar(kLine)), broad;
  for (std::size_t i = 0; i < areas; ++i) {
    const cv::Mat here = label == static_cast<int>(i);
    cv::morphologyEx(here | lines, broad, cv::MORPH_OPEN, cv::Mat::ones(kLeastWidth, kLeastWidth, CV_8U));
    out.setTo(static_cast<int>(i), broad & here);
  }
  return out;
}

/// How far it is from the mixtures of two.
float off_mixture(const Tone& c, const Tone& a, const Tone& b) {
  const Tone way = b - a;
  const float length = way.dot(way);
  const float share = length > 0.0F ? std::clamp((c - a).dot(way) / length, 0.0F, 1.0F) : 0.0F;
  return static_cast<float>(cv::norm(c - a - share * way));
}

/// The areas within a few pixels, each once.
std::vector<unsigned char> areas_near(const cv::Mat& areas, int x, int y) {
  std::vector<unsigned char> out;
  for (int v = std::max(0, y - kBlends); v <= std::min(areas.rows - 1, y + kBlends); ++v)
    for (int u = std::max(0, x - kBlends); u <= std::min(areas.cols - 1, x + kBlends); ++u) {
      const unsigned char here = areas.at<unsigned char>(v, u);
      if (here != kLine && std::find(out.begin(), out.end(), here) == out.end()) out.push_back(here);
    }
  return out;
}

/// A picture by its areas and what lies between.
struct Areas {
  cv::Mat label;               ///< CV_8U, kLine between them
  std::vector<Tone> tones;     ///< of each area
  float colour_weight = 1.0F;  ///< of tones
  bool blended = true;         ///< as soon as there are more colours than areas and lines have
};

/// Lines, and not the blended borders of two areas.
cv::Mat lines_between(const cv::Mat& colours, const Areas& areas, const cv::Mat& apart) {
  cv::Mat out = cv::Mat::zeros(colours.size(), CV_8U);
  for (int y = 0; y < colours.rows; ++y)
    for (int x = 0; x < colours.cols; ++x) {
      if (areas.label.at<unsigned char>(y, x) != kLine || apart.at<unsigned char>(y, x) != 0) continue;
      const Tone c = tone_of(colours.at<cv::Vec3b>(y, x), areas.colour_weight);
      const std::vector<unsigned char> near = areas_near(areas.label, x, y);
      bool blended = false;
      for (std::size_t i = 0; areas.blended && i < near.size() && !blended; ++i)
        for (std::size_t k = i; k < near.size() && !blended; ++k)
          blended = off_mixture(c, areas.tones[near[i]], areas.tones[near[k]]) <= kMixture;
      if (!blended) out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// Of the colours that many lines have, the one that stands out most: ways and marks are drawn in paler ink.
Tone walls_of(const std::vector<std::pair<cv::Vec3f, double>>& inks, const Areas& areas) {
  constexpr double kMany = 0.3;  // of the most frequent
  Tone out;
  double farthest = -1.0;
  for (const auto& [colour, count] : inks) {
    const Tone tone = tone_of(colour, areas.colour_weight);
    double least = 1e9;
    for (const Tone& ground : areas.tones) least = std::min(least, cv::norm(tone - ground));
    if (count < kMany * inks.front().second || least <= farthest) continue;
    farthest = least;
    out = tone;
  }
  return out;
}

/// Pixels of lines that have enough of the walls' colour, beside the ground that is nearest.
cv::Mat walls_among(const cv::Mat& colours, const cv::Mat& lines, const cv::Mat& ground, const Areas& areas,
                    const Tone& wall) {
  cv::Mat out = cv::Mat::zeros(lines.size(), CV_8U);
  for (int y = 0; y < lines.rows; ++y)
    for (int x = 0; x < lines.cols; ++x) {
      if (lines.at<unsigned char>(y, x) == 0) continue;
      const Tone c = tone_of(colours.at<cv::Vec3b>(y, x), areas.colour_weight);
      const Tone& own_ground = areas.tones[ground.at<unsigned char>(y, x)];
      const Tone way = wall - own_ground, own = c - own_ground;
      const double length = cv::norm(way), share = own.dot(way) / (length * length);
      const bool is_wall = cv::norm(own - static_cast<float>(share) * way) <= kOffWall * length;
      if (share >= kWallLike && is_wall) out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// Lines are darker or lighter than both grounds, by a part of what these differ: greys tell them as well.
bool are_told_by_brightness(const cv::Mat& colours, const cv::Mat& lines, const std::vector<Tone>& grounds) {
  constexpr float kClearly = 0.3F;
  constexpr double kMost = 0.4;  // of them
  const auto [low, high] = std::minmax({grounds[0][0], grounds[1][0]});
  const float apart = kClearly * (high - low);
  double clear = 0.0;
  for (int y = 0; y < lines.rows; ++y)
    for (int x = 0; x < lines.cols; ++x) {
      if (lines.at<unsigned char>(y, x) == 0) continue;
      const float light = tone_of(colours.at<cv::Vec3b>(y, x), 1.0F)[0];
      clear += light < low - apart || light > high + apart ? 1.0 : 0.0;
    }
  return clear >= kMost * cv::countNonZero(lines);
}

/// Share of the pixels in `where` that are of each area.
std::vector<double> shares_in(const cv::Mat& label, const cv::Mat& where, std::size_t areas) {
  std::vector<double> out(areas, 0.0);
  double all = 0.0;
  for (int y = 0; y < label.rows; ++y)
    for (int x = 0; x < label.cols; ++x) {
      if (where.at<unsigned char>(y, x) == 0) continue;
      const unsigned char here = label.at<unsigned char>(y, x);
      if (here < areas) out[here] += 1.0;
      all += 1.0;
    }
  for (double& share : out) share /= std::max(1.0, all);
  return out;
}

std::size_t largest(const std::vector<double>& of) {
  return static_cast<std::size_t>(std::max_element(of.begin(), of.end()) - of.begin());
}

/// How many walls have this area on both sides.
int walls_within(const cv::Mat& ground, const cv::Mat& walls, std::size_t area) {
  constexpr int kWidest = 16;  // of a wall [pixels]
  int out = 0;
  const auto count = [&](const cv::Mat& labels, const cv::Mat& lines) {
    for (int y = 0; y < labels.rows; ++y)
      for (int x = 1; x + 1 < labels.cols; ++x) {
        if (lines.at<unsigned char>(y, x) == 0) continue;
        const int first = x;
        while (x + 1 < labels.cols && lines.at<unsigned char>(y, x) != 0) ++x;
        if (x - first <= kWidest && labels.at<unsigned char>(y, first - 1) == area &&
            labels.at<unsigned char>(y, x) == area)
          ++out;
      }
  };
  count(ground, walls);
  count(ground.t(), walls.t());
  return out;
}

/// Whether an area lies around what is not `outside` as the unknown ground in a window or within a frame does: no walls
/// stand between, or an upright frame all around, and none within it.
bool goes_on_as_unknown(const cv::Mat& outside, const cv::Mat& ground, const cv::Mat& walls, std::size_t area) {
  constexpr double kOpen = 0.1, kFrame = 0.9;  // of what is beside the outside
  constexpr double kUpright = 0.97;
  constexpr int kAnywhere = 20;  // walls within it [pixels]
  cv::Mat beside;
  cv::dilate(outside, beside, cv::Mat::ones(9, 9, CV_8U));
  beside &= ~outside;
  cv::Mat lines;
  cv::dilate(walls, lines, cv::Mat::ones(9, 9, CV_8U));
  const double with_walls =
      cv::countNonZero(lines & beside) / std::max(1.0, static_cast<double>(cv::countNonZero(beside)));
  const cv::Mat inside = ~outside;
  const bool upright = cv::countNonZero(inside) >= kUpright * cv::boundingRect(inside).area();
  return upright && (with_walls <= kOpen || with_walls >= kFrame) && walls_within(ground, walls, area) < kAnywhere;
}

/// Areas that are unknown ground: that on the rim, and what lies around all the rest (the paper around a map, the
/// window around a view).
std::vector<bool> unknown_among(const cv::Mat& label, const cv::Mat& walls, std::size_t areas) {
  std::vector<bool> out(areas, false);
  cv::Mat rim = cv::Mat::zeros(label.size(), CV_8U);
  cv::rectangle(rim, {0, 0}, {label.cols - 1, label.rows - 1}, cv::Scalar(255));
  const std::vector<double> on_rim = shares_in(label, rim, areas);
  if (on_rim[largest(on_rim)] < kOnRim) return {};
  std::size_t outer = largest(on_rim);
  out[outer] = true;
  cv::Mat around = label == static_cast<int>(outer);
  for (std::size_t i = 0; i + 2 < areas; ++i) {
    // Beside what is connected with the rim, no matter what lies within.
    cv::Mat padded, grown, inner;
    cv::copyMakeBorder(around, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
    cv::floodFill(padded, {0, 0}, cv::Scalar(128), nullptr, cv::Scalar(), cv::Scalar(), 4);
    // Words and ticks in it belong to it.
    cv::Mat within = ~cv::Mat(padded(cv::Rect(1, 1, label.cols, label.rows)) == 128);
    cv::morphologyEx(within, within, cv::MORPH_OPEN, cv::Mat::ones(9, 9, CV_8U));
    const cv::Mat outside = ~within;
    cv::dilate(outside, grown, cv::Mat::ones(9, 9, CV_8U));
    cv::dilate(outside, inner, cv::Mat::ones(7, 7, CV_8U));
    const std::vector<double> beside = shares_in(label, grown & ~inner, areas);
    const std::size_t next = largest(beside);
    if (out[next] || beside[next] < kAllAround || !goes_on_as_unknown(outside, label, walls, next)) break;
    out[next] = true;
    around |= label == static_cast<int>(next);
  }
  return std::count(out.begin(), out.end(), false) > 0 ? out : std::vector<bool>();
}

}  // namespace

std::optional<GreyedAreas> greys_of_coloured_areas(const RgbImage& image, const cv::Mat& apart) {
  constexpr std::size_t kPalette = 512;
  const cv::Mat colours = colours_of_image(image);
  cv::Mat smooth;
  cv::medianBlur(colours, smooth, 3);
  const auto pixels = static_cast<double>(colours.total());
  const cv::Mat even = even_pixels(smooth) & ~apart;
  std::vector<cv::Vec3f> grounds;
  double coloured = 0.0, covered = 0.0;
  for (const auto& [colour, count] : frequent(smooth, even, kLeastArea * pixels, kMostAreaColours + 1)) {
    grounds.push_back(colour);
    covered += count;
  }
  if (grounds.size() > kMostAreaColours) return std::nullopt;
  grounds = broad_among(smooth, grounds);
  if (grounds.size() < 2 || covered < kMostEven * pixels) return std::nullopt;
  Areas areas;
  areas.colour_weight = has_few_colours(image, kPalette) ? 1.0F : kSmeared;
  constexpr std::size_t kAtMostLines = 8;
  areas.blended = !has_few_colours(image, grounds.size() + kAtMostLines);
  areas.label = areas_of(colours, grounds);
  areas.label.setTo(kLine, apart);
  for (std::size_t i = 0; i < grounds.size(); ++i)
    if (spread_of_channels(grounds[i]) > kMostTint) coloured += cv::countNonZero(areas.label == static_cast<int>(i));
  if (coloured < kLeastColoured * pixels) return std::nullopt;
  for (const cv::Vec3f& ground : grounds) areas.tones.push_back(tone_of(ground, areas.colour_weight));
  const cv::Mat lines = lines_between(colours, areas, apart);
  const auto inks = frequent(colours, lines, 0.25 * kFewestWalls * pixels, 4);
  if (inks.empty()) return std::nullopt;
  cv::Mat ground = broad_labels(areas.label, lines, grounds.size());
  carry_ground(ground == static_cast<int>(kLine), ground);
  if (cv::countNonZero(ground == static_cast<int>(kLine)) > 0) return std::nullopt;  // no ground is broad anywhere
  const Tone wall = walls_of(inks, areas);
  // What JPEG has smeared greys tell better, or nobody.
  const bool lossy = areas.colour_weight < 1.0F;
  if (grounds.size() == 2 && (lossy || are_told_by_brightness(colours, lines, areas.tones))) return std::nullopt;
  const cv::Mat walls = walls_among(colours, lines, ground, areas, wall);
  const double drawn = cv::countNonZero(walls);
  if (drawn < kFewestWalls * pixels || drawn > kMostWalls * pixels || mean_half_width(walls) > kThinLines)
    return std::nullopt;
  const std::vector<bool> unknown = unknown_among(ground, walls, grounds.size());
  if (unknown.empty()) return std::nullopt;
  GreyedAreas out;
  out.how = "areas of " + std::to_string(grounds.size()) + " colours";
  cv::Mat table(1, 256, CV_8U, cv::Scalar(128));
  for (std::size_t i = 0; i < grounds.size(); ++i)
    table.at<unsigned char>(static_cast<int>(i)) = unknown[i] ? 128 : 255;
  cv::LUT(ground, table, out.grey);
  // Frames and words in unknown ground are no walls.
  cv::Mat beside_free;
  cv::dilate(out.grey == 255, beside_free, cv::Mat::ones(9, 9, CV_8U));
  out.grey.setTo(0, walls & beside_free);
  if (cv::countNonZero(out.grey == 0) == 0) return std::nullopt;
  return out;
}

}  // namespace rubble::scoring
