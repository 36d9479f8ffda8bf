#include "scoring/measures/association.h"

#include <algorithm>
#include <numeric>

#include "base/assignment.h"

namespace rubble::scoring {
namespace {

/// A pair cheaper than leaving both alone.
struct Pair {
  std::size_t map = 0;
  std::size_t truth = 0;
  double cost = 0.0;
};

/// Groups of pairs that share nothing with any other group: things of the map count from 0, those of the truth on.
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

/// The cheapest association within one group; each thing of the map also has a dummy partner of its own at `cap`.
void match_group(const std::vector<Pair>& pairs, double cap, Association& out) {
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
    out.pairs.emplace_back(p.map, p.truth);
  }
}

}  // namespace

Association associate(std::size_t m, std::size_t n, const std::function<double(std::size_t, std::size_t)>& cost,
                      double cap) {
  Association out;
  const double total = 0.5 * static_cast<double>(m + n);
  out.error = cap * total;  // all left alone
  std::vector<Pair> pairs;
  Groups groups(m + n);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double c = cost(i, j);
      if (c >= cap) continue;
      pairs.push_back({i, j, c});
      groups.join(i, m + j);
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
  out.error = total > 0.0 ? out.error / total : cap;  // eq. (7)
  return out;
}

}  // namespace rubble::scoring
