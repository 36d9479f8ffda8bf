#include "slam/robust/robust_mapper.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/planar.h"
#include "robot/slope_creep.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/robust/graph/known_ground.h"
#include "slam/robust/graph/wall_compass.h"
#include "slam/robust/map/stamped_map.h"
#include "slam/robust/tracking/known_leans.h"
#include "slam/robust/tracking/motion_expectation.h"
#include "slam/robust/tracking/repeated_scans.h"
#include "slam/robust/tracking/scan_diary.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::LaserScan;

namespace {

constexpr double kEdgeDistance = 0.008;     ///< least error between key frames [m]
constexpr double kEdgeAngle = 0.003;        ///< [rad]
constexpr Work kLeastBudget = 300'000;      ///< for work put off, each scan
constexpr Work kUsualShare = 16;            ///< the usual budget is such a part of the largest ...
constexpr Work kHurry = 2;                  ///< ... and grows by itself with so many tasks that wait
constexpr double kLevel = deg_to_rad(5.0);  ///< of the scan plane
constexpr double kSteady = 0.01;            ///< it tilted by no more than this [rad] ...
constexpr double kSteadyFor = 0.1;          ///< ... in so long [s]
constexpr double kBelieved = 0.5;           ///< share of inliers with which a scan overrules the odometry
constexpr double kLongestLost = 3.0;        ///< then the map goes on from where the robot is thought to be [s]
constexpr double kLostDistance = 0.5;       ///< uncertainty of a robot that was lost [m]
constexpr double kLostAngle = 0.5;          ///< [rad]
constexpr double kKnownInliers = 0.65;      ///< and what is seen there is what was seen
constexpr double kKnownMoves = 0.20;        ///< [m]
constexpr double kSameSlope = 0.4;          ///< the floor slopes as where the robot was so near [m]
constexpr std::size_t kScanWitnesses = 8;   ///< key frames that are asked whether a scan can be true
constexpr std::size_t kDoubtedFrames = 8;   ///< doubled key frames of a map that is doubted, at least ...
constexpr double kDoubtedShare = 0.005;     ///< ... and of all of them; right maps have 0.0013 and less
constexpr double kDoubtedUnfit = 0.05;      ///< or such a share of scans that fit nothing mapped
constexpr double kNotLost = 0.5;  ///< share of inliers of a scan that may be mapped though the odometry is doubted

/// Derivative of a pose by the one it hangs on, in the map frame: d is the lever between the two.
Eigen::Matrix3d lever(const TPose2D& from, const TPose2D& to) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -(to.y - from.y);
  J(1, 2) = to.x - from.x;
  return J;
}

bool usable(const LaserScan& scan) {
  return has_directions(scan.angle_min, scan.angle_step, scan.ranges.size()) && std::isfinite(scan.beam_period);
}

}  // namespace

struct RobustMapper::Impl {
  Impl(const robot::RobotModel& model, const RobustConfig& config)
      : config_(config),
        T_base_laser_(model.T_base_laser),
        level_scan_(model.T_base_laser, config.scan),
        tilt_(model, config.tilt),
        creep_(model, config.tracker.wheel_friction),
        motion_(model.laser.scan_period),
        tracker_(config.tracker),
        closer_(config.loop, config.tracker.cell, frames_),
        map_(CountMap(config.map_cells, config.map_cells, config.resolution, config.max_map_cells), model.T_base_laser,
             stamping(config)) {}

  void receive(const robot::Inputs& inputs);
  bool ready(Stamp now) const;
  void process(LaserScan scan);
  std::optional<ScanTilt> tilt_of(Stamp reference, const ExpectedMotion& motion, Work* work) const;
  bool level_and_steady(const ScanTilt& tilt, Stamp reference) const;
  bool asks_for_frame(const Tracked& tracked) const;
  bool hang_on_old_frame(const Cloud& cloud, Work* work);
  std::optional<int> old_frame_here(Work* work) const;
  std::vector<int> frames_here(int here) const;
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

  const RobustConfig config_;
  const mrpt::math::TPose3D T_base_laser_;
  LevelScan level_scan_;
  TiltTrack tilt_;
  const robot::SlopeCreep creep_;
  MotionExpectation motion_;
  RepeatedScans repeated_;
  KeyFrames frames_;
  LocalTracker tracker_;
  WallCompass compass_;
  LoopCloser closer_;
  StampedMap map_;
  bool grows_ = true;  ///< false: the map is another's, and stays as it is
  ScanDiary diary_;

  WaitingScans waiting_;
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
  KnownLeans leans_;
  Trajectory live_;
  mutable Trajectory trajectory_;
  mutable std::uint64_t trajectory_revision_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<TPoint2D> last_hits_;
  MapperCounts counts_;
  Stamp lost_since_ = Stamp::never();
  bool lost_on_the_way_ = false;  ///< since the newest key frame
  std::uint64_t reused_ = 0;
  std::uint64_t slips_ = 0;
  std::uint64_t lost_ = 0;
  std::size_t doubled_ = 0;  ///< key frames, as the finished map lies
  std::uint64_t unfit_ = 0;  ///< scans that fit nothing mapped
  std::uint64_t relocated_ = 0;
  std::uint64_t unseen_ = 0;
  Work last_work_ = 0;
  Work all_work_ = 0;
  Work most_work_ = 0;
};

void RobustMapper::Impl::receive(const robot::Inputs& inputs) {
  tilt_.add(inputs);
  for (const robot::Odometry& odometry : inputs.odometry) motion_.hear(odometry, inputs.now);
  motion_.begin_late();
  for (const LaserScan& scan : inputs.scans) {
    ++counts_.scans;
    if (!usable(scan) || scan.middle() - inputs.now > kAhead || !waiting_.add(scan)) ++counts_.out_of_order;
  }
  while (ready(inputs.now)) process(waiting_.take());
  if (motion_.odometry().empty()) return;
  motion_.forget_before(waiting_.oldest_needed(motion_.odometry()));
  tilt_.forget_before(motion_.odometry().newest() - WaitingScans::kLateScan);
}

/// A scan waits for odometry, and for its tilt.
bool RobustMapper::Impl::ready(Stamp now) const {
  return waiting_.ready(motion_.odometry(), now) && (!config_.use_tilt || tilt_.ready(waiting_.front().middle(), now));
}

void RobustMapper::Impl::process(LaserScan scan) {
  const Stamp reference = scan.middle();
  ExpectedMotion motion = motion_.expect(scan);
  if (repeated_.is_repeated(scan, motion, motion_.last_step()))
    scan.ranges.assign(scan.ranges.size(), LaserScan::kUnknown);
  Work work = 0;
  std::optional<SweepMotion> sweep = config_.deskew ? motion_.sweep(scan, motion) : std::nullopt;
  const std::optional<ScanTilt> tilt = config_.use_tilt ? tilt_of(reference, motion, &work) : std::nullopt;
  if (tilt && motion.told) {
    const TPoint2D crept = creep_.expected({tilt->body_pitch, tilt->body_roll}, wrap_angle(motion.T_last_now.phi));
    motion.T_last_now.x += crept.x;
    motion.T_last_now.y += crept.y;
    motion.crept = crept;
  }
  if (config_.tracker.vain_error == 0.0) motion.in_vain = 0.0;
  motion.ramps = tilt.has_value();
  motion.level = !tilt || level_and_steady(*tilt, reference);
  ScanPoints points = level_scan_.points(scan, sweep ? &*sweep : nullptr, tilt ? &*tilt : nullptr);
  Cloud cloud = cloud_of(points, config_.cloud);
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
      if (const auto found = motion_.sweep_at(scan, tracked.fit.pose - T_frame_last, motion.time);
          found && config_.deskew) {
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
    sure = may_be_mapped(tracked, motion.doubt, reference);
    T_frame_base_ = tracked.fit.pose;
    matched_since_frame_ = matched_since_frame_ || tracked.found;
    motion_.found(T_frame_base_ - T_frame_last, motion.time, contradicted);
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
  motion_.scan_taken(reference);
  scans_.push_back({reference, here_, T_frame_base_});
  if (const auto felt = tilt_.at(reference)) leans_.add(here_, T_frame_base_, {felt->body_pitch, felt->body_roll});

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
  diary_.write({reference, scan, points.hits.size(), seen ? &*seen : nullptr, contradiction, last_work_,
                pose_covariance(), frames_.size()},
               closer_.counts());
}

/// Of a scan. Without a word from the levelling unit the scan plane stays where it was on the body, and that leans as
/// it did in this place before, else as on level floor.
std::optional<ScanTilt> RobustMapper::Impl::tilt_of(Stamp reference, const ExpectedMotion& motion, Work* work) const {
  std::optional<ScanTilt> tilt = tilt_.at(reference);
  if (tilt || !tilt_.knows_servos() || !tilt_.fell_silent(reference)) return tilt;
  Lean lean;
  if (!frames_.empty()) lean = leans_.nearest(frames_, now() + motion.T_last_now, kSameSlope, work);
  return tilt_.on_body(lean.pitch, lean.roll, reference);
}

/// A scan plane that swings through level is not: what it sees of a ramp moves.
bool RobustMapper::Impl::level_and_steady(const ScanTilt& tilt, Stamp reference) const {
  if (std::max(std::abs(tilt.pitch), std::abs(tilt.roll)) >= kLevel) return false;
  const std::optional<ScanTilt> before = tilt_.at(reference + -kSteadyFor);
  return !before || std::max(std::abs(tilt.pitch - before->pitch), std::abs(tilt.roll - before->roll)) < kSteady;
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

/// Two places on top of each other, or a drive of which the scans did not follow one another or the wheels.
bool RobustMapper::Impl::is_map_doubted() const {
  const auto share = [](auto count, std::size_t all) { return static_cast<double>(count) / static_cast<double>(all); };
  return (doubled_ >= kDoubtedFrames && share(doubled_, static_cast<std::size_t>(frames_.size())) >= kDoubtedShare) ||
         (!scans_.empty() && share(unfit_, scans_.size()) >= kDoubtedUnfit) || motion_.turns_against();
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

/// On a map that stays as it is.
std::vector<int> RobustMapper::Impl::frames_here(int here) const {
  return frames_around(frames_, here, 0.5 * config_.tracker.path, config_.tracker.frames);
}

/// What the closest key frames say of a scan where the robot is thought to be.
double RobustMapper::Impl::contradiction_of(const Cloud& cloud) const {
  std::vector<int> close = frames_here(here_);
  close.resize(std::min(close.size(), kScanWitnesses));
  return frames_.agreement(cloud.points, T_frame_base_, frames_.pose(here_), close).contradiction();
}

void RobustMapper::Impl::redraw(int here, Work* work) {
  if (grows_)
    tracker_.redraw(frames_, here, work);
  else
    tracker_.redraw(frames_, frames_here(here), work);
}

/// The key frame of an earlier visit that the robot can hang on.
std::optional<int> RobustMapper::Impl::old_frame_here(Work* work) const {
  if (!grows_) return closest_frame(frames_, now());
  if (!config_.loops || frames_.size() < config_.exact_frames || lost_on_the_way_) return std::nullopt;
  const double path = path_here_ + length(T_frame_base_.x, T_frame_base_.y);
  return frame_of_earlier_visit(frames_, now(), here_, path, config_.loop.least_path, work);
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

void RobustMapper::Impl::go_on_in(KeyFrames frames, StampedMap map, const TPose2D& T_map_drive, bool grows) {
  const int shift = frames.size() - frames_.size();
  const TPose2D T_map_base = T_map_drive + now();
  const std::vector<StampedMap::Entry> stamped = map_.entries();
  const double path = grows && frames_.size() > 0 ? frames[shift].path - frames_[0].path : 0.0;
  std::vector<TPose2D> poses;
  for (std::size_t k = 0; k < scans_.size(); ++k) poses.push_back(T_map_drive + pose_of(k));
  frame_covariance_ = turned(frame_covariance_, T_map_drive.phi);
  if (grows)
    leans_.shift(shift);
  else
    leans_ = leans_.on(frames, frames_, T_map_drive);
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
    here_ = closest_frame(frames_, T_map_base);
    T_frame_base_ = T_map_base - frames_.pose(here_);
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      scans_[k].frame = here_;
      scans_[k].T_frame_base = poses[k] - frames_.pose(here_);
    }
  }
  closer_.begin_anew(grows ? std::optional(shift) : std::nullopt);
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
    if (!motion_.hears_odometry() || stamp > motion_.odometry().newest()) return std::nullopt;
    return now() + motion_.believed_since_scan(stamp);
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
  if (impl_->config_.drop_gone) impl_->map_.drop_gone();
  if (impl_->config_.thin_walls) impl_->map_.thin();
  impl_->tracker_.redraw(impl_->frames_, impl_->here_, nullptr);
}

const CountMap& RobustMapper::map() const { return impl_->map_.map(); }

TPose2D RobustMapper::pose() const {
  if (impl_->frames_.empty()) return {};
  return impl_->now() + impl_->motion_.believed_since_scan(impl_->motion_.odometry().newest());
}

PoseCovariance RobustMapper::covariance() const {
  if (impl_->frames_.empty()) return {};
  return PoseCovariance(impl_->pose_covariance());
}

std::uint64_t RobustMapper::revision() const { return impl_->revision_; }
bool RobustMapper::settled() const { return impl_->map_.settled(); }
std::optional<TPose2D> RobustMapper::pose_at(Stamp stamp) const { return impl_->pose_at(stamp); }
const Trajectory& RobustMapper::trajectory() const { return impl_->trajectory(); }
const Trajectory& RobustMapper::live_trajectory() const { return impl_->live_; }
const std::vector<TPoint2D>& RobustMapper::last_hits() const { return impl_->last_hits_; }
double RobustMapper::blind_way() const { return impl_->tracker_.blind_way(); }
const MapperCounts& RobustMapper::counts() const { return impl_->counts_; }

const ScanRecords* RobustMapper::scan_records() const { return &impl_->diary_.records(); }
std::string RobustMapper::loop_table(const StampName& name) const { return csv_of(impl_->closer_.records(), name); }
std::vector<FoundLoop> RobustMapper::found_loops() const {
  std::vector<FoundLoop> found;
  for (const LoopRecord& record : impl_->closer_.records())
    found.push_back({record.old_stamp, record.stamp, record.T_old_new,
                     record.old_frame < 0 ? std::nullopt : std::optional(impl_->frames_.pose(record.old_frame)),
                     name_of(record.end), record.inliers, record.contradiction, record.expected_contradiction});
  return found;
}
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
          {"odometry_silent", static_cast<double>(impl_->motion_.silent())},
          {"scans_repeated", static_cast<double>(impl_->repeated_.count())},
          {"lost", static_cast<double>(impl_->lost_)},
          {"odometry_jumps", static_cast<double>(impl_->motion_.jumps())},
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
          {MapperFigure::kTurnsAgainst, impl_->motion_.turns_against() ? 1.0 : 0.0},
          {MapperFigure::kMapDoubted, impl_->is_map_doubted() ? 1.0 : 0.0},
          {"graph_solved", static_cast<double>(loops.solved)},
          {"last_work_ms", static_cast<double>(impl_->last_work_) * 1e-6},
          {"work_ms", static_cast<double>(impl_->all_work_) * 1e-6},
          {MapperFigure::kMostWork, static_cast<double>(impl_->most_work_) * 1e-6}};
}

}  // namespace rubble::slam
