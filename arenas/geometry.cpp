#include "arenas/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

double cross(const TPoint2D& u, const TPoint2D& v) { return u.x * v.y - u.y * v.x; }

const TPoint2D& next(const Outline& outline, std::size_t i) { return outline[(i + 1) % outline.size()]; }

}  // namespace

Outline rectangle(const TPoint2D& centre, double length, double width, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto corner = [&](double along, double across) {
    return TPoint2D{centre.x + c * along - s * across, centre.y + s * along + c * across};
  };
  const double l = 0.5 * length;
  const double w = 0.5 * width;
  return {corner(-l, -w), corner(l, -w), corner(l, w), corner(-l, w)};
}

Outline strip(const TPoint2D& from, const TPoint2D& to, double thickness) {
  const TPoint2D along = to - from;
  const double length = std::hypot(along.x, along.y);
  const double half = 0.5 * thickness / length;
  const TPoint2D left{-along.y * half, along.x * half};
  return {from - left, to - left, to + left, from + left};
}

double signed_area(const Outline& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) twice += cross(outline[i], next(outline, i));
  return 0.5 * twice;
}

bool is_convex(const Outline& outline) {
  if (outline.size() < 3 || !(signed_area(outline) > 0.0)) return false;
  // Every corner left of every edge: also refuses stars, whose corners all turn left.
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D edge = next(outline, i) - outline[i];
    if (!(std::hypot(edge.x, edge.y) > 0.0)) return false;
    for (const TPoint2D& p : outline) {
      if (cross(edge, p - outline[i]) < -1e-9) return false;
    }
  }
  return true;
}

bool contains(const Outline& outline, const TPoint2D& p, double tolerance) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D edge = next(outline, i) - outline[i];
    if (cross(edge, p - outline[i]) < -tolerance * std::hypot(edge.x, edge.y)) return false;
  }
  return true;
}

std::optional<Interval> clip(const Outline& outline, const TPoint2D& a, const TPoint2D& b) {
  Interval inside;
  const TPoint2D along = b - a;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D edge = next(outline, i) - outline[i];
    const double depth = cross(edge, a - outline[i]);  // positive: a lies inside this edge
    const double slope = cross(edge, along);
    if (slope == 0.0) {
      if (depth < 0.0) return std::nullopt;
    } else if (slope > 0.0) {
      inside.from = std::max(inside.from, -depth / slope);
    } else {
      inside.to = std::min(inside.to, -depth / slope);
    }
  }
  if (inside.from > inside.to) return std::nullopt;
  return inside;
}

double distance(const Outline& outline, const TPoint2D& p) {
  if (contains(outline, p, 0.0)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D edge = next(outline, i) - outline[i];
    const TPoint2D to = p - outline[i];
    const double u = std::clamp((to.x * edge.x + to.y * edge.y) / (edge.x * edge.x + edge.y * edge.y), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(to.x - u * edge.x, to.y - u * edge.y));
  }
  return nearest;
}

}  // namespace rubble::arenas
