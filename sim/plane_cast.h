#pragma once

#include <cstdint>
#include <vector>

#include "sim/clutter.h"
#include "sim/rays.h"
#include "sim/scan_faces.h"

namespace rubble::sim {

/// Casts a whole scan from one pose. Every face cuts the scan plane in a segment; along it the inverse range is
/// 1/r = A cos(bearing) + B sin(bearing), so a face is drawn over the beams it covers and the largest inverse range
/// stays. Faster than a sweep by the bearings that need no margin and by having no pose per beam.
class PlaneCast {
 public:
  explicit PlaneCast(const ScanFaces& faces) : faces_(faces) {}

  /// ranges: one a beam [m]; +inf when nothing is within max_range.
  void cast(const Placement& laser, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
            std::vector<float>& ranges);

 private:
  void draw(const ScanFaces::Polygon& polygon, const Placement& laser, const BeamTable& table);
  void draw_segment(double x0, double y0, double x1, double y1, const BeamTable& table);
  void draw(const Sphere& sphere, const Placement& laser, const BeamTable& table, double max_range);

  const ScanFaces& faces_;
  std::vector<std::uint32_t> near_;
  std::vector<float> inverse_;  ///< nearest so far, 1 / range
};

}  // namespace rubble::sim
