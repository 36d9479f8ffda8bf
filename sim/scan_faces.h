#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "arenas/arena.h"
#include "base/grid.h"
#include "sim/rays.h"

namespace rubble::sim {

/// The arena's faces, found by place and cut by a scan plane: what both fast casters start from.
class ScanFaces {
 public:
  static constexpr std::size_t kMostCorners = 8;  ///< faces with more are cut into several polygons

  struct Polygon {
    Eigen::Vector3d normal;  ///< to the side it is seen from
    double offset = 0.0;     ///< normal . p of its points
    std::uint32_t first = 0, count = 0;
    Eigen::Vector3d middle;
    double radius = 0.0;  ///< of the sphere about middle that holds it [m]
  };

  /// `faces` turn counter-clockwise for a viewer on their visible side, as arenas::faces makes them; from behind they
  /// are never seen.
  explicit ScanFaces(const std::vector<arenas::Face>& faces);

  /// Indices of the polygons that a ray of length `range` from p, or from up to `slack` beside it, may meet (and some
  /// more), each once.
  void near(const Eigen::Vector3d& p, double range, double slack, std::vector<std::uint32_t>& found) const;

  const Polygon& polygon(std::uint32_t i) const { return polygons_[i]; }
  const Eigen::Vector3d* vertices(const Polygon& polygon) const { return vertices_.data() + polygon.first; }

 private:
  void add(const std::vector<Eigen::Vector3d>& corners);

  std::vector<Polygon> polygons_;
  std::vector<Eigen::Vector3d> vertices_;
  GridFrame frame_;
  double reach_ = 0.0;                ///< largest radius of the listed polygons [m]
  std::vector<std::uint32_t> start_;  ///< of each cell's part of list_; a polygon is listed where its middle lies
  std::vector<std::uint32_t> list_;
  std::vector<std::uint32_t> large_;  ///< too large for the cells
};

/// atan2 to 2e-5 rad: enough to tell which beams may meet something. Abramowitz and Stegun, 4.4.49.
double rough_atan2(double y, double x);
constexpr double kRoughAtan2Error = 2e-5;  ///< [rad]

}  // namespace rubble::sim
