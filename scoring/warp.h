#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <array>

namespace rubble::scoring {

/// A rigid transform behind a quadratic displacement of the map: p_truth = T (p + D(p)), eq. (8) with degree 2.
struct Warp {
  static constexpr int kTerms = 5;  ///< x, y, x^2, xy, y^2 in coordinates normalised to the map's extent

  mrpt::math::TPose2D T_truth_map;
  mrpt::math::TPoint2D centre;  ///< of the map, origin of the normalised coordinates [m]
  double extent = 1.0;          ///< metres that become 1
  std::array<double, kTerms> dx{};
  std::array<double, kTerms> dy{};

  static std::array<double, kTerms> terms(double u, double v) { return {u, v, u * u, u * v, v * v}; }
  mrpt::math::TPoint2D displacement(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D forward(const mrpt::math::TPoint2D& p_map) const;
  /// By fixed-point iteration; good to centimetres for the mild displacements allowed here.
  mrpt::math::TPoint2D inverse(const mrpt::math::TPoint2D& p_truth) const;
};

}  // namespace rubble::scoring
