#include "explore/caution/blacklist.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr Stamp kForever{std::numeric_limits<std::int64_t>::max()};

bool holds(const TPoint2D& centre, double radius, const TPoint2D& p) { return distance(p, centre) <= radius; }

}  // namespace

void Blacklist::bar(const AnchoredPoint& p, double radius, Stamp until) { entries_.push_back({p, radius, until}); }

void Blacklist::bar_for_good(const AnchoredPoint& p, double radius) {
  const bool twice = std::any_of(entries_.begin(), entries_.end(),
                                 [&](const Entry& e) { return e.for_good && holds(e.p.p_map(), e.radius, p.p_map()); });
  entries_.push_back({p, radius, kForever, true, twice});
}

void Blacklist::follow(const slam::Mapper& mapper) {
  for (Entry& e : entries_) e.p.follow(mapper);
}

bool Blacklist::barred(const TPoint2D& p_map, Stamp now) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& e) { return now < e.until && holds(e.p.p_map(), e.radius, p_map); });
}

bool Blacklist::barred_for_good(const TPoint2D& p_map) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& e) { return e.until == kForever && holds(e.p.p_map(), e.radius, p_map); });
}

int Blacklist::times_barred(const TPoint2D& p_map) const {
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(),
                                        [&](const Entry& e) { return holds(e.p.p_map(), e.radius, p_map); }));
}

bool Blacklist::pardon_all(Stamp now) {
  bool any = false;
  for (Entry& e : entries_) {
    if (e.until <= now || e.twice) continue;
    e.until = now;
    any = true;
  }
  return any;
}

bool Blacklist::pardon(Stamp now) {
  bool any = false;
  for (Entry& e : entries_) {
    if (e.until <= now || e.until == kForever) continue;
    e.until = now;
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
