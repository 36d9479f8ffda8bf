#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// The shifts at which the walls of a map fall on its own walls most, best first, at most `count`; at least 0.6 m long
/// and apart, with a fifth of the walls on known ground. Where walls stand on a lattice these are its vectors: how a
/// map that knows the lattice, and nothing else, may come to lie.
std::vector<mrpt::math::TPoint2D> lattice_shifts(const OccupancyGrid& grid, std::size_t count);

}  // namespace rubble::scoring
