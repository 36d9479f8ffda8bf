#pragma once

#include "arenas/model/arena.h"
#include "base/image/geotiff.h"

namespace rubble::arenas {

/// A plan of the arena as a person would draw it, north up: wooden pallets, shaded as if lit from the north-west, the
/// higher the lighter; an arrow uphill on each ramp; walls and boxes dark; paper white; victims red; the start green
/// with an arrow along the heading. A large arena gets fewer pixels a metre, so that no side exceeds 6,000; painted in
/// bands, so that it takes little more memory than the picture.
RgbImage render(const Arena& arena, double pixels_per_metre = 60.0);

/// The same, and below it what its colours mean (those of what this arena has) and a scale bar. A small arena gets up
/// to twice as many pixels a metre, for the words to have room.
RgbImage render_with_legend(const Arena& arena, double pixels_per_metre = 60.0);

}  // namespace rubble::arenas
