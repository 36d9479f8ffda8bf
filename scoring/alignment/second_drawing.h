#pragma once

#include "base/grid.h"
#include "base/planar.h"
#include "scoring/measures/sight_lines.h"

namespace rubble::scoring {

/// Share of the map's known area that lies off the truth and draws the truth again: another hypothesis on the same
/// canvas, joined to the first or not. It is looked for where a tenth or more of what lies on the truth lies off it:
/// at 0.4 to 2.5 times its own size in steps of 5 %, at sizes that its ground and its reach tell, stretched along its
/// walls to the truth's proportions, and mirrored at its own and the told sizes. Of its own size its two halves may
/// agree each by itself, at poses near each other, since a drawing that came apart agrees nowhere as a whole. A small
/// drawing counts as the ground that it covers at the size at which it agrees, for it is as much of a guess as a large
/// one. What merely surrounds an arena (a hall seen through its entrance) does not agree with its lines of sight
/// anywhere, and does not count. Of a bare truth, which many a hall is like at another size, only 0.7 to 1.4 times the
/// size are tried, and no other shapes.
double second_drawing_share(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map,
                            const SightLines& sights);

}  // namespace rubble::scoring
