#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace rubble::scoring {

/// Which of m things of the map is which of n things of the truth, w_ij = 1 of eq. (7).
struct Association {
  double error = 0.0;  ///< E, 0 .. cap; the cap where nothing is matched: W = 0 is the worst, not the best
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< of the map and of the truth, in the order of the map's
};

/// The best one-to-one association W of eq. (7) with its footnote: E = (sum over matched of c_ij + cap/2 for each left
/// alone, of either map) / mean of m and n; pairs with c_ij >= cap are never matched. Exact: Hungarian method on each
/// group of things that may compete. `cost` is asked once a pair.
Association associate(std::size_t m, std::size_t n,
                      const std::function<double(std::size_t map, std::size_t truth)>& cost, double cap);

}  // namespace rubble::scoring
