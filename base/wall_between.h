#pragma once

#include <mrpt/math/TPoint2D.h>

#include "base/grid.h"

namespace rubble {

/// Whether something occupied lies on the line between two places [m], both ends included.
bool wall_between(const OccupancyGrid& known, const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to);

}  // namespace rubble
