#pragma once

#include <optional>
#include <string>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// A picture whose values were drawn in a colour scale, as the greys that they were.
struct ScaledValues {
  RgbImage greys;
  std::string name;  ///< of the scale
};

/// Where nearly all colours of a picture are those of one of the scales that plotting programs have (viridis, jet,
/// ...): its values, from 0 at the scale's beginning to 255 at its end.
std::optional<ScaledValues> values_of_colour_scale(const RgbImage& image);

}  // namespace rubble::scoring
