#pragma once

#include <mrpt/math/TPoint2D.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "base/image/geotiff.h"
#include "base/trajectory.h"

namespace rubble::scoring {

/// A map as the league draws it: how surely cells are occupied.
struct LeagueCells {
  GridFrame frame;
  std::function<std::optional<double>(Cell)> p_occ;  ///< 0..1; nothing where never seen. Asked inside the frame only.
};

struct LeagueVictim {
  int id = 0;  ///< printed into its circle
  mrpt::math::TPoint2D p_map;
};

/// What is drawn over the map, and how fine.
struct LeagueDrawing {
  double resolution = 0.025;        ///< of the picture [m] a pixel
  double occupied_threshold = 0.5;  ///< p_occ from which a cell is drawn as wall
  std::string title;                ///< file name printed into the margin
  Trajectory path;                  ///< driven so far, map frame
  std::vector<LeagueVictim> victims;
  /// Whether the victim sensors have looked at the floor at a place, map frame; empty: nobody searched.
  std::function<bool(const mrpt::math::TPoint2D&)> searched;
  std::optional<GeoAnchor> geo;  ///< Earth position of the map origin and heading of its x axis
};

/// From metres right of and below the robot's start, on a picture with its start heading up, to the coordinates of a
/// league map: a local frame or, with an anchor, UTM.
PixelToModel picture_of_start(const std::optional<GeoAnchor>& geo);

/// Draws a map with the league's colours and symbols, cropped to the known area; map x points up, map y left
/// (easting = -y, northing = x), layers as the league orders them: checkerboard, map and grid, scale and axes, path,
/// objects.
GeoTiff draw_league_map(const LeagueCells& map, const LeagueDrawing& drawing);

/// A bare class map in league colours, easting = x, northing = y: how ground truth is stored.
GeoTiff draw_truth(const OccupancyGrid& truth);

}  // namespace rubble::scoring
