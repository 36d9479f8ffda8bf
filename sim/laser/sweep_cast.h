#pragma once

#include <cstdint>
#include <vector>

#include "sim/body/world_state.h"
#include "sim/laser/rays.h"
#include "sim/laser/scan_faces.h"

namespace rubble::sim {

/// Casts a sweep face by face: each face is met with just the beams whose bearing it covers, every beam from its own
/// pose, four at a time. Exact up to float rounding (some 10 um).
class SweepCast {
 public:
  explicit SweepCast(const ScanFaces& faces) : faces_(faces) {}

  /// ranges: one a beam [m]; +inf when nothing is within max_range. `moving`: faces beside the arena's, or null.
  void cast(const Beams& beams, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
            std::vector<float>& ranges, const ScanFaces* moving = nullptr);

 private:
  struct Span {
    std::size_t begin = 0, end = 0;  ///< groups of four beams
  };
  struct Spans {
    Span span[3];
    std::size_t count = 0;

    std::size_t groups() const {
      std::size_t sum = 0;
      for (std::size_t i = 0; i < count; ++i) sum += span[i].end - span[i].begin;
      return sum;
    }
  };
  /// What of a polygon the scan plane sweeps over, seen from the laser.
  struct Bearings {
    double low = 0.0, high = 0.0;  ///< [rad], high may exceed pi
    double nearest = 1e9;          ///< [m]
    bool around = false;           ///< the laser's axis passes through it
  };
  void meet(const ScanFaces& faces, const Beams& beams, const BeamTable& table, double max_range);
  void meet(const NearFace& face, const ScanFaces::Polygon& polygon, const ScanFaces::Corners& corners,
            const Beams& beams, const BeamTable& table, double max_range);
  void meet(const Sphere& sphere, const Beams& beams, const BeamTable& table, double max_range);
  Bearings bearings(const ScanFaces::Corners& corners, double slack) const;
  Spans rough_spans(const ScanFaces::Corners& corners, double nearest, const Beams& beams,
                    const BeamTable& table) const;
  double sway(const Beams& beams, double nearest) const;
  void near_first();
  bool is_stopped(std::size_t group, const Float4& nearest) const;
  void trim(Spans& spans, const Float4& nearest) const;
  Spans spans(double low, double high, double margin, const BeamTable& table) const;

  const ScanFaces& faces_;
  double slack_ = 0.0;  ///< beams leave the middle scan plane by less [m]
  std::vector<NearFace> near_;
  std::vector<NearFace> order_;  ///< from near to far
  float* best_ = nullptr;        ///< nearest so far [m]: the scan being cast
};

}  // namespace rubble::sim
