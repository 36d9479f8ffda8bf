#include "scoring/walls/warp.h"

#include <cmath>
#include <cstddef>

namespace rubble::scoring {

using mrpt::math::TPoint2D;

Warp::Terms Warp::terms_at(const TPoint2D& p_map) const {
  const double u = (p_map.x - centre.x) / extent;
  const double v = (p_map.y - centre.y) / extent;
  return {u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v};
}

TPoint2D Warp::displacement(const TPoint2D& p_map) const {
  const Terms phi = terms_at(p_map);
  TPoint2D out(0.0, 0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i) {
    out.x += dx[i] * phi[i];
    out.y += dy[i] * phi[i];
  }
  return out;
}

TPoint2D Warp::operator()(const TPoint2D& p_map) const {
  return T_truth_map(p_map + displacement(p_map));  // eq. (8)
}

TPoint2D Warp::inverse(const TPoint2D& p_truth) const {
  const TPoint2D p0 = T_truth_map.inverse(p_truth);
  TPoint2D p = p0;
  for (int i = 0; i < 3; ++i) p = p0 - displacement(p);
  return p;
}

double Warp::strain() const {
  // Eigenvalues of the symmetric part; the rest is a rotation.
  const double mean = 0.5 * (dx[0] + dy[1]) / extent;
  const double half = 0.5 * (dx[0] - dy[1]) / extent;
  const double shear = 0.5 * (dx[1] + dy[0]) / extent;
  return std::abs(mean) + std::hypot(half, shear);
}

double Warp::jacobian(const TPoint2D& p_map) const {
  const double u = (p_map.x - centre.x) / extent;
  const double v = (p_map.y - centre.y) / extent;
  const Terms by_u = {1.0, 0.0, 2.0 * u, v, 0.0, 3.0 * u * u, 2.0 * u * v, v * v, 0.0};
  const Terms by_v = {0.0, 1.0, 0.0, u, 2.0 * v, 0.0, u * u, 2.0 * u * v, 3.0 * v * v};
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i) {
    xx += dx[i] * by_u[i];
    xy += dx[i] * by_v[i];
    yx += dy[i] * by_u[i];
    yy += dy[i] * by_v[i];
  }
  return (1.0 + xx / extent) * (1.0 + yy / extent) - xy * yx / (extent * extent);
}

}  // namespace rubble::scoring
