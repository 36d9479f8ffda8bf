#pragma once

#include <cstdint>
#include <vector>

#include "base/grid.h"

namespace rubble {

/// Exact Euclidean distance from each cell centre to the nearest cell centre where `mask` is non-zero [m], capped at
/// `cap`. Where no cell is set: cap everywhere. Felzenszwalb and Huttenlocher 2012, O(cells).
Grid<float> distance_transform(const Grid<std::uint8_t>& mask, double cap);

}  // namespace rubble
