#pragma once

#include "base/image/geotiff.h"
#include "scoring/maps/colours/blur.h"
#include "scoring/maps/colours/grey_levels.h"

namespace rubble::scoring {

/// The classes of a league map without its drawings. Colours: the league's GeoTIFF map rules as hector_geotiff and
/// crosbot draw them (docs/map_readers.md has the table). `undone`: the blur that it had had.
LabelImage classify_league(const RgbImage& image, const Blur& undone = {});

}  // namespace rubble::scoring
