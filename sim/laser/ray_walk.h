#pragma once

#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"
#include "base/grid.h"
#include "sim/body/world_state.h"
#include "sim/laser/rays.h"

namespace rubble::sim {

/// The exact caster: walks a ray through a 2D grid of cells and meets the faces and balls listed there.
/// Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray tracing".
class RayWalk {
 public:
  explicit RayWalk(const std::vector<arenas::Face>& faces);

  /// Distance to the first face along the ray [m]; +inf when there is none within `max_range`.
  double cast(const Ray& ray, double max_range) const;
  /// The same with balls in the way.
  double cast(const Ray& ray, double max_range, const std::vector<Sphere>& spheres) const;

 private:
  /// A convex polygon: its plane and, square to it, one plane through each edge.
  struct Polygon {
    Eigen::Vector3d normal;
    double offset = 0.0;  ///< normal . p of its points
    std::uint32_t first = 0, count = 0;
    double z_min = 0.0, z_max = 0.0;
  };
  struct EdgePlane {
    Eigen::Vector3d inward;
    double offset = 0.0;
  };

  double meet(const Polygon& polygon, const Ray& ray, double best) const;

  std::vector<Polygon> polygons_;
  std::vector<EdgePlane> edges_;
  GridFrame frame_;
  std::vector<std::uint32_t> start_;  ///< of each cell's part of list_
  std::vector<std::uint32_t> list_;
};

/// Distance to a sphere [m]; +inf when the ray passes it.
double cast_sphere(const Ray& ray, const Sphere& sphere);

}  // namespace rubble::sim
