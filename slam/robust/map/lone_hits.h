#pragma once

#include "slam/grid/count_map.h"

namespace rubble::slam {

/// Leaves out single beams that end far from both their neighbours - mixed pixels, dust, crosstalk: no wall is as
/// narrow as one beam.
void drop_lone_hits(ScanPoints& points);

}  // namespace rubble::slam
