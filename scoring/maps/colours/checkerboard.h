#pragma once

#include <cstddef>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// What a picture shows of the checkerboard that league maps draw where nobody has been. It outlives changes of
/// brightness, contrast and hue, and tells that colours mean something else than they seem to.
struct Checkerboard {
  std::size_t crossings = 0;  ///< corners at which four squares meet, the diagonal ones alike
  Rgb darker{};               ///< of the two squares, in the middle of all crossings
  Rgb lighter{};
  int unevenness = 0;  ///< how far the darker squares differ over the picture, without a twentieth at either end
  bool is_there() const { return crossings >= kFewest; }

  static constexpr std::size_t kFewest = 6;
};

/// Looks in each channel for corners around which 4 x 4 pixels of each square, from the fourth on, are even.
Checkerboard find_checkerboard(const RgbImage& image);

}  // namespace rubble::scoring
