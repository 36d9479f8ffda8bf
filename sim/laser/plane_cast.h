#pragma once

#include <cstdint>
#include <vector>

#include "sim/body/world_state.h"
#include "sim/laser/rays.h"
#include "sim/laser/scan_faces.h"

namespace rubble::sim {

/// Casts a whole scan from one pose. Every face cuts the scan plane in a segment; along it the inverse range is
/// 1/r = A cos(bearing) + B sin(bearing), so a face is drawn over the beams it covers and the largest inverse range
/// stays. Faster than a sweep by the bearings that need no margin and by having no pose per beam.
class PlaneCast {
 public:
  explicit PlaneCast(const ScanFaces& faces) : faces_(faces) {}

  /// ranges: one a beam [m]; +inf when nothing is within max_range. `moving`: faces beside the arena's, or null.
  void cast(const Placement& laser, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
            std::vector<float>& ranges, const ScanFaces* moving = nullptr);

 private:
  /// What the faces leave on the scan plane, from (x0, y0) counter-clockwise to (x1, y1), seen from the laser over less
  /// than half a turn. Structure of arrays.
  struct Segments {
    std::vector<float> x0, y0, x1, y1;
    std::size_t count = 0;
  };
  /// One segment, ready to be drawn; first .. last are the beams between its ends, to a fraction.
  struct Stroke {
    float a, b;    ///< 1/r = a cos + b sin
    float margin;  ///< how far off first and last may be [beams]
    float x0, y0, x1, y1;
  };

  void draw_faces(const ScanFaces& faces, const Placement& laser, const BeamTable& table, double max_range);
  void cut(const ScanFaces::Corners& corners);
  void draw_segments(const BeamTable& table);
  void draw(const Stroke& stroke, float first, float last, const BeamTable& table);
  void draw(const Sphere& sphere, const Placement& laser, const BeamTable& table, double max_range);

  const ScanFaces& faces_;
  std::vector<NearFace> near_;
  Segments segments_;
  float* inverse_ = nullptr;  ///< nearest so far, 1 / range: the scan being drawn
};

}  // namespace rubble::sim
