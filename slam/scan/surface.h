#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "slam/grid/count_map.h"

namespace rubble::slam {

struct SurfaceConfig {
  double spacing = 0.05;         ///< of the points along the surfaces [m]
  double max_gap = kSurfaceGap;  ///< neighbouring returns farther apart do not lie on one surface [m] ...
  double flattest = 8.0;         ///< ... unless the gap is at most so many beam widths: a far wall at a flat angle
  int max_missing = 3;           ///< so many beams without a return do not end a surface
};

/// A point on a surface: the mean of a few neighbouring returns.
struct SurfacePoint {
  mrpt::math::TPoint2D p;
  std::size_t first_hit = 0;  ///< the returns it stands for: ScanPoints::hits[first_hit] ...
  std::size_t hits = 1;       ///< ... so many
  bool joined = false;        ///< the next point lies on the same surface
  bool fades_before = false;  ///< before it the surface goes on out of sight: out of range, of view, or hidden
  bool fades_after = false;   ///< the same after it
};

/// The surfaces a scan saw, in the order of its beams.
struct Surface {
  mrpt::math::TPoint2D origin;  ///< the laser
  std::vector<SurfacePoint> points;
};

/// Thins a scan to about `spacing` by averaging runs of neighbouring returns, so that near walls do not outvote far
/// ones. Needs `scan.rays`.
Surface surface_of(const ScanPoints& scan, const SurfaceConfig& config);

/// Knows where a scan saw surfaces, by bearing from its laser, and so which points of a later scan can have a partner
/// in it. Points that have none (newly in range, in view or round a corner) would pair with the rim of what was seen
/// and hold the robot back.
class SurfaceCoverage {
 public:
  SurfaceCoverage() = default;
  explicit SurfaceCoverage(const Surface& surface);

  /// True where `p`, in the frame of the covering scan, lies in line with a surface that goes on for `margin` [m] to
  /// either side.
  bool covers(const mrpt::math::TPoint2D& p, double margin) const;

 private:
  double bearing(const mrpt::math::TPoint2D& p) const;

  struct Bearing {
    double angle;       ///< counter-clockwise, ascending [rad]
    double to_the_rim;  ///< along the surface to its nearer end [m]
    bool joined;
  };
  mrpt::math::TPoint2D origin_;
  double first_ = 0.0;
  std::vector<Bearing> bearings_;
};

/// The part of `now` that `last` covers when the base moved by T_last_now in between.
Surface covered_part(const Surface& now, const SurfaceCoverage& last, const mrpt::math::TPose2D& T_last_now,
                     double margin);

/// The part of `now` that lies at least `margin` [m] along the surface from where it goes out of sight. What lies
/// nearer may have come into sight only now; the map cannot know it yet, and in eq. (2) would favour particles that lag
/// behind.
Surface settled_part(const Surface& now, double margin);

/// The returns that the points of `part` stand for.
std::vector<mrpt::math::TPoint2D> hits_of(const Surface& part, const ScanPoints& scan);

}  // namespace rubble::slam
