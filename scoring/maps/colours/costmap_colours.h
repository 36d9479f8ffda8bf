#pragma once

#include <optional>

#include "base/image/geotiff.h"
#include "scoring/maps/colours/grey_levels.h"

namespace rubble::scoring {

/// Reads a costmap in the colours of RViz (costs from blue to red, cyan where the robot's middle would hit, magenta on
/// obstacles, 112,137,134 where nothing is known), alone or half transparent over its map: obstacles are walls, costs
/// free ground. Nothing: it is none.
std::optional<LabelImage> classify_costmap(const RgbImage& image);

}  // namespace rubble::scoring
