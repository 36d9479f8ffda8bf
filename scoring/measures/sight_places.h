#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/planar.h"
#include "scoring/measures/sight_lines.h"

namespace rubble::scoring {

/// A place of the truth where a line of sight is answered, and how the map answers there. All are parts of `asked`;
/// what is left of it is right.
struct SightPlace {
  mrpt::math::TPoint2D p;  ///< truth frame
  double asked = 0.0;      ///< weight
  double drawn = 0.0;      ///< of that, a wall is drawn where the way is open, or drawn again beside itself
  double missed = 0.0;     ///< the wall is not drawn, or elsewhere
  double unknown = 0.0;    ///< the map does not say
};

/// Where the map is right about the lines of sight and where it is not: a blocked line is answered where its wall
/// stands; an open one where the map draws a wall on it, else at the places at which walls block it at the shifts. The
/// sum of all is what the score is made of. `lines` must be Located.
std::vector<SightPlace> sight_places(const SightLines& lines, const SightMap& map, const PlanarTransform& T_truth_map);

}  // namespace rubble::scoring
