#include "sim/scan_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 1.2;   ///< one pallet [m]
constexpr double kLarge = 2.0;  ///< larger polygons are asked every time [m]

}  // namespace

ScanFaces::ScanFaces(const std::vector<arenas::Face>& faces) {
  for (const arenas::Face& face : faces) {
    const auto& v = face.vertices;
    for (std::size_t first = 1; first + 1 < v.size(); first += kMostCorners - 2) {
      const std::size_t last = std::min(first + kMostCorners - 2, v.size() - 1);
      std::vector<Vector3d> corners{Vector3d(v[0].x, v[0].y, v[0].z)};
      for (std::size_t i = first; i <= last; ++i) corners.emplace_back(v[i].x, v[i].y, v[i].z);
      add(corners);
    }
  }
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  for (const Polygon& polygon : polygons_) {
    const Vector3d& m = polygon.middle;
    if (&polygon == polygons_.data()) x0 = x1 = m.x(), y0 = y1 = m.y();
    x0 = std::min(x0, m.x());
    y0 = std::min(y0, m.y());
    x1 = std::max(x1, m.x());
    y1 = std::max(y1, m.y());
  }

  frame_.resolution = kCell;
  frame_.x0 = x0;
  frame_.y0 = y0;
  frame_.width = static_cast<int>(std::floor((x1 - x0) / kCell)) + 1;
  frame_.height = static_cast<int>(std::floor((y1 - y0) / kCell)) + 1;
  std::vector<std::vector<std::uint32_t>> cells(frame_.size());
  for (std::uint32_t i = 0; i < polygons_.size(); ++i) {
    if (polygons_[i].radius > kLarge) {
      large_.push_back(i);
      continue;
    }
    reach_ = std::max(reach_, polygons_[i].radius);
    cells[frame_.index(frame_.cell({polygons_[i].middle.x(), polygons_[i].middle.y()}))].push_back(i);
  }
  for (const auto& cell : cells) {
    start_.push_back(static_cast<std::uint32_t>(list_.size()));
    list_.insert(list_.end(), cell.begin(), cell.end());
  }
  start_.push_back(static_cast<std::uint32_t>(list_.size()));
}

void ScanFaces::add(const std::vector<Vector3d>& corners) {
  Vector3d normal = Vector3d::Zero();
  Polygon polygon;
  polygon.middle = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
    polygon.middle += corners[i] / static_cast<double>(corners.size());
  }
  if (normal.norm() < 1e-12) return;  // no area, nothing to hit
  polygon.normal = normal.normalized();
  polygon.offset = polygon.normal.dot(corners[0]);
  polygon.first = static_cast<std::uint32_t>(vertices_.size());
  polygon.count = static_cast<std::uint32_t>(corners.size());
  for (const Vector3d& corner : corners) polygon.radius = std::max(polygon.radius, (corner - polygon.middle).norm());
  vertices_.insert(vertices_.end(), corners.begin(), corners.end());
  polygons_.push_back(polygon);
}

void ScanFaces::near(const Vector3d& p, double range, double slack, std::vector<std::uint32_t>& found) const {
  found.clear();
  const auto consider = [&](std::uint32_t i) {
    const Polygon& polygon = polygons_[i];
    // Seen from the front, its plane in reach, and its sphere, too.
    const double height = polygon.normal.dot(p) - polygon.offset;
    if (height < -slack || height > range + slack) return;
    const double limit = range + slack + polygon.radius;
    if ((polygon.middle - p).squaredNorm() < limit * limit) found.push_back(i);
  };
  for (const std::uint32_t i : large_) consider(i);
  const double radius = range + slack + reach_;
  const Cell low = frame_.cell({p.x() - radius, p.y() - radius});
  const Cell high = frame_.cell({p.x() + radius, p.y() + radius});
  for (int y = std::max(0, low.y); y <= std::min(frame_.height - 1, high.y); ++y) {
    const int x0 = std::max(0, low.x);
    const int x1 = std::min(frame_.width - 1, high.x);
    if (x0 > x1) break;
    const std::uint32_t end = start_[frame_.index({x1, y}) + 1];
    for (std::uint32_t i = start_[frame_.index({x0, y})]; i < end; ++i) consider(list_[i]);
  }
}

double rough_atan2(double y, double x) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  const double high = std::max(ax, ay);
  if (high == 0.0) return 0.0;
  const double q = std::min(ax, ay) / high;
  const double s = q * q;
  double a = q * (0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351))));
  if (ay > ax) a = 0.5 * kPi - a;
  if (x < 0.0) a = kPi - a;
  return y < 0.0 ? -a : a;
}

}  // namespace rubble::sim
