#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/math/TPose3D.h>

#include <vector>

#include "robot/measurements.h"
#include "slam/grid/count_map.h"

namespace rubble::slam {

/// No scanner sees farther: a limit above it, none at all or one that is no number tells nothing, and what seems to
/// come back from beyond is no hit [m].
constexpr double kFarthestReturn = 1000.0;

struct LevelScanConfig {
  bool carve_misses = false;  ///< beams without a return free cells up to `miss_margin` before the range limit
  double max_range = 0.0;     ///< returns beyond are no hits [m]; 0: the scanner's own limit
  double miss_margin = 0.1;   ///< [m]
  double miss_climb = 0.15;  ///< a miss says nothing of where its beam is higher or lower than the laser by more, or in
                             ///< the margins below [m]
  double floor_margin = 0.0;  ///< of a tilted scan, returns lower than this above the floor are no hits [m] ...
  /// ... and this [m] for beams that look down as from a ramp, which may end on the next one; two thirds of the laser's
  /// height at most. In between, for beams that fall by 1.5 to 3 deg, it grows from one to the other.
  double ramp_margin = 0.0;
};

/// Motion of the base during a sweep, relative to the base at the scan's reference time.
struct SweepMotion {
  mrpt::math::TPose2D T_ref_first;  ///< base when beam 0 leaves
  mrpt::math::TPose2D T_ref_last;   ///< base when the last beam leaves
};

/// How laser and robot are inclined while a scan is taken: nose up and left side up are positive [rad].
struct ScanTilt {
  double pitch = 0.0;  ///< of the scan plane
  double roll = 0.0;
  double body_pitch = 0.0;  ///< of the robot's body: moves the laser, which sits above the base's origin
  double body_roll = 0.0;
};

/// Turns a scan of a levelled laser into end points in the base frame. Returns, misses and unmeasured beams stay apart:
/// a NaN, a range below the scanner's least and (unless carved) a miss say nothing.
class LevelScan {
 public:
  LevelScan(const mrpt::math::TPose3D& T_base_laser, const LevelScanConfig& config);

  /// With `motion` each beam is placed where the base was when it left (linear in time); without, the scan is taken as
  /// one instant, as the paper does. With `tilt` beams are projected to the ground plane from where the tilted body
  /// holds the laser, and what they meet at the floor is left out; without, all is taken to be level.
  ScanPoints points(const robot::LaserScan& scan, const SweepMotion* motion = nullptr, const ScanTilt* tilt = nullptr);

 private:
  struct Direction {
    double x;
    double y;
  };
  void aim_beams(const robot::LaserScan& scan);
  double margin_of(double climb) const;

  LevelScanConfig config_;
  mrpt::math::TPoint2D p_base_laser_;
  double laser_height_;
  double m_[2][2];  ///< the mount's rotation, seen from above
  bool upside_down_ = false;
  double angle_min_ = 0.0;
  double angle_step_ = 0.0;
  std::vector<Direction> directions_;  ///< of the beams in the base frame, for the geometry seen last
};

}  // namespace rubble::slam
