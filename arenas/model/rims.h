#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// A piece of floor edge beyond which there is no floor, and no wall stands on it.
struct Rim {
  mrpt::math::TPoint2D a;
  mrpt::math::TPoint2D b;
  double z_a = 0.0;  ///< height of the floor at a [m]
  double z_b = 0.0;  ///< the same at b
};

/// All pieces at least `narrowest` [m] long: through shorter ones nothing as wide drives. Pieces that stand more than
/// `climbable_step` above the ground are left to risers(). `height` [m] above the floor is what a wall has to reach
/// into.
std::vector<Rim> open_rims(const Arena& arena, double climbable_step, double narrowest = 0.3, double height = 0.3);

}  // namespace rubble::arenas
