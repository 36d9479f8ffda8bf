#include "scoring/warp.h"

namespace rubble::scoring {

using mrpt::math::TPoint2D;

TPoint2D Warp::displacement(const TPoint2D& p_map) const {
  const std::array<double, kTerms> phi = terms((p_map.x - centre.x) / extent, (p_map.y - centre.y) / extent);
  TPoint2D out(0.0, 0.0);
  for (std::size_t i = 0; i < phi.size(); ++i) {
    out.x += dx[i] * phi[i];
    out.y += dy[i] * phi[i];
  }
  return out;
}

TPoint2D Warp::forward(const TPoint2D& p_map) const {
  return T_truth_map.composePoint(p_map + displacement(p_map));  // eq. (8)
}

TPoint2D Warp::inverse(const TPoint2D& p_truth) const {
  const TPoint2D p0 = T_truth_map.inverseComposePoint(p_truth);
  TPoint2D p = p0;
  for (int i = 0; i < 3; ++i) p = p0 - displacement(p);
  return p;
}

}  // namespace rubble::scoring
