#include "scoring/maps/normalise.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>

#include "base/error.h"
#include "base/image/geotiff.h"
#include "scoring/maps/league_palette.h"
#include "scoring/maps/map_colours.h"
#include "scoring/maps/raster_image.h"
#include "scoring/maps/ros_map.h"
#include "scoring/maps/victim_symbols.h"

namespace rubble::scoring {
namespace {

namespace fs = std::filesystem;

constexpr double kMinResolution = 0.001;  // [m] a pixel
constexpr double kMaxResolution = 2.0;
constexpr double kSquare = 0.01;  // sides of a pixel may differ by this share

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// A world file beside the image: map.tif -> map.tfw, map.png -> map.pgw, or map.wld.
std::optional<PixelToModel> world_file_beside(const std::string& path) {
  const std::string extension = lower_extension(path);
  std::vector<std::string> names = {".wld"};
  if (extension.size() >= 3) names.insert(names.begin(), std::string{'.', extension[1], extension.back(), 'w'});
  for (const std::string& name : names) {
    const fs::path candidate = fs::path(path).replace_extension(name);
    if (fs::exists(candidate)) return read_world_file(candidate.string());
  }
  return std::nullopt;
}

void check_resolution(const std::string& path, double resolution) {
  if (!(resolution >= kMinResolution && resolution <= kMaxResolution))
    throw InputError(path + cv::format(": %g m a pixel is no scale of a building map (%g to %g); give the resolution "
                                       "in metres with --resolution",
                                       resolution, kMinResolution, kMaxResolution));
}

double pixel_size(const std::string& path, const PixelToModel& t) {
  const double along = std::hypot(t.a, t.d);
  const double across = std::hypot(t.b, t.e);
  if (std::abs(along - across) > kSquare * std::max(along, across))
    throw InputError(path + cv::format(": pixels are not square (%g x %g m); resample the image", along, across));
  return std::sqrt(along * across);
}

bool is_south_up(const std::optional<PixelToModel>& t) { return t && t->a * t->e - t->b * t->d > 0.0; }

/// Puts the image's classes on a metric frame. A rotated georeference keeps its scale, not its rotation.
OccupancyGrid place(const Grid<Occupancy>& classes, double resolution, const std::optional<PixelToModel>& t) {
  GridFrame frame = classes.frame();
  frame.resolution = resolution;
  const bool south_up = is_south_up(t);
  if (t && t->b == 0.0 && t->d == 0.0) {
    frame.x0 = std::min(t->c, t->c + t->a * frame.width);
    frame.y0 = std::min(t->f, t->f + t->e * frame.height);
  }
  OccupancyGrid out(frame);
  for (int y = 0; y < frame.height; ++y) {
    const Occupancy* row = classes.row(south_up ? frame.height - 1 - y : y);
    std::copy(row, row + frame.width, out.row(y));
  }
  return out;
}

/// The victims drawn on a league map, on the same frame.
std::vector<Poi> place_symbols(const RgbImage& image, const GridFrame& frame, bool south_up) {
  std::vector<Poi> out;
  for (const VictimSymbol& symbol : find_victim_symbols(image, frame.resolution)) {
    const double up = south_up ? symbol.row : frame.height - symbol.row;
    out.push_back({"symbol_" + std::to_string(out.size() + 1),
                   {frame.x0 + symbol.column * frame.resolution, frame.y0 + up * frame.resolution}});
  }
  return out;
}

/// Local frames begin where the robot did, a few hundred metres away at the most; UTM eastings and northings do not.
bool counts_from_the_start(const PixelToModel& t) {
  constexpr double kLocal = 10e3;  // [m]
  return t.b == 0.0 && t.d == 0.0 && std::abs(t.c) < kLocal && std::abs(t.f) < kLocal;
}

LoadedMap load_image(const std::string& path, const LoadOptions& options) {
  const std::string extension = lower_extension(path);
  const bool is_tiff = extension == ".tif" || extension == ".tiff";
  GeoTiff tiff;
  if (is_tiff)
    tiff = read_geotiff(path, league::kUnexplored);
  else
    tiff.image = read_rgb(path);
  check_image_size(path, tiff.image.width, tiff.image.height);

  std::string source = is_tiff ? "GeoTIFF" : "image";
  std::optional<PixelToModel> transform = tiff.transform;
  if (!transform && (transform = world_file_beside(path)))
    source = is_tiff ? "TIFF with world file" : "image with world file";
  if (!transform && !options.resolution)
    throw InputError(path + ": says nothing about its scale; give --resolution METRES_A_PIXEL or put a world file (" +
                     (is_tiff ? ".tfw" : ".wld") + ") beside it");
  const bool given = options.resolution && (options.overrides || !transform);
  const double resolution = given ? *options.resolution : pixel_size(path, *transform);
  check_resolution(path, resolution);
  if (given && transform && std::abs(pixel_size(path, *transform) - resolution) > 1e-9) transform.reset();

  const ClassImage classes = classify(tiff.image);
  LoadedMap out;
  out.transform = transform;
  if (transform) out.origin = counts_from_the_start(*transform) ? MapOrigin::Local : MapOrigin::Earth;
  out.grid = place(classes.classes, resolution, transform);
  if (classes.is_league) out.symbols = place_symbols(tiff.image, out.grid.frame(), is_south_up(transform));
  out.recognised = source + cv::format(" %g m a pixel, %d x %d, ", resolution, out.grid.width(), out.grid.height()) +
                   classes.recognised;
  return out;
}

}  // namespace

mrpt::math::TPoint2D in_grid(const LoadedMap& map, const mrpt::math::TPoint2D& p_model) {
  if (!map.transform) return p_model;
  const PixelToModel& t = *map.transform;
  const double x = p_model.x - t.c;
  const double y = p_model.y - t.f;
  const double determinant = t.a * t.e - t.b * t.d;
  const double column = (t.e * x - t.b * y) / determinant;
  const double row = (t.a * y - t.d * x) / determinant;
  const GridFrame& f = map.grid.frame();
  const double up = is_south_up(t) ? row : f.height - row;
  return {f.x0 + column * f.resolution, f.y0 + up * f.resolution};
}

LoadedMap load_map(const std::string& path, const LoadOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension != ".yaml" && extension != ".yml") return load_image(path, options);
  LoadedMap out;
  out.origin = MapOrigin::Ros;
  out.grid = read_ros_map(path);
  if (options.resolution && options.overrides) {
    check_resolution(path, *options.resolution);
    GridFrame frame = out.grid.frame();
    frame.resolution = *options.resolution;
    OccupancyGrid rescaled(frame);
    rescaled.cells() = out.grid.cells();
    out.grid = std::move(rescaled);
  }
  out.recognised =
      cv::format("ROS map %g m a pixel, %d x %d", out.grid.resolution(), out.grid.width(), out.grid.height());
  return out;
}

}  // namespace rubble::scoring
