#pragma once

#include "slam/grid/count_map.h"

namespace rubble::slam {

/// How much of a scan enters a map at once.
struct StampedPart {
  double cells = 2.5e6;  ///< that beams pass; the widest hall measured has 2.2 million
  double reach = 2000;   ///< of a beam [cells]
};

/// Shortens beams, all to one length, so that no more of the scan is left: a beam that ended on a surface beyond then
/// ends free. Over open ground the cells that a scanner sees grow with the square of its reach; each of them takes
/// nanoseconds, and near ones are what other scans see as well.
void cut_to(const StampedPart& part, double resolution, ScanPoints& points);

}  // namespace rubble::slam
