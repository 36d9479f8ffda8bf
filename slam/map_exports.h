#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/math/TPose3D.h>

#include <string>
#include <vector>

#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/map_base.h"
#include "slam/mappers.h"

namespace rubble::slam {

/// A scan of a map, as it was measured.
struct MapScan {
  mrpt::math::TPose2D T_map_base;
  robot::LaserScan scan;  ///< stamp: of the key frame that it hangs on
};

/// What other programs can use of a map.
struct MapContent {
  mrpt::math::TPose3D T_base_laser;
  std::vector<MapScan> scans;
};

// All throw InputError for a map that is damaged.

MapContent content_of(const MapBase& map);
/// The graph as text for g2o (slam/robust/graph/g2o.h).
std::string graph_as_g2o(const MapBase& map);

/// One map of two, in the frame of the first.
struct MergedBytes {
  MergeEnd end;
  std::string bytes;  ///< of MergeEnd::Whole
};

/// `model` and `mapper`: a robot like theirs, and a mapper of kind robust.
MergedBytes merged_maps(const MapBase& first, const MapBase& second, const robot::RobotModel& model,
                        const MapperConfig& mapper, const MergeProgress& progress);

}  // namespace rubble::slam
