#pragma once

#include <array>
#include <cstdint>

namespace rubble {

/// The value that stands for white in samples that could reach `nominal` but of which the largest is `most`. Programs
/// that store a picture in 16 bits often keep its 0..255 as they are, or the 10, 12 or 14 bits of a camera.
constexpr std::uint32_t white_of(std::uint32_t most, std::uint32_t nominal) {
  constexpr std::array<std::uint32_t, 4> kUsual{255, 1023, 4095, 16383};
  if (most == 0) return nominal;
  for (const std::uint32_t white : kUsual)
    if (most <= white && white < nominal) return white;
  return nominal;
}

}  // namespace rubble
