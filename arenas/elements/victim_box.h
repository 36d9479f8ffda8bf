#pragma once

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// Adds a victim in the middle of its box: a back and two side boards of 15 mm, open to `facing` and to the top.
/// The boards reach from the lowest floor below the box to `size` above the highest. position.z of `victim` is taken
/// as height above the floor there and is replaced by the absolute height. size [m] 0: no box.
void add_victim(Arena& arena, Victim victim, double size = 0.4);

}  // namespace rubble::arenas
