#include "slam/paper/paper_mapper.h"

#include <cmath>
#include <optional>

#include "base/planar.h"
#include "base/rng.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/odometry_track.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::LaserScan;

void bind(Binder& b, PaperConfig& c) {
  b.integer("map_cells", c.map_cells, 16, 8000);
  b.number("resolution_m", c.resolution, 0.01, 0.5);
  b.integer("particles", c.particles, 1, 100000);
  b.number("top_share", c.top_share, 0.0001, 1.0);
  b.number("rotation_error", c.motion_error.rotation, 0.0, 1.0);
  b.degrees("heading_error_deg_per_m", c.motion_error.heading_per_m, 0.0, 90.0);
  b.number("distance_error", c.motion_error.distance, 0.0, 1.0);
  b.number("distance_error_m_per_rad", c.motion_error.distance_per_rad, 0.0, 1.0);
  b.number("gate_distance_m", c.gate_distance, 0.0, 2.0);
  b.degrees("gate_turn_deg", c.gate_turn, 0.0, 180.0);
  b.choice("gated", c.gated, {"step", "resampling"});
  b.boolean("icp", c.icp);
  b.choice("icp_target", c.icp_target, {"last_mapped", "last_scan"});
  b.boolean("icp_trimmed", c.icp_trimmed);
  b.choice("sweep_reference", c.sweep_reference, {"middle", "stamp"});
  b.boolean("carve_misses", c.scan.carve_misses);
  b.number("max_range_m", c.scan.max_range, 0.0, 1000.0);
  b.boolean("deskew", c.deskew);
  b.integer("first_scans", c.first_scans, 1, 1000);
  b.integer("max_map_cells", c.max_map_cells, 16, 20000);
  b.number("coverage_margin_m", c.coverage_margin, 0.0, 1.0);
  b.number("rim_margin_m", c.rim_margin, 0.0, 1.0);
  b.section("icp_limits", [&](Binder& m) {
    m.number("first_distance_m", c.matcher.first_distance, 0.01, 5.0);
    m.number("last_distance_m", c.matcher.last_distance, 0.005, 5.0);
    m.number("min_goodness", c.matcher.min_goodness, 0.0, 1.0);
    m.number("max_correction_m", c.matcher.max_correction, 0.0, 5.0);
    m.degrees("max_turn_deg", c.matcher.max_turn, 0.0, 180.0);
    m.number("dense_spacing_m", c.matcher.dense_spacing, 0.005, 1.0);
  });
}

struct PaperMapper::Impl {
  Impl(const robot::RobotModel& model, const PaperConfig& config, std::uint64_t seed)
      : config_(config),
        level_scan_(model.T_base_laser, config.scan),
        matcher_(config.matcher),
        map_(config.map_cells, config.map_cells, config.resolution, config.max_map_cells),
        drift_rng_(seed, "drift") {}

  void receive(const robot::Inputs& inputs);
  void process(const LaserScan& scan);
  void start(Stamp reference, const ScanPoints& points);
  void keep(Stamp reference, const TPose2D& T_map_base, const ScanPoints& points, const Surface& surface);
  void remember_hits(const TPose2D& T_map_base, const ScanPoints& points);
  void pass(Stamp reference, const TPose2D& T_last_now);
  void match_later_scans_with(const Surface& surface);
  Stamp reference_of(const LaserScan& scan) const;
  TPose2D motion_since_scan(Stamp reference) const;
  TPose2D refined_motion(const Surface& surface, const TPose2D& T_target_prior);
  std::vector<TPoint2D> hits_to_weigh(const ScanPoints& points, const Surface& surface) const;
  bool moved(const TPose2D& motion) const;

  const PaperConfig config_;
  LevelScan level_scan_;
  ScanMatcher matcher_;
  OdometryTrack odometry_;
  CountMap map_;
  Rng drift_rng_;

  WaitingScans waiting_;
  Particles particles_;
  Trajectory trajectory_;
  std::vector<TPoint2D> last_hits_;
  MapperCounts counts_;
  std::uint64_t icp_accepted_ = 0;
  std::uint64_t icp_rejected_ = 0;
  bool started_ = false;
  // The last mapping step.
  TPose2D T_map_last_;
  // The last scan, mapped or not.
  TPose2D T_last_scan_;  ///< motion since the last mapping step
  // The scan that others are matched with.
  SurfaceCoverage last_coverage_;
  TPose2D T_last_target_;               ///< its place, seen from the last mapping step
  TPose2D T_target_scan_;               ///< the last scan's place, seen from it
  std::optional<TPose2D> T_odom_scan_;  ///< nothing while no odometry has come
};

void PaperMapper::Impl::receive(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) odometry_.add(odometry);
  if (started_ && !T_odom_scan_ && !odometry_.empty()) T_odom_scan_ = odometry_.pose_at(Stamp::never());
  for (const LaserScan& scan : inputs.scans) {
    ++counts_.scans;
    if (!waiting_.add(scan)) ++counts_.out_of_order;
  }
  while (waiting_.ready(odometry_, inputs.now)) process(waiting_.take());
  if (!odometry_.empty()) odometry_.forget_before(waiting_.oldest_needed(odometry_));
}

void PaperMapper::Impl::process(const LaserScan& scan) {
  const Stamp reference = reference_of(scan);
  const std::optional<SweepMotion> sweep = config_.deskew ? sweep_motion(odometry_, scan, reference) : std::nullopt;
  const ScanPoints points = level_scan_.points(scan, sweep ? &*sweep : nullptr);
  if (!started_) return start(reference, points);

  // Section III.B: odometry interpolated at the scan's time, refined by ICP of an earlier and the current scan.
  const Surface surface = surface_of(points, config_.surface);
  const TPose2D T_last_now = T_last_target_ + refined_motion(surface, T_target_scan_ + motion_since_scan(reference));
  const bool gate = moved(T_last_now);
  const bool whole_step = gate || config_.gated == GatedPart::Resampling;
  if (!whole_step && counts_.mapped >= static_cast<std::uint64_t>(config_.first_scans)) {
    remember_hits(T_map_last_ + T_last_now, points);
    pass(reference, T_last_now);
    if (config_.icp_target == IcpTarget::LastScan) match_later_scans_with(surface);
    return;
  }

  const std::vector<TPoint2D> judged = hits_to_weigh(points, surface);
  const Particles resampled = gate ? resample(particles_) : particles_;
  const Particles drifted = drift(resampled, T_last_now, config_.motion_error, drift_rng_);  // Fig. 5
  const Particles measured = measure(drifted, judged, map_);                                 // eq. (2)
  particles_ = normalise(measured);
  const TPose2D T_map_now = mean_of_best(particles_, config_.top_share);
  keep(reference, T_map_now, points, surface);
}

void PaperMapper::Impl::start(Stamp reference, const ScanPoints& points) {
  started_ = true;
  particles_ = particles_at(TPose2D(), config_.particles);
  keep(reference, TPose2D(), points, surface_of(points, config_.surface));
}

/// Ends a scan: the next one's odometry counts from here.
void PaperMapper::Impl::pass(Stamp reference, const TPose2D& T_last_now) {
  T_last_scan_ = T_last_now;
  T_target_scan_ = T_last_now - T_last_target_;
  if (!odometry_.empty()) T_odom_scan_ = odometry_.pose_at(reference);
  trajectory_.push_back({reference, T_map_last_ + T_last_now});
}

/// Makes the scan that has just ended the one that later scans are matched with.
void PaperMapper::Impl::match_later_scans_with(const Surface& surface) {
  matcher_.set_last(surface);
  last_coverage_ = SurfaceCoverage(surface);
  T_last_target_ = T_last_scan_;
  T_target_scan_ = TPose2D();
}

/// Ends a mapping step: the scan enters the map, and later ones are matched with it.
void PaperMapper::Impl::keep(Stamp reference, const TPose2D& T_map_base, const ScanPoints& points,
                             const Surface& surface) {
  map_.stamp(T_map_base, points);
  T_map_last_ = T_map_base;
  remember_hits(T_map_base, points);
  ++counts_.mapped;
  pass(reference, TPose2D());
  match_later_scans_with(surface);
}

void PaperMapper::Impl::remember_hits(const TPose2D& T_map_base, const ScanPoints& points) {
  const PlanarTransform to_map(T_map_base);
  last_hits_.clear();
  for (const TPoint2D& p_base : points.hits) last_hits_.push_back(to_map(p_base));
}

/// A scan's stamp is that of its first beam. The queue orders scans by their middles; where beams are left out from
/// scan to scan their stamps may be in another order, and then the middle stands.
Stamp PaperMapper::Impl::reference_of(const LaserScan& scan) const {
  const bool printed = config_.sweep_reference == SweepReference::Stamp &&
                       (trajectory_.empty() || scan.stamp > trajectory_.back().stamp);
  return printed ? scan.stamp : scan.middle();
}

/// Nothing where there is no odometry: the scan matcher alone then finds the motion.
TPose2D PaperMapper::Impl::motion_since_scan(Stamp reference) const {
  return T_odom_scan_ ? odometry_.pose_at(reference) - *T_odom_scan_ : TPose2D();
}

TPose2D PaperMapper::Impl::refined_motion(const Surface& surface, const TPose2D& T_target_prior) {
  if (!config_.icp) return T_target_prior;
  const ScanMatch match = matcher_.match(
      config_.icp_trimmed ? covered_part(surface, last_coverage_, T_target_prior, config_.coverage_margin) : surface,
      T_target_prior);
  ++(match.accepted ? icp_accepted_ : icp_rejected_);
  return match.T_last_now;
}

std::vector<TPoint2D> PaperMapper::Impl::hits_to_weigh(const ScanPoints& points, const Surface& surface) const {
  if (config_.rim_margin <= 0.0) return points.hits;
  return hits_of(settled_part(surface, config_.rim_margin), points);
}

bool PaperMapper::Impl::moved(const TPose2D& motion) const {
  return length(motion.x, motion.y) >= config_.gate_distance || std::abs(wrap_angle(motion.phi)) >= config_.gate_turn;
}

PaperMapper::PaperMapper(const robot::RobotModel& model, const PaperConfig& config, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(model, config, seed)) {}
PaperMapper::~PaperMapper() = default;

void PaperMapper::update(const robot::Inputs& inputs) { impl_->receive(inputs); }

const CountMap& PaperMapper::map() const { return impl_->map_; }

TPose2D PaperMapper::pose() const {
  return impl_->T_map_last_ + impl_->T_last_scan_ + impl_->motion_since_scan(impl_->odometry_.newest());
}

PoseCovariance PaperMapper::covariance() const { return spread(impl_->particles_); }

std::optional<TPose2D> PaperMapper::pose_at(Stamp stamp) const { return rubble::pose_at(impl_->trajectory_, stamp); }

const Trajectory& PaperMapper::trajectory() const { return impl_->trajectory_; }
const std::vector<Particle>& PaperMapper::particles() const { return impl_->particles_; }
const std::vector<TPoint2D>& PaperMapper::last_hits() const { return impl_->last_hits_; }
const MapperCounts& PaperMapper::counts() const { return impl_->counts_; }

std::vector<MapperFigure> PaperMapper::figures() const {
  return {{"icp_accepted", static_cast<double>(impl_->icp_accepted_)},
          {"icp_rejected", static_cast<double>(impl_->icp_rejected_)}};
}

}  // namespace rubble::slam
