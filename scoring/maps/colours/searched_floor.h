#pragma once

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// A league map with its searched floor as white as other free floor: turned, scaled or compressed with loss, that
/// floor gives its green to the walls and the ground beside it, and takes their colours in. As it is where none was
/// searched.
RgbImage without_searched_floor(const RgbImage& image);

}  // namespace rubble::scoring
