#pragma once

#include "arenas/elements/element_shapes.h"

namespace rubble::arenas {

/// 10 x 10 columns of 0.1 m in a frame of 50 mm planks: the diagonal is `tallest` high, the others 0 to 3 quarters of
/// it. Red 0.4 m, orange 0.2 m.
void add_step_field(const ElementFrame& frame, double tallest, Arena& arena);
/// Four ramps of half a pallet that rise in turn, each to the side the next begins at: their floors agree nowhere.
/// slope: rise per metre.
/// Four half ramps that rise in turn, two on the ground and two 0.17 m up.
void add_elevated_ramps(const ElementFrame& frame, double slope, Arena& arena);
void add_crossing_ramps(const ElementFrame& frame, double slope, Arena& arena);
/// A ceiling over the pallet from 0.60 to 0.62 m, a wall of 1.2 m above it to either side: the ways in are at +y and
/// -y.
void add_tunnel(const ElementFrame& frame, Arena& arena);

}  // namespace rubble::arenas
