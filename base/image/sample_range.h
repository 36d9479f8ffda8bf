#pragma once

#include <array>
#include <cstdint>

namespace rubble {

/// The value that stands for white in samples that could reach `nominal` but of which the largest is `most`. Programs
/// that store a picture in 16 bits often keep its 0..255 as they are, or the 10, 12 or 14 bits of a camera. Where the
/// largest is less than 0.78 of each of these (free or unknown ground of any map is brighter), it is white itself.
/// Not so with `is_opacity`: nothing need be opaque.
constexpr std::uint32_t white_of(std::uint32_t most, std::uint32_t nominal, bool is_opacity = false) {
  constexpr std::array<std::uint32_t, 4> kUsual{255, 1023, 4095, 16383};
  if (most == 0) return nominal;
  std::uint32_t white = nominal;
  for (const std::uint32_t usual : kUsual)
    if (most <= usual && usual < white) white = usual;
  return !is_opacity && 100 * most < 78 * white ? most : white;
}

/// White is no usual value but the brightest sample there is.
constexpr bool is_odd_white(std::uint32_t white, std::uint32_t nominal) {
  return white != nominal && white != 255 && white != 1023 && white != 4095 && white != 16383;
}

}  // namespace rubble
