#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/grid.h"
#include "scoring/marks.h"

namespace rubble::scoring {

/// Writes a PNG of the map laid over the truth: walls within 5 cm of each other dark, within 15 cm orange, walls only
/// in the map red, only in the truth blue, free space known by both white; walls of the map where the truth knows
/// nothing (legends, axes, names beside the drawing) grey, as lines of sight and overlap do not count them. `warning`
/// stands in a red band over it. Victims: found ones green with a line to where they are, false ones crossed red,
/// missed ones ringed blue; with a warning all are grey. A seam is dashed violet. Throws RunError when it cannot be
/// written.
void write_overlay(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                   const mrpt::math::TPose2D& T_truth_map, const std::string& warning = "", const Marks& marks = {});

/// The same as bytes, for a page.
std::string overlay_png(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                        const std::string& warning = "", const Marks& marks = {});

/// Writes a PNG as the paper's Fig. 12: the map, turned as it lies on the truth, beside the truth; pairs of marks of
/// one colour joined by a line, outliers as red (map) and blue (truth) crosses, boxes and names where marks have them.
/// Without a pose the middles of both maps are brought together.
void write_side_by_side(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                        const std::optional<mrpt::math::TPose2D>& pose, const Marks& marks,
                        const std::string& warning = "");

/// Writes a PNG of the truth in which each wall is coloured by its distance to the map's nearest wall (green 0 .. blue
/// >= tau: missing), and each wall of the map by its distance to the truth (green 0 .. red >= tau: phantom), or
/// grey where the truth knows nothing.
void write_error_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const mrpt::math::TPose2D& T_truth_map, double tau);
/// The same as bytes, for a page.
std::string error_map_png(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                          double tau);

}  // namespace rubble::scoring
