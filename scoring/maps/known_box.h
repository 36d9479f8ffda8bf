#pragma once

#include <algorithm>
#include <cmath>

#include "base/grid.h"

namespace rubble::scoring {

/// [m]
struct KnownBox {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

/// The cells with any information, grown by a margin, on whole half metres; a small box round the origin when there are
/// none.
template <class Known>
KnownBox known_box(const GridFrame& frame, double margin, Known known) {
  int west = frame.width, east = -1, south = frame.height, north = -1;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (known(Cell{x, y})) {
        west = std::min(west, x), east = std::max(east, x);
        south = std::min(south, y), north = std::max(north, y);
      }
  if (east < west) return {-1.0, 1.0, -1.0, 1.0};
  const auto down = [](double v) { return 0.5 * std::floor(2.0 * v); };
  const auto up = [](double v) { return 0.5 * std::ceil(2.0 * v); };
  return {down(frame.x0 + west * frame.resolution - margin), up(frame.x0 + (east + 1) * frame.resolution + margin),
          down(frame.y0 + south * frame.resolution - margin), up(frame.y0 + (north + 1) * frame.resolution + margin)};
}

}  // namespace rubble::scoring
