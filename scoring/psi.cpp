#include "scoring/psi.h"

#include <cassert>
#include <cstdint>

#include "base/distance_transform.h"

namespace rubble::scoring {
namespace {

using Mask = Grid<std::uint8_t>;

Mask mask_of(const OccupancyGrid& grid, Occupancy colour, std::int64_t& count) {
  Mask mask(grid.frame());
  count = 0;
  for (std::size_t i = 0; i < grid.cells().size(); ++i) {
    mask.cells()[i] = grid.cells()[i] == colour ? 1 : 0;
    count += mask.cells()[i];
  }
  return mask;
}

double mean_distance(const Mask& from, std::int64_t count, const Mask& to) {
  const Grid<std::uint16_t> distance = manhattan_transform(to);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < from.cells().size(); ++i)
    sum += static_cast<std::int64_t>(from.cells()[i]) * static_cast<std::int64_t>(distance.cells()[i]);
  return static_cast<double>(sum) / static_cast<double>(count);  // eq. (6)
}

PsiClass psi_of(const OccupancyGrid& map, const OccupancyGrid& truth, Occupancy colour, double absent_cap) {
  std::int64_t map_count = 0;
  std::int64_t truth_count = 0;
  const Mask in_map = mask_of(map, colour, map_count);
  const Mask in_truth = mask_of(truth, colour, truth_count);
  if (map_count == 0 && truth_count == 0) return {};
  if (map_count == 0 || truth_count == 0) return {absent_cap, absent_cap};
  return {mean_distance(in_map, map_count, in_truth) * truth.resolution(),
          mean_distance(in_truth, truth_count, in_map) * truth.resolution()};
}

}  // namespace

Psi psi(const OccupancyGrid& map, const OccupancyGrid& truth, double absent_cap) {
  assert(map.width() == truth.width() && map.height() == truth.height());
  Psi out;
  out.occupied = psi_of(map, truth, Occupancy::Occupied, absent_cap);
  out.free = psi_of(map, truth, Occupancy::Free, absent_cap);
  out.unknown = psi_of(map, truth, Occupancy::Unknown, absent_cap);
  for (const PsiClass& c : {out.occupied, out.free, out.unknown})
    out.literal += c.map_to_truth + c.truth_to_map;  // eq. (5)
  out.mean =
      0.25 * (out.occupied.map_to_truth + out.occupied.truth_to_map + out.free.map_to_truth + out.free.truth_to_map);
  return out;
}

}  // namespace rubble::scoring
