#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include "robot/model.h"
#include "slam/mrpt/mrpt_slam.h"

namespace rubble::slam {

/// The occupancy grid that MRPT's builders are asked to keep: options as in the files that MRPT ships with rbpf-slam,
/// with our cell size and the scanner's range. It starts small and grows.
inline mrpt::maps::COccupancyGridMap2D::TMapDefinition mrpt_grid(const robot::RobotModel& model, double resolution) {
  constexpr float kHalfSide = 6.0f;  ///< [m]
  mrpt::maps::COccupancyGridMap2D::TMapDefinition grid;
  grid.min_x = grid.min_y = -kHalfSide;
  grid.max_x = grid.max_y = kHalfSide;
  grid.resolution = static_cast<float>(resolution);
  grid.insertionOpts.maxDistanceInsertion = static_cast<float>(model.laser.range_max);
  grid.insertionOpts.maxOccupancyUpdateCertainty = 0.6f;
  // A beam without an echo may have met a dark or grazing surface close by.
  grid.insertionOpts.considerInvalidRangesAsFreeSpace = false;
  grid.insertionOpts.wideningBeamsWithDistance = false;
  using Likelihood = mrpt::maps::COccupancyGridMap2D;
  grid.likelihoodOpts.likelihoodMethod = Likelihood::lmLikelihoodField_Thrun;
  grid.likelihoodOpts.LF_decimation = 5;
  grid.likelihoodOpts.LF_stdHit = 0.2f;
  grid.likelihoodOpts.LF_maxCorrsDistance = 0.3f;
  grid.likelihoodOpts.LF_zHit = 0.999f;
  grid.likelihoodOpts.LF_zRandom = 0.001f;
  grid.likelihoodOpts.LF_maxRange = static_cast<float>(model.laser.range_max);
  grid.likelihoodOpts.LF_alternateAverageMethod = false;
  grid.likelihoodOpts.enableLikelihoodCache = true;
  return grid;
}

inline BuilderGrid grid_of(const mrpt::maps::COccupancyGridMap2D& from) {
  BuilderGrid grid;
  grid.x0 = from.getXMin();
  grid.y0 = from.getYMin();
  grid.width = static_cast<int>(from.getSizeX());
  grid.height = static_cast<int>(from.getSizeY());
  grid.p_free.reserve(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) grid.p_free.push_back(from.getCell(x, y));
  return grid;
}

}  // namespace rubble::slam
