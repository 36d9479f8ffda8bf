#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"
#include "base/grid.h"
#include "sim/laser/rays.h"
#include "sim/laser/simd.h"

namespace rubble::sim {

/// What a scan can meet at most: a slab about the scan plane, cut off at the range.
struct ScanReach {
  Placement laser;
  double range = 0.0;   ///< of the beams [m]
  double travel = 0.0;  ///< a beam may start so far beside the laser [m]
  double lift = 0.0;    ///< and be so far above or below the plane [m]
};

/// A polygon that a scan may meet.
struct NearFace {
  std::uint32_t polygon = 0;  ///< its index
  float nearest = 0.0f;       ///< no point of it is nearer to the laser, for its plane and its sphere are not [m]
};

/// The arena's faces, found by place and seen from the laser: what both fast casters start from.
class ScanFaces {
 public:
  static constexpr std::size_t kCorners = 4;  ///< faces with more are cut into several polygons

  /// An edge's plane, square to the polygon: inside is inward . p >= offset.
  struct Edge {
    Eigen::Vector3d inward;
    double offset = 0.0;
  };
  struct Polygon {
    Eigen::Vector3d normal;  ///< to the side it is seen from
    double offset = 0.0;     ///< normal . p of its points
    std::array<Edge, kCorners> edges;
  };
  /// The corners of a polygon in a laser's frame, a lane each; a triangle repeats its last.
  struct Corners {
    Float4 x, y, z;
  };
  /// A laser's placement, ready for `corners`.
  struct View {
    explicit View(const ScanFaces& faces, const Placement& laser);
    std::array<Float4, 9> R;  ///< row by row of the inverse rotation
    Float4 x, y, z;           ///< of the laser, about the faces' origin
  };

  /// `faces` turn counter-clockwise for a viewer on their visible side, as arenas::faces makes them; from behind they
  /// are never seen.
  explicit ScanFaces(const std::vector<arenas::Face>& faces);

  /// The polygons within reach that show their front (and some more), each once.
  void near(const ScanReach& reach, std::vector<NearFace>& found) const;

  const Polygon& polygon(std::uint32_t i) const { return polygons_[i]; }
  Corners corners(std::uint32_t i, const View& view) const {
    const Quad& quad = quads_[i];
    const Float4 x = load4(quad.x) - view.x, y = load4(quad.y) - view.y, z = load4(quad.z) - view.z;
    const auto& R = view.R;
    return {R[0] * x + R[1] * y + R[2] * z, R[3] * x + R[4] * y + R[5] * z, R[6] * x + R[7] * y + R[8] * z};
  }

 private:
  /// Corners about origin_, so that floats keep micrometres.
  struct Quad {
    float x[4], y[4], z[4];
  };
  /// What decides whether a polygon is near, polygon after polygon; padded to whole groups of four.
  struct Bounds {
    std::vector<float> x, y, z, radius;      ///< sphere that holds it, about origin_
    std::vector<float> nx, ny, nz, nearest;  ///< normal, and its product with the polygon's points
  };
  struct Entry;

  static void cut(const arenas::Face& face, std::vector<Entry>& entries);
  void append(const Entry& entry);

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Polygon> polygons_;  ///< cell by cell of the frame, then those too large for the cells
  std::vector<Quad> quads_;
  Bounds bounds_;
  GridFrame frame_;
  double reach_ = 0.0;                ///< largest radius of the polygons in cells [m]
  std::vector<std::uint32_t> start_;  ///< of each cell's polygons; they lie where their middle does
};

}  // namespace rubble::sim
