#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "scoring/rooms/room_config.h"
#include "scoring/rooms/room_floor.h"
#include "scoring/rooms/room_regions.h"

namespace rubble::scoring {

/// Symmetric matrix of which points see each other, each row a bit set of 64-bit words (A of section IV.E).
struct VisibilityMatrix {
  std::size_t size = 0;
  std::size_t words = 0;  ///< of a row
  std::vector<std::uint64_t> bits;
  void set(std::size_t i, std::size_t j) { bits[i * words + j / 64] |= std::uint64_t{1} << (j % 64); }
  bool get(std::size_t i, std::size_t j) const { return (bits[i * words + j / 64] >> (j % 64) & 1u) != 0; }
};

VisibilityMatrix visibility(const RoomFloor& floor, const std::vector<cv::Point>& points, const RoomConfig& config);

/// Average-linkage clusters of the rows: joined while their mean Jaccard similarity is `least` or more. Returns the
/// cluster of each row, numbered from 0 in the order of their first rows. Nearest-neighbour chains, O(n^2).
std::vector<int> cluster_rows(const VisibilityMatrix& seen, double least);

/// Rooms as clusters of wall control points that see the same (section IV.E); each cell of the floor belongs to the
/// cluster of the nearest control point as one walks.
RoomRegions cluster_rooms(const RoomFloor& floor, const RoomConfig& config);

}  // namespace rubble::scoring
