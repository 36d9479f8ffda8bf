#pragma once

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// By how much the colours of a league map were made stronger, greys and brightness left alone (saturation): by the
/// dark blue of most walls, since titles and codes of such a blue are few; where JPEG smeared that, by the green of
/// searched floor. From 1.06 to 3; 1 where nothing says so.
double colour_strength(const RgbImage& image);

/// What a colour was before that: the league's own where one of them became it.
Rgb before_strengthening(const Rgb& colour, double by);

}  // namespace rubble::scoring
