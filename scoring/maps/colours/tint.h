#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// A colour as JPEG keeps it (YCbCr of ITU-R BT.601): brightness sharp, the two differences of colour smeared over up
/// to 16 pixels. The values are those of the channels, 0 to 255, the differences without the offset.
struct Tint {
  double light = 0.0, blue = 0.0, red = 0.0;
};

/// `rgb`: three channels.
template <class Channels>
Tint tint_of(const Channels& rgb) {
  const double light = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
  return {light, 0.564 * (rgb[2] - light), 0.713 * (rgb[0] - light)};
}

/// The way back, clipped to what a channel holds.
inline Rgb rgb_of(const Tint& tint) {
  const auto level = [](double value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))); };
  const double red = tint.light + tint.red / 0.713, blue = tint.light + tint.blue / 0.564;
  return {level(red), level((tint.light - 0.299 * red - 0.114 * blue) / 0.587), level(blue)};
}

}  // namespace rubble::scoring
