#include "arenas/model/geometry.h"

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

namespace {

double turn(const TPoint2D& a, const TPoint2D& b, const TPoint2D& c) {
  return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

bool edges_cross(const Outline& o) {
  const std::size_t n = o.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 2; k < n; ++k) {
      if (i == 0 && k == n - 1) continue;  // neighbours
      const TPoint2D &a = o[i], &b = o[i + 1], &c = o[k], &d = o[(k + 1) % n];
      if (turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0) return true;
    }
  }
  return false;
}

/// A corner with nothing of the rest inside the triangle it makes with its neighbours.
bool is_ear(const Outline& o, std::size_t i) {
  const std::size_t n = o.size();
  const Outline triangle{o[(i + n - 1) % n], o[i], o[(i + 1) % n]};
  if (turn(triangle[0], triangle[1], triangle[2]) <= 0.0) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == i || k == (i + 1) % n || k == (i + n - 1) % n) continue;
    if (contains(triangle, o[k], 0.0)) return false;
  }
  return true;
}

/// a and b joined along an edge they share in opposite senses, when that is convex.
std::optional<Outline> joined(const Outline& a, const Outline& b) {
  const auto same = [](const TPoint2D& p, const TPoint2D& q) { return p.x == q.x && p.y == q.y; };
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (!same(a[i], b[(k + 1) % b.size()]) || !same(a[(i + 1) % a.size()], b[k])) continue;
      Outline whole;
      for (std::size_t m = 1; m <= a.size(); ++m) whole.push_back(a[(i + m) % a.size()]);
      for (std::size_t m = 2; m < b.size(); ++m) whole.push_back(b[(k + m) % b.size()]);
      if (is_convex(whole)) return whole;
    }
  }
  return std::nullopt;
}

bool join_two(std::vector<Outline>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t k = i + 1; k < pieces.size(); ++k) {
      const auto whole = joined(pieces[i], pieces[k]);
      if (!whole) continue;
      pieces[i] = *whole;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Outline> convex_pieces(Outline outline) {
  if (signed_area(outline) < 0.0) outline = Outline(outline.rbegin(), outline.rend());
  if (is_convex(outline)) return {outline};
  if (outline.size() < 3 || edges_cross(outline)) return {};
  std::vector<Outline> pieces;
  while (outline.size() > 3) {
    const std::size_t n = outline.size();
    std::size_t ear = 0;
    while (ear < n && !is_ear(outline, ear)) ++ear;
    if (ear == n) return {};
    pieces.push_back({outline[(ear + n - 1) % n], outline[ear], outline[(ear + 1) % n]});
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (!is_convex(outline)) return {};
  pieces.push_back(outline);
  while (join_two(pieces)) {
  }
  return pieces;
}

}  // namespace rubble::arenas
