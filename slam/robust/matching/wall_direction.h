#pragma once

#include <optional>

#include "base/angle.h"
#include "slam/robust/matching/cloud.h"

namespace rubble::slam {

constexpr double kOtherWalls = deg_to_rad(5.0);  ///< walls that run so differently are another building's

/// Which way the walls of a scan run: they stand along one direction or across it.
struct WallDirection {
  double angle = 0.0;  ///< of the walls in the base frame, within a quarter turn: (-pi/4, pi/4]
  double sigma = 0.0;  ///< of the lines that tell it [rad]
};

/// Wraps an angle to (-pi/4, pi/4]: what it is to walls that stand along it or across.
double wrap_quarter(double angle);

/// Lines through the points of a scan vote for the direction; nothing where too few metres of wall are seen or no
/// direction has most of them.
std::optional<WallDirection> wall_direction(const Cloud& cloud);

}  // namespace rubble::slam
