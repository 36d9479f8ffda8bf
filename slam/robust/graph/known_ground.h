#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "slam/robust/graph/key_frames.h"

namespace rubble::slam {

/// The key frame where nothing but the pose decides: closest, and looking the same way. At least one key frame.
int closest_frame(const KeyFrames& frames, const mrpt::math::TPose2D& T_map_base);

/// Up to `most` key frames within `distance` [m] of one, it first, then the closest; for maps whose graph stays as it
/// is, so that poses can be trusted for it.
std::vector<int> frames_around(const KeyFrames& frames, int here, double distance, int most);

/// The closest key frame of an earlier visit, `least_path` [m] of driving ago or more, that the graph ties closely to
/// where the robot is: near key frame `here`, after so much path [m].
std::optional<int> frame_of_earlier_visit(const KeyFrames& frames, const mrpt::math::TPose2D& T_map_base, int here,
                                          double path, double least_path, Work* work);

}  // namespace rubble::slam
