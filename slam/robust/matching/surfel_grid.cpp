#include "slam/robust/matching/surfel_grid.h"

#include <algorithm>
#include <cmath>

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kMargin = 1.0;  ///< around what is covered [m]
/// 2.4 km by 2.4 km of cells of 0.15 m; more would count beyond 32 bits, and fill the memory.
constexpr double kMostGridCells = 1U << 28U;
constexpr float kSlack = 0.01F;      ///< far more than a mean of points lies outside of their cell by rounding [m]
constexpr float kOneSurface = 0.7F;  ///< cosine between normals that are averaged
/// Cosine between normals that are matched. They scatter less by the scanner's noise, but for corners: a normal from
/// both of its walls is neither's, and aslant to a corridor it holds back all that moves along.
constexpr float kSameSide = 0.9F;

}  // namespace

void SurfelGrid::begin(double cell, const TPoint2D& low, const TPoint2D& high) {
  const double extent_x = high.x - low.x + 2.0 * kMargin;
  const double extent_y = high.y - low.y + 2.0 * kMargin;
  cell = std::max(cell, std::sqrt(extent_x * extent_y / kMostGridCells));
  cells_per_m_ = static_cast<float>(1.0 / cell);
  x0_ = static_cast<float>(low.x - kMargin);
  y0_ = static_cast<float>(low.y - kMargin);
  width_ = static_cast<int>(extent_x / cell) + 2;
  height_ = static_cast<int>(extent_y / cell) + 2;
  filled_.assign((static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) / 64 + 1, 0);
  added_.clear();
  surfels_.clear();
}

void SurfelGrid::add(const std::vector<OrientedPoint>& points, const TPose2D& T) {
  const auto c = static_cast<float>(std::cos(T.phi));
  const auto s = static_cast<float>(std::sin(T.phi));
  const auto x = static_cast<float>(T.x);
  const auto y = static_cast<float>(T.y);
  for (const OrientedPoint& p : points) {
    if (!p.has_normal()) continue;
    const float at_x = x + c * p.x - s * p.y;
    const float at_y = y + s * p.x + c * p.y;
    const int column = static_cast<int>((at_x - x0_) * cells_per_m_);
    const int row = static_cast<int>((at_y - y0_) * cells_per_m_);
    if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
    const auto cell =
        static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(width_) + static_cast<std::uint32_t>(column);
    filled_[cell >> 6U] |= std::uint64_t{1} << (cell & 63U);
    added_.push_back({at_x, at_y, c * p.nx - s * p.ny, s * p.nx + c * p.ny, cell});
  }
}

void SurfelGrid::finish() {
  ranks_.resize(filled_.size());
  std::uint32_t cells = 0;
  for (std::size_t word = 0; word < filled_.size(); ++word) {
    ranks_[word] = cells;
    cells += static_cast<std::uint32_t>(__builtin_popcountll(filled_[word]));
  }
  head_.assign(cells, -1);
  sums_.clear();
  for (const Added& point : added_) {
    int& head = head_[rank(point.cell)];
    int k = head;
    while (k >= 0) {
      Sum& sum = sums_[static_cast<std::size_t>(k)];
      if (sum.nx * point.nx + sum.ny * point.ny > kOneSurface * sum.count) {
        sum.x += point.x;
        sum.y += point.y;
        sum.nx += point.nx;
        sum.ny += point.ny;
        sum.count += 1.0F;
        break;
      }
      k = sum.next;
    }
    if (k >= 0) continue;
    sums_.push_back({point.x, point.y, point.nx, point.ny, 1.0F, head});
    head = static_cast<int>(sums_.size()) - 1;
  }
  surfels_.reserve(sums_.size());
  first_.clear();
  for (const int head : head_) {
    first_.push_back(static_cast<int>(surfels_.size()));
    for (int k = head; k >= 0; k = sums_[static_cast<std::size_t>(k)].next) {
      const Sum& sum = sums_[static_cast<std::size_t>(k)];
      const float norm = std::sqrt(sum.nx * sum.nx + sum.ny * sum.ny);
      surfels_.push_back({sum.x / sum.count, sum.y / sum.count, sum.nx / norm, sum.ny / norm});
    }
  }
  first_.push_back(static_cast<int>(surfels_.size()));
}

const Surfel* SurfelGrid::nearest(float x, float y, float nx, float ny, float radius) const {
  const int reach = static_cast<int>(std::ceil(radius * cells_per_m_ - 0.5F));
  const int column = static_cast<int>((x - x0_) * cells_per_m_);
  const int row = static_cast<int>((y - y0_) * cells_per_m_);
  if (column < reach || row < reach || column + reach >= width_ || row + reach >= height_) return nullptr;
  const bool any_side = nx == 0.0F && ny == 0.0F;
  float best = radius * radius;
  const Surfel* found = nullptr;
  const auto look_along = [&](int v) {
    const auto middle =
        static_cast<std::uint32_t>(v) * static_cast<std::uint32_t>(width_) + static_cast<std::uint32_t>(column);
    const std::size_t from = rank(middle - static_cast<std::uint32_t>(reach));
    const std::size_t to = rank(middle + static_cast<std::uint32_t>(reach) + 1U);
    if (from == to) return;
    const Surfel* end = surfels_.data() + first_[to];
    for (const Surfel* surfel = surfels_.data() + first_[from]; surfel != end; ++surfel) {
      const float dx = surfel->x - x;
      const float dy = surfel->y - y;
      const float d2 = dx * dx + dy * dy;
      if (!(d2 <= best) || !(any_side || surfel->nx * nx + surfel->ny * ny > kSameSide)) continue;
      // Of two as near the first in the list, whatever row was asked first.
      if (d2 == best && (found == nullptr || surfel > found)) continue;
      best = d2;
      found = surfel;
    }
  };
  // From the middle outwards: rows that begin farther away than the best one need not be asked.
  look_along(row);
  const float cell = 1.0F / cells_per_m_;
  float below = y - (y0_ + static_cast<float>(row) * cell) - kSlack;
  float above = cell - 2.0F * kSlack - below;
  for (int step = 1; step <= reach; ++step, below += cell, above += cell) {
    const bool down = below <= 0.0F || below * below <= best;
    const bool up = above <= 0.0F || above * above <= best;
    if (down) look_along(row - step);
    if (up) look_along(row + step);
    if (!down && !up) break;
  }
  return found;
}

std::vector<OrientedPoint> SurfelGrid::every_nth(std::size_t n) const {
  std::vector<OrientedPoint> points;
  points.reserve(surfels_.size() / n + 1);
  for (std::size_t k = 0; k < surfels_.size(); k += n)
    points.push_back({surfels_[k].x, surfels_[k].y, surfels_[k].nx, surfels_[k].ny});
  return points;
}

std::vector<OrientedPoint> SurfelGrid::thinned_to(std::size_t most) const {
  return every_nth(std::max<std::size_t>(1, surfels_.size() / most));
}

}  // namespace rubble::slam
