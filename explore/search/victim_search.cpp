#include "explore/search/victim_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;

constexpr std::size_t kKinds = 4;

}  // namespace

TPoint2D geometric_median(const std::vector<TPoint2D>& points, const std::vector<double>& weights) {
  TPoint2D median;
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    median += points[i] * weights[i];
    total += weights[i];
  }
  median *= 1.0 / total;
  for (int iteration = 0; iteration < 20; ++iteration) {
    TPoint2D sum;
    double norm = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double w = weights[i] / std::max(distance(points[i], median), 0.01);  // 1 cm keeps it finite on a point
      sum += points[i] * w;
      norm += w;
    }
    median = sum * (1.0 / norm);
  }
  return median;
}

/// Whether two places `d` [m] apart, with a sighting of each, are two victims: on the two sides of a wall.
bool VictimSearch::back_to_back(double d, const Sighting& a, const Sighting& b, const SightFn& in_sight) const {
  if (d < config_.back_to_back) return false;
  const double bearing_a = a.anchor.T_map_base.phi + std::atan2(a.p_base.y, a.p_base.x);
  const double bearing_b = b.anchor.T_map_base.phi + std::atan2(b.p_base.y, b.p_base.x);
  if (std::abs(wrap_angle(bearing_a - bearing_b)) < config_.other_side) return false;
  return !in_sight({a.anchor.T_map_base.x, a.anchor.T_map_base.y}, {b.anchor.T_map_base.x, b.anchor.T_map_base.y});
}

std::size_t VictimSearch::cluster_near(const Sighting& sighting, const SightFn& in_sight) const {
  std::size_t best = clusters_.size();
  double best_distance = config_.merge_distance;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double d = distance(clusters_[i].p_map, sighting.p_map);
    if (d >= best_distance) continue;
    if (back_to_back(d, clusters_[i].sightings.front(), sighting, in_sight)) continue;
    best = i;
    best_distance = d;
  }
  return best;
}

void VictimSearch::locate(Cluster& cluster) const {
  std::vector<TPoint2D> points;
  std::vector<double> weights;
  for (const Sighting& s : cluster.sightings) {
    points.push_back(s.p_map);
    weights.push_back(s.confidence);
  }
  cluster.p_map = geometric_median(points, weights);
}

void VictimSearch::confirm(Cluster& cluster, Stamp stamp) {
  if (cluster.id != 0) return;
  int cues = 0;
  double evidence = 0.0;
  for (const Sighting& s : cluster.sightings) {
    if (stamp - s.anchor.stamp > config_.memory || distance(s.p_map, cluster.p_map) > config_.consistency) continue;
    ++cues;
    evidence += s.confidence;
  }
  if (cues < config_.min_cues || evidence < config_.min_evidence) return;
  cluster.id = next_id_++;
  cluster.confirmed = stamp;
}

/// Joins the cluster with another one that its position has come too close to; returns where it is then.
std::size_t VictimSearch::merge_into_neighbour(std::size_t index, const SightFn& in_sight) {
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double d = distance(clusters_[i].p_map, clusters_[index].p_map);
    if (i == index || d >= config_.merge_distance) continue;
    if (back_to_back(d, clusters_[i].sightings.front(), clusters_[index].sightings.front(), in_sight)) continue;
    const std::size_t keep = std::min(i, index);
    const std::size_t drop = std::max(i, index);
    Cluster& kept = clusters_[keep];
    const Cluster& dropped = clusters_[drop];
    kept.sightings.insert(kept.sightings.end(), dropped.sightings.begin(), dropped.sightings.end());
    if (kept.id == 0 || (dropped.id != 0 && dropped.id < kept.id)) {
      kept.id = dropped.id;
      kept.confirmed = dropped.confirmed;
    }
    clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(drop));
    return keep;
  }
  return index;
}

void VictimSearch::add(const robot::VictimCue& cue, const TPose2D& T_map_base) {
  add(cue, Anchor{cue.stamp, T_map_base}, [](const TPoint2D&, const TPoint2D&) { return true; });
}

void VictimSearch::add(const robot::VictimCue& cue, const Anchor& anchor, const SightFn& in_sight) {
  if (!std::isfinite(cue.bearing) || !std::isfinite(cue.range) || !(cue.confidence > 0.0)) return;
  Sighting sighting;
  sighting.kind = cue.kind;
  sighting.confidence = std::min(cue.confidence, 1.0);
  sighting.anchor = anchor;
  sighting.p_base = {cue.range * std::cos(cue.bearing), cue.range * std::sin(cue.bearing)};
  sighting.p_map = anchor.T_map_base.composePoint(sighting.p_base);

  std::size_t index = cluster_near(sighting, in_sight);
  if (index == clusters_.size()) clusters_.emplace_back();
  clusters_[index].sightings.push_back(sighting);
  locate(clusters_[index]);
  index = merge_into_neighbour(index, in_sight);
  std::vector<Sighting>& sightings = clusters_[index].sightings;
  if (static_cast<int>(sightings.size()) > config_.max_cues)
    sightings.erase(sightings.begin(), sightings.end() - config_.max_cues);
  locate(clusters_[index]);
  clusters_[index].newest = std::max(clusters_[index].newest, cue.stamp);
  confirm(clusters_[index], cue.stamp);
  rebuild_reports();
}

void VictimSearch::follow(const slam::Mapper& mapper) {
  for (Cluster& cluster : clusters_) {
    for (Sighting& sighting : cluster.sightings) {
      sighting.anchor.follow(mapper);
      sighting.p_map = sighting.anchor.T_map_base.composePoint(sighting.p_base);
    }
    locate(cluster);
  }
  rebuild_reports();
}

bool VictimSearch::undecided(Stamp now, double age) const {
  return std::any_of(clusters_.begin(), clusters_.end(), [&](const Cluster& cluster) {
    return cluster.id == 0 && cluster.newest != Stamp::never() && now - cluster.newest < age;
  });
}

void VictimSearch::rebuild_reports() {
  reports_.clear();
  for (const Cluster& cluster : clusters_) {
    if (cluster.id == 0) continue;
    VictimReport report{cluster.id, cluster.p_map, cluster.confirmed, 0.0, {}};
    std::array<double, kKinds> sum{};
    std::array<int, kKinds> count{};
    for (const Sighting& s : cluster.sightings) {
      sum[static_cast<std::size_t>(s.kind)] += s.confidence;
      ++count[static_cast<std::size_t>(s.kind)];
    }
    double doubt = 1.0;  // kinds of sensors err independently; a kind with few cues counts less
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      if (count[kind] == 0) continue;
      doubt *= 1.0 - sum[kind] / (count[kind] + 1);
      report.cues.push_back(static_cast<CueKind>(kind));
    }
    report.confidence = 1.0 - doubt;
    reports_.push_back(report);
  }
  std::sort(reports_.begin(), reports_.end(), [](const VictimReport& a, const VictimReport& b) { return a.id < b.id; });
}

}  // namespace rubble::explore
