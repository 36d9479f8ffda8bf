#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// What an image editor may have done to all channels of a league map alike.
struct ToneCurve {
  std::array<std::uint8_t, 256> of{};  ///< what each value became
  std::string name;                    ///< "gamma 1.5"
};

/// What free floor looks like, and what the league draws it in: white, or searched.
struct FloorTone {
  Rgb now;
  Rgb own;
};

/// Curves (gamma; contrast and brightness, clipped at both ends) that make two greys of the league's checkerboard and
/// what is seen now of its floor, the likeliest first.
std::vector<ToneCurve> tone_curves(const Rgb& darker, const Rgb& lighter, const FloorTone& floor);

/// The colour before that: the league's own where one of them became it, else of each channel the value that comes
/// nearest.
Rgb without(const ToneCurve& curve, const Rgb& colour);
}  // namespace rubble::scoring
