#include "slam/peers/mrpt_mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr int kCounts = 100;            ///< a cell of MRPT's grid becomes so many counts
constexpr int kMostCells = 8000;        ///< of the map a side, as the other mappers
constexpr double kNothingKnown = 0.01;  ///< p_occ this close to one half was never observed

}  // namespace

MrptMapper::MrptMapper(const robot::RobotModel& model, double resolution, std::unique_ptr<MapBuilder> builder)
    : model_(model), builder_(std::move(builder)), level_scan_(model.T_base_laser, {}), map_(2, 2, resolution) {}

void MrptMapper::update(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) odometry_.add(odometry);
  for (const robot::LaserScan& scan : inputs.scans) {
    ++counts_.scans;
    if (!waiting_.add(scan)) ++counts_.out_of_order;
  }
  while (waiting_.ready(odometry_, inputs.now)) take(waiting_.take());
  if (!odometry_.empty()) odometry_.forget_before(waiting_.oldest_needed(odometry_));
}

void MrptMapper::take(const robot::LaserScan& scan) {
  const Stamp reference = scan.middle();
  const TPose2D T_odom_base = odometry_.pose_at(reference);
  const TPose2D step = T_odom_scan_ ? T_odom_base - *T_odom_scan_ : TPose2D();
  T_odom_scan_ = T_odom_base;

  const std::optional<SweepMotion> sweep = sweep_motion(odometry_, scan);
  const ScanPoints points = level_scan_.points(scan, sweep ? &*sweep : nullptr);
  builder_->process(step, as_instant(scan, points));

  follow_path(reference, T_odom_base);
  if (builder_->inserted() != mapped_) take_grid();
  mapped_ = builder_->inserted();
  counts_.mapped = mapped_;
  covariance_ = builder_->uncertainty();
  const PlanarTransform to_map(trajectory_.back().pose);
  last_hits_.clear();
  for (const auto& p_base : points.hits) last_hits_.push_back(to_map(p_base));
}

/// The points of a sweep as beams of a scan taken all at once; of several in one beam the nearest. MRPT turns them by
/// the whole mount, so they are seen as a laser sees them that hangs from its mount upside down or inclined.
robot::LaserScan MrptMapper::as_instant(const robot::LaserScan& scan, const ScanPoints& points) const {
  robot::LaserScan instant = scan;
  instant.stamp = scan.middle();
  instant.beam_period = 0.0;
  std::fill(instant.ranges.begin(), instant.ranges.end(), std::numeric_limits<float>::quiet_NaN());
  const auto R = model_.T_base_laser.getRotationMatrix();
  const double determinant = R(0, 0) * R(1, 1) - R(0, 1) * R(1, 0);
  for (const auto& p_base : points.hits) {
    const double dx = p_base.x - points.origin.x, dy = p_base.y - points.origin.y;
    const double x = (R(1, 1) * dx - R(0, 1) * dy) / determinant, y = (R(0, 0) * dy - R(1, 0) * dx) / determinant;
    const double turned = std::fmod(std::atan2(y, x) - scan.angle_min + 4.0 * kPi, 2.0 * kPi);
    const double beam = std::round(turned / scan.angle_step);
    if (!(beam < static_cast<double>(scan.ranges.size()))) continue;
    float& range = instant.ranges[static_cast<std::size_t>(beam)];
    const auto distance = static_cast<float>(length(x, y));
    if (!(range <= distance)) range = distance;
  }
  return instant;
}

/// Between the builder's steps the odometry leads on. Where steps of the past have moved, everything on them moves.
void MrptMapper::follow_path(Stamp stamp, const TPose2D& T_odom_base) {
  const std::vector<TPose2D> now = builder_->path();
  if (now.size() != path_.size() || path_.empty()) T_odom_step_ = T_odom_base;
  bool moved = false;
  for (std::size_t i = 0; i < std::min(now.size(), path_.size()); ++i)
    moved = moved || now[i].x != path_[i].x || now[i].y != path_[i].y || now[i].phi != path_[i].phi;
  path_ = now;
  const auto step_pose = [&](const Anchor& anchor) {
    return anchor.step < path_.size() ? path_[anchor.step] + anchor.T_step_base : anchor.T_step_base;
  };
  const Anchor here{stamp, path_.empty() ? 0 : path_.size() - 1, T_odom_base - T_odom_step_};
  anchors_.push_back(here);
  live_.push_back({stamp, step_pose(here)});
  trajectory_.push_back(live_.back());
  if (!moved) return;
  ++revision_;
  for (std::size_t i = 0; i < anchors_.size(); ++i) trajectory_[i].pose = step_pose(anchors_[i]);
}

/// What MRPT's map knows: it grows by far more than it needs, and without bound where poses go astray.
void MrptMapper::take_grid() {
  const BuilderGrid from = builder_->grid();
  GridFrame whole;
  whole.width = from.width;
  whole.height = from.height;
  const auto p_occ = [&](Cell c) { return 1.0 - static_cast<double>(from.p_free[whole.index(c)]); };
  const auto known = [&](Cell c) { return std::abs(p_occ(c) - 0.5) >= kNothingKnown; };
  GridFrame frame;
  frame.resolution = map_.frame().resolution;
  const auto cells = [&](float edge) {
    return static_cast<int>(std::lround(static_cast<double>(edge) / frame.resolution));
  };
  const Cell start{std::clamp(-cells(from.x0), 0, whole.width - 1), std::clamp(-cells(from.y0), 0, whole.height - 1)};
  Cell low = start, high = start;
  for (int y = std::max(0, start.y - kMostCells / 2); y < std::min(whole.height, start.y + kMostCells / 2); ++y)
    for (int x = std::max(0, start.x - kMostCells / 2); x < std::min(whole.width, start.x + kMostCells / 2); ++x) {
      if (!known({x, y})) continue;
      low = {std::min(low.x, x), std::min(low.y, y)};
      high = {std::max(high.x, x), std::max(high.y, y)};
    }
  frame.width = high.x - low.x + 1;
  frame.height = high.y - low.y + 1;
  frame.x0 = (cells(from.x0) + low.x) * frame.resolution;
  frame.y0 = (cells(from.y0) + low.y) * frame.resolution;
  std::vector<std::uint16_t> seen(frame.size(), 0), occupied(frame.size(), 0);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      if (!known({x, y})) continue;
      const std::size_t cell = frame.index({x - low.x, y - low.y});
      seen[cell] = kCounts;
      occupied[cell] = static_cast<std::uint16_t>(std::lround(p_occ({x, y}) * kCounts));
    }
  map_.assign(frame, std::move(seen), std::move(occupied));
}

TPose2D MrptMapper::pose() const {
  const TPose2D last = trajectory_.empty() ? TPose2D() : trajectory_.back().pose;
  return T_odom_scan_ && !odometry_.empty() ? last + (odometry_.pose_at(odometry_.newest()) - *T_odom_scan_) : last;
}

std::optional<TPose2D> MrptMapper::pose_at(Stamp stamp) const { return rubble::pose_at(trajectory_, stamp); }

}  // namespace rubble::slam
