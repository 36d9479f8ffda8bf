#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "base/image/geotiff.h"
#include "scoring/maps/pois.h"

namespace rubble::scoring {

struct LoadOptions {
  std::optional<double> resolution;  ///< [m] a pixel
  bool overrides = true;             ///< `resolution` holds also where a file says its own (wrong tags)
};

/// Where a map's coordinates count from: what a list of places in other coordinates needs to know.
enum class MapOrigin {
  Local,   ///< a world file or tags in a local frame: the league's, easting = -y, northing = x of the robot's start
  Ros,     ///< the map frame of its yaml: x, y of the robot's start
  Earth,   ///< UTM, or a turned picture: where the robot started is not said
  Picture  ///< the lower left corner of an image that says nothing
};

/// A map image reduced to classes on a metric grid.
struct LoadedMap {
  OccupancyGrid grid;
  std::string recognised;  ///< what was recognised, for people: "GeoTIFF 0.05 m, league colours"
  MapOrigin origin = MapOrigin::Picture;
  std::optional<PixelToModel> transform;  ///< of the image's pixels, if its tags or world file are used
  std::vector<Poi> symbols;               ///< victims drawn on it, in the coordinates of `grid`; league colours only
};

/// A point in the coordinates of the tags or world file, in those of the grid (the same unless the picture is turned).
mrpt::math::TPoint2D in_grid(const LoadedMap& map, const mrpt::math::TPoint2D& p_model);

/// Reads GeoTIFF (own tags or .tfw beside it), ROS yaml + pgm/png, or a plain image with options.resolution.
/// Throws InputError: unreadable, no scale, absurd size.
LoadedMap load_map(const std::string& path, const LoadOptions& options = {});

}  // namespace rubble::scoring
