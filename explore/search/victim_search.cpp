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

std::size_t VictimSearch::cluster_near(const TPoint2D& p_map) const {
  std::size_t best = clusters_.size();
  double best_distance = config_.merge_distance;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double d = distance(clusters_[i].p_map, p_map);
    if (d >= best_distance) continue;
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
    if (distance(s.p_map, cluster.p_map) > config_.consistency) continue;
    ++cues;
    evidence += s.confidence;
  }
  if (cues < config_.min_cues || evidence < config_.min_evidence) return;
  cluster.id = next_id_++;
  cluster.confirmed = stamp;
}

/// Joins the cluster with another one that its position has come too close to; returns where it is then.
std::size_t VictimSearch::merge_into_neighbour(std::size_t index) {
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    if (i == index || distance(clusters_[i].p_map, clusters_[index].p_map) >= config_.merge_distance) continue;
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
  if (!std::isfinite(cue.bearing) || !std::isfinite(cue.range) || !(cue.confidence > 0.0)) return;
  const double heading = T_map_base.phi + cue.bearing;
  const TPoint2D p_map{T_map_base.x + cue.range * std::cos(heading), T_map_base.y + cue.range * std::sin(heading)};

  std::size_t index = cluster_near(p_map);
  if (index == clusters_.size()) clusters_.emplace_back();
  clusters_[index].sightings.push_back({p_map, cue.kind, std::min(cue.confidence, 1.0)});
  locate(clusters_[index]);
  index = merge_into_neighbour(index);
  std::vector<Sighting>& sightings = clusters_[index].sightings;
  if (static_cast<int>(sightings.size()) > config_.max_cues)
    sightings.erase(sightings.begin(), sightings.end() - config_.max_cues);
  locate(clusters_[index]);
  clusters_[index].newest = std::max(clusters_[index].newest, cue.stamp);
  confirm(clusters_[index], cue.stamp);
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
