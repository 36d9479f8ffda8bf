#include "arenas/model/risers.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBeyond = 1e-4;  ///< how far outside the edge the neighbour is looked for [m]

/// Height that is linear along an edge, where it is known.
struct Profile {
  Interval where;
  double at0 = 0.0;
  double at1 = 0.0;
  double at(double t) const { return at0 + t * (at1 - at0); }
};

/// Where two profiles have equal height, if that is inside the edge.
void add_crossing(const Profile& p, const Profile& q, std::vector<double>& breaks) {
  const double slope = (p.at1 - p.at0) - (q.at1 - q.at0);
  if (slope == 0.0) return;
  const double t = (q.at0 - p.at0) / slope;
  if (t > 0.0 && t < 1.0) breaks.push_back(t);
}

/// Floors of other patches along the line just beyond the edge a -> b.
std::vector<Profile> neighbours(const Arena& arena, const PatchIndex& index, std::size_t own, const TPoint2D& a,
                                const TPoint2D& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const TPoint2D out{(b.y - a.y) / length * kBeyond, -(b.x - a.x) / length * kBeyond};
  const TPoint2D a_out = a + out;
  const TPoint2D b_out = b + out;
  std::vector<Profile> found;
  for (const std::size_t i : index.near(a_out, b_out)) {
    if (i == own) continue;
    const FloorPatch& patch = arena.floor[i];
    if (const auto part = clip(patch.outline, a_out, b_out)) {
      found.push_back({*part, patch.height(a), patch.height(b)});
    }
  }
  return found;
}

/// Between two neighbouring breaks one profile is the highest throughout.
std::vector<double> breaks_along(const Profile& own, const std::vector<Profile>& others) {
  std::vector<double> breaks{0.0, 1.0};
  for (std::size_t i = 0; i < others.size(); ++i) {
    breaks.push_back(others[i].where.from);
    breaks.push_back(others[i].where.to);
    add_crossing(own, others[i], breaks);
    for (std::size_t j = 0; j < i; ++j) add_crossing(others[j], others[i], breaks);
  }
  add_crossing(own, Profile{}, breaks);
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

void add_risers_of_edge(const Profile& own, const std::vector<Profile>& others, const TPoint2D& a, const TPoint2D& b,
                        double min_gap, std::vector<Riser>& result) {
  const std::vector<double> breaks = breaks_along(own, others);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double t0 = breaks[i];
    const double t1 = breaks[i + 1];
    if (t1 - t0 < 1e-4) continue;
    const double middle = 0.5 * (t0 + t1);
    const Profile* beyond = nullptr;
    for (const Profile& other : others) {
      if (middle < other.where.from || middle > other.where.to) continue;
      if (beyond == nullptr || other.at(middle) > beyond->at(middle)) beyond = &other;
    }
    const Profile low = beyond != nullptr ? *beyond : Profile{};
    if (std::max(own.at(t0) - low.at(t0), own.at(t1) - low.at(t1)) < min_gap) continue;
    const TPoint2D along = b - a;
    result.push_back({a + along * t0, a + along * t1, std::min(low.at(t0), own.at(t0)), own.at(t0),
                      std::min(low.at(t1), own.at(t1)), own.at(t1), beyond != nullptr});
  }
}

}  // namespace

std::vector<Riser> risers(const Arena& arena, double min_gap) {
  const PatchIndex index(arena);
  std::vector<Riser> result;
  for (std::size_t i = 0; i < arena.floor.size(); ++i) {
    const FloorPatch& patch = arena.floor[i];
    for (std::size_t k = 0; k < patch.outline.size(); ++k) {
      const TPoint2D& a = patch.outline[k];
      const TPoint2D& b = patch.outline[(k + 1) % patch.outline.size()];
      const Profile own{{0.0, 1.0}, patch.height(a), patch.height(b)};
      add_risers_of_edge(own, neighbours(arena, index, i, a, b), a, b, min_gap, result);
    }
  }
  return result;
}

Stretch too_high(const Riser& riser, double limit) {
  const double a = riser.high_a - riser.low_a - limit;
  const double b = riser.high_b - riser.low_b - limit;
  if (a <= 0.0 && b <= 0.0) return {0.0, 0.0};
  if (a > 0.0 && b > 0.0) return {0.0, 1.0};
  const double crossing = a / (a - b);
  return a > 0.0 ? Stretch{0.0, crossing} : Stretch{crossing, 1.0};
}

}  // namespace rubble::arenas
