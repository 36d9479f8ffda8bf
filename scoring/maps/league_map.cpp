#include "scoring/maps/league_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/angle.h"
#include "base/text/number_text.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/known_box.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

/// For OpenCV, on a picture whose channels are red, green, blue.
cv::Scalar ink(const Rgb& colour) { return {double(colour[0]), double(colour[1]), double(colour[2])}; }

void paint(std::uint8_t* pixel, const Rgb& colour) { std::copy(colour.begin(), colour.end(), pixel); }

/// Grey of a free cell by confidence, 128 to 255, leaving out the band of the unknown checkerboard.
int free_grey(double confidence) {
  const int grey = 128 + static_cast<int>(std::lround(127.0 * confidence));
  if (grey >= 215 && grey < 231) return 214;
  if (grey >= 231 && grey < 247) return 247;
  return grey;
}

/// Green of a searched cell by confidence.
Rgb searched_green(double confidence) {
  Rgb out{};
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::uint8_t>(
        std::lround(league::kSearchedUnsure[i] + confidence * (league::kSearched[i] - league::kSearchedUnsure[i])));
  return out;
}

/// Places map points on a picture whose up is map x and whose left is map y.
class Canvas {
 public:
  Canvas(const KnownBox& box, double resolution)
      : box_(box),
        resolution_(resolution),
        image_(std::max(1, static_cast<int>(std::lround((box.y1 - box.y0) / resolution))),
               std::max(1, static_cast<int>(std::lround((box.x1 - box.x0) / resolution)))),
        mat_(image_.height, image_.width, CV_8UC3, image_.rgb.data()) {}

  TPoint2D map_point(int column, int row) const {
    return {box_.x1 - (row + 0.5) * resolution_, box_.y1 - (column + 0.5) * resolution_};
  }
  cv::Point pixel(const TPoint2D& p) const {
    return {static_cast<int>(std::floor((box_.y1 - p.y) / resolution_)),
            static_cast<int>(std::floor((box_.x1 - p.x) / resolution_))};
  }
  int pixels(double metres) const { return std::max(1, static_cast<int>(std::lround(metres / resolution_))); }
  cv::Mat& mat() { return mat_; }
  RgbImage& image() { return image_; }

 private:
  KnownBox box_;
  double resolution_;
  RgbImage image_;
  cv::Mat mat_;  // a view of image_
};

void draw_cells(Canvas& canvas, const LeagueCells& map, const LeagueDrawing& drawing) {
  const double threshold = drawing.occupied_threshold;
  RgbImage& image = canvas.image();
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const TPoint2D p = canvas.map_point(column, row);
      const Cell cell = map.frame.cell(p);
      std::uint8_t* pixel = image.pixel(column, row);
      const std::optional<double> p_occ = map.frame.inside(cell) ? map.p_occ(cell) : std::nullopt;
      if (!p_occ) {
        const bool dark = (static_cast<int>(std::floor(p.x)) + static_cast<int>(std::floor(p.y))) % 2 == 0;
        paint(pixel, dark ? league::kUnexplored : league::kUnexploredLight);
      } else if (*p_occ >= threshold) {
        paint(pixel, league::kWall);
      } else {
        const double x2 = std::abs(p.x * 2.0 - std::round(p.x * 2.0)), y2 = std::abs(p.y * 2.0 - std::round(p.y * 2.0));
        const bool line = std::min(x2, y2) * 0.5 < 0.25 / canvas.pixels(0.5);  // half a pixel either side
        const double confidence = 1.0 - *p_occ / threshold;
        const auto grey = static_cast<std::uint8_t>(free_grey(confidence));
        const bool searched = drawing.searched && drawing.searched(p);
        paint(pixel, line ? league::kGridLine : searched ? searched_green(confidence) : Rgb{grey, grey, grey});
      }
    }
}

void draw_scale(Canvas& canvas, const std::string& title) {
  cv::Mat& mat = canvas.mat();
  const cv::Scalar scale = ink(league::kScale);
  const int metre = canvas.pixels(1.0), left = 8, bottom = mat.rows - 10;
  cv::line(mat, {left, bottom}, {left + metre, bottom}, scale, 1);
  cv::line(mat, {left, bottom - 4}, {left, bottom + 4}, scale, 1);
  cv::line(mat, {left + metre, bottom - 4}, {left + metre, bottom + 4}, scale, 1);
  cv::putText(mat, "1 m", {left + 4, bottom - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.35, scale, 1);
  const cv::Point corner(mat.cols - 10, mat.rows - 10);
  const int arm = canvas.pixels(0.6);
  cv::arrowedLine(mat, corner, corner - cv::Point(0, arm), scale, 1);
  cv::arrowedLine(mat, corner, corner - cv::Point(arm, 0), scale, 1);
  cv::putText(mat, "x", corner + cv::Point(-10, -arm + 4), cv::FONT_HERSHEY_SIMPLEX, 0.35, scale, 1);
  cv::putText(mat, "y", corner + cv::Point(-arm, -5), cv::FONT_HERSHEY_SIMPLEX, 0.35, scale, 1);
  cv::putText(mat, title, {8, 12}, cv::FONT_HERSHEY_SIMPLEX, 0.35, ink(league::kTitle), 1);
}

void draw_path(Canvas& canvas, const Trajectory& path) {
  for (std::size_t i = 1; i < path.size(); ++i)
    cv::line(canvas.mat(), canvas.pixel({path[i - 1].pose.x, path[i - 1].pose.y}),
             canvas.pixel({path[i].pose.x, path[i].pose.y}), ink(league::kPath), canvas.pixels(0.02));
  const cv::Point tail = canvas.pixel({-0.125, 0.0}), head = canvas.pixel({0.125, 0.0});
  cv::arrowedLine(canvas.mat(), tail, head, ink(league::kStart), 2, cv::LINE_8, 0, 0.5);
}

void draw_victims(Canvas& canvas, const std::vector<LeagueVictim>& victims) {
  for (const auto& victim : victims) {
    const cv::Point centre = canvas.pixel(victim.p_map);
    cv::circle(canvas.mat(), centre, canvas.pixels(league::kVictimRadius), ink(league::kVictim), cv::FILLED);
    const std::string number = std::to_string(victim.id);
    cv::putText(canvas.mat(), number, centre + cv::Point(-4 * static_cast<int>(number.size()), 4),
                cv::FONT_HERSHEY_SIMPLEX, 0.35, ink(league::kLettering), 1);
  }
}

/// The picture's easting axis is map -y: 90 deg clockwise of map x.
std::optional<GeoAnchor> picture_anchor(std::optional<GeoAnchor> geo) {
  if (geo) geo->heading_deg += 90.0;
  return geo;
}

}  // namespace

PixelToModel picture_of_start(const std::optional<GeoAnchor>& geo) {
  int epsg = 0;
  return georeference(0.0, 0.0, 1.0, picture_anchor(geo), epsg);
}

GeoTiff draw_league_map(const LeagueCells& map, const LeagueDrawing& drawing) {
  const KnownBox box = known_box(map.frame, 0.75, [&](Cell c) { return map.p_occ(c).has_value(); });
  // A building of half a kilometre gets coarser pixels: nobody opens a picture of a gigabyte.
  constexpr double kMostPixels = 8000.0;
  double resolution = drawing.resolution;
  while (std::max(box.x1 - box.x0, box.y1 - box.y0) > kMostPixels * resolution) resolution *= 2.0;
  Canvas canvas(box, resolution);
  draw_cells(canvas, map, drawing);
  draw_scale(canvas, drawing.title);
  draw_path(canvas, drawing.path);
  draw_victims(canvas, drawing.victims);

  GeoTiff tiff;
  tiff.transform = georeference(-box.y1, box.x1, resolution, picture_anchor(drawing.geo), tiff.epsg);
  tiff.description =
      "{\"producer\": \"rubble\", \"frame\": \"easting = -map y, northing = map x\", \"resolution_m\": " +
      number_text(drawing.resolution) + ", \"victims\": " + std::to_string(drawing.victims.size()) + "}";
  tiff.image = std::move(canvas.image());
  return tiff;
}

GeoTiff draw_truth(const OccupancyGrid& truth) {
  GeoTiff tiff;
  tiff.image = RgbImage(truth.width(), truth.height());
  for (int row = 0; row < truth.height(); ++row)
    for (int column = 0; column < truth.width(); ++column) {
      std::uint8_t* pixel = tiff.image.pixel(column, row);
      switch (truth[{column, truth.height() - 1 - row}]) {
        case Occupancy::Free:
          paint(pixel, league::kFree);
          break;
        case Occupancy::Occupied:
          paint(pixel, league::kWall);
          break;
        case Occupancy::Unknown:
          paint(pixel, league::kUnexplored);
          break;
      }
    }
  const GridFrame& f = truth.frame();
  tiff.transform = georeference(f.x0, f.y0 + f.height * f.resolution, f.resolution, std::nullopt, tiff.epsg);
  tiff.description =
      "{\"producer\": \"rubble\", \"content\": \"ground truth\", \"resolution_m\": " + number_text(f.resolution) + "}";
  return tiff;
}

}  // namespace rubble::scoring
