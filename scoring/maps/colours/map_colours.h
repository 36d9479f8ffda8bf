#pragma once

#include <optional>
#include <string>

#include "base/grid.h"
#include "base/image/rich_tiff.h"

namespace rubble::scoring {

/// What the colours of a map image turned out to mean.
struct ClassImage {
  Grid<Occupancy> classes;  ///< frame: 1 m a cell at the origin, row 0 is the image's lowest row
  std::string recognised;   ///< "league colours", "grey levels, unknown 205", ...
  std::string refusal;      ///< why this is no map of occupancy, and how to mend it; empty: it is one
  bool is_league = false;   ///< has the league's colours, so that its drawings mean something
  /// The picture as it was before its colours were changed as a whole (inverted, say); nothing: they were not.
  std::optional<RgbImage> restored;
};

/// Reduces any map image to {occupied, free, unknown}. League maps (RoboCupRescue GeoTIFF colours, as hector_geotiff
/// and crosbot draw them) lose their drawings: path, arrow, victims, hazards, QR codes, grid, scale, axes and file name
/// take the class around them. Grey maps: what a grey stands for is decided by the shape and place
/// of what has it (grey_roles()). Images that were turned or resampled with interpolation are understood: mixtures of
/// two colours count as the nearer one, and corners filled in by the turning as unknown.
ClassImage classify(const RgbImage& image, const SampleNotes& notes = {});

}  // namespace rubble::scoring
