#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// A straight piece of something upright, seen from above. Thin boards are their centre line with a thickness; of all
/// else each edge of the outline is a line of its own, counter-clockwise, without thickness.
struct WallLine {
  mrpt::math::TPoint2D a, b;           ///< [m]
  double bottom_a = 0.0, top_a = 0.0;  ///< heights above the ground at a [m]
  double bottom_b = 0.0, top_b = 0.0;  ///< the same at b; only the flanks of ramps differ
  std::string kind;                    ///< the solid's element; "step": between two floors, "rim": floor to ground
  double thickness = 0.0;              ///< [m]
  int part = 0;                        ///< lines of one number belong to one solid, or to one edge of a floor
};

/// All walls, blocks, boxes and steps of the building; paper, balls and loose objects are not in it.
std::vector<WallLine> wall_lines(const Arena& arena);

/// One line a wall, first x0,y0,x1,y1,bottom,top,kind.
std::string walls_csv(const std::vector<WallLine>& lines);

/// A FeatureCollection of LineStrings in metres of the arena's frame, with the same fields as properties.
std::string walls_geojson(const std::vector<WallLine>& lines);

}  // namespace rubble::arenas
