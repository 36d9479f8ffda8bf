#pragma once

#include <vector>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// A victim as league maps draw it: a filled circle of 0.35 m, red 240,10,10 or, unconfirmed, 240,100,10, with white
/// lettering.
struct VictimSymbol {
  double column = 0.0;  ///< centre [pixels], the upper-left corner of the image is 0, 0
  double row = 0.0;
  bool confirmed = true;
};

/// The victims drawn on a league map, from top to bottom. Holes of lettering are filled; circles that touch, overlap or
/// are cut by their lettering are found one by one with the nominal radius; single ones may be 0.2 to 0.6 m wide.
/// Diamonds (hazards), lines (path, arrow) and larger areas are no victims. Images that were turned, resampled or
/// compressed with loss are understood while a circle is at least 3 pixels wide. `resolution`: [m] a pixel.
std::vector<VictimSymbol> find_victim_symbols(const RgbImage& image, double resolution);

}  // namespace rubble::scoring
