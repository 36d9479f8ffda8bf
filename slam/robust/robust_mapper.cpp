#include "slam/robust/robust_mapper.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/planar.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/robust/graph/wall_compass.h"
#include "slam/robust/map/stamped_map.h"
#include "slam/scan/odometry_track.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::LaserScan;

namespace {

constexpr double kAhead = 1.0;             ///< stamps so far in the future are wrong [s]
constexpr double kFastest = 10.0;          ///< odometry that goes faster has jumped [m/s]
constexpr double kFastestTurn = 20.0;      ///< or turns faster [rad/s]
constexpr double kFastestSweep = 3.0;      ///< the same within one sweep [m/s]
constexpr double kFastestSweepTurn = 6.0;  ///< [rad/s]
constexpr double kNoDuration = 1e-3;       ///< stamps closer than any scanner's say the order, not how long it took [s]
constexpr double kLeastJump = 0.5;         ///< below, a coarse clock may be to blame [m, rad]
constexpr double kEdgeDistance = 0.008;    ///< least error between key frames [m]
constexpr double kEdgeAngle = 0.003;       ///< [rad]
constexpr Work kLeastBudget = 300'000;     ///< for work put off, each scan
constexpr Work kUsualShare = 8;            ///< the usual budget is such a part of the largest ...
constexpr Work kHurry = 4;                 ///< ... and grows by itself with so many tasks that wait
constexpr double kLevel = deg_to_rad(5.0);  ///< of the scan plane
constexpr double kBelieved = 0.5;           ///< share of inliers with which a scan overrules the odometry
constexpr double kForgiving = 0.6;          ///< what is left of the doubt after each scan that agrees with the odometry
constexpr double kNoDoubt = 0.05;
constexpr double kLongestCarry = 0.5;   ///< motion is taken to go on for so long [s]
constexpr double kLongestLost = 3.0;    ///< then the map goes on from where the robot is thought to be [s]
constexpr double kLostDistance = 0.5;   ///< uncertainty of a robot that was lost [m]
constexpr double kLostAngle = 0.5;      ///< [rad]
constexpr double kKnownDistance = 0.6;  ///< ground is known within this of an old key frame [m] ...
constexpr double kKnownTurn = 0.5;      ///< ... looking the same way [rad] ...
constexpr double kKnownPath = 6.0;      ///< ... to which the graph leads so directly, though the drive was longer [m]
constexpr double kKnownInliers = 0.65;  ///< and what is seen there is what was seen
constexpr double kKnownMoves = 0.20;    ///< [m]
constexpr std::size_t kScanWitnesses = 8;  ///< key frames that are asked whether a scan can be true
constexpr double kTurnWeight = 0.3;        ///< [m] that a key frame may be farther off for looking 1 rad less aside
constexpr std::size_t kDoubtedFrames = 8;  ///< doubled key frames of a map that is doubted, at least ...
constexpr double kDoubtedShare = 0.005;    ///< ... and of all of them; right maps have 0.0013 and less
constexpr double kDoubtedUnfit = 0.05;     ///< or such a share of scans that fit nothing mapped
constexpr double kNotLost = 0.5;  ///< share of inliers of a scan that may be mapped though the odometry is doubted

/// Derivative of a pose by the one it hangs on, in the map frame: d is the lever between the two.
Eigen::Matrix3d lever(const TPose2D& from, const TPose2D& to) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -(to.y - from.y);
  J(1, 2) = to.x - from.x;
  return J;
}

bool finite(const robot::Odometry& o) {
  return std::isfinite(o.pose.x) && std::isfinite(o.pose.y) && std::isfinite(o.pose.phi) && std::isfinite(o.v) &&
         std::isfinite(o.w);
}

bool usable(const LaserScan& scan) {
  return std::isfinite(scan.angle_min) && scan.angle_step > 0.0 && std::isfinite(scan.angle_step) &&
         std::isfinite(scan.beam_period);
}

/// What record() writes.
std::vector<std::string> record_columns() {
  return {"inliers",
          "contradiction",
          "residual_m",
          "paired",
          "odometry_chi2",
          "slipped",
          "lost",
          "held",
          "beams",
          "beams_rejected",
          "work_ms",
          "sigma_x_m",
          "sigma_y_m",
          "sigma_heading_deg",
          "key_frames",
          "loops_searched",
          "loops_ambiguous",
          "loops_contradicted",
          "loops_needless",
          MapperFigure::kLoopsClosed,
          "near_edges",
          MapperFigure::kLoopsRemoved};
}

}  // namespace

struct RobustMapper::Impl {
  Impl(const robot::RobotModel& model, const RobustConfig& config)
      : config_(config),
        T_base_laser_(model.T_base_laser),
        scan_period_(model.laser.scan_period),
        level_scan_(model.T_base_laser, config.scan),
        tilt_(config.tilt),
        tracker_(config.tracker),
        closer_(config.loop, config.tracker.cell, frames_),
        map_(CountMap(config.map_cells, config.map_cells, config.resolution, config.max_map_cells), model.T_base_laser,
             stamping(config)) {}

  void receive(const robot::Inputs& inputs);
  bool ready(Stamp now) const;
  void process(const LaserScan& scan);
  TPose2D motion_since_scan(Stamp reference) const;
  ExpectedMotion expected_motion(const LaserScan& scan);
  bool jumps_within(const LaserScan& scan) const;
  std::optional<TPose2D> carried(double time) const;
  bool asks_for_frame(const Tracked& tracked) const;
  bool hang_on_old_frame(const Cloud& cloud, Work* work);
  std::optional<int> old_frame_here(Work* work) const;
  int closest_frame(const TPose2D& T_map_base) const;
  std::vector<int> frames_around(int here) const;
  double contradiction_of(const Cloud& cloud) const;
  Eigen::Matrix3d pose_covariance() const;
  bool is_map_doubted() const;
  void redraw(int here, Work* work);
  void go_on_in(KeyFrames frames, StampedMap map, const TPose2D& T_map_drive, bool grows);
  void add_frame(Stamp reference, Cloud cloud, const ScanPoints& points, const TPose2D& T_map_base,
                 const GraphEdge& edge);
  GraphEdge edge_to_now(const Tracked& tracked) const;
  void put_into_map(const LaserScan& scan, const std::optional<SweepMotion>& sweep, const std::optional<ScanTilt>& tilt,
                    Work& work);
  void close_loops(Work& budget);
  void lay_walls();
  void set_compass_right();
  void remember_hits(const ScanPoints& points);
  TPose2D now() const { return frames_.pose(here_) + T_frame_base_; }
  std::optional<SweepMotion> sweep_at(const LaserScan& scan, const TPose2D& motion, double time) const;
  bool may_be_mapped(const Tracked& tracked, double doubt, Stamp reference);
  const Trajectory& trajectory() const;
  TPose2D pose_of(std::size_t scan) const { return frames_.pose(scans_[scan].frame) + scans_[scan].T_frame_base; }
  std::optional<TPose2D> pose_at(Stamp stamp) const;

  /// Where a scan was taken.
  struct Place {
    Stamp stamp;
    int frame;
    TPose2D T_frame_base;
  };

  void record(Stamp reference, const LaserScan& scan, const ScanPoints& points, const Tracked* tracked,
              double contradiction);

  const RobustConfig config_;
  const mrpt::math::TPose3D T_base_laser_;
  const double scan_period_;  ///< [s]
  LevelScan level_scan_;
  TiltTrack tilt_;
  OdometryTrack odometry_;
  KeyFrames frames_;
  LocalTracker tracker_;
  WallCompass compass_;
  LoopCloser closer_;
  StampedMap map_;
  bool grows_ = true;  ///< false: the map is another's, and stays as it is
  ScanRecords records_{record_columns(), {}, {}};

  WaitingScans waiting_;
  std::optional<TPose2D> T_odom_scan_;  ///< at the last scan; nothing while no odometry has come
  std::optional<bool>
      silent_at_scan_;      ///< whether odometry was silent at the last scan, once what was said is forgotten
  int here_ = -1;           ///< the key frame that the robot hangs on: the newest, or an old one ...
  double path_here_ = 0.0;  ///< ... which it reached after so much path [m]
  TPose2D T_frame_base_;    ///< at the last scan, relative to that key frame
  /// What the compass moved that key frame by. The local map did not move with it, so scans are matched as if it had
  /// not.
  std::optional<TPose2D> T_matched_frame_;
  bool matched_since_frame_ = false;
  TPose2D T_map_stamped_;                                       ///< where the map was stamped last
  Eigen::Matrix3d frame_covariance_ = Eigen::Matrix3d::Zero();  ///< of that key frame, in the map
  Eigen::Matrix3d scan_covariance_ = Eigen::Matrix3d::Zero();   ///< of T_frame_base_, along the frame's axes
  std::vector<Place> scans_;
  Trajectory live_;
  mutable Trajectory trajectory_;
  mutable std::uint64_t trajectory_revision_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<TPoint2D> last_hits_;
  MapperCounts counts_;
  TPose2D last_step_;            ///< between the last two scans, as matched
  double last_step_time_ = 0.0;  ///< [s]
  double doubt_ = 0.0;           ///< of the odometry, by what the last scans said of it
  Stamp lost_since_ = Stamp::never();
  bool lost_on_the_way_ = false;  ///< since the newest key frame
  std::uint64_t reused_ = 0;
  std::uint64_t slips_ = 0;
  std::uint64_t silent_ = 0;
  std::uint64_t lost_ = 0;
  std::size_t doubled_ = 0;  ///< key frames, as the finished map lies
  std::uint64_t unfit_ = 0;  ///< scans that fit nothing mapped
  std::uint64_t relocated_ = 0;
  std::uint64_t unseen_ = 0;
  std::uint64_t odometry_jumps_ = 0;
  Work last_work_ = 0;
  Work all_work_ = 0;
  Work most_work_ = 0;
};

void RobustMapper::Impl::receive(const robot::Inputs& inputs) {
  tilt_.add(inputs);
  for (const robot::Odometry& odometry : inputs.odometry)
    if (finite(odometry) && odometry.stamp - inputs.now <= kAhead) odometry_.add(odometry);
  if (!scans_.empty() && !T_odom_scan_ && !odometry_.empty()) T_odom_scan_ = odometry_.pose_at(Stamp::never());
  for (const LaserScan& scan : inputs.scans) {
    ++counts_.scans;
    if (!usable(scan) || scan.middle() - inputs.now > kAhead || !waiting_.add(scan)) ++counts_.out_of_order;
  }
  while (ready(inputs.now)) process(waiting_.take());
  if (odometry_.empty()) return;
  const Stamp oldest_needed = waiting_.oldest_needed(odometry_);
  if (!scans_.empty() && !silent_at_scan_ && scans_.back().stamp < oldest_needed)
    silent_at_scan_ = odometry_.silent_at(scans_.back().stamp);  // the last time that it can be told
  odometry_.forget_before(oldest_needed);
  tilt_.forget_before(odometry_.newest() - WaitingScans::kLateScan);
}

/// A scan waits for odometry, and for its tilt.
bool RobustMapper::Impl::ready(Stamp now) const {
  return waiting_.ready(odometry_, now) && (!config_.use_tilt || tilt_.ready(waiting_.front().middle(), now));
}

void RobustMapper::Impl::process(const LaserScan& scan) {
  const Stamp reference = scan.middle();
  ExpectedMotion motion = frames_.empty() ? ExpectedMotion{} : expected_motion(scan);
  std::optional<SweepMotion> sweep = motion.doubt >= 1.0 && motion.carried
                                         ? sweep_at(scan, *motion.carried, motion.time)
                                         : sweep_motion(odometry_, scan);
  const std::optional<ScanTilt> tilt = config_.use_tilt ? tilt_.at(reference) : std::nullopt;
  motion.ramps = tilt.has_value();
  motion.level = !tilt || std::max(std::abs(tilt->pitch), std::abs(tilt->roll)) < kLevel;
  ScanPoints points = level_scan_.points(scan, sweep ? &*sweep : nullptr, tilt ? &*tilt : nullptr);
  Cloud cloud = cloud_of(points, config_.cloud);
  Work work = 0;
  bool sure = true;
  std::optional<Tracked> seen;
  double contradiction = 0.0;

  if (frames_.empty()) {
    add_frame(reference, std::move(cloud), points, TPose2D(), {});
    map_.lay_raster(frames_);
    tracker_.redraw(frames_, here_, &work);
  } else {
    const TPose2D T_frame_last = T_frame_base_;
    Tracked tracked = tracker_.track(frames_, cloud, motion, T_frame_last, &work);
    const bool contradicted =
        !tracked.held && tracked.odometry_chi2 > config_.tracker.slip_chi2 && tracked.fit.inliers >= kBelieved;
    if (motion.doubt >= 1.0 || contradicted) {
      // The sweep was straightened by a motion that was wrong; now a better one is known.
      if (const auto found = sweep_at(scan, tracked.fit.pose - T_frame_last, motion.time)) {
        sweep = found;
        points = level_scan_.points(scan, &*sweep, tilt ? &*tilt : nullptr);
        cloud = cloud_of(points, config_.cloud);
        ExpectedMotion better = motion;
        better.carried = tracked.fit.pose - T_frame_last;
        better.doubt = 1.0;
        better.again = true;
        tracked = tracker_.track(frames_, cloud, better, T_frame_last, &work);
      }
    }
    doubt_ = contradicted ? 1.0 : doubt_ < kNoDoubt ? 0.0 : kForgiving * doubt_;
    sure = may_be_mapped(tracked, motion.doubt, reference);
    T_frame_base_ = tracked.fit.pose;
    matched_since_frame_ = matched_since_frame_ || tracked.found;
    last_step_ = T_frame_base_ - T_frame_last;
    last_step_time_ = motion.time;
    seen = tracked;
    slips_ += tracked.slipped ? 1 : 0;
    relocated_ += tracked.relocated ? 1 : 0;
    unseen_ += tracked.found ? 0 : 1;
    unfit_ += tracked.fit.inliers < config_.tracker.lost_inliers ? 1 : 0;
    if (!grows_) contradiction = contradiction_of(cloud);
    const GraphEdge edge = edge_to_now(tracked);
    scan_covariance_ = edge.information.inverse();
    if (sure && asks_for_frame(tracked) && !hang_on_old_frame(cloud, &work) && grows_) {
      add_frame(reference, std::move(cloud), points, now(), edge);
      if (config_.loops) closer_.look(&work);
      tracker_.redraw(frames_, here_, &work);
    }
  }
  if (!odometry_.empty()) T_odom_scan_ = odometry_.pose_at(reference);
  scans_.push_back({reference, here_, T_frame_base_});
  silent_at_scan_.reset();

  // What waits is done bit by bit, the more of it the faster.
  const auto most = static_cast<Work>(config_.budget_ms * 1e6);
  const Work usual = most / kUsualShare;
  const auto waiting = static_cast<Work>(closer_.queued());
  Work budget = std::max(kLeastBudget, std::min(most, usual + usual * waiting / kHurry) - work);
  const Work given = budget;
  if (config_.loops && grows_) close_loops(budget);
  if (sure && grows_) put_into_map(scan, sweep, tilt, budget);
  map_.work(frames_, budget);
  last_work_ = work + given - budget;
  all_work_ += last_work_;
  most_work_ = std::max(most_work_, last_work_);
  live_.push_back({reference, now()});
  remember_hits(points);
  record(reference, scan, points, seen ? &*seen : nullptr, contradiction);
}

/// Of now(). A robot that strayed may be anywhere in the window in which it is looked for.
Eigen::Matrix3d RobustMapper::Impl::pose_covariance() const {
  const TPose2D& frame = frames_.pose(here_);
  const Eigen::Matrix3d J = lever(frame, now());
  Eigen::Matrix3d covariance = J * frame_covariance_ * J.transpose() + turned(scan_covariance_, frame.phi);
  if (closer_.astray()) {
    const double sigma = config_.loop.astray_window / std::sqrt(3.0);
    covariance.diagonal() += Eigen::Vector3d(sigma * sigma, sigma * sigma, 0.0);
  }
  return covariance;
}

/// Two places on top of each other, or a drive of which the scans did not follow one another.
bool RobustMapper::Impl::is_map_doubted() const {
  const auto share = [](auto count, std::size_t all) { return static_cast<double>(count) / static_cast<double>(all); };
  return (doubled_ >= kDoubtedFrames && share(doubled_, static_cast<std::size_t>(frames_.size())) >= kDoubtedShare) ||
         (!scans_.empty() && share(unfit_, scans_.size()) >= kDoubtedUnfit);
}

void RobustMapper::Impl::record(Stamp reference, const LaserScan& scan, const ScanPoints& points,
                                const Tracked* tracked, double contradiction) {
  const auto returns = std::count_if(scan.ranges.begin(), scan.ranges.end(), [&](float range) {
    return std::isfinite(range) && range > 0.0F && static_cast<double>(range) >= scan.range_min;
  });
  const LoopCounts& loops = closer_.counts();
  const Eigen::Matrix3d covariance = pose_covariance();
  records_.stamps.push_back(reference);
  for (const double value : {tracked != nullptr ? tracked->fit.inliers : 1.0,
                             contradiction,
                             tracked != nullptr ? tracked->fit.residual : 0.0,
                             tracked != nullptr ? static_cast<double>(tracked->fit.paired) : 0.0,
                             tracked != nullptr ? tracked->odometry_chi2 : 0.0,
                             tracked != nullptr && tracked->slipped ? 1.0 : 0.0,
                             tracked != nullptr && tracked->lost ? 1.0 : 0.0,
                             tracked != nullptr && tracked->held ? 1.0 : 0.0,
                             static_cast<double>(returns),
                             static_cast<double>(returns) - static_cast<double>(points.hits.size()),
                             static_cast<double>(last_work_) * 1e-6,
                             std::sqrt(covariance(0, 0)),
                             std::sqrt(covariance(1, 1)),
                             rad_to_deg(std::sqrt(covariance(2, 2))),
                             static_cast<double>(frames_.size()),
                             static_cast<double>(loops.searched),
                             static_cast<double>(loops.ambiguous),
                             static_cast<double>(loops.contradicted),
                             static_cast<double>(loops.needless),
                             static_cast<double>(loops.closed),
                             static_cast<double>(loops.near_edges),
                             static_cast<double>(loops.removed)})
    records_.values.push_back(static_cast<float>(value));
}

/// What odometry says; how the motion would go on where that cannot be true or nothing was reported.
ExpectedMotion RobustMapper::Impl::expected_motion(const LaserScan& scan) {
  const Stamp reference = scan.middle();
  const Stamp last = scans_.back().stamp;
  ExpectedMotion motion;
  motion.T_last_now = motion_since_scan(reference);
  motion.time = reference - last;
  motion.carried = carried(motion.time);
  motion.doubt = doubt_;
  if (motion.time < kNoDuration) return motion;
  const double path = length(motion.T_last_now.x, motion.T_last_now.y);
  const double turn = std::abs(wrap_angle(motion.T_last_now.phi));
  // Stamps that come bunched do not mean that the scanner was faster than it is.
  const double time = std::max(motion.time, scan_period_);
  const bool jumped = (path > kLeastJump && path > kFastest * time) ||
                      (turn > kLeastJump && turn > kFastestTurn * time) || jumps_within(scan);
  const bool silent_then = silent_at_scan_ ? *silent_at_scan_ : odometry_.silent_at(last);
  const bool silent = T_odom_scan_ && (silent_then || odometry_.silent_at(reference));
  odometry_jumps_ += jumped ? 1 : 0;
  silent_ += silent ? 1 : 0;
  motion.told = T_odom_scan_ && !jumped && !silent;
  if (jumped || silent) motion.doubt = 1.0;
  if (jumped) motion.T_last_now = motion.carried.value_or(TPose2D());
  return motion;
}

/// A jump between two reports shows sooner within a sweep that lies between them, and its time is the scanner's own.
bool RobustMapper::Impl::jumps_within(const LaserScan& scan) const {
  const std::optional<SweepMotion> sweep = sweep_motion(odometry_, scan);
  if (!sweep) return false;
  const double time = std::abs(scan.beam_stamp(scan.ranges.size() - 1) - scan.stamp);
  const TPose2D motion = sweep->T_ref_last - sweep->T_ref_first;
  return length(motion.x, motion.y) > 0.05 + kFastestSweep * time ||
         std::abs(wrap_angle(motion.phi)) > 0.05 + kFastestSweepTurn * time;
}

/// As the last two scans were apart, for `time`.
std::optional<TPose2D> RobustMapper::Impl::carried(double time) const {
  if (last_step_time_ < kNoDuration || time < kNoDuration || std::max(time, last_step_time_) > kLongestCarry)
    return std::nullopt;
  const double share = time / last_step_time_;
  return TPose2D{share * last_step_.x, share * last_step_.y, share * wrap_angle(last_step_.phi)};
}

/// How the base moved during a sweep if it moved by `motion` in `time`.
std::optional<SweepMotion> RobustMapper::Impl::sweep_at(const LaserScan& scan, const TPose2D& motion,
                                                        double time) const {
  if (scan.beam_period == 0.0 || time < kNoDuration || time > kLongestCarry) return sweep_motion(odometry_, scan);
  const Stamp reference = scan.middle();
  const auto part = [&](Stamp stamp) {
    const double share = (stamp - reference) / time;
    return TPose2D{share * motion.x, share * motion.y, share * wrap_angle(motion.phi)};
  };
  return SweepMotion{part(scan.stamp), part(scan.beam_stamp(scan.ranges.size() - 1))};
}

/// A scan that may lie anywhere spoils the map: it waits until the place is known again, but not for ever.
bool RobustMapper::Impl::may_be_mapped(const Tracked& tracked, double doubt, Stamp reference) {
  if (tracked.lost) {
    ++lost_;
    lost_on_the_way_ = true;
    if (lost_since_ == Stamp::never()) lost_since_ = reference;
  } else if (tracked.fit.inliers >= kNotLost) {
    lost_since_ = Stamp::never();
  }
  if (lost_since_ != Stamp::never() && reference - lost_since_ > kLongestLost && doubt < 1.0)
    lost_since_ = Stamp::never();
  return lost_since_ == Stamp::never() && !tracked.held && (doubt < 1.0 || tracked.fit.inliers >= kNotLost);
}

bool RobustMapper::Impl::asks_for_frame(const Tracked& tracked) const {
  const double path = length(T_frame_base_.x, T_frame_base_.y);
  const double turn = std::abs(wrap_angle(T_frame_base_.phi));
  if (path > config_.frame_distance || turn > config_.frame_turn) return true;
  return tracked.fit.inliers < config_.frame_overlap && (path > 0.1 || turn > 0.08);
}

/// Known ground adds no key frame once there are many: the robot then hangs on an old one, and the graph grows with the
/// ground covered instead of the time driven.
bool RobustMapper::Impl::hang_on_old_frame(const Cloud& cloud, Work* work) {
  const std::optional<int> old = old_frame_here(work);
  if (!old) return false;
  const TPose2D expected = now() - frames_.pose(*old);
  if (!grows_ && *old == here_) return true;
  redraw(*old, work);
  ExpectedMotion at_rest;
  at_rest.time = kNoDuration;
  const Tracked there = tracker_.track(frames_, cloud, at_rest, expected, work);
  const TPose2D moved = there.fit.pose - expected;
  if (!there.found || there.fit.inliers < kKnownInliers || length(moved.x, moved.y) > kKnownMoves) {
    redraw(here_, work);
    return false;
  }
  path_here_ += length(T_frame_base_.x, T_frame_base_.y);
  here_ = *old;
  T_frame_base_ = there.fit.pose;
  T_matched_frame_.reset();
  scan_covariance_ = edge_to_now(there).information.inverse();
  ++reused_;
  return true;
}

/// Where nothing but the pose decides: closest, and looking the same way.
int RobustMapper::Impl::closest_frame(const TPose2D& T_map_base) const {
  int closest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j < frames_.size(); ++j) {
    const TPose2D& old = frames_.pose(j);
    const double off = length(T_map_base.x - old.x, T_map_base.y - old.y) +
                       kTurnWeight * std::abs(wrap_angle(T_map_base.phi - old.phi));
    if (off >= least) continue;
    least = off;
    closest = j;
  }
  return closest;
}

/// What the closest key frames say of a scan where the robot is thought to be.
double RobustMapper::Impl::contradiction_of(const Cloud& cloud) const {
  std::vector<int> close = frames_around(here_);
  close.resize(std::min(close.size(), kScanWitnesses));
  return frames_.agreement(cloud.points, T_frame_base_, frames_.pose(here_), close).contradiction();
}

/// All that lie close to a key frame, it first; the graph of a map that stays as it is can be trusted for them.
std::vector<int> RobustMapper::Impl::frames_around(int here) const {
  std::vector<std::pair<double, int>> close;
  for (int j = 0; j < frames_.size(); ++j) {
    const double away = length(frames_.pose(j).x - frames_.pose(here).x, frames_.pose(j).y - frames_.pose(here).y);
    if (away <= 0.5 * config_.tracker.path) close.emplace_back(j == here ? -1.0 : away, j);
  }
  std::sort(close.begin(), close.end());
  if (close.size() > static_cast<std::size_t>(config_.tracker.frames))
    close.resize(static_cast<std::size_t>(config_.tracker.frames));
  std::vector<int> frames;
  for (const auto& [away, j] : close) frames.push_back(j);
  return frames;
}

void RobustMapper::Impl::redraw(int here, Work* work) {
  if (grows_)
    tracker_.redraw(frames_, here, work);
  else
    tracker_.redraw(frames_, frames_around(here), work);
}

/// The closest key frame of an earlier visit that loops tie to where the robot is.
std::optional<int> RobustMapper::Impl::old_frame_here(Work* work) const {
  if (!grows_) return closest_frame(now());
  if (!config_.loops || frames_.size() < config_.exact_frames || lost_on_the_way_) return std::nullopt;
  const TPose2D T_map_base = now();
  const double path = path_here_ + length(T_frame_base_.x, T_frame_base_.y);
  std::vector<int> close;
  std::vector<double> off;
  for (int j = 0; j < frames_.size(); ++j) {
    if (path - frames_[j].path < config_.loop.least_path) continue;
    const TPose2D& old = frames_.pose(j);
    const double distance = length(T_map_base.x - old.x, T_map_base.y - old.y);
    const double turn = std::abs(wrap_angle(T_map_base.phi - old.phi));
    if (distance > kKnownDistance || turn > kKnownTurn) continue;
    close.push_back(j);
    off.push_back(distance + turn);
  }
  if (close.empty()) return std::nullopt;
  const std::vector<double> paths = frames_.paths_from(here_, close, kKnownPath, work);
  std::optional<int> old;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < close.size(); ++k) {
    if (!(paths[k] <= kKnownPath) || off[k] >= least) continue;
    least = off[k];
    old = close[k];
  }
  return old;
}

/// The key frame's edge to where the robot is now: what the scan says, and what odometry says at least.
GraphEdge RobustMapper::Impl::edge_to_now(const Tracked& tracked) const {
  const double path = length(T_frame_base_.x, T_frame_base_.y);
  const double turn = std::abs(wrap_angle(T_frame_base_.phi));
  const double distance = lost_on_the_way_ ? kLostDistance : 0.01 + 0.1 * path;
  const double angle = lost_on_the_way_ ? kLostAngle : 0.01 + 0.1 * turn + 0.03 * path;
  const Eigen::Matrix3d odometry =
      Eigen::Vector3d(1.0 / (distance * distance), 1.0 / (distance * distance), 1.0 / (angle * angle)).asDiagonal();
  Eigen::Matrix3d information = odometry;
  if (tracked.found) information += tracked.fit.information;
  const Eigen::Matrix3d floor =
      Eigen::Vector3d(kEdgeDistance * kEdgeDistance, kEdgeDistance * kEdgeDistance, kEdgeAngle * kEdgeAngle)
          .asDiagonal();
  GraphEdge edge;
  edge.from = here_;
  edge.to = frames_.last() + 1;
  edge.T_from_to = T_matched_frame_ && matched_since_frame_ ? *T_matched_frame_ + T_frame_base_ : T_frame_base_;
  edge.information = (information.inverse() + floor).inverse();
  return edge;
}

void RobustMapper::Impl::add_frame(Stamp reference, Cloud cloud, const ScanPoints& points, const TPose2D& T_map_base,
                                   const GraphEdge& edge) {
  KeyFrame frame;
  frame.stamp = reference;
  frame.cloud = std::move(cloud);
  frame.cloud.ends = {};
  frame.cloud.sight = sight_of(points);
  if (config_.wall_compass) frame.walls = wall_direction(frame.cloud);
  if (!frames_.empty()) {
    path_here_ += length(T_frame_base_.x, T_frame_base_.y);
    frame.path = path_here_;
    const TPose2D& from = frames_.pose(here_);
    const Eigen::Matrix3d J = lever(from, T_map_base);
    frame_covariance_ = J * frame_covariance_ * J.transpose() + turned(scan_covariance_, from.phi);
    compass_.go_on(J);
  }
  const Eigen::Vector3d off = compass_.look(T_map_base.phi, frame.walls, frame_covariance_);
  const TPose2D T_map_frame(T_map_base.x + off[0], T_map_base.y + off[1], wrap_angle(T_map_base.phi + off[2]));
  T_matched_frame_.reset();
  if (!off.isZero(0.0)) T_matched_frame_ = T_map_frame - T_map_base;
  matched_since_frame_ = false;
  frames_.add(std::move(frame), T_map_frame, edge);
  if (compass_.doubted()) compass_.set_right(frames_.graph());
  lay_walls();
  here_ = frames_.last();
  T_frame_base_ = TPose2D();
  lost_on_the_way_ = false;
  scan_covariance_.setZero();
}

void RobustMapper::Impl::close_loops(Work& budget) {
  if (!closer_.work(budget)) return;
  ++revision_;
  frame_covariance_ = closer_.covariance();
  if (here_ <= closer_.solved()) T_matched_frame_.reset();
  set_compass_right();
  map_.moved();
  Work used = 0;
  tracker_.redraw(frames_, here_, &used);
  budget -= used;
}

/// The graph takes what the compass knows.
void RobustMapper::Impl::lay_walls() {
  if (compass_.direction()) frames_.set_walls(*compass_.direction(), compass_.variance());
}

/// After poses were corrected.
void RobustMapper::Impl::set_compass_right() {
  if (!config_.wall_compass) return;
  compass_.set_right(frames_.graph());
  lay_walls();
}

void RobustMapper::Impl::put_into_map(const LaserScan& scan, const std::optional<SweepMotion>& sweep,
                                      const std::optional<ScanTilt>& tilt, Work& budget) {
  const TPose2D moved = now() - T_map_stamped_;
  const bool gate =
      length(moved.x, moved.y) >= config_.map_distance || std::abs(wrap_angle(moved.phi)) >= config_.map_turn;
  if (!gate && counts_.mapped >= static_cast<std::uint64_t>(config_.first_scans)) return;
  Work used = 0;
  map_.add(frames_, here_, T_frame_base_, packed(with_trusted_misses(scan, config_.misses), sweep, tilt), &used);
  budget -= used;
  T_map_stamped_ = now();
  ++counts_.mapped;
}

void RobustMapper::Impl::remember_hits(const ScanPoints& points) {
  const PlanarTransform to_map(now());
  last_hits_.clear();
  for (const TPoint2D& p_base : points.hits) last_hits_.push_back(to_map(p_base));
}

TPose2D RobustMapper::Impl::motion_since_scan(Stamp reference) const {
  return T_odom_scan_ ? odometry_.pose_at(reference) - *T_odom_scan_ : TPose2D();
}

void RobustMapper::Impl::go_on_in(KeyFrames frames, StampedMap map, const TPose2D& T_map_drive, bool grows) {
  const int shift = frames.size() - frames_.size();
  const TPose2D T_map_base = T_map_drive + now();
  const std::vector<StampedMap::Entry> stamped = map_.entries();
  const double path = grows && frames_.size() > 0 ? frames[shift].path - frames_[0].path : 0.0;
  std::vector<TPose2D> poses;
  for (std::size_t k = 0; k < scans_.size(); ++k) poses.push_back(T_map_drive + pose_of(k));
  frame_covariance_ = turned(frame_covariance_, T_map_drive.phi);
  frames_ = std::move(frames);
  map_ = std::move(map);
  grows_ = grows;
  if (grows) {
    here_ += shift;
    path_here_ += path;
    for (Place& place : scans_) place.frame += shift;
    for (const StampedMap::Entry& entry : stamped)
      map_.add(frames_, entry.frame + shift, entry.T_frame_base, entry.scan, nullptr);
  } else {
    here_ = closest_frame(T_map_base);
    T_frame_base_ = T_map_base - frames_.pose(here_);
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      scans_[k].frame = here_;
      scans_[k].T_frame_base = poses[k] - frames_.pose(here_);
    }
  }
  closer_.begin_anew();
  if (!grows) T_matched_frame_.reset();
  compass_ = WallCompass();  // what it knew was of the drive's frame
  set_compass_right();
  redraw(here_, nullptr);
  T_map_stamped_ = now();
  last_hits_.clear();
  ++revision_;
}

const Trajectory& RobustMapper::Impl::trajectory() const {
  if (trajectory_revision_ != revision_) trajectory_.clear();
  trajectory_revision_ = revision_;
  while (trajectory_.size() < scans_.size())
    trajectory_.push_back({scans_[trajectory_.size()].stamp, pose_of(trajectory_.size())});
  return trajectory_;
}

std::optional<TPose2D> RobustMapper::Impl::pose_at(Stamp stamp) const {
  if (scans_.empty() || stamp < scans_.front().stamp) return std::nullopt;
  const auto after = std::lower_bound(scans_.begin(), scans_.end(), stamp,
                                      [](const Place& place, Stamp s) { return place.stamp < s; });
  if (after == scans_.end()) {
    if (!T_odom_scan_ || stamp > odometry_.newest()) return std::nullopt;
    return now() + motion_since_scan(stamp);
  }
  const auto index = static_cast<std::size_t>(after - scans_.begin());
  if (after->stamp == stamp) return pose_of(index);
  const Place& before = scans_[index - 1];
  return interpolate(pose_of(index - 1), pose_of(index), (stamp - before.stamp) / (after->stamp - before.stamp));
}

RobustMapper::RobustMapper(const robot::RobotModel& model, const RobustConfig& config, std::uint64_t)
    : impl_(std::make_unique<Impl>(model, suited_to(model.laser, config))) {}
RobustMapper::~RobustMapper() = default;

void RobustMapper::update(const robot::Inputs& inputs) { impl_->receive(inputs); }

void RobustMapper::finish() {
  if (impl_->frames_.empty()) return;
  if (impl_->config_.loops && impl_->grows_) {
    impl_->closer_.finish();
    ++impl_->revision_;
    impl_->frame_covariance_ = impl_->closer_.covariance();
    impl_->doubled_ = impl_->closer_.doubled().size();
  }
  impl_->map_.set_right(impl_->frames_);
  impl_->map_.lay_raster(impl_->frames_);
  if (impl_->config_.thin_walls) impl_->map_.thin();
  impl_->tracker_.redraw(impl_->frames_, impl_->here_, nullptr);
}

const CountMap& RobustMapper::map() const { return impl_->map_.map(); }

TPose2D RobustMapper::pose() const {
  if (impl_->frames_.empty()) return {};
  return impl_->now() + impl_->motion_since_scan(impl_->odometry_.newest());
}

PoseCovariance RobustMapper::covariance() const {
  if (impl_->frames_.empty()) return {};
  return PoseCovariance(impl_->pose_covariance());
}

std::uint64_t RobustMapper::revision() const { return impl_->revision_; }
std::optional<TPose2D> RobustMapper::pose_at(Stamp stamp) const { return impl_->pose_at(stamp); }
const Trajectory& RobustMapper::trajectory() const { return impl_->trajectory(); }
const Trajectory& RobustMapper::live_trajectory() const { return impl_->live_; }
const std::vector<TPoint2D>& RobustMapper::last_hits() const { return impl_->last_hits_; }
const MapperCounts& RobustMapper::counts() const { return impl_->counts_; }

const ScanRecords* RobustMapper::scan_records() const { return &impl_->records_; }
const KeyFrames& RobustMapper::key_frames() const { return impl_->frames_; }
std::string RobustMapper::saved_map() const { return impl_->frames_.empty() ? std::string() : encode_map(saved()); }

void RobustMapper::go_on_in(KeyFrames frames, StampedMap map, const TPose2D& T_map_drive, bool grows) {
  impl_->go_on_in(std::move(frames), std::move(map), T_map_drive, grows);
}

SavedMap RobustMapper::saved() const {
  SavedMap map;
  map.T_base_laser = impl_->T_base_laser_;
  map.frames = impl_->frames_;
  for (const StampedMap::Entry& entry : impl_->map_.entries())
    map.scans.push_back({entry.frame, entry.T_frame_base, entry.scan});
  map.here = impl_->here_;
  map.T_frame_base = impl_->T_frame_base_;
  map.path = impl_->path_here_;
  map.frame_covariance = impl_->frame_covariance_;
  map.scan_covariance = impl_->scan_covariance_;
  return map;
}

std::vector<MapperFigure> RobustMapper::figures() const {
  const LoopCounts& loops = impl_->closer_.counts();
  return {{"key_frames", static_cast<double>(impl_->frames_.size())},
          {"frames_reused", static_cast<double>(impl_->reused_)},
          {"slips", static_cast<double>(impl_->slips_)},
          {"relocated", static_cast<double>(impl_->relocated_)},
          {"unseen", static_cast<double>(impl_->unseen_)},
          {"odometry_silent", static_cast<double>(impl_->silent_)},
          {"lost", static_cast<double>(impl_->lost_)},
          {"odometry_jumps", static_cast<double>(impl_->odometry_jumps_)},
          {"loops_searched", static_cast<double>(loops.searched)},
          {"loops_ambiguous", static_cast<double>(loops.ambiguous)},
          {"loops_contradicted", static_cast<double>(loops.contradicted)},
          {"loops_needless", static_cast<double>(loops.needless)},
          {MapperFigure::kLoopsClosed, static_cast<double>(loops.closed)},
          {MapperFigure::kLoopsRemoved, static_cast<double>(loops.removed)},
          {"near_edges", static_cast<double>(loops.near_edges)},
          {"frames_astray", static_cast<double>(loops.astray)},
          {"frames_doubled", static_cast<double>(impl_->doubled_)},
          {"scans_unfit", static_cast<double>(impl_->unfit_)},
          {"map_doubted", impl_->is_map_doubted() ? 1.0 : 0.0},
          {"graph_solved", static_cast<double>(loops.solved)},
          {"last_work_ms", static_cast<double>(impl_->last_work_) * 1e-6},
          {"work_ms", static_cast<double>(impl_->all_work_) * 1e-6},
          {"most_work_ms", static_cast<double>(impl_->most_work_) * 1e-6}};
}

}  // namespace rubble::slam
