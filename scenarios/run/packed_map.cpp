#include "scenarios/run/packed_map.h"

#include <algorithm>

namespace rubble::scenarios {
namespace {

constexpr int kLengthBits = 6;
constexpr std::size_t kLongestRun = 1u << kLengthBits;

}  // namespace

PackedMap::PackedMap(const OccupancyGrid& map) : frame_(map.frame()) {
  const std::vector<Occupancy>& cells = map.cells();
  for (std::size_t at = 0; at < cells.size();) {
    std::size_t length = 1;
    while (length < kLongestRun && at + length < cells.size() && cells[at + length] == cells[at]) ++length;
    runs_.push_back(static_cast<std::uint8_t>((static_cast<unsigned>(cells[at]) << kLengthBits) | (length - 1)));
    at += length;
  }
  runs_.shrink_to_fit();
}

OccupancyGrid PackedMap::unpacked() const {
  OccupancyGrid map(frame_);
  auto to = map.cells().begin();
  for (const std::uint8_t run : runs_)
    to = std::fill_n(to, 1 + run % kLongestRun, static_cast<Occupancy>(run >> kLengthBits));
  return map;
}

}  // namespace rubble::scenarios
