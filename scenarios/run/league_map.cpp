#include "scenarios/run/league_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "base/angle.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPoint2D;

// The colours two league teams agree on (hector_geotiff, crosbot), RGB.
const cv::Scalar kWall(0, 40, 120), kPath(120, 0, 140), kStart(255, 200, 0), kVictim(240, 10, 10);
const cv::Scalar kScale(0, 50, 140), kTitle(0, 44, 207), kGridLine(190, 190, 191);
constexpr int kUnknownDark = 226, kUnknownLight = 237;

/// Grey of a free cell by confidence, 128 to 255, leaving out the band of the unknown checkerboard.
int free_grey(double confidence) {
  const int grey = 128 + static_cast<int>(std::lround(127.0 * confidence));
  if (grey >= 215 && grey < 231) return 214;
  if (grey >= 231 && grey < 247) return 247;
  return grey;
}

struct Box {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

/// The cells with any information, grown by a margin, on whole half metres; a small box round the origin when there are
/// none.
template <class Known>
Box known_box(const GridFrame& frame, double margin, Known known) {
  int west = frame.width, east = -1, south = frame.height, north = -1;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (known(Cell{x, y})) {
        west = std::min(west, x), east = std::max(east, x);
        south = std::min(south, y), north = std::max(north, y);
      }
  if (east < west) return {-1.0, 1.0, -1.0, 1.0};
  const auto down = [](double v) { return 0.5 * std::floor(2.0 * v); };
  const auto up = [](double v) { return 0.5 * std::ceil(2.0 * v); };
  return {down(frame.x0 + west * frame.resolution - margin), up(frame.x0 + (east + 1) * frame.resolution + margin),
          down(frame.y0 + south * frame.resolution - margin), up(frame.y0 + (north + 1) * frame.resolution + margin)};
}

/// Places map points on a picture whose up is map x and whose left is map y.
class Canvas {
 public:
  Canvas(const Box& box, double resolution)
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
  Box box_;
  double resolution_;
  RgbImage image_;
  cv::Mat mat_;  // a view of image_
};

void draw_cells(Canvas& canvas, const slam::CountMap& map, double threshold) {
  RgbImage& image = canvas.image();
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const TPoint2D p = canvas.map_point(column, row);
      const Cell cell = map.frame().cell(p);
      std::uint8_t* pixel = image.pixel(column, row);
      if (!map.frame().inside(cell) || map.seen(cell) == 0) {
        const bool dark = (static_cast<int>(std::floor(p.x)) + static_cast<int>(std::floor(p.y))) % 2 == 0;
        const int grey = dark ? kUnknownDark : kUnknownLight;
        pixel[0] = pixel[1] = static_cast<std::uint8_t>(grey);
        pixel[2] = static_cast<std::uint8_t>(grey + 1);
      } else if (map.p_occ(cell) >= threshold) {
        for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(kWall[i]);
      } else {
        const double x2 = std::abs(p.x * 2.0 - std::round(p.x * 2.0)), y2 = std::abs(p.y * 2.0 - std::round(p.y * 2.0));
        const bool line = std::min(x2, y2) * 0.5 < 0.25 / canvas.pixels(0.5);  // half a pixel either side
        const int grey = free_grey(1.0 - map.p_occ(cell) / threshold);
        for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(line ? kGridLine[i] : grey);
      }
    }
}

void draw_scale(Canvas& canvas, const std::string& title) {
  cv::Mat& mat = canvas.mat();
  const int metre = canvas.pixels(1.0), left = 8, bottom = mat.rows - 10;
  cv::line(mat, {left, bottom}, {left + metre, bottom}, kScale, 1);
  cv::line(mat, {left, bottom - 4}, {left, bottom + 4}, kScale, 1);
  cv::line(mat, {left + metre, bottom - 4}, {left + metre, bottom + 4}, kScale, 1);
  cv::putText(mat, "1 m", {left + 4, bottom - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.35, kScale, 1);
  const cv::Point corner(mat.cols - 10, mat.rows - 10);
  const int arm = canvas.pixels(0.6);
  cv::arrowedLine(mat, corner, corner - cv::Point(0, arm), kScale, 1);
  cv::arrowedLine(mat, corner, corner - cv::Point(arm, 0), kScale, 1);
  cv::putText(mat, "x", corner + cv::Point(-10, -arm + 4), cv::FONT_HERSHEY_SIMPLEX, 0.35, kScale, 1);
  cv::putText(mat, "y", corner + cv::Point(-arm, -5), cv::FONT_HERSHEY_SIMPLEX, 0.35, kScale, 1);
  cv::putText(mat, title, {8, 12}, cv::FONT_HERSHEY_SIMPLEX, 0.35, kTitle, 1);
}

void draw_path(Canvas& canvas, const Trajectory& path) {
  for (std::size_t i = 1; i < path.size(); ++i)
    cv::line(canvas.mat(), canvas.pixel({path[i - 1].pose.x, path[i - 1].pose.y}),
             canvas.pixel({path[i].pose.x, path[i].pose.y}), kPath, canvas.pixels(0.02));
  const cv::Point tail = canvas.pixel({-0.125, 0.0}), head = canvas.pixel({0.125, 0.0});
  cv::arrowedLine(canvas.mat(), tail, head, kStart, 2, cv::LINE_8, 0, 0.5);
}

void draw_victims(Canvas& canvas, const std::vector<explore::VictimReport>& victims) {
  for (const auto& victim : victims) {
    const cv::Point centre = canvas.pixel(victim.p_map);
    cv::circle(canvas.mat(), centre, canvas.pixels(0.175), kVictim, cv::FILLED);
    const std::string number = std::to_string(victim.id);
    cv::putText(canvas.mat(), number, centre + cv::Point(-4 * static_cast<int>(number.size()), 4),
                cv::FONT_HERSHEY_SIMPLEX, 0.35, cv::Scalar(255, 255, 255), 1);
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

GeoTiff draw_league_map(const slam::CountMap& map, const LeagueDrawing& drawing) {
  const Box box = known_box(map.frame(), 0.75, [&](Cell c) { return map.seen(c) > 0; });
  // A building of half a kilometre gets coarser pixels: nobody opens a picture of a gigabyte.
  constexpr double kMostPixels = 8000.0;
  double resolution = drawing.resolution;
  while (std::max(box.x1 - box.x0, box.y1 - box.y0) > kMostPixels * resolution) resolution *= 2.0;
  Canvas canvas(box, resolution);
  draw_cells(canvas, map, drawing.occupied_threshold);
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
          pixel[0] = pixel[1] = pixel[2] = 255;
          break;
        case Occupancy::Occupied:
          for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(kWall[i]);
          break;
        case Occupancy::Unknown:
          pixel[0] = pixel[1] = kUnknownDark;
          pixel[2] = kUnknownDark + 1;
          break;
      }
    }
  const GridFrame& f = truth.frame();
  tiff.transform = georeference(f.x0, f.y0 + f.height * f.resolution, f.resolution, std::nullopt, tiff.epsg);
  tiff.description =
      "{\"producer\": \"rubble\", \"content\": \"ground truth\", \"resolution_m\": " + number_text(f.resolution) + "}";
  return tiff;
}

void write_ros_map(const std::string& stem, const OccupancyGrid& grid, double occupied_threshold) {
  const GridFrame& f = grid.frame();
  const Box box = known_box(f, f.resolution, [&](Cell c) { return grid[c] != Occupancy::Unknown; });
  const auto index = [&](double v, double origin) {
    return static_cast<int>(std::lround((v - origin) / f.resolution));
  };
  const int x0 = std::clamp(index(box.x0, f.x0), 0, f.width), x1 = std::clamp(index(box.x1, f.x0), 0, f.width);
  const int y0 = std::clamp(index(box.y0, f.y0), 0, f.height), y1 = std::clamp(index(box.y1, f.y0), 0, f.height);
  std::string pgm = "P5\n" + std::to_string(x1 - x0) + " " + std::to_string(y1 - y0) + "\n255\n";
  for (int y = y1 - 1; y >= y0; --y)
    for (int x = x0; x < x1; ++x) {
      const Occupancy o = grid[{x, y}];
      pgm.push_back(static_cast<char>(o == Occupancy::Unknown ? 205 : o == Occupancy::Free ? 254 : 0));
    }
  write_text_file(stem + ".pgm", pgm);
  std::ostringstream yaml;
  yaml << "image: " << stem.substr(stem.find_last_of('/') + 1) << ".pgm\nresolution: " << number_text(f.resolution)
       << "\norigin: [" << number_text(f.x0 + x0 * f.resolution) << ", " << number_text(f.y0 + y0 * f.resolution)
       << ", 0.0]\nnegate: 0\noccupied_thresh: " << number_text(std::max(occupied_threshold, 0.25))
       << "\nfree_thresh: 0.196\n";
  write_text_file(stem + ".yaml", yaml.str());
}

}  // namespace rubble::scenarios
