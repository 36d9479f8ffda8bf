#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
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

/// How it ends when two maps are to become one.
enum class MergeEnd {
  Whole,
  OtherMount,  ///< their lasers were mounted differently
  NoPlace,     ///< the second shows no place of the first for sure
  SeenThrough  ///< it seems to, but each sees through walls of the other: two arenas
};

/// Told what is being done and how much of that is done, 0 to 1.
using MergeProgress = std::function<void(const std::string& what, double share)>;

}  // namespace rubble::slam
