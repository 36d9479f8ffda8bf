#include "explore/search/victim_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;

constexpr std::size_t kKinds = 4;
constexpr double kMedianLoss = 1.57;  ///< a median's variance over that of a mean, of normal errors: pi / 2

/// Cameras tell where a victim is, ears and noses only whereabouts.
bool places_well(CueKind kind) { return kind == CueKind::Appearance || kind == CueKind::Heat; }

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

PlaceCovariance covariance_at(const TPoint2D& place, const TPose2D& T_map_base, const PoseCovariance& covariance) {
  const double dx = place.x - T_map_base.x, dy = place.y - T_map_base.y;
  const double xt = covariance(0, 2), yt = covariance(1, 2), tt = covariance(2, 2);
  return {covariance(0, 0) - 2.0 * dy * xt + dy * dy * tt, covariance(0, 1) + dx * xt - dy * yt - dx * dy * tt,
          covariance(1, 1) + 2.0 * dx * yt + dx * dx * tt};
}

/// Whether two places `d` [m] apart, with a sighting of each, are two victims: on the two sides of a wall.
bool VictimSearch::back_to_back(double d, const Sighting& a, const Sighting& b, const Sightlines& sight) const {
  if (d < config_.back_to_back) return false;
  const double bearing_a = a.anchor.T_map_base.phi + std::atan2(a.p_base.y, a.p_base.x);
  const double bearing_b = b.anchor.T_map_base.phi + std::atan2(b.p_base.y, b.p_base.x);
  if (std::abs(wrap_angle(bearing_a - bearing_b)) < config_.other_side) return false;
  return !sight.open(position(a.anchor.T_map_base), position(b.anchor.T_map_base));
}

/// Whether a cluster and what was seen `d` [m] from it, through a hole in a wall or not, are of two boxes behind it.
bool VictimSearch::side_by_side(double d, const Cluster& cluster, bool through, const Sightlines& sight) const {
  if (!sight.holes || !through || d < config_.side_by_side) return false;
  return std::count_if(cluster.sightings.begin(), cluster.sightings.end(),
                       [](const Sighting& s) { return s.through; }) >= config_.min_cues;
}

/// The sighting of a cluster that the same sense had in the same look; null: none. A look of a camera shows each victim
/// once, and at its place.
VictimSearch::Sighting* VictimSearch::of_same_look(Cluster& cluster, const Sighting& sighting) const {
  if (!places_well(sighting.kind)) return nullptr;
  for (Sighting& other : cluster.sightings)
    if (other.anchor.stamp == sighting.anchor.stamp && other.kind == sighting.kind &&
        distance(other.p_map, sighting.p_map) >= config_.back_to_back)
      return &other;
  return nullptr;
}

/// Whether a cue near a cluster cannot be of it.
bool VictimSearch::is_other(Cluster& cluster, const Sighting& sighting, const Sightlines& sight) const {
  const double d = distance(cluster.p_map, sighting.p_map);
  if (back_to_back(d, cluster.sightings.front(), sighting, sight)) return true;
  if (side_by_side(d, cluster, sighting.through, sight)) return true;
  if (of_same_look(cluster, sighting) != nullptr) return true;
  const TPoint2D from = position(sighting.anchor.T_map_base);
  return places_well(sighting.kind) && d >= config_.back_to_back && sight.hidden(from, cluster.p_map) &&
         !sight.hidden(from, sighting.p_map);
}

VictimSearch::Home VictimSearch::home_of(const Sighting& sighting, const Sightlines& sight) {
  Home home{clusters_.size(), false};
  double best_distance = config_.merge_distance;
  int others = 0;
  int near = 0;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double d = distance(clusters_[i].p_map, sighting.p_map);
    if (d >= config_.merge_distance) continue;
    if (is_other(clusters_[i], sighting, sight)) {
      ++others;
      continue;
    }
    ++near;
    if (d >= best_distance) continue;
    home.index = i;
    best_distance = d;
  }
  home.sure = others > 0 && near <= 1;
  return home;
}

bool VictimSearch::seen_through(const Cluster& cluster) {
  return std::any_of(cluster.sightings.begin(), cluster.sightings.end(), [](const Sighting& s) { return s.through; });
}

/// Whether two clusters that have come too close to each other are two victims all the same. A single look at a false
/// alarm beside a victim tells them apart for a while only.
bool VictimSearch::are_two(Cluster& a, Cluster& b, const Sightlines& sight) {
  const Stamp now = std::max(a.newest, b.newest);
  int looks = 0, sure = 0;
  bool of_late = false;
  for (const Sighting& s : a.sightings) {
    if (of_same_look(b, s) == nullptr) continue;
    ++looks;
    of_late = of_late || now - s.anchor.stamp <= config_.memory;
  }
  if (of_late || looks >= config_.min_cues) return true;
  const double d = distance(a.p_map, b.p_map);
  if (d < config_.back_to_back) return false;
  if (side_by_side(d, a, seen_through(b), sight) || side_by_side(d, b, seen_through(a), sight)) return true;
  if (back_to_back(d, a.sightings.front(), b.sightings.front(), sight)) return true;
  // Boxes behind walls do not overlap: what told two apart was the error of a pose.
  if (sight.holes && d < config_.side_by_side && seen_through(a) && seen_through(b)) return false;
  for (const Cluster* cluster : {&a, &b})
    for (const Sighting& s : cluster->sightings) {
      sure += s.sure ? 1 : 0;
      of_late = of_late || (s.sure && now - s.anchor.stamp <= config_.memory);
    }
  return of_late || sure >= config_.min_cues;
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
  // So near to a victim only what cannot be that one counts.
  const bool beside_victim = std::any_of(clusters_.begin(), clusters_.end(), [&](const Cluster& other) {
    return other.id != 0 && distance(other.p_map, cluster.p_map) < config_.merge_distance;
  });
  int cues = 0;
  double evidence = 0.0;
  for (const Sighting& s : cluster.sightings) {
    if (stamp - s.anchor.stamp > config_.memory || distance(s.p_map, cluster.p_map) > config_.consistency) continue;
    if (beside_victim && !s.sure) continue;
    ++cues;
    evidence += s.confidence;
  }
  if (cues < config_.min_cues || evidence < config_.min_evidence) return;
  cluster.id = next_id_++;
  cluster.confirmed = stamp;
}

/// Joins the cluster with another one that its position has come too close to; returns where it is then.
std::size_t VictimSearch::merge_into_neighbour(std::size_t index, const Sightlines& sight) {
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double d = distance(clusters_[i].p_map, clusters_[index].p_map);
    if (i == index || d >= config_.merge_distance) continue;
    if (are_two(clusters_[i], clusters_[index], sight)) continue;
    const std::size_t keep = std::min(i, index);
    const std::size_t drop = std::max(i, index);
    Cluster& kept = clusters_[keep];
    const Cluster& dropped = clusters_[drop];
    kept.sightings.insert(kept.sightings.end(), dropped.sightings.begin(), dropped.sightings.end());
    kept.newest = std::max(kept.newest, dropped.newest);
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
  add(cue, Anchor{cue.stamp, T_map_base},
      {[](const TPoint2D&, const TPoint2D&) { return true; }, [](const TPoint2D&, const TPoint2D&) { return false; }});
}

void VictimSearch::add(const robot::VictimCue& cue, const Anchor& anchor, const Sightlines& sight,
                       const PoseCovariance& covariance) {
  if (!std::isfinite(cue.bearing) || !std::isfinite(cue.range) || !(cue.confidence > 0.0)) return;
  Sighting sighting;
  sighting.kind = cue.kind;
  sighting.confidence = std::min(cue.confidence, 1.0);
  sighting.anchor = anchor;
  sighting.p_base = {cue.range * std::cos(cue.bearing), cue.range * std::sin(cue.bearing)};
  sighting.p_map = anchor.T_map_base.composePoint(sighting.p_base);
  sighting.through =
      sight.through && places_well(cue.kind) && sight.through(position(anchor.T_map_base), sighting.p_map);
  sighting.pose = covariance_at(sighting.p_map, anchor.T_map_base, covariance);
  put(std::move(sighting), sight);
  rebuild_reports();
}

void VictimSearch::put(Sighting sighting, const Sightlines& sight) {
  // The cues of one look come one by one: one that took the place of a nearer one makes room for it.
  for (Cluster& cluster : clusters_) {
    const double d = distance(sighting.p_map, cluster.p_map);
    if (d >= config_.merge_distance) continue;
    Sighting* const other = of_same_look(cluster, sighting);
    if (other == nullptr || d >= distance(other->p_map, cluster.p_map)) continue;
    std::swap(*other, sighting);
    break;
  }
  const Home home = home_of(sighting, sight);
  sighting.sure = home.sure;
  for (Cluster& cluster : clusters_) {
    if (distance(sighting.p_map, cluster.p_map) >= config_.merge_distance) continue;
    if (Sighting* const other = of_same_look(cluster, sighting)) other->sure = true;
  }
  put_into(home.index, sighting, sight);
}

void VictimSearch::put_into(std::size_t index, const Sighting& sighting, const Sightlines& sight) {
  if (index == clusters_.size()) clusters_.emplace_back();
  clusters_[index].sightings.push_back(sighting);
  locate(clusters_[index]);
  clusters_[index].newest = std::max(clusters_[index].newest, sighting.anchor.stamp);
  index = merge_into_neighbour(index, sight);
  std::vector<Sighting>& sightings = clusters_[index].sightings;
  if (static_cast<int>(sightings.size()) > config_.max_cues)
    sightings.erase(sightings.begin(), sightings.end() - config_.max_cues);
  locate(clusters_[index]);
  confirm(clusters_[index], sighting.anchor.stamp);
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

std::vector<TPoint2D> VictimSearch::undecided(Stamp now, double age) const {
  std::vector<TPoint2D> places;
  for (const Cluster& cluster : clusters_)
    if (cluster.id == 0 && cluster.newest != Stamp::never() && now - cluster.newest < age)
      places.push_back(cluster.p_map);
  return places;
}

std::vector<TPoint2D> VictimSearch::seen_from(int id) const {
  std::vector<TPoint2D> places;
  for (const Cluster& cluster : clusters_) {
    if (cluster.id != id) continue;
    for (const Sighting& s : cluster.sightings)
      if (places_well(s.kind) && distance(s.p_map, cluster.p_map) <= config_.consistency)
        places.push_back(position(s.anchor.T_map_base));
  }
  return places;
}

void VictimSearch::rename(int id, int older, Stamp confirmed) {
  for (Cluster& cluster : clusters_)
    if (cluster.id == id) {
      cluster.id = older;
      cluster.confirmed = confirmed;
    }
  rebuild_reports();
}

/// What the cues scatter about their median, and what the poses err that they were sensed from, which all may share.
PlaceCovariance VictimSearch::covariance_of(const Cluster& cluster) const {
  PlaceCovariance scatter, poses;
  double weight = 0.0, squares = 0.0;
  for (const Sighting& s : cluster.sightings) {
    const TPoint2D d = s.p_map - cluster.p_map;
    if (d.norm() > config_.consistency) continue;  // a false alarm
    scatter = scatter + PlaceCovariance{d.x * d.x, d.x * d.y, d.y * d.y} * s.confidence;
    poses = poses + s.pose * s.confidence;
    weight += s.confidence;
    squares += s.confidence * s.confidence;
  }
  if (weight == 0.0) return {};
  return scatter * (kMedianLoss * squares / (weight * weight * weight)) + poses * (1.0 / weight);
}

void VictimSearch::rebuild_reports() {
  reports_.clear();
  for (const Cluster& cluster : clusters_) {
    if (cluster.id == 0) continue;
    VictimReport report{cluster.id, cluster.p_map, cluster.confirmed, 0.0, {}, covariance_of(cluster)};
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
