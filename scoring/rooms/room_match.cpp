#include "scoring/rooms/room_match.h"

#include <algorithm>

#include "base/assignment.h"
#include "base/planar.h"

namespace rubble::scoring {
namespace {

constexpr double kCap = 2.0;     // C [m^2]
constexpr double kLambda = 1.0;  // [m^2]

RoomPair pair_of(const Rooms& map, std::size_t i, const Rooms& truth, std::size_t j,
                 const PlanarTransform& T_truth_map) {
  const Room& g = map.rooms[i];
  const Room& f = truth.rooms[j];
  RoomPair out{j, i};
  out.offset = distance(T_truth_map(g.centre), f.centre);
  out.area_ratio = g.area / f.area;
  out.difference = room_difference(f, g);
  out.cost = out.offset * out.offset + kLambda * out.difference;  // eq. (7)
  return out;
}

}  // namespace

RoomMatch match_rooms(const Rooms& map, const Rooms& truth, const mrpt::math::TPose2D& T_truth_map) {
  RoomMatch out;
  const PlanarTransform T(T_truth_map);
  const std::size_t n = truth.rooms.size(), m = map.rooms.size();
  // Every room of the truth also has a partner of its own that stands for none: leaving both rooms alone costs C.
  std::vector<std::vector<double>> cost(n, std::vector<double>(m + n, kCap));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < m; ++i) cost[j][i] = std::min(kCap, pair_of(map, i, truth, j, T).cost);
  const std::vector<std::size_t> partner = n > 0 ? assign(cost) : std::vector<std::size_t>();
  std::vector<bool> taken(m, false);
  double sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    if (partner[j] >= m || cost[j][partner[j]] >= kCap) {
      out.missing.push_back(j);
      continue;
    }
    taken[partner[j]] = true;
    out.pairs.push_back(pair_of(map, partner[j], truth, j, T));
    sum += out.pairs.back().cost;
  }
  for (std::size_t i = 0; i < m; ++i)
    if (!taken[i]) out.surplus.push_back(i);
  sum += 0.5 * kCap * static_cast<double>(out.missing.size() + out.surplus.size());
  out.error = n + m > 0 ? sum / (0.5 * static_cast<double>(n + m)) : kCap;
  out.score = n > 0 && m > 0 ? 1.0 - out.error / kCap : 0.0;
  return out;
}

}  // namespace rubble::scoring
