#include "scoring/rooms/room_match.h"

#include <algorithm>

#include "base/planar.h"
#include "scoring/measures/association.h"

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
  const auto cost = [&](std::size_t i, std::size_t j) { return pair_of(map, i, truth, j, T).cost; };
  const Association found = associate(m, n, cost, kCap);
  std::vector<bool> of_map(m, false), of_truth(n, false);
  for (const auto& [i, j] : found.pairs) {
    of_map[i] = of_truth[j] = true;
    out.pairs.push_back(pair_of(map, i, truth, j, T));
  }
  std::sort(out.pairs.begin(), out.pairs.end(), [](const RoomPair& a, const RoomPair& b) { return a.truth < b.truth; });
  for (std::size_t j = 0; j < n; ++j)
    if (!of_truth[j]) out.missing.push_back(j);
  for (std::size_t i = 0; i < m; ++i)
    if (!of_map[i]) out.surplus.push_back(i);
  out.error = found.error;
  out.score = n > 0 && m > 0 ? 1.0 - out.error / kCap : 0.0;
  return out;
}

}  // namespace rubble::scoring
