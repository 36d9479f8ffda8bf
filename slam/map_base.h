#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

namespace rubble::slam {

/// A map of an earlier run.
struct MapBase {
  std::string bytes;  ///< Mapper::saved_map()
  std::string name;   ///< the file's, for messages
  bool grows = true;  ///< false: the robot only finds its place in it
  /// Where the base is at the first scan; nothing: where the earlier run ended, or else anywhere.
  std::optional<mrpt::math::TPose2D> start;
};

}  // namespace rubble::slam
