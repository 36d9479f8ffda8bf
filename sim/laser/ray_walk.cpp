#include "sim/laser/ray_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr double kPolygonSeam = 1e-6;  ///< polygons reach so far beyond their edges: no light through seams [m]
constexpr double kNoRange = std::numeric_limits<double>::infinity();

Vector3d vertex(const arenas::Face& face, std::size_t i) {
  const auto& v = face.vertices[i % face.vertices.size()];
  return {v.x, v.y, v.z};
}

/// Newell's normal: robust for any number of vertices.
Vector3d face_normal(const arenas::Face& face) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < face.vertices.size(); ++i) {
    const Vector3d a = vertex(face, i) - vertex(face, 0);
    const Vector3d b = vertex(face, i + 1) - vertex(face, 0);
    sum += a.cross(b);
  }
  return sum;
}

}  // namespace

RayWalk::RayWalk(const std::vector<arenas::Face>& faces) {
  Vector3d low = Vector3d::Constant(kNoRange);
  Vector3d high = Vector3d::Constant(-kNoRange);
  std::vector<std::pair<Vector3d, Vector3d>> boxes;
  for (const arenas::Face& face : faces) {
    const Vector3d normal = face_normal(face);
    if (normal.norm() < 1e-12) continue;  // no area, nothing to hit
    Polygon polygon;
    polygon.normal = normal.normalized();
    polygon.offset = polygon.normal.dot(vertex(face, 0));
    polygon.first = static_cast<std::uint32_t>(edges_.size());
    Vector3d box_low = Vector3d::Constant(kNoRange);
    Vector3d box_high = Vector3d::Constant(-kNoRange);
    for (std::size_t i = 0; i < face.vertices.size(); ++i) {
      const Vector3d a = vertex(face, i);
      box_low = box_low.cwiseMin(a);
      box_high = box_high.cwiseMax(a);
      const Vector3d along = vertex(face, i + 1) - a;
      if (along.norm() < 1e-9) continue;
      const Vector3d inward = polygon.normal.cross(along).normalized();
      edges_.push_back({inward, inward.dot(a) - kPolygonSeam});
    }
    polygon.count = static_cast<std::uint32_t>(edges_.size()) - polygon.first;
    polygon.z_min = box_low.z() - kPolygonSeam;
    polygon.z_max = box_high.z() + kPolygonSeam;
    polygons_.push_back(polygon);
    boxes.emplace_back(box_low, box_high);
    low = low.cwiseMin(box_low);
    high = high.cwiseMax(box_high);
  }
  if (polygons_.empty()) low = high = Vector3d::Zero();

  frame_.resolution = arenas::kHalfPallet;
  frame_.x0 = low.x() - arenas::kHalfPallet;
  frame_.y0 = low.y() - arenas::kHalfPallet;
  frame_.width = static_cast<int>(std::ceil((high.x() - frame_.x0) / arenas::kHalfPallet)) + 1;
  frame_.height = static_cast<int>(std::ceil((high.y() - frame_.y0) / arenas::kHalfPallet)) + 1;
  std::vector<std::vector<std::uint32_t>> cells(frame_.size());
  for (std::size_t i = 0; i < polygons_.size(); ++i) {
    // A polygon on the border of two cells is listed in both, or a rounding error would let the light through.
    const Cell from = frame_.cell({boxes[i].first.x() - kPolygonSeam, boxes[i].first.y() - kPolygonSeam});
    const Cell to = frame_.cell({boxes[i].second.x() + kPolygonSeam, boxes[i].second.y() + kPolygonSeam});
    for (int y = from.y; y <= to.y; ++y) {
      for (int x = from.x; x <= to.x; ++x) cells[frame_.index({x, y})].push_back(static_cast<std::uint32_t>(i));
    }
  }
  for (const auto& cell : cells) {
    start_.push_back(static_cast<std::uint32_t>(list_.size()));
    list_.insert(list_.end(), cell.begin(), cell.end());
  }
  start_.push_back(static_cast<std::uint32_t>(list_.size()));
}

double RayWalk::meet(const Polygon& polygon, const Ray& ray, double best) const {
  const double closing = polygon.normal.dot(ray.direction);
  if (closing == 0.0) return best;
  const double t = (polygon.offset - polygon.normal.dot(ray.origin)) / closing;
  if (!(t > 0.0 && t < best)) return best;
  const Vector3d p = ray.origin + t * ray.direction;
  for (std::uint32_t i = polygon.first; i < polygon.first + polygon.count; ++i) {
    if (edges_[i].inward.dot(p) < edges_[i].offset) return best;
  }
  return t;
}

double RayWalk::cast(const Ray& ray, double max_range) const {
  double best = max_range;
  bool hit = false;
  const double inverse = 1.0 / frame_.resolution;
  const double gx = (ray.origin.x() - frame_.x0) * inverse;
  const double gy = (ray.origin.y() - frame_.y0) * inverse;
  const double ix = ray.direction.x() * inverse;
  const double iy = ray.direction.y() * inverse;

  // Enter the grid when the origin lies outside.
  double t = 0.0;
  double leave = max_range;
  const auto clip = [&](double origin, double speed, double size) {
    if (speed == 0.0) {
      if (origin < 0.0 || origin >= size) leave = -1.0;
      return;
    }
    const double a = (0.0 - origin) / speed;
    const double b = (size - origin) / speed;
    t = std::max(t, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  clip(gx, ix, frame_.width);
  clip(gy, iy, frame_.height);
  if (t > leave) return kNoRange;

  Cell cell{std::clamp(static_cast<int>(std::floor(gx + t * ix)), 0, frame_.width - 1),
            std::clamp(static_cast<int>(std::floor(gy + t * iy)), 0, frame_.height - 1)};
  const int step_x = ix > 0.0 ? 1 : -1;
  const int step_y = iy > 0.0 ? 1 : -1;
  const double each_x = ix != 0.0 ? std::abs(1.0 / ix) : kNoRange;
  const double each_y = iy != 0.0 ? std::abs(1.0 / iy) : kNoRange;
  double next_x = ix != 0.0 ? (static_cast<double>(cell.x + (ix > 0.0 ? 1 : 0)) - gx) / ix : kNoRange;
  double next_y = iy != 0.0 ? (static_cast<double>(cell.y + (iy > 0.0 ? 1 : 0)) - gy) / iy : kNoRange;

  while (t <= best && frame_.inside(cell)) {
    const double exit = std::min(std::min(next_x, next_y), best);
    const double z0 = ray.origin.z() + t * ray.direction.z();
    const double z1 = ray.origin.z() + exit * ray.direction.z();
    const double z_low = std::min(z0, z1);
    const double z_high = std::max(z0, z1);
    const std::size_t index = frame_.index(cell);
    for (std::uint32_t i = start_[index]; i < start_[index + 1]; ++i) {
      const Polygon& polygon = polygons_[list_[i]];
      if (polygon.z_min > z_high || polygon.z_max < z_low) continue;
      const double found = meet(polygon, ray, best);
      if (found < best) {
        best = found;
        hit = true;
      }
    }
    t = std::min(next_x, next_y);
    if (next_x < next_y) {
      cell.x += step_x;
      next_x += each_x;
    } else {
      cell.y += step_y;
      next_y += each_y;
    }
  }
  return hit ? best : kNoRange;
}

double RayWalk::cast(const Ray& ray, double max_range, const std::vector<Sphere>& spheres) const {
  double best = cast(ray, max_range);
  for (const Sphere& sphere : spheres) {
    const double t = cast_sphere(ray, sphere);
    if (t <= max_range) best = std::min(best, t);
  }
  return best;
}

double cast_sphere(const Ray& ray, const Sphere& sphere) {
  const Vector3d to = Vector3d(sphere.x, sphere.y, sphere.z) - ray.origin;
  const double middle = to.dot(ray.direction);
  const double half2 = sphere.radius * sphere.radius - (to.squaredNorm() - middle * middle);
  if (half2 < 0.0) return kNoRange;
  const double t = middle - std::sqrt(half2);
  return t > 0.0 ? t : kNoRange;
}

}  // namespace rubble::sim
