#include "scoring/alignment/match_error.h"

#include <cmath>

#include "base/planar.h"
#include "scoring/measures/association.h"

namespace rubble::scoring {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

MatchError match_error(const std::vector<TPoint2D>& map, const std::vector<TPoint2D>& truth, const TPose2D& T_truth_map,
                       const std::function<double(std::size_t, std::size_t)>& difference, double cap) {
  const PlanarTransform T(T_truth_map);
  std::vector<TPoint2D> moved;
  for (const TPoint2D& p : map) moved.push_back(T(p));
  const auto square = [&](std::size_t i, std::size_t j) { return (moved[i] - truth[j]).sqrNorm(); };
  const auto cost = [&](std::size_t i, std::size_t j) {
    const double apart = square(i, j);
    return apart >= cap ? cap : apart + difference(i, j);  // c_ij of eq. (7)
  };
  const Association found = associate(map.size(), truth.size(), cost, cap);
  MatchError out;
  out.error = found.error;
  out.matched = found.pairs.size();
  out.pairs = found.pairs;
  for (const auto& [i, j] : out.pairs) out.mean_offset += std::sqrt(square(i, j));
  if (out.matched > 0) out.mean_offset /= static_cast<double>(out.matched);
  return out;
}

}  // namespace rubble::scoring
