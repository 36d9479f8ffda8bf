#include "sim/laser/scan_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr double kLarge = 2.0;    ///< larger polygons are asked every time [m]
constexpr double kCoarse = 1e-3;  ///< what float coordinates may be off by, generously [m]

}  // namespace

struct ScanFaces::Entry {
  std::vector<Vector3d> corners;
  Vector3d normal;
  Vector3d middle;
  double radius = 0.0;
};

void ScanFaces::cut(const arenas::Face& face, std::vector<Entry>& entries) {
  const auto& v = face.vertices;
  for (std::size_t first = 1; first + 1 < v.size(); first += kCorners - 2) {
    const std::size_t last = std::min(first + kCorners - 2, v.size() - 1);
    Entry entry;
    entry.corners.emplace_back(v[0].x, v[0].y, v[0].z);
    for (std::size_t i = first; i <= last; ++i) entry.corners.emplace_back(v[i].x, v[i].y, v[i].z);
    const std::vector<Vector3d>& c = entry.corners;
    entry.normal = Vector3d::Zero();
    entry.middle = Vector3d::Zero();
    for (std::size_t i = 0; i < c.size(); ++i) {
      entry.normal += (c[i] - c[0]).cross(c[(i + 1) % c.size()] - c[0]);
      entry.middle += c[i] / static_cast<double>(c.size());
    }
    if (entry.normal.norm() < 1e-12) continue;  // no area, nothing to hit
    entry.normal.normalize();
    for (const Vector3d& corner : c) entry.radius = std::max(entry.radius, (corner - entry.middle).norm());
    entries.push_back(entry);
  }
}

void ScanFaces::append(const Entry& entry) {
  Polygon polygon;
  polygon.normal = entry.normal;
  polygon.offset = entry.normal.dot(entry.corners[0]);
  Quad quad;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const std::size_t last = entry.corners.size() - 1;
    const Vector3d& a = entry.corners[std::min(i, last)];
    const Vector3d& b = entry.corners[std::min((i + 1) % kCorners, last)];
    const Vector3d along = b - a;
    // An edge without length (a triangle's third, to its repeated corner) bounds nothing: 0 . p >= 0.
    const bool bounds = along.squaredNorm() > 1e-18;
    polygon.edges[i].inward = bounds ? Vector3d(entry.normal.cross(along).normalized()) : Vector3d(Vector3d::Zero());
    polygon.edges[i].offset = polygon.edges[i].inward.dot(a);
    quad.x[i] = static_cast<float>(a.x() - origin_.x());
    quad.y[i] = static_cast<float>(a.y() - origin_.y());
    quad.z[i] = static_cast<float>(a.z() - origin_.z());
  }
  polygons_.push_back(polygon);
  quads_.push_back(quad);
  const Vector3d middle = entry.middle - origin_;
  const auto put = [](std::vector<float>& list, double value) { list.push_back(static_cast<float>(value)); };
  put(bounds_.x, middle.x());
  put(bounds_.y, middle.y());
  put(bounds_.z, middle.z());
  put(bounds_.radius, entry.radius);
  put(bounds_.nx, entry.normal.x());
  put(bounds_.ny, entry.normal.y());
  put(bounds_.nz, entry.normal.z());
  put(bounds_.nearest, entry.normal.dot(middle));
}

ScanFaces::ScanFaces(const std::vector<arenas::Face>& faces) {
  std::vector<Entry> entries;
  for (const arenas::Face& face : faces) cut(face, entries);
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  for (const Entry& entry : entries) {
    if (&entry == entries.data()) low = high = entry.middle;
    low = low.cwiseMin(entry.middle);
    high = high.cwiseMax(entry.middle);
  }
  origin_ = 0.5 * (low + high);
  frame_.resolution = arenas::kPallet;
  frame_.x0 = low.x();
  frame_.y0 = low.y();
  frame_.width = static_cast<int>(std::floor((high.x() - low.x()) / arenas::kPallet)) + 1;
  frame_.height = static_cast<int>(std::floor((high.y() - low.y()) / arenas::kPallet)) + 1;

  std::vector<std::vector<const Entry*>> cells(frame_.size());
  std::vector<const Entry*> large;
  for (const Entry& entry : entries) {
    if (entry.radius > kLarge) {
      large.push_back(&entry);
      continue;
    }
    reach_ = std::max(reach_, entry.radius);
    cells[frame_.index(frame_.cell({entry.middle.x(), entry.middle.y()}))].push_back(&entry);
  }
  cells.push_back(large);
  for (const auto& cell : cells) {
    start_.push_back(static_cast<std::uint32_t>(polygons_.size()));
    for (const Entry* entry : cell) append(*entry);
  }
  start_.push_back(static_cast<std::uint32_t>(polygons_.size()));
  for (auto* list :
       {&bounds_.x, &bounds_.y, &bounds_.z, &bounds_.radius, &bounds_.nx, &bounds_.ny, &bounds_.nz, &bounds_.nearest}) {
    list->resize(list->size() + 3, 0.0f);
  }
}

void ScanFaces::near(const ScanReach& reach, std::vector<NearFace>& found) const {
  found.clear();
  const Vector3d p = reach.laser.p - origin_;
  const Vector3d up = reach.laser.R.col(2);
  const double slack = reach.travel + kCoarse;
  const Float4 px = splat(p.x()), py = splat(p.y()), pz = splat(p.z());
  const Float4 ux = splat(up.x()), uy = splat(up.y()), uz = splat(up.z());
  const Float4 lowest = splat(-slack), far = splat(reach.range + slack), lift = splat(reach.lift + kCoarse);
  const auto consider = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; i += 4) {
      const Float4 dx = load4(&bounds_.x[i]) - px, dy = load4(&bounds_.y[i]) - py, dz = load4(&bounds_.z[i]) - pz;
      const Float4 radius = load4(&bounds_.radius[i]);
      const Float4 limit = far + radius;
      const Float4 above = abs4(ux * dx + uy * dy + uz * dz);
      // Seen from the front and its plane in reach; its sphere in reach and cut by the slab.
      const Float4 height = load4(&bounds_.nx[i]) * px + load4(&bounds_.ny[i]) * py + load4(&bounds_.nz[i]) * pz -
                            load4(&bounds_.nearest[i]);
      const Float4 distance2 = dx * dx + dy * dy + dz * dz;
      const Int4 hit = (height >= lowest) & (height <= far) & (distance2 <= limit * limit) & (above <= radius + lift);
      int lanes = bits4(hit);
      if (end - i < 4) lanes &= (1 << (end - i)) - 1;
      if (lanes == 0) continue;
      const Float4 nearest = max4(height, sqrt4(distance2) - radius);
      for (; lanes != 0; lanes &= lanes - 1) {
        const std::uint32_t lane = lowest4(lanes);
        found.push_back({i + lane, nearest[lane]});
      }
    }
  };
  consider(start_[frame_.size()], start_[frame_.size() + 1]);
  const double radius = reach.range + slack + reach_;
  const Cell low = frame_.cell({reach.laser.p.x() - radius, reach.laser.p.y() - radius});
  const Cell high = frame_.cell({reach.laser.p.x() + radius, reach.laser.p.y() + radius});
  const int x0 = std::max(0, low.x);
  const int x1 = std::min(frame_.width - 1, high.x);
  if (x0 > x1) return;
  for (int y = std::max(0, low.y); y <= std::min(frame_.height - 1, high.y); ++y) {
    consider(start_[frame_.index({x0, y})], start_[frame_.index({x1, y}) + 1]);
  }
}

ScanFaces::View::View(const ScanFaces& faces, const Placement& laser) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) R[static_cast<std::size_t>(3 * i + k)] = splat(laser.R(k, i));
  }
  const Vector3d p = laser.p - faces.origin_;
  x = splat(p.x());
  y = splat(p.y());
  z = splat(p.z());
}

}  // namespace rubble::sim
