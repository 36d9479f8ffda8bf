#include "scoring/maps/normalise.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <utility>

#include "base/error.h"
#include "base/image/rich_tiff.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/map_colours.h"
#include "scoring/maps/raster_image.h"
#include "scoring/maps/ros_map.h"
#include "scoring/maps/victim_symbols.h"
#include "scoring/maps/wall_drawing.h"

namespace rubble::scoring {
namespace {

namespace fs = std::filesystem;

constexpr double kSquare = 0.01;  // sides of a pixel may differ by this share

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string lower_extension(const std::string& path) { return lower(fs::path(path).extension().string()); }

/// What programs call the world file of an image with this extension, by their habits: .tfw, .tifw, both with x, .wld.
std::vector<std::string> world_endings(const std::string& extension) {
  std::vector<std::string> out;
  if (extension.size() >= 3) {
    const std::string brief = {'.', extension[1], extension.back(), 'w'};
    for (const std::string& name : {brief, extension + "w", brief + "x", extension + "wx"}) out.push_back(name);
    if (extension == ".tif" || extension == ".tiff")
      for (const char* name : {".tifw", ".tiffw", ".tifwx", ".tiffwx"}) out.push_back(name);
  }
  out.push_back(".wld");
  return out;
}

/// A world file or .aux.xml beside the image, its ending in upper or lower case, behind the image's name with or
/// without its extension.
std::optional<PixelToModel> world_file_beside(const std::string& path) {
  const fs::path image(path);
  const fs::path folder = image.has_parent_path() ? image.parent_path() : fs::path(".");
  std::vector<std::string> beside;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, image.stem().string().size(), image.stem().string()) == 0) beside.push_back(name);
  }
  std::sort(beside.begin(), beside.end());
  const auto find = [&](const std::string& ending) -> std::optional<std::string> {
    for (const std::string& stem : {image.stem().string(), image.filename().string()})
      for (const std::string& name : beside)
        if (name.size() == stem.size() + ending.size() && name.compare(0, stem.size(), stem) == 0 &&
            lower(name.substr(stem.size())) == ending)
          return (folder / name).string();
    return std::nullopt;
  };
  for (const std::string& ending : world_endings(lower_extension(path)))
    if (const auto name = find(ending)) return read_world_file(*name);
  if (const auto name = find(".aux.xml")) return read_aux_xml(*name);
  return std::nullopt;
}

/// Metres on the ground that a metre of the map's plane stands for: web Mercator (EPSG:3857) is stretched more and more
/// towards the poles. Exact on the ellipsoid of WGS 84, the mean of north and east.
double ground_metres(const GeoTiff& tiff) {
  constexpr int kWebMercator = 3857;
  constexpr int kWebMercatorOfOld = 3785;
  if (!tiff.transform || (tiff.epsg != kWebMercator && tiff.epsg != kWebMercatorOfOld)) return 1.0;
  constexpr double kRadius = 6378137.0;          // [m]
  constexpr double kEccentricity2 = 6.69438e-3;  // squared
  const PixelToModel& t = *tiff.transform;
  const double northing = t.f + 0.5 * (t.d * tiff.image.width + t.e * tiff.image.height);
  const double latitude = std::atan(std::sinh(northing / kRadius));
  const double sine = std::sin(latitude);
  return std::cos(latitude) * std::sqrt(1.0 - kEccentricity2) / (1.0 - kEccentricity2 * sine * sine);
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
    out.push_back({"symbol " + std::to_string(out.size() + 1),
                   {frame.x0 + symbol.column * frame.resolution, frame.y0 + up * frame.resolution}});
  }
  return out;
}

/// Local frames begin where the robot did, a few hundred metres away at the most; UTM eastings and northings do not.
bool counts_from_the_start(const PixelToModel& t) {
  constexpr double kLocal = 10e3;  // [m]
  return t.b == 0.0 && t.d == 0.0 && std::abs(t.c) < kLocal && std::abs(t.f) < kLocal;
}

/// Where a drawing of walls leaves out a class, walls tell it.
void read_as_drawing(LoadedMap& map) {
  FloodedDrawing flooded = flood_drawing(std::move(map.grid));
  map.grid = std::move(flooded.grid);
  if (!flooded.note.empty()) map.recognised += "; " + flooded.note;
}

LoadedMap load_image(const std::string& path, const LoadOptions& options) {
  const std::string extension = lower_extension(path);
  const bool is_tiff = extension == ".tif" || extension == ".tiff";
  RichTiff rich;
  GeoTiff& tiff = rich.tiff;
  std::optional<PixelToModel> beside;
  if (is_tiff) {
    rich = read_rich_tiff(path, league::kUnexplored);
    if (!tiff.transform) beside = world_file_beside(path);
    // Coordinates count from the stored rows and columns, whichever way up a viewer shows them.
    if (!tiff.transform && !beside) turn_upright(rich);
  } else {
    beside = world_file_beside(path);
    tiff.image = read_rgb(path, beside ? Upright::AsStored : Upright::AsSeen);
  }
  check_image_size(path, tiff.image.width, tiff.image.height);

  std::string source = !is_tiff ? "image" : tiff.transform ? "GeoTIFF" : "TIFF";
  if (is_tiff && rich.pages > 1)
    source += ", page " + std::to_string(rich.page) + " of " + std::to_string(rich.pages) + ",";
  if (beside) source = is_tiff ? "TIFF with world file" : "image with world file";
  const std::optional<PixelToModel> transform = tiff.transform ? tiff.transform : beside;
  if (!transform && !options.resolution)
    throw InputError(path + ": says nothing about its scale; give --resolution METRES_A_PIXEL or put a world file (" +
                     (is_tiff ? ".tfw" : ".wld") + ") beside it");
  const bool given = options.resolution && (options.overrides || !transform);
  const double ground = ground_metres(tiff);
  const double resolution = given ? *options.resolution : ground * pixel_size(path, *transform);
  check_resolution(path, resolution);
  if (transform && !(std::abs(transform->c) <= kFarthestPlace && std::abs(transform->f) <= kFarthestPlace))
    throw InputError(path + cv::format(": its corner at %g, %g m lies farther off than any place on Earth; give it a "
                                       "georeference or world file in metres",
                                       transform->c, transform->f));
  const bool tags_hold = transform && (!given || std::abs(ground * pixel_size(path, *transform) - resolution) <= 1e-9);
  if (ground != 1.0 && !given) source += cv::format(" in web Mercator (%.4f m on the ground a metre)", ground);

  const ClassImage classes = classify(tiff.image, rich.notes);
  if (!classes.refusal.empty()) throw InputError(path + ": " + classes.refusal);
  LoadedMap out;
  if (tags_hold) out.transform = transform;
  if (tags_hold) out.origin = counts_from_the_start(*transform) ? MapOrigin::Local : MapOrigin::Earth;
  out.grid = place(classes.classes, resolution, out.transform);
  const RgbImage& drawn = classes.restored ? *classes.restored : tiff.image;
  if (classes.is_league) out.symbols = place_symbols(drawn, out.grid.frame(), is_south_up(out.transform));
  out.recognised = source + cv::format(" %g m a pixel, %d x %d, ", resolution, out.grid.width(), out.grid.height()) +
                   classes.recognised;
  read_as_drawing(out);
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
  RosMap ros = read_ros_map(path);
  out.grid = std::move(ros.grid);
  if (options.resolution && options.overrides) {
    check_resolution(path, *options.resolution);
    GridFrame frame = out.grid.frame();
    frame.resolution = *options.resolution;
    out.grid = with_frame(out.grid, frame);
  }
  out.recognised =
      cv::format("ROS map %g m a pixel, %d x %d", out.grid.resolution(), out.grid.width(), out.grid.height()) +
      ros.recognised;
  read_as_drawing(out);
  return out;
}

}  // namespace rubble::scoring
