#pragma once

#include <cstdint>
#include <vector>

#include "sim/clutter.h"
#include "sim/rays.h"
#include "sim/scan_faces.h"

namespace rubble::sim {

/// Casts a sweep face by face: each face is met with just the beams whose bearing it covers, every beam from its own
/// pose, four at a time. Exact up to float rounding (some 10 um).
class SweepCast {
 public:
  explicit SweepCast(const ScanFaces& faces) : faces_(faces) {}

  /// ranges: one a beam [m]; +inf when nothing is within max_range.
  void cast(const Beams& beams, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
            std::vector<float>& ranges);

 private:
  struct Span {
    std::size_t begin = 0, end = 0;  ///< groups of four beams
  };
  void meet(const ScanFaces::Polygon& polygon, const Beams& beams, const BeamTable& table, double max_range);
  void meet(const Sphere& sphere, const Beams& beams, const BeamTable& table, double max_range);
  /// What of a polygon the scan plane sweeps over, seen from the laser.
  struct Bearings {
    double low = 0.0, high = 0.0;  ///< [rad], high may exceed pi
    double nearest = 1e9;          ///< [m]
    bool around = false;           ///< the laser's axis passes through it
  };
  Bearings bearings(const Eigen::Vector3d* vertices, const double* z, std::size_t n, double slack,
                    const Placement& laser) const;
  void spans(double low, double high, double margin, const BeamTable& table, std::vector<Span>& found) const;

  const ScanFaces& faces_;
  std::vector<std::uint32_t> near_;
  std::vector<Span> spans_;
  std::vector<float> best_;
};

}  // namespace rubble::sim
