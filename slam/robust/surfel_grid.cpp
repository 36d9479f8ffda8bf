#include "slam/robust/surfel_grid.h"

#include <algorithm>
#include <cmath>

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kMargin = 1.0;      ///< around what is covered [m]
constexpr float kOneSurface = 0.7F;  ///< cosine between normals that are averaged
constexpr float kSameSide = 0.6F;    ///< cosine between normals that are matched

}  // namespace

void SurfelGrid::begin(double cell, const TPoint2D& low, const TPoint2D& high) {
  cells_per_m_ = static_cast<float>(1.0 / cell);
  x0_ = static_cast<float>(low.x - kMargin);
  y0_ = static_cast<float>(low.y - kMargin);
  width_ = static_cast<int>((high.x - low.x + 2.0 * kMargin) / cell) + 2;
  height_ = static_cast<int>((high.y - low.y + 2.0 * kMargin) / cell) + 2;
  head_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1);
  next_.clear();
  sums_.clear();
  surfels_.clear();
}

void SurfelGrid::add(const std::vector<OrientedPoint>& points, const TPose2D& T) {
  const auto c = static_cast<float>(std::cos(T.phi));
  const auto s = static_cast<float>(std::sin(T.phi));
  const auto x = static_cast<float>(T.x);
  const auto y = static_cast<float>(T.y);
  for (const OrientedPoint& p : points)
    if (p.has_normal()) put(x + c * p.x - s * p.y, y + s * p.x + c * p.y, c * p.nx - s * p.ny, s * p.nx + c * p.ny);
}

void SurfelGrid::put(float x, float y, float nx, float ny) {
  const int column = static_cast<int>((x - x0_) * cells_per_m_);
  const int row = static_cast<int>((y - y0_) * cells_per_m_);
  if (column < 0 || row < 0 || column >= width_ || row >= height_) return;
  int& head =
      head_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)];
  for (int k = head; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
    Sum& sum = sums_[static_cast<std::size_t>(k)];
    if (sum.nx * nx + sum.ny * ny <= kOneSurface * sum.count) continue;
    sum = {sum.x + x, sum.y + y, sum.nx + nx, sum.ny + ny, sum.count + 1.0F};
    return;
  }
  sums_.push_back({x, y, nx, ny, 1.0F});
  next_.push_back(head);
  head = static_cast<int>(sums_.size()) - 1;
}

void SurfelGrid::finish() {
  surfels_.reserve(sums_.size());
  first_.resize(head_.size() + 1);
  for (std::size_t cell = 0; cell < head_.size(); ++cell) {
    first_[cell] = static_cast<int>(surfels_.size());
    for (int k = head_[cell]; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
      const Sum& sum = sums_[static_cast<std::size_t>(k)];
      const float norm = std::sqrt(sum.nx * sum.nx + sum.ny * sum.ny);
      surfels_.push_back({sum.x / sum.count, sum.y / sum.count, sum.nx / norm, sum.ny / norm});
    }
  }
  first_.back() = static_cast<int>(surfels_.size());
}

const Surfel* SurfelGrid::nearest(float x, float y, float nx, float ny, float radius) const {
  const int reach = static_cast<int>(std::ceil(radius * cells_per_m_ - 0.5F));
  const int column = static_cast<int>((x - x0_) * cells_per_m_);
  const int row = static_cast<int>((y - y0_) * cells_per_m_);
  if (column < reach || row < reach || column + reach >= width_ || row + reach >= height_) return nullptr;
  const bool any_side = nx == 0.0F && ny == 0.0F;
  float best = radius * radius;
  const Surfel* found = nullptr;
  for (int v = row - reach; v <= row + reach; ++v) {
    const int* cells = &first_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_)];
    const Surfel* end = surfels_.data() + cells[column + reach + 1];
    for (const Surfel* surfel = surfels_.data() + cells[column - reach]; surfel != end; ++surfel) {
      const float dx = surfel->x - x;
      const float dy = surfel->y - y;
      const float d2 = dx * dx + dy * dy;
      if (d2 < best && (any_side || surfel->nx * nx + surfel->ny * ny > kSameSide)) {
        best = d2;
        found = surfel;
      }
    }
  }
  return found;
}

}  // namespace rubble::slam
