#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <array>

#include "base/planar.h"

namespace rubble::scoring {

/// A rigid transform behind a polynomial displacement of the map: p_truth = T (p + D(p)), eq. (8).
struct Warp {
  static constexpr int kMaxTerms = 9;  ///< x, y; x^2, xy, y^2; x^3, x^2 y, x y^2, y^3 of normalised coordinates
  using Terms = std::array<double, kMaxTerms>;

  PlanarTransform T_truth_map;
  mrpt::math::TPoint2D centre;  ///< of the map, origin of the normalised coordinates [m]
  double extent = 1.0;          ///< metres that become 1
  int terms = 5;                ///< in use: 5 for degree 2, 9 for degree 3
  Terms dx{};                   ///< [m]
  Terms dy{};

  static int terms_of(int degree) { return degree * (degree + 3) / 2; }
  static int degree_of(int term) { return term < 2 ? 1 : term < 5 ? 2 : 3; }
  Terms terms_at(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D displacement(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D operator()(const mrpt::math::TPoint2D& p_map) const;
  /// By fixed-point iteration; good to centimetres for the mild displacements allowed here.
  mrpt::math::TPoint2D inverse(const mrpt::math::TPoint2D& p_truth) const;
  /// Largest stretch or shear that the linear terms ask for: 0.02 is a map drawn 2 % too large.
  double strain() const;
  /// Determinant of the Jacobian of p + D(p): the area a small piece of the map takes; not above 0 where it folds.
  double jacobian(const mrpt::math::TPoint2D& p_map) const;
};

}  // namespace rubble::scoring
