#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "slam/grid/bit_raster.h"

namespace rubble::slam {

/// One measured ray of a scan: where it ended, and whether on a surface.
struct ScanRay {
  mrpt::math::TPoint2D end;
  bool hit = true;      ///< false: nothing was met up to `end`
  bool joined = false;  ///< the next ray is the neighbouring beam: what lies between the two was seen as well
  int beam = 0;         ///< number of the beam, ascending or descending: tells how many are missing in between
};

/// Sets the bits of all cells whose centre lies inside what the scan saw. That is one polygon for each run of joined
/// rays: origin, ray ends in their order, origin. The first and the last ray of a run are widened by half a beam, since
/// a beam is not a line: the spot of such scanners is about as wide as the step between two beams.
/// Coordinates in cells of the raster's grid: cell c covers [c, c + 1). `rays` counter-clockwise and one turn at most,
/// so that the polygons do not overlap; what lies outside the raster is clipped. The raster must have been reset.
void fill_scan_polygons(const std::vector<ScanRay>& rays, const mrpt::math::TPoint2D& origin, double beam_width,
                        BitRaster& raster);

/// Neighbouring hits farther apart than this do not lie on one surface [m].
constexpr double kSurfaceGap = 0.3;

/// Clears the cells that the line between two neighbouring hits runs through, where they lie at most `max_gap` cells
/// apart: along a wall seen at a flat angle the hits leave gaps, and the cells in between are wall, not free. To count
/// them as free would make far walls faint, and a robot that lags behind would seem to fit the map better.
void clear_surfaces(const std::vector<ScanRay>& rays, double max_gap, BitRaster& raster);

/// Rays for ends whose beams are not known: sorted by bearing, joined where they lie closer than 1.5 beam widths.
std::vector<ScanRay> rays_from_ends(const std::vector<mrpt::math::TPoint2D>& hits,
                                    const std::vector<mrpt::math::TPoint2D>& passes, const mrpt::math::TPoint2D& origin,
                                    double beam_width);

}  // namespace rubble::slam
