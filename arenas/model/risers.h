#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// An upright piece of floor edge: the floor stands above what lies beyond the edge. Goes counter-clockwise round its
/// patch, so that a viewer who faces it from the low side sees `a` to the left.
struct Riser {
  mrpt::math::TPoint2D a;
  mrpt::math::TPoint2D b;
  double low_a = 0.0, high_a = 0.0;  ///< height of the low and the high side at a [m]
  double low_b = 0.0, high_b = 0.0;  ///< the same at b
  bool above_floor = false;          ///< false: beyond the edge there is only the ground at z = 0
};

/// All risers of at least `min_gap` [m] somewhere along them. A ramp's flank tapers to a triangle (low_a == high_a).
/// Flush neighbours leave none. O(edges x neighbours).
std::vector<Riser> risers(const Arena& arena, double min_gap = 0.001);

/// A part of a riser, as parameters along it from a (0) to b (1).
struct Stretch {
  double from = 0.0;
  double to = 1.0;
};

/// Where the step is higher than `limit` [m]; from >= to: nowhere. There it stops a wheel.
Stretch too_high(const Riser& riser, double limit);

}  // namespace rubble::arenas
