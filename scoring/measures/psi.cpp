#include "scoring/measures/psi.h"

#include <cassert>
#include <cstdint>

#include "scoring/measures/manhattan_sum.h"

namespace rubble::scoring {
namespace {

PsiClass psi_of(const ManhattanSums& distances, Occupancy colour, double absent_cap, double resolution) {
  const std::int64_t map_count = distances.map_count[colour];
  const std::int64_t truth_count = distances.truth_count[colour];
  if (map_count == 0 && truth_count == 0) return {};
  if (map_count == 0 || truth_count == 0) return {absent_cap, absent_cap};
  const auto mean = [&](std::int64_t sum, std::int64_t n) {
    return static_cast<double>(sum) / static_cast<double>(n) * resolution;  // eq. (6)
  };
  return {mean(distances.map_to_truth[colour], map_count), mean(distances.truth_to_map[colour], truth_count)};
}

}  // namespace

Psi psi(const OccupancyGrid& map, const OccupancyGrid& truth, double absent_cap) {
  assert(map.width() == truth.width() && map.height() == truth.height());
  const ManhattanSums distances = manhattan_sums(map, truth);
  const double resolution = truth.resolution();
  Psi out;
  out.occupied = psi_of(distances, Occupancy::Occupied, absent_cap, resolution);
  out.free = psi_of(distances, Occupancy::Free, absent_cap, resolution);
  out.unknown = psi_of(distances, Occupancy::Unknown, absent_cap, resolution);
  for (const PsiClass& c : {out.occupied, out.free, out.unknown})
    out.literal += c.map_to_truth + c.truth_to_map;  // eq. (5)
  out.mean =
      0.25 * (out.occupied.map_to_truth + out.occupied.truth_to_map + out.free.map_to_truth + out.free.truth_to_map);
  return out;
}

}  // namespace rubble::scoring
