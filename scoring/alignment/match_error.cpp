#include "scoring/alignment/match_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/assignment.h"
#include "base/planar.h"
#include "scoring/measures/victims.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// A pair cheaper than leaving both unmatched.
struct Pair {
  std::size_t map = 0;
  std::size_t truth = 0;
  double cost = 0.0;
  double offset = 0.0;  // [m]
};

/// Groups of pairs that share no feature with any other group: features of the map count from 0, those of the truth on.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(b)] = of(a); }

 private:
  std::vector<std::size_t> parent_;
};

std::size_t index_in(std::vector<std::size_t>& list, std::size_t value) {
  const auto at = std::find(list.begin(), list.end(), value);
  if (at != list.end()) return static_cast<std::size_t>(at - list.begin());
  list.push_back(value);
  return list.size() - 1;
}

/// The cheapest association within one group; every feature of the map also has a dummy partner of its own at `cap`.
void match_group(const std::vector<Pair>& pairs, double cap, MatchError& out) {
  std::vector<std::size_t> of_map;
  std::vector<std::size_t> of_truth;
  for (const Pair& p : pairs) {
    index_in(of_map, p.map);
    index_in(of_truth, p.truth);
  }
  std::vector<std::vector<double>> cost(of_map.size(), std::vector<double>(of_truth.size() + of_map.size(), cap));
  for (const Pair& p : pairs) cost[index_in(of_map, p.map)][index_in(of_truth, p.truth)] = p.cost;
  const std::vector<std::size_t> partner = assign(cost);
  for (const Pair& p : pairs) {
    if (partner[index_in(of_map, p.map)] != index_in(of_truth, p.truth)) continue;
    out.error += p.cost - cap;
    out.mean_offset += p.offset;
    out.pairs.emplace_back(p.map, p.truth);
    ++out.matched;
  }
}

}  // namespace

MatchError match_error(const std::vector<TPoint2D>& map, const std::vector<TPoint2D>& truth, const TPose2D& T_truth_map,
                       const std::function<double(std::size_t, std::size_t)>& difference, double cap) {
  MatchError out;
  const double total = 0.5 * static_cast<double>(map.size() + truth.size());
  out.error = cap * total;  // all unmatched
  const PlanarTransform T(T_truth_map);
  std::vector<Pair> pairs;
  Groups groups(map.size() + truth.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const TPoint2D p = T(map[i]);
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double square = (p - truth[j]).sqrNorm();
      if (square >= cap) continue;
      const double cost = square + difference(i, j);  // c_ij of eq. (7)
      if (cost >= cap) continue;
      pairs.push_back({i, j, cost, std::sqrt(square)});
      groups.join(i, map.size() + j);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const Pair& a, const Pair& b) { return groups.of(a.map) < groups.of(b.map); });
  for (auto begin = pairs.begin(); begin != pairs.end();) {
    const auto end =
        std::find_if(begin, pairs.end(), [&](const Pair& p) { return groups.of(p.map) != groups.of(begin->map); });
    match_group({begin, end}, cap, out);
    begin = end;
  }
  std::sort(out.pairs.begin(), out.pairs.end());
  out.error = total > 0.0 ? out.error / total : cap;
  if (out.matched > 0) out.mean_offset /= static_cast<double>(out.matched);
  return out;
}

}  // namespace rubble::scoring
