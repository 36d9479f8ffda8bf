#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "scoring/rooms/room_config.h"

namespace rubble::scoring {

/// A line between two points of the walls that closes a door or another narrow place.
struct Passage {
  cv::Point a;  ///< [cells]
  cv::Point b;
  double width = 0.0;  ///< [cells]
};

/// The passages that separate rooms, narrowest first:
/// 1. candidates join a corner of a wall to the nearest points of the walls it sees (section IV.E's visibility);
/// 2. a door opens into wide space on either side: from it most of a half disc as wide as the door can be seen;
/// 3. a corridor's end opens into a much wider hall on one side only.
/// Each passage taken is closed before the next is judged, so that of many lines across one door one remains.
/// `given` are taken first, and unasked; `may_be` refuses others.
std::vector<Passage> find_passages(const cv::Mat& floor, double resolution, const RoomConfig& config,
                                   std::vector<Passage> given = {},
                                   const std::function<bool(const Passage&)>& may_be = {});

/// Corners of the walls, from which passages may begin: time and memory go with them.
std::size_t count_corners(const cv::Mat& floor, double resolution, const RoomConfig& config);

/// Makes the cells of the passages obstacles; 4-connected lines, so that no step leads across.
void close_passages(cv::Mat& floor, const std::vector<Passage>& passages);

}  // namespace rubble::scoring
