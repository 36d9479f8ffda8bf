#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <vector>

#include "base/planar.h"
#include "slam/robust/matching/surfel_grid.h"
#include "tests/support/slam_world.h"

namespace rubble::slam_test {

/// Points `spacing` apart on the segments of a world, each with the normal to the left of its segment.
inline std::vector<slam::OrientedPoint> surface_points(const World& world, double spacing) {
  std::vector<slam::OrientedPoint> points;
  for (const Segment& s : world) {
    const TPoint2D along = s.b - s.a;
    const double size = length(along);
    const int pieces = static_cast<int>(size / spacing);
    for (int k = 0; k <= pieces; ++k) {
      const TPoint2D p = s.a + along * (k * spacing / size);
      points.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(-along.y / size),
                        static_cast<float>(along.x / size)});
    }
  }
  return points;
}

/// The points as T sees them: moved by its inverse.
inline std::vector<slam::OrientedPoint> seen_from(const TPose2D& T, const std::vector<slam::OrientedPoint>& points) {
  const double c = std::cos(T.phi);
  const double s = std::sin(T.phi);
  std::vector<slam::OrientedPoint> seen;
  for (const slam::OrientedPoint& p : points) {
    const double dx = static_cast<double>(p.x) - T.x;
    const double dy = static_cast<double>(p.y) - T.y;
    const double nx = static_cast<double>(p.nx);
    const double ny = static_cast<double>(p.ny);
    seen.push_back({static_cast<float>(c * dx + s * dy), static_cast<float>(-s * dx + c * dy),
                    static_cast<float>(c * nx + s * ny), static_cast<float>(-s * nx + c * ny)});
  }
  return seen;
}

/// A grid of the surfels of points seen from the origin.
inline slam::SurfelGrid surfel_grid(const std::vector<slam::OrientedPoint>& points, double cell) {
  slam::SurfelGrid grid;
  TPoint2D low(1e9, 1e9);
  TPoint2D high(-1e9, -1e9);
  for (const slam::OrientedPoint& p : points) {
    low = {std::min(low.x, static_cast<double>(p.x)), std::min(low.y, static_cast<double>(p.y))};
    high = {std::max(high.x, static_cast<double>(p.x)), std::max(high.y, static_cast<double>(p.y))};
  }
  if (points.empty()) low = high = TPoint2D(0, 0);
  grid.begin(cell, low, high);
  grid.add(points, TPose2D());
  grid.finish();
  return grid;
}

/// Points with random normals in a square about the origin.
inline std::vector<slam::OrientedPoint> random_points(Rng& rng, int count, double half_side) {
  std::vector<slam::OrientedPoint> points;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-half_side, half_side);
    const double y = rng.uniform(-half_side, half_side);
    const double bearing = rng.uniform(-kPi, kPi);
    points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(std::cos(bearing)),
                      static_cast<float>(std::sin(bearing))});
  }
  return points;
}

}  // namespace rubble::slam_test
