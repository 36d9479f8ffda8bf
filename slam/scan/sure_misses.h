#pragma once

#include <vector>

#include "base/yaml/binder.h"
#include "robot/measurements.h"

namespace rubble::slam {

/// Which beams without an echo free the cells that they ran through.
enum class MissTrust {
  None,
  Sure,  ///< those of which the scan itself makes it likely that nothing was there, see with_sure_misses()
  All
};

void bind_misses(Binder& binder, MissTrust& misses);

/// The scan with every miss that may have met something made unknown (NaN). A miss is sure where
/// - the scanner tells by codes why a beam failed, and this one has none: a log of bare ranges writes a dark wall and
/// an
///   open hall alike (exp1.dat of CoreSLAM has no echo on half of its beams);
/// - at least five beams beside each other met nothing, the two next to a surface left out: a dark post is a few beams
///   wide, and the spot of a beam lies half on what its neighbour meets;
/// - the surface that ends beside them does not go on into them at less than 12 deg: from about 80 deg of incidence on
/// a
///   URG-04LX gets no echo from a wall.
/// Cost: linear in the beams.
robot::LaserScan with_sure_misses(robot::LaserScan scan);

/// The scan as `misses` takes it.
robot::LaserScan with_trusted_misses(robot::LaserScan scan, MissTrust misses);

}  // namespace rubble::slam
