#include "slam/robust/correlator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kBlurReach = 2.5;                ///< the Gaussian is drawn so many sigmas wide
constexpr double kLongReach = 12.0;               ///< points farther away do not ask for finer angles [m]
constexpr double kFinestAngle = deg_to_rad(0.4);  ///< [rad]
constexpr int kTopLevel = Correlator::kLevels - 1;
constexpr int kSpan = 1 << kTopLevel;
constexpr Work kWorkPerCell = 3;  ///< of drawing and pooling a raster
constexpr Work kWorkPerSurfel = 60;
constexpr Work kWorkPerLookup = 2;

/// Best first; ties by place, so that the order never depends on the sorting.
template <class Node>
bool better(const Node& a, const Node& b) {
  if (a.bound != b.bound) return a.bound > b.bound;
  if (a.angle != b.angle) return a.angle < b.angle;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace

void Correlator::build(const std::vector<Surfel>& surfels, double resolution, double blur, Work* work) {
  resolution_ = resolution;
  per_m_ = static_cast<float>(1.0 / resolution);
  draw(surfels, blur);
  for (int level = 1; level < kLevels; ++level) pool(level);
  if (work != nullptr) {
    *work += kWorkPerCell * kLevels * static_cast<Work>(levels_[0].size());
    *work += kWorkPerSurfel * static_cast<Work>(surfels.size());
  }
}

void Correlator::draw(const std::vector<Surfel>& surfels, double blur) {
  const int reach = std::max(1, static_cast<int>(std::ceil(kBlurReach * blur / resolution_)));
  float low_x = std::numeric_limits<float>::max(), low_y = low_x;
  float high_x = std::numeric_limits<float>::lowest(), high_y = high_x;
  for (const Surfel& q : surfels) {
    low_x = std::min(low_x, q.x);
    low_y = std::min(low_y, q.y);
    high_x = std::max(high_x, q.x);
    high_y = std::max(high_y, q.y);
  }
  if (surfels.empty()) low_x = low_y = high_x = high_y = 0.0F;
  const auto border = static_cast<float>((reach + 1) * resolution_);
  x0_ = low_x - border;
  y0_ = low_y - border;
  width_ = static_cast<int>((high_x - x0_) * per_m_) + reach + 2;
  height_ = static_cast<int>((high_y - y0_) * per_m_) + reach + 2;
  levels_[0].assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);

  const int side = 2 * reach + 1;
  std::vector<std::uint8_t> spot(static_cast<std::size_t>(side * side));
  for (int v = -reach; v <= reach; ++v)
    for (int u = -reach; u <= reach; ++u) {
      const double d2 = (u * u + v * v) * resolution_ * resolution_;
      spot[static_cast<std::size_t>((v + reach) * side + u + reach)] =
          static_cast<std::uint8_t>(255.0 * std::exp(-0.5 * d2 / (blur * blur)));
    }
  for (const Surfel& q : surfels) {
    const Cell c = cell(q.x, q.y);
    for (int v = -reach; v <= reach; ++v) {
      const std::uint8_t* from = &spot[static_cast<std::size_t>((v + reach) * side)];
      std::uint8_t* to = &levels_[0][static_cast<std::size_t>(c.y + v) * static_cast<std::size_t>(width_) +
                                     static_cast<std::size_t>(c.x - reach)];
      for (int u = 0; u < side; ++u) to[u] = std::max(to[u], from[u]);
    }
  }
}

/// Doubles the squares: first along the rows, then along the columns.
void Correlator::pool(int level) {
  const int half = 1 << (level - 1);
  const int width = width_ + half - 1;
  const int height = height_ + half - 1;
  const int wide = width + half;
  const std::vector<std::uint8_t>& from = levels_[static_cast<std::size_t>(level - 1)];
  std::vector<std::uint8_t>& to = levels_[static_cast<std::size_t>(level)];
  const auto row = [](int y, int w) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(w); };
  half_pooled_.assign(row(height, wide), 0);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* a = &from[row(y, width)];
    std::uint8_t* t = &half_pooled_[row(y, wide)];
    std::copy(a, a + width, t + half);
    for (int x = 0; x < width; ++x) t[x] = std::max(t[x], a[x]);
  }
  to.assign(row(height + half, wide), 0);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* t = &half_pooled_[row(y, wide)];
    std::uint8_t* upper = &to[row(y + half, wide)];
    std::uint8_t* lower = &to[row(y, wide)];
    for (int x = 0; x < wide; ++x) {
      upper[x] = std::max(upper[x], t[x]);
      lower[x] = std::max(lower[x], t[x]);
    }
  }
}

double Correlator::value(const std::vector<Cell>& cells, int x, int y, int level) const {
  const int pad = (1 << level) - 1;
  const auto width = static_cast<unsigned>(width_ + pad);
  const auto height = static_cast<unsigned>(height_ + pad);
  const std::uint8_t* raster = levels_[static_cast<std::size_t>(level)].data();
  std::uint32_t sum = 0;
  for (const Cell& c : cells) {
    const auto u = static_cast<unsigned>(c.x + x + pad);
    const auto v = static_cast<unsigned>(c.y + y + pad);
    if (u < width && v < height) sum += raster[static_cast<std::size_t>(v) * width + u];
  }
  return sum / (255.0 * static_cast<double>(cells.size()));
}

double Correlator::bound(const std::vector<Cell>& cells, int x, int y, int level, double floor, Work& looked_at) const {
  constexpr std::size_t kStretch = 48;  ///< cells between two looks at what can still come
  const int pad = (1 << level) - 1;
  const auto width = static_cast<unsigned>(width_ + pad);
  const auto height = static_cast<unsigned>(height_ + pad);
  const std::uint8_t* raster = levels_[static_cast<std::size_t>(level)].data();
  const double whole = 255.0 * static_cast<double>(cells.size());
  const auto enough = static_cast<std::uint32_t>(std::max(0.0, floor * whole));
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < cells.size();) {
    const std::size_t end = std::min(cells.size(), k + kStretch);
    for (; k < end; ++k) {
      const auto u = static_cast<unsigned>(cells[k].x + x + pad);
      const auto v = static_cast<unsigned>(cells[k].y + y + pad);
      if (u < width && v < height) sum += raster[static_cast<std::size_t>(v) * width + u];
    }
    const std::uint32_t most = sum + 255U * static_cast<std::uint32_t>(cells.size() - k);
    if (most > enough) continue;
    looked_at += static_cast<Work>(k);
    return most / whole;
  }
  looked_at += static_cast<Work>(cells.size());
  return sum / whole;
}

void CorrelativeSearch::start(const Correlator& target, const std::vector<OrientedPoint>& points,
                              const SearchWindow& window, double floor, const std::optional<SearchExclusion>& exclusion,
                              double later_floor) {
  target_ = &target;
  points_ = points;
  window_ = window;
  exclusion_ = exclusion;
  float reach = 0.5F;
  for (const OrientedPoint& p : points) reach = std::max(reach, std::sqrt(p.x * p.x + p.y * p.y));
  angle_step_ = std::max(target.resolution() / std::min(static_cast<double>(reach), kLongReach), kFinestAngle);
  angles_ = static_cast<int>(std::ceil(window.angle / angle_step_));
  cells_ = static_cast<int>(std::ceil(window.distance / target.resolution()));
  best_ = floor;
  kept_ = std::min(floor, later_floor);
  found_.reset();
  turned_.clear();
  roots_.clear();
  next_root_ = 0;
  sorted_ = false;
  stack_.clear();
}

void CorrelativeSearch::start_again(double floor, const SearchExclusion& exclusion) {
  exclusion_ = exclusion;
  best_ = std::max(floor, kept_);
  found_.reset();
  next_root_ = 0;
  stack_.clear();
}

bool CorrelativeSearch::advance(Work& budget) {
  used_ = 0;
  if (points_.empty()) return true;
  while (used_ < budget) {
    if (static_cast<int>(turned_.size()) < 2 * angles_ + 1) {
      open_angle();
      continue;
    }
    if (!sorted_) {
      std::sort(roots_.begin(), roots_.end(), better<Node>);
      sorted_ = true;
    }
    if (stack_.empty()) {
      if (next_root_ == roots_.size() || roots_[next_root_].bound <= best_) {
        budget -= used_;
        return true;
      }
      stack_.push_back(roots_[next_root_++]);
    }
    const Node next = stack_.back();
    stack_.pop_back();
    if (next.bound > best_) expand(next);
  }
  budget -= used_;
  return false;
}

/// Turns the points to the next angle and bounds the coarsest squares there.
void CorrelativeSearch::open_angle() {
  const int index = static_cast<int>(turned_.size());
  const double phi = window_.centre.phi + (index - angles_) * angle_step_;
  const auto c = static_cast<float>(std::cos(phi));
  const auto s = static_cast<float>(std::sin(phi));
  const auto x = static_cast<float>(window_.centre.x);
  const auto y = static_cast<float>(window_.centre.y);
  std::vector<Cell>& cells = turned_.emplace_back();
  cells.reserve(points_.size());
  for (const OrientedPoint& p : points_) cells.push_back(target_->cell(c * p.x - s * p.y + x, s * p.x + c * p.y + y));
  for (int v = -cells_; v <= cells_; v += kSpan)
    for (int u = -cells_; u <= cells_; u += kSpan) {
      const Node root = node(index, u, v, kTopLevel, kept_);
      if (root.bound > kept_) roots_.push_back(root);
    }
}

CorrelativeSearch::Node CorrelativeSearch::node(int angle, int x, int y, int level, double floor) {
  Work looked_at = 0;
  const double bound = target_->bound(turned_[static_cast<std::size_t>(angle)], x, y, level, floor, looked_at);
  used_ += kWorkPerLookup * looked_at;
  return {angle, x, y, level, bound};
}

void CorrelativeSearch::expand(const Node& parent) {
  if (parent.level == 0) {
    const TPose2D pose = pose_of(parent);
    if (excluded(pose)) return;
    best_ = parent.bound;
    found_ = Found{pose, parent.bound};
    return;
  }
  const int half = 1 << (parent.level - 1);
  const auto before = static_cast<std::ptrdiff_t>(stack_.size());
  for (int v = 0; v < 2; ++v)
    for (int u = 0; u < 2; ++u) {
      const int x = parent.x + u * half;
      const int y = parent.y + v * half;
      if (x <= cells_ && y <= cells_) stack_.push_back(node(parent.angle, x, y, parent.level - 1, best_));
    }
  // The best on top.
  std::sort(stack_.begin() + before, stack_.end(), [](const Node& a, const Node& b) { return better(b, a); });
}

TPose2D CorrelativeSearch::pose_of(const Node& node) const {
  const double cell = target_->resolution();
  return {window_.centre.x + node.x * cell, window_.centre.y + node.y * cell,
          wrap_angle(window_.centre.phi + (node.angle - angles_) * angle_step_)};
}

bool CorrelativeSearch::excluded(const TPose2D& pose) const {
  return exclusion_ && length(pose.x - exclusion_->pose.x, pose.y - exclusion_->pose.y) < exclusion_->distance &&
         std::abs(wrap_angle(pose.phi - exclusion_->pose.phi)) < exclusion_->angle;
}

std::optional<CorrelativeSearch::Found> search(const Correlator& target, const std::vector<OrientedPoint>& points,
                                               const SearchWindow& window, double floor,
                                               const std::optional<SearchExclusion>& exclusion, Work* work) {
  CorrelativeSearch search;
  search.start(target, points, window, floor, exclusion);
  Work budget = std::numeric_limits<Work>::max();
  search.advance(budget);
  if (work != nullptr) *work += std::numeric_limits<Work>::max() - budget;
  return search.found();
}

}  // namespace rubble::slam
