#include "scoring/pictures/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/image/png.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using Colour = cv::Vec3b;  // blue, green, red

constexpr double kAgree = 0.05;  // walls this near count as the same in the overlay [m]
constexpr double kNear = 0.15;   // walls this near as displaced [m]
constexpr int kStrip = 34;       // height of the legend strip [pixels]
constexpr int kMaxSide = 3000;   // of the picture [pixels]

const Colour kInk(40, 34, 30);
const Colour kDisplaced(40, 150, 225);
const Colour kMapOnly(48, 48, 214);
const Colour kTruthOnly(205, 110, 20);
const Colour kBothFree(255, 255, 255);
const Colour kMapFree(222, 226, 248);
const Colour kTruthFree(248, 234, 218);
const Colour kUnknown(206, 206, 206);
const Colour kWall(120, 40, 0);

Occupancy at(const OccupancyGrid& grid, const TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) ? grid[c] : Occupancy::Unknown;
}

/// Pixels a cell such that a map of usual size can be read and a huge one still fits a screenful or two.
int pixels_per_cell(const GridFrame& frame) {
  const int side = std::max(frame.width, frame.height);
  return std::clamp(1800 / std::max(side, 1), 1, 3);
}

/// The frame of the picture: large maps are drawn with coarser cells.
GridFrame picture_frame(GridFrame frame) {
  const int side = std::max(frame.width, frame.height);
  const int shrink = (side + kMaxSide - 1) / kMaxSide;
  if (shrink <= 1) return frame;
  frame.resolution *= shrink;
  frame.width = (frame.width + shrink - 1) / shrink;
  frame.height = (frame.height + shrink - 1) / shrink;
  return frame;
}

/// A picture of a metric frame, north up, with room for a legend below.
struct Canvas {
  explicit Canvas(const GridFrame& map_frame) : frame(picture_frame(map_frame)), scale(pixels_per_cell(frame)) {
    const int width = std::max(frame.width * scale, 900);
    image = cv::Mat(frame.height * scale + kStrip, width, CV_8UC3, cv::Scalar(206, 206, 206));
    image.rowRange(frame.height * scale, image.rows).setTo(cv::Scalar(250, 250, 250));
  }
  int map_rows() const { return frame.height * scale; }
  int map_columns() const { return frame.width * scale; }
  /// Metric position of the centre of a pixel.
  TPoint2D point(int column, int row) const {
    return {frame.x0 + (column + 0.5) * frame.resolution / scale,
            frame.y0 + (map_rows() - row - 0.5) * frame.resolution / scale};
  }

  GridFrame frame;
  int scale;
  cv::Mat image;
};

void text(Canvas& canvas, const std::string& words, int x, int y) {
  cv::putText(canvas.image, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(kInk), 1, cv::LINE_AA);
}

int text_width(const std::string& words) {
  int base = 0;
  return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, 0.42, 1, &base).width;
}

/// A bar of a round number of metres, at most a quarter of the picture wide, at the right of the strip.
void draw_scale_bar(Canvas& canvas) {
  const double room = 0.2 * canvas.image.cols * canvas.frame.resolution / canvas.scale;
  double length = 0.1;
  for (const double candidate : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (candidate <= room) length = candidate;
  const int pixels = static_cast<int>(std::lround(length * canvas.scale / canvas.frame.resolution));
  const std::string words = length < 1.0 ? cv::format("%.1f m", length) : cv::format("%.0f m", length);
  const int right = canvas.image.cols - 12 - text_width(words) - 6;
  const int y = canvas.map_rows() + kStrip / 2;
  cv::rectangle(canvas.image, {right - pixels, y - 2}, {right, y + 2}, cv::Scalar(kInk), cv::FILLED);
  cv::line(canvas.image, {right - pixels, y - 6}, {right - pixels, y + 6}, cv::Scalar(kInk));
  cv::line(canvas.image, {right, y - 6}, {right, y + 6}, cv::Scalar(kInk));
  text(canvas, words, right + 6, y + 5);
}

struct LegendEntry {
  Colour colour;
  std::string words;
};

void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries) {
  int x = 10;
  const int y = canvas.map_rows() + kStrip / 2;
  for (const LegendEntry& entry : entries) {
    const cv::Rect box(x, y - 6, 12, 12);
    cv::rectangle(canvas.image, box, cv::Scalar(entry.colour), cv::FILLED);
    cv::rectangle(canvas.image, box, cv::Scalar(120, 120, 120));
    text(canvas, entry.words, x + 17, y + 5);
    x += 17 + text_width(entry.words) + 14;
  }
  draw_scale_bar(canvas);
}

Colour mixed(const Colour& a, const Colour& b, double share) {
  Colour out;
  for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<unsigned char>((1.0 - share) * a[i] + share * b[i]);
  return out;
}

/// From green to the colour of a wall that only one of the maps has: red for the map's (phantom), blue for the truth's
/// (missing), so that nobody takes one for the other.
Colour heat(double share, const Colour& only) {
  const double t = std::clamp(share, 0.0, 1.0);
  const Colour good(40, 160, 40);
  const Colour middle = mixed(mixed(good, only, 0.5), Colour(160, 235, 235), 0.6);
  return t < 0.5 ? mixed(good, middle, 2.0 * t) : mixed(middle, only, 2.0 * t - 1.0);
}

/// From a point to the edge of the nearest wall cell [m], as the score has it.
double to_wall(const WallField& field, const TPoint2D& p, const OccupancyGrid& grid) {
  return std::max(0.0, field.distance(p) - 0.5 * grid.resolution());
}

/// How a wall `off` metres from the nearest of the other map is drawn.
Colour wall_colour(double off, const Colour& only) { return off <= kAgree ? kInk : off <= kNear ? kDisplaced : only; }

Colour background(Occupancy map, Occupancy truth) {
  const bool map_known = map != Occupancy::Unknown;
  const bool truth_known = truth != Occupancy::Unknown;
  if (map_known && truth_known) return kBothFree;
  return map_known ? kMapFree : truth_known ? kTruthFree : kUnknown;
}

void draw_heat_bar(Canvas& canvas, double tau) {
  const int y = canvas.map_rows() + kStrip / 2;
  int x = 10;
  for (const auto& [words, only] :
       {std::pair{"map's wall off: 0", kMapOnly}, std::pair{"truth's wall off: 0", kTruthOnly}}) {
    text(canvas, words, x, y + 5);
    x += text_width(words) + 8;
    for (int i = 0; i < 60; ++i)
      cv::line(canvas.image, {x + i, y - 6}, {x + i, y + 6}, cv::Scalar(heat(i / 59.0, only)));
    const std::string most = cv::format("%.2g m: ", tau) + std::string(only == kMapOnly ? "phantom" : "missing");
    text(canvas, most, x + 66, y + 5);
    x += 66 + text_width(most) + 16;
  }
  draw_scale_bar(canvas);
}

/// A band over the picture's top that nobody overlooks.
void draw_warning(Canvas& canvas, const std::string& words) {
  if (words.empty()) return;
  cv::rectangle(canvas.image, {0, 0}, {canvas.image.cols - 1, 26}, cv::Scalar(kMapOnly), cv::FILLED);
  cv::putText(canvas.image, words, {10, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
}

}  // namespace

void write_overlay(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                   const TPose2D& T_truth_map, const std::string& warning) {
  Canvas canvas(common_frame(map, truth, T_truth_map, 0.5));
  const WallField to_map(map, 0.5);
  const WallField to_truth(truth, 0.5);
  for (int row = 0; row < canvas.map_rows(); ++row) {
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const TPoint2D p_truth = canvas.point(column, row);
      const TPoint2D p_map = T_truth_map.inverseComposePoint(p_truth);
      const Occupancy in_map = at(map, p_map);
      const Occupancy in_truth = at(truth, p_truth);
      Colour colour = background(in_map, in_truth);
      if (in_truth == Occupancy::Occupied) colour = wall_colour(to_wall(to_map, p_map, map), kTruthOnly);
      if (in_map == Occupancy::Occupied && colour != kInk)
        colour = wall_colour(to_wall(to_truth, p_truth, truth), kMapOnly);
      canvas.image.at<Colour>(row, column) = colour;
    }
  }
  draw_warning(canvas, warning);
  draw_legend(canvas, {{kInk, "walls within 5 cm"},
                       {kDisplaced, "within 15 cm"},
                       {kMapOnly, "only in map"},
                       {kTruthOnly, "only in truth"},
                       {kMapFree, "seen by map only"},
                       {kTruthFree, "not seen by map"}});
  write_png(path, canvas.image);
}

void write_error_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const TPose2D& T_truth_map, double tau) {
  Canvas canvas(common_frame(map, truth, T_truth_map, 0.5));
  const WallField to_map(map, tau);
  const WallField to_truth(truth, tau);
  for (int row = 0; row < canvas.map_rows(); ++row) {
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const TPoint2D p_truth = canvas.point(column, row);
      const TPoint2D p_map = T_truth_map.inverseComposePoint(p_truth);
      const Occupancy in_map = at(map, p_map);
      const Occupancy in_truth = at(truth, p_truth);
      Colour colour = background(in_map, in_truth);
      if (in_truth == Occupancy::Occupied)
        colour = heat(to_wall(to_map, p_map, map) / tau, kTruthOnly);
      else if (in_map == Occupancy::Occupied)
        colour = heat(to_wall(to_truth, p_truth, truth) / tau, kMapOnly);
      canvas.image.at<Colour>(row, column) = colour;
    }
  }
  draw_heat_bar(canvas, tau);
  write_png(path, canvas.image);
}

}  // namespace rubble::scoring
