#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// The part of a segment a -> b between the parameters from <= to, 0 at a, 1 at b.
struct Interval {
  double from = 0.0;
  double to = 1.0;
};

/// A rectangle, counter-clockwise; `length` lies along `angle` [rad], `width` across it.
Outline rectangle(const mrpt::math::TPoint2D& centre, double length, double width, double angle = 0.0);

/// A wall seen from above: `thickness` wide, from end to end.
Outline strip(const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to, double thickness);

/// Positive for counter-clockwise outlines [m^2].
double signed_area(const Outline& outline);

/// Three or more corners, counter-clockwise, nowhere bent inwards.
bool is_convex(const Outline& outline);

/// Convex, counter-clockwise pieces that together are a simple outline (either sense of rotation); empty when its edges
/// cross or it has no area. Cuts off ears, then joins neighbours where the result stays convex (Hertel and Mehlhorn
/// 1983).
std::vector<Outline> convex_pieces(Outline outline);

/// Whether p lies in a convex outline or at most `tolerance` [m] outside one of its edges.
bool contains(const Outline& outline, const mrpt::math::TPoint2D& p, double tolerance = 1e-9);

/// The part of the segment that lies in a convex outline. Cyrus and Beck 1978.
std::optional<Interval> clip(const Outline& outline, const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b);

/// Distance from p to a convex outline, 0 inside [m].
double distance(const Outline& outline, const mrpt::math::TPoint2D& p);

}  // namespace rubble::arenas
