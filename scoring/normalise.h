#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "scoring/pois.h"

namespace rubble::scoring {

struct LoadOptions {
  std::optional<double> resolution;  ///< [m] a pixel, for plain images; overrides what a file says
};

/// A map image reduced to classes on a metric grid.
struct LoadedMap {
  OccupancyGrid grid;
  std::string recognised;    ///< what was recognised, for people: "GeoTIFF 0.05 m, league colours"
  std::vector<Poi> symbols;  ///< victims drawn on it, in the coordinates of `grid`; league colours only
};

/// Reads GeoTIFF (own tags or .tfw beside it), ROS yaml + pgm/png, or a plain image with options.resolution.
/// Throws InputError: unreadable, no scale, absurd size.
LoadedMap load_map(const std::string& path, const LoadOptions& options = {});

}  // namespace rubble::scoring
