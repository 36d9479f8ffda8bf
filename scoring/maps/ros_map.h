#pragma once

#include <string>

#include "base/grid.h"

namespace rubble::scoring {

/// Scales of a building's map [m a pixel].
inline constexpr double kMinResolution = 0.001;
inline constexpr double kMaxResolution = 2.0;

struct RosMap {
  OccupancyGrid grid;
  std::string recognised;  ///< how it was read and what is doubtful (colours/reading_doubts.h), ", " before each
};

/// Reads a ROS map: YAML with image, resolution, origin, negate, occupied_thresh, free_thresh, mode (map_server's
/// rules), and the image beside it; one in league colours is read by these, not by the thresholds. Transparent pixels
/// are unknown. The yaw of the origin does not turn the grid. Throws InputError with file and line, or with what the
/// picture is instead of a map.
RosMap read_ros_map(const std::string& yaml_path);

/// Writes `stem`.pgm and `stem`.yaml as ROS map_server reads them, cropped to the known area. Throws RunError.
void write_ros_map(const std::string& stem, const OccupancyGrid& grid, double occupied_threshold);

}  // namespace rubble::scoring
