#include "slam/robust/map/gone_things.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kLargestThing = 0.5;    ///< edge of the box around one [m]
constexpr double kCoreOfRadius = 0.4;    ///< a line so close to the middle of a thing meets it
constexpr double kCoreOfCell = 0.3;      ///< likewise, of things of one cell
constexpr std::size_t kRaysThrough = 2;  ///< make a pass
constexpr int kPasses = 4;               ///< of scans make a thing gone ...
constexpr int kPassesFromThere = 2;      ///< ... so many of them from where it was seen
constexpr double kSamePlace = 0.5;       ///< "there": within this [m]
constexpr double kOtherPlace = 0.25;     ///< places from which a thing was seen are kept so far apart [m]
constexpr double kUnderRobot = 0.10;     ///< the middle of a robot that was so close was where the thing was [m]

bool is_wall(const CountMap& map, Cell c) {
  const int occupied = map.occupied(c);
  return occupied > 0 && 2 * occupied >= map.seen(c);
}

}  // namespace

GoneThings::GoneThings(const CountMap& map) : frame_(map.frame()) {
  const int most = static_cast<int>(std::lround(kLargestThing / frame_.resolution));
  std::vector<bool> visited(frame_.size(), false);
  std::vector<Cell> cluster;
  for (int y = 0; y < frame_.height; ++y)
    for (int x = 0; x < frame_.width; ++x) {
      const std::size_t first = frame_.index({x, y});
      if (visited[first] || !is_wall(map, {x, y})) continue;
      visited[first] = true;
      cluster.assign(1, {x, y});
      Cell low = cluster[0], high = cluster[0];
      for (std::size_t next = 0; next < cluster.size(); ++next) {
        const Cell c = cluster[next];
        low = {std::min(low.x, c.x), std::min(low.y, c.y)};
        high = {std::max(high.x, c.x), std::max(high.y, c.y)};
        for (int v = std::max(0, c.y - 1); v <= std::min(frame_.height - 1, c.y + 1); ++v)
          for (int u = std::max(0, c.x - 1); u <= std::min(frame_.width - 1, c.x + 1); ++u) {
            const std::size_t beside = frame_.index({u, v});
            if (visited[beside] || !is_wall(map, {u, v})) continue;
            visited[beside] = true;
            cluster.push_back({u, v});
          }
      }
      if (high.x - low.x < most && high.y - low.y < most) add(cluster);
    }
  std::sort(thing_at_.begin(), thing_at_.end());
  hit_.assign(things_.size(), 0);
}

void GoneThings::add(std::vector<Cell> cells) {
  Thing thing;
  std::vector<TPoint2D> centres;
  for (const Cell c : cells) centres.push_back(frame_.centre(c));
  thing.centre = middle_of(centres);
  for (const TPoint2D& p : centres) thing.radius = std::max(thing.radius, distance(p, thing.centre));
  thing.core = std::max(kCoreOfRadius * thing.radius, kCoreOfCell * frame_.resolution);
  thing.radius += frame_.resolution;
  if (near_.empty()) near_.assign(frame_.size(), false);
  for (const Cell c : cells)
    for (int v = c.y - 1; v <= c.y + 1; ++v)
      for (int u = c.x - 1; u <= c.x + 1; ++u) {
        if (!frame_.inside({u, v})) continue;
        const std::size_t index = frame_.index({u, v});
        near_[index] = true;
        thing_at_.emplace_back(index, static_cast<int>(things_.size()));
      }
  thing.cells = std::move(cells);
  things_.push_back(std::move(thing));
}

bool GoneThings::Thing::gone() const {
  return driven_over || (passes >= kPasses && passes_from_there >= kPassesFromThere);
}

void GoneThings::see(Thing& thing, const TPoint2D& from) {
  thing.passes = 0;
  thing.passes_from_there = 0;
  thing.driven_over = false;
  const bool known = std::any_of(thing.seen_from.begin(), thing.seen_from.end(),
                                 [&](const TPoint2D& p) { return distance(p, from) < kOtherPlace; });
  if (!known) thing.seen_from.push_back(from);
}

bool GoneThings::seen_through(const Thing& thing, double away, double bearing, double beam_width) const {
  const double half = thing.core / away;
  if (2.0 * half < beam_width) return false;
  std::size_t through = 0;
  // The bearings of a scan are one turn from the first.
  const double past_first = wrap_angle(bearing - half - rays_.front().bearing);
  const double low = rays_.front().bearing + (past_first < 0.0 ? past_first + 2.0 * kPi : past_first);
  const auto first = std::lower_bound(rays_.begin(), rays_.end(), low,
                                      [](const Ray& ray, double value) { return ray.bearing < value; });
  for (auto ray = first; ray != rays_.end() && ray->bearing <= low + 2.0 * half; ++ray) {
    if (!ray->hit) continue;
    if (ray->range < away + thing.radius) return false;
    ++through;
  }
  return through >= kRaysThrough;
}

void GoneThings::look(const TPose2D& T_map_base, const ScanPoints& points, bool level) {
  if (points.rays.empty()) return;
  const PlanarTransform to_map(T_map_base);
  const TPoint2D origin = to_map(points.origin);
  double farthest = 0.0;
  std::fill(hit_.begin(), hit_.end(), char{0});
  for (const ScanRay& ray : points.rays) {
    if (!ray.hit) continue;
    farthest = std::max(farthest, distance(ray.end, points.origin));
    const Cell c = frame_.cell(to_map(ray.end));
    if (!frame_.inside(c) || !near_[frame_.index(c)]) continue;
    const std::pair<std::size_t, int> key(frame_.index(c), 0);
    for (auto at = std::lower_bound(thing_at_.begin(), thing_at_.end(), key);
         at != thing_at_.end() && at->first == key.first; ++at)
      hit_[static_cast<std::size_t>(at->second)] = 1;
  }
  rays_.clear();
  for (std::size_t k = 0; k < things_.size(); ++k) {
    Thing& thing = things_[k];
    if (hit_[k] != 0) {
      see(thing, origin);
      continue;
    }
    if (thing.seen_from.empty()) continue;
    if (distance(position(T_map_base), thing.centre) < kUnderRobot) thing.driven_over = true;
    const double away = distance(origin, thing.centre);
    if (!level || away > farthest || away <= thing.radius) continue;
    if (rays_.empty()) {
      double turned = 0.0, before = 0.0;
      for (const ScanRay& ray : points.rays) {
        const TPoint2D along = ray.end - points.origin;
        const double bearing = std::atan2(along.y, along.x);
        turned = rays_.empty() ? bearing : turned + std::max(0.0, wrap_angle(bearing - before));
        before = bearing;
        rays_.push_back({turned, length(along), ray.hit});
      }
    }
    const TPoint2D towards = to_map.inverse(thing.centre) - points.origin;
    if (!seen_through(thing, away, std::atan2(towards.y, towards.x), points.beam_width)) continue;
    ++thing.passes;
    const bool from_there = std::any_of(thing.seen_from.begin(), thing.seen_from.end(),
                                        [&](const TPoint2D& p) { return distance(p, origin) < kSamePlace; });
    thing.passes_from_there += from_there ? 1 : 0;
  }
}

std::vector<Cell> GoneThings::cells() const {
  std::vector<Cell> cells;
  for (const Thing& thing : things_)
    if (thing.gone()) cells.insert(cells.end(), thing.cells.begin(), thing.cells.end());
  return cells;
}

}  // namespace rubble::slam
