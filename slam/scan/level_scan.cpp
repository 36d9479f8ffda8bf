#include "slam/scan/level_scan.h"

#include <algorithm>
#include <cmath>

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

const double kFallsLittle = std::sin(deg_to_rad(1.5));     ///< of a beam, as servos leave it [m/m] ...
const double kFallsAsOnRamps = std::sin(deg_to_rad(3.0));  ///< ... and as on ramps
constexpr double kMostOfHeight = 2.0 / 3.0;  ///< of a laser near the ground, so that what it sees ahead stays

/// Where the base is as the beams of a sweep leave, linear in time. The heading goes on beam by beam as a product of
/// rotations, which spares a sine and a cosine a beam; after 10,000 beams it is off by less than 1e-11 rad.
class SweepingBase {
 public:
  SweepingBase(const SweepMotion& motion, std::size_t beams)
      : T_ref_first_(motion.T_ref_first),
        step_{motion.T_ref_last.x - T_ref_first_.x, motion.T_ref_last.y - T_ref_first_.y},
        cosine_(std::cos(T_ref_first_.phi)),
        sine_(std::sin(T_ref_first_.phi)) {
    const double steps = static_cast<double>(std::max<std::size_t>(1, beams - 1));
    const double turn = wrap_angle(motion.T_ref_last.phi - T_ref_first_.phi) / steps;
    step_ = {step_.x / steps, step_.y / steps};
    step_cosine_ = std::cos(turn);
    step_sine_ = std::sin(turn);
  }

  /// Goes on to `beam`, which must not lie before the last one asked for.
  SweepingBase& to(std::size_t beam) {
    for (; beam_ < beam; ++beam_) {
      const double cosine = cosine_ * step_cosine_ - sine_ * step_sine_;
      sine_ = sine_ * step_cosine_ + cosine_ * step_sine_;
      cosine_ = cosine;
    }
    return *this;
  }

  /// A point in the base frame at the beam, seen from the base at the reference time.
  TPoint2D operator()(const TPoint2D& p) const {
    const double u = static_cast<double>(beam_);
    return {T_ref_first_.x + u * step_.x + cosine_ * p.x - sine_ * p.y,
            T_ref_first_.y + u * step_.y + sine_ * p.x + cosine_ * p.y};
  }

 private:
  TPose2D T_ref_first_;
  TPoint2D step_;
  double cosine_;
  double sine_;
  double step_cosine_ = 1.0;
  double step_sine_ = 0.0;
  std::size_t beam_ = 0;
};

/// Projects directions of the level plane that is held inclined to the ground.
class TiltedPlane {
 public:
  explicit TiltedPlane(const ScanTilt& tilt)
      : sp_(std::sin(tilt.pitch)), cp_(std::cos(tilt.pitch)), sr_(std::sin(tilt.roll)), cr_(std::cos(tilt.roll)) {}

  double x(double c, double s) const { return c * cp_ - s * sp_ * sr_; }
  double y(double s) const { return s * cr_; }
  /// Climb per metre of range.
  double climb(double c, double s) const { return c * sp_ + s * cp_ * sr_; }

 private:
  double sp_, cp_, sr_, cr_;
};

/// Where an inclined body holds a point that it holds at `p` and `height` when level.
TPoint2D leaning(const TPoint2D& p, double height, const ScanTilt& tilt) {
  return {p.x * std::cos(tilt.body_pitch) - height * std::sin(tilt.body_pitch),
          p.y - height * std::sin(tilt.body_roll)};
}

}  // namespace

LevelScan::LevelScan(const mrpt::math::TPose3D& T_base_laser, const LevelScanConfig& config)
    : config_(config), p_base_laser_(T_base_laser.x, T_base_laser.y), laser_height_(T_base_laser.z) {
  const auto R = T_base_laser.getRotationMatrix();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) m_[i][j] = R(i, j);
  }
  config_.ramp_margin =
      std::max(config_.floor_margin, std::min(config_.ramp_margin, kMostOfHeight * std::max(0.0, laser_height_)));
  upside_down_ = m_[0][0] * m_[1][1] - m_[0][1] * m_[1][0] < 0.0;
}

void LevelScan::aim_beams(const robot::LaserScan& scan) {
  if (scan.ranges.size() == directions_.size() && scan.angle_min == angle_min_ && scan.angle_step == angle_step_) {
    return;
  }
  angle_min_ = scan.angle_min;
  angle_step_ = scan.angle_step;
  directions_.resize(scan.ranges.size());
  for (std::size_t beam = 0; beam < directions_.size(); ++beam) {
    const double c = std::cos(scan.bearing(beam));
    const double s = std::sin(scan.bearing(beam));
    directions_[beam] = {m_[0][0] * c + m_[0][1] * s, m_[1][0] * c + m_[1][1] * s};
  }
}

/// How high the floor may seem to a beam that climbs so much a metre.
double LevelScan::margin_of(double climb) const {
  const double share = std::clamp((-climb - kFallsLittle) / (kFallsAsOnRamps - kFallsLittle), 0.0, 1.0);
  return config_.floor_margin + share * (config_.ramp_margin - config_.floor_margin);
}

ScanPoints LevelScan::points(const robot::LaserScan& scan, const SweepMotion* motion, const ScanTilt* tilt) {
  aim_beams(scan);
  const TiltedPlane plane(tilt != nullptr ? *tilt : ScanTilt{});
  const TPoint2D laser = tilt != nullptr ? leaning(p_base_laser_, laser_height_, *tilt) : p_base_laser_;
  ScanPoints points;
  points.origin = laser;
  points.beam_width = scan.angle_step;
  const bool known = scan.range_max > 0.0 && scan.range_max <= kFarthestReturn;
  const double limit = known ? scan.range_max : kFarthestReturn;
  const double cap = config_.max_range > 0.0 ? std::min(config_.max_range, limit) : limit;
  const bool carve = config_.carve_misses && (known || config_.max_range > 0.0);
  // Beams beyond one full turn would see the same directions twice.
  const double turn = 2.0 * kPi / std::abs(scan.angle_step) + 1e-6;  // infinite for a single beam that tells no step
  const auto beams = static_cast<std::size_t>(std::min(static_cast<double>(scan.ranges.size()), turn));
  points.hits.reserve(beams);
  points.rays.reserve(beams);

  SweepingBase base_at_beam(motion != nullptr ? *motion : SweepMotion{}, beams);
  std::size_t last_beam = 0;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const double range = static_cast<double>(scan.ranges[beam]);
    if (std::isnan(range) || range < scan.range_min || range <= 0.0) continue;
    const bool hit = range <= cap;
    if (!hit && !carve) continue;
    double length = hit ? range : std::max(0.0, cap - config_.miss_margin);
    Direction d = directions_[beam];
    if (tilt != nullptr) {
      const double climb = plane.climb(d.x, d.y);
      const double margin = margin_of(climb);
      if (!hit) {
        const double above = laser_height_ - margin;  // what lies lower may be the floor
        length =
            std::min(length, std::min(config_.miss_climb, climb < 0.0 ? above : config_.miss_climb) / std::abs(climb));
        if (length <= 0.0) continue;
      } else if (laser_height_ + length * climb < margin) {  // the floor
        points.floor_beams.push_back(static_cast<int>(beam));
        continue;
      }
      d = {plane.x(d.x, d.y), plane.y(d.y)};
    }
    TPoint2D end{laser.x + length * d.x, laser.y + length * d.y};
    if (motion != nullptr) end = base_at_beam.to(beam)(end);
    if (!points.rays.empty()) points.rays.back().joined = beam == last_beam + 1;
    last_beam = beam;
    // Field by field: a ray that is made elsewhere and copied waits each time until its bytes have been stored.
    ScanRay& ray = points.rays.emplace_back();
    ray.end = end;
    ray.hit = hit;
    ray.beam = static_cast<int>(beam);
    (hit ? points.hits : points.passes).push_back(end);
  }
  if (upside_down_) {  // the beams run clockwise in the base frame
    std::reverse(points.rays.begin(), points.rays.end());
    for (std::size_t i = 0; i + 1 < points.rays.size(); ++i) points.rays[i].joined = points.rays[i + 1].joined;
    if (!points.rays.empty()) points.rays.back().joined = false;
  }
  return points;
}

}  // namespace rubble::slam
