#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

#include "base/grid.h"

namespace rubble::scoring {

/// Writes a PNG of the map laid over the truth: walls within 5 cm of each other dark, within 15 cm orange, walls only
/// in the map red, only in the truth blue, free space known by both white. `warning` stands in a red band over it.
/// Throws RunError when it cannot be written.
void write_overlay(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                   const mrpt::math::TPose2D& T_truth_map, const std::string& warning = "");

/// Writes a PNG of the truth in which each wall is coloured by its distance to the map's nearest wall (green 0 .. blue
/// >= tau: missing), and each wall of the map by its distance to the truth (green 0 .. red >= tau: phantom).
void write_error_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const mrpt::math::TPose2D& T_truth_map, double tau);

}  // namespace rubble::scoring
