#include "scoring/pictures/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/image/png.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using Colour = cv::Vec3b;  // blue, green, red

constexpr double kAgree = 0.15;  // walls this near count as the same in the overlay [m]
constexpr int kStrip = 34;       // height of the legend strip [pixels]
constexpr int kMaxSide = 3000;   // of the picture [pixels]

const Colour kInk(40, 34, 30);
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

/// Green over yellow to red.
Colour heat(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  const double red = t < 0.5 ? 40.0 + 2.0 * t * 200.0 : 240.0 - (t - 0.5) * 2.0 * 30.0;
  const double green = t < 0.5 ? 160.0 + 2.0 * t * 30.0 : 190.0 - (t - 0.5) * 2.0 * 170.0;
  return Colour(30, static_cast<unsigned char>(green), static_cast<unsigned char>(red));
}

Colour background(Occupancy map, Occupancy truth) {
  const bool map_known = map != Occupancy::Unknown;
  const bool truth_known = truth != Occupancy::Unknown;
  if (map_known && truth_known) return kBothFree;
  return map_known ? kMapFree : truth_known ? kTruthFree : kUnknown;
}

void draw_heat_bar(Canvas& canvas, double tau) {
  const int y = canvas.map_rows() + kStrip / 2;
  const std::string words = "distance to the nearest wall of the other map: 0";
  text(canvas, words, 10, y + 5);
  const int x = 10 + text_width(words) + 8;
  for (int i = 0; i < 90; ++i) cv::line(canvas.image, {x + i, y - 6}, {x + i, y + 6}, cv::Scalar(heat(i / 89.0)));
  text(canvas, cv::format("%.2g m or more", tau), x + 98, y + 5);
  draw_scale_bar(canvas);
}

}  // namespace

void write_overlay(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                   const TPose2D& T_truth_map) {
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
      if (in_truth == Occupancy::Occupied) colour = to_map.distance(p_map) <= kAgree ? kInk : kTruthOnly;
      if (in_map == Occupancy::Occupied && colour != kInk)
        colour = to_truth.distance(p_truth) <= kAgree ? kInk : kMapOnly;
      canvas.image.at<Colour>(row, column) = colour;
    }
  }
  draw_legend(canvas, {{kInk, "walls agree"},
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
        colour = heat(to_map.distance(p_map) / tau);
      else if (in_map == Occupancy::Occupied)
        colour = heat(to_truth.distance(p_truth) / tau);
      canvas.image.at<Colour>(row, column) = colour;
    }
  }
  draw_heat_bar(canvas, tau);
  write_png(path, canvas.image);
}

void write_grid_png(const std::string& path, const OccupancyGrid& grid) {
  Canvas canvas(grid.frame());
  for (int row = 0; row < canvas.map_rows(); ++row) {
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const Occupancy in_grid = at(grid, canvas.point(column, row));
      canvas.image.at<Colour>(row, column) = in_grid == Occupancy::Occupied ? kWall
                                             : in_grid == Occupancy::Free   ? kBothFree
                                                                            : kUnknown;
    }
  }
  draw_legend(canvas, {{kWall, "wall"}, {kBothFree, "free"}, {kUnknown, "unknown"}});
  write_png(path, canvas.image);
}

}  // namespace rubble::scoring
