#pragma once

#include "arenas/model/arena.h"
#include "base/image/geotiff.h"

namespace rubble::arenas {

/// A plan of the arena as a person would draw it, north up: wooden pallets, shaded as if lit from the north-west, the
/// higher the lighter; an arrow uphill on each ramp; walls and boxes dark; paper white; victims red; the start green
/// with an arrow along the heading. Throws InputError when the picture would be larger than 10,000 pixels a side.
RgbImage render(const Arena& arena, double pixels_per_metre = 60.0);

}  // namespace rubble::arenas
