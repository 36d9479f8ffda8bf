#include "slam/robust/matching/correlator.h"

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
constexpr int kCoarseBits = 2;
constexpr int kCoarse = 1 << kCoarseBits;                          ///< cells a side of one for the roots
constexpr int kCoarseSees = Correlator::kRootCells + kCoarse - 1;  ///< cells a side that such a one must see
constexpr int kCoarsePad = (kCoarseSees + kCoarse - 2) / kCoarse;  ///< below and left, in coarse cells
constexpr int kStepBits = 2;
constexpr int kStep = 1 << kStepBits;  ///< from root to root, in coarse cells
static_assert(kStep * kCoarse == Correlator::kRootCells);
constexpr int kGroup = 16;              ///< roots in a row that are summed at once
constexpr std::uint32_t kFine = 63;     ///< the coarse raster's values are rounded up to 63rds ...
constexpr std::size_t kSafe = 4;        ///< ... so that so many of them add up within a byte
constexpr std::size_t kSafeSums = 256;  ///< bytes whose sum fits in 16 bits
constexpr double kMostCells = 2.4e6;    ///< of a raster, but for its border: the widest hall measured has 2.3 million
constexpr double kCoarseCells = 1.2e6;  ///< of one that would have more
constexpr double kApartCells = 2.5;     ///< places that are closer are one peak of the raster
constexpr double kLeastBlur = 1.0;      ///< of a raster that is coarser than asked for, in its cells
constexpr Work kCellsPerWork = 2;       ///< of pooling a raster
constexpr Work kWorkPerSurfel = 30;
constexpr Work kWorkPerLookup = 6;  ///< of the four quarters at one point
constexpr Work kWorkPerTurn = 6;    ///< of a point
constexpr Work kRootsPerWork = 4;   ///< of a point in a root

/// Best first; ties by place, so that the order never depends on the sorting.
template <class Node>
bool better(const Node& a, const Node& b) {
  if (a.bound != b.bound) return a.bound > b.bound;
  if (a.angle != b.angle) return a.angle < b.angle;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

int whole_groups(int cells) { return (cells + kGroup - 1) / kGroup * kGroup; }

std::size_t plane(int width, int height) { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

/// The resolution asked for, or a coarser one where the raster would have too many cells.
double affordable(double resolution, const Correlator::Extent& extent) {
  const double width = static_cast<double>(extent.high_x) - static_cast<double>(extent.low_x);
  const double height = static_cast<double>(extent.high_y) - static_cast<double>(extent.low_y);
  const double area = width * height;
  return area > kMostCells * resolution * resolution ? std::sqrt(area / kCoarseCells) : resolution;
}

Correlator::Extent extent_of(const std::vector<Surfel>& surfels) {
  if (surfels.empty()) return {};
  constexpr float kMost = std::numeric_limits<float>::max();
  Correlator::Extent extent{kMost, kMost, -kMost, -kMost};
  for (const Surfel& q : surfels) {
    extent.low_x = std::min(extent.low_x, q.x);
    extent.low_y = std::min(extent.low_y, q.y);
    extent.high_x = std::max(extent.high_x, q.x);
    extent.high_y = std::max(extent.high_y, q.y);
  }
  return extent;
}

}  // namespace

void Correlator::build(const std::vector<Surfel>& surfels, double resolution, double blur, Work* work) {
  const Extent extent = extent_of(surfels);
  resolution_ = affordable(resolution, extent);
  coarser_ = resolution_ / resolution;
  per_m_ = static_cast<float>(1.0 / resolution_);
  if (coarser_ > 1.0) blur = std::max(blur, kLeastBlur * resolution_);
  const int reach = std::max(1, static_cast<int>(std::ceil(kBlurReach * blur / resolution_)));
  lay_out(extent, reach);
  draw(surfels, blur, reach);
  for (int level = 1; level < kLevels; ++level) pool(level);
  pool_roots();
  if (work != nullptr) {
    *work += kLevels * static_cast<Work>(plane(width_, height_)) / kCellsPerWork;
    *work += kWorkPerSurfel * static_cast<Work>(surfels.size());
  }
}

/// How large the planes are, and where they lie.
void Correlator::lay_out(const Extent& extent, int reach) {
  const auto border = static_cast<float>((reach + 1) * resolution_);
  x0_ = extent.low_x - border;
  y0_ = extent.low_y - border;
  const int side = 2 * reach + 1;
  width_ = static_cast<int>((extent.high_x - x0_) * per_m_) + reach + 2 + whole_groups(side) - side;
  height_ = static_cast<int>((extent.high_y - y0_) * per_m_) + reach + 2;
  coarse_columns_ = (width_ - 1) / kCoarse + 1 + kCoarsePad;
  coarse_height_ = (height_ - 1) / kCoarse + 1 + kCoarsePad + 2;  // an empty row below and above
  coarse_stride_ = (coarse_columns_ + kStep - 1) / kStep + 2 * kGroup;

  std::array<std::size_t, kLevels + 1> begin{};
  for (int level = 0; level < kLevels; ++level) {
    const int pad = (1 << level) - 1;
    begin[static_cast<std::size_t>(level) + 1] =
        begin[static_cast<std::size_t>(level)] + plane(width_ + pad, height_ + pad);
  }
  std::uint8_t* const memory = memory_.hold(begin[kLevels] + kStep * plane(coarse_stride_, coarse_height_));
  for (std::size_t level = 0; level < levels_.size(); ++level) levels_[level] = memory + begin[level];
  coarse_ = memory + begin[kLevels];
}

void Correlator::draw(const std::vector<Surfel>& surfels, double blur, int reach) {
  const int side = 2 * reach + 1;
  const int row = whole_groups(side);  // of bytes, which are drawn at once
  std::fill_n(levels_[0], plane(width_, height_), std::uint8_t{0});

  std::vector<std::uint8_t> spot(static_cast<std::size_t>(side * row), 0);
  for (int v = -reach; v <= reach; ++v)
    for (int u = -reach; u <= reach; ++u) {
      const double d2 = (u * u + v * v) * resolution_ * resolution_;
      spot[static_cast<std::size_t>((v + reach) * row + u + reach)] =
          static_cast<std::uint8_t>(255.0 * std::exp(-0.5 * d2 / (blur * blur)));
    }
  for (const Surfel& q : surfels) {
    const Cell c = cell(q.x, q.y);
    std::uint8_t* to = &levels_[0][static_cast<std::size_t>(c.y - reach) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(c.x - reach)];
    const std::uint8_t* from = spot.data();
    for (int v = 0; v < side; ++v, to += width_)
      for (int group = 0; group < row; group += kGroup, from += kGroup)
        for (int u = 0; u < kGroup; ++u) to[group + u] = std::max(to[group + u], from[u]);
  }
}

namespace {

/// One row of pool(): doubles it and joins it with the one that was doubled `half` rows before, which it replaces.
/// Plain arrays in one pass: vector code.
void pool_row(const std::uint8_t* __restrict row, int width, int half, std::uint8_t* __restrict doubled,
              std::uint8_t* __restrict out) {
  const auto put = [&](int x, std::uint8_t value) {
    out[x] = std::max(doubled[x], value);
    doubled[x] = value;
  };
  // What begins at x sees row[x] and, `half` further, row[x + half].
  for (int x = 0; x < half; ++x) put(x, row[x]);
  for (int x = half; x < width; ++x) put(x, std::max(row[x], row[x - half]));
  for (int x = width; x < width + half; ++x) put(x, row[x - half]);
}

}  // namespace

/// Doubles the squares: first along the rows, then along the columns.
void Correlator::pool(int level) {
  const int half = 1 << (level - 1);
  const int width = width_ + half - 1;
  const int height = height_ + half - 1;
  const int wide = width + half;
  const std::uint8_t* const from = levels_[static_cast<std::size_t>(level - 1)];
  std::uint8_t* const to = levels_[static_cast<std::size_t>(level)];
  const auto row = [](int y, int w) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(w); };
  half_pooled_.assign(row(half, wide), 0);  // the last rows, in a ring
  for (int y = 0; y < height + half; ++y) {
    std::uint8_t* const doubled = &half_pooled_[row(y % half, wide)];
    std::uint8_t* const out = &to[row(y, wide)];
    if (y < height)
      pool_row(&from[row(y, width)], width, half, doubled, out);
    else
      std::copy(doubled, doubled + wide, out);
  }
}

/// Squares of kCoarseSees cells are the union of three of the top level along each axis.
void Correlator::pool_roots() {
  constexpr int kSees = 1 << kTopLevel;
  constexpr int kPad = kSees - 1;
  constexpr std::array<int, 3> kParts{0, kSees, kCoarseSees - kSees};
  static_assert(kCoarseSees <= 3 * kSees && kCoarseSees >= 2 * kSees);
  const int width = width_ + kPad;
  const int height = height_ + kPad;
  const std::uint8_t* const top = levels_[kTopLevel];
  const int columns = coarse_columns_;
  const std::size_t coarse_plane = plane(coarse_stride_, coarse_height_);
  std::fill_n(coarse_, kStep * coarse_plane, std::uint8_t{0});
  // Columns of the top level from -kCoarsePad * kCoarse on, with room for the last square.
  const int shift = kCoarsePad * kCoarse - kPad;
  std::vector<std::uint8_t> row(static_cast<std::size_t>(columns * kCoarse + kCoarseSees + shift + width), 0);
  std::vector<std::uint8_t> sees(static_cast<std::size_t>(columns * kCoarse));  // from each cell of the row on
  std::array<std::uint8_t, 256> fine{};
  for (std::uint32_t value = 0; value < fine.size(); ++value)
    fine[value] = static_cast<std::uint8_t>((value * kFine + 254U) / 255U);
  for (int y = 1; y + 1 < coarse_height_; ++y) {
    std::fill(row.begin(), row.end(), std::uint8_t{0});
    for (const int part : kParts) {
      const int v = (y - 1 - kCoarsePad) * kCoarse + part + kPad;
      if (v < 0 || v >= height) continue;
      const std::uint8_t* from = &top[static_cast<std::size_t>(v) * static_cast<std::size_t>(width)];
      std::uint8_t* to = row.data() + shift;
      for (int x = 0; x < width; ++x) to[x] = std::max(to[x], from[x]);
    }
    const std::uint8_t* const from = row.data();
    for (int x = 0; x < columns * kCoarse; ++x)
      sees[static_cast<std::size_t>(x)] = std::max({from[x + kParts[0]], from[x + kParts[1]], from[x + kParts[2]]});
    std::uint8_t* const to = coarse_ + static_cast<std::size_t>(y) * static_cast<std::size_t>(coarse_stride_) + kGroup;
    for (int x = 0; x < columns; ++x)
      to[static_cast<std::size_t>(x % kStep) * coarse_plane + static_cast<std::size_t>(x / kStep)] =
          fine[sees[static_cast<std::size_t>(x * kCoarse)]];
  }
}

double Correlator::value(const std::vector<Cell>& cells, int x, int y, int level) const {
  const int pad = (1 << level) - 1;
  const auto width = static_cast<unsigned>(width_ + pad);
  const auto height = static_cast<unsigned>(height_ + pad);
  const std::uint8_t* raster = levels_[static_cast<std::size_t>(level)];
  std::uint32_t sum = 0;
  for (const Cell& c : cells) {
    const auto u = static_cast<unsigned>(c.x + x + pad);
    const auto v = static_cast<unsigned>(c.y + y + pad);
    if (u < width && v < height) sum += raster[static_cast<std::size_t>(v) * width + u];
  }
  return sum / (255.0 * static_cast<double>(cells.size()));
}

std::optional<std::array<Correlator::Sums, 4>> Correlator::quarters(const std::vector<Cell>& cells, int x, int y,
                                                                    int level, const Sums& around, std::uint32_t floor,
                                                                    Work& looked_at) const {
  const int half = 1 << level;
  const int pad = half - 1;
  const int width = width_ + pad;
  const int height = height_ + pad;
  const auto stride = static_cast<std::uint32_t>(width);
  const std::uint8_t* const raster = levels_[static_cast<std::size_t>(level)];
  const std::uint8_t* const raster_right = raster + half;
  const std::uint8_t* const raster_up = raster + static_cast<std::size_t>(half) * stride;
  const std::uint8_t* const raster_both = raster_up + half;
  const auto at = [&](int u, int v) -> std::uint32_t {
    const bool inside = u >= 0 && v >= 0 && u < width && v < height;
    return inside ? raster[static_cast<std::uint32_t>(v) * stride + static_cast<std::uint32_t>(u)] : 0U;
  };
  const int shift_x = x + pad, shift_y = y + pad;
  const auto all_inside_x = static_cast<unsigned>(std::max(0, width - half));
  const auto all_inside_y = static_cast<unsigned>(std::max(0, height - half));
  std::array<Sums, 4> sums;
  std::uint32_t promised = around.whole;
  for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
    const std::size_t begin = cells.size() * stretch / kStretches;
    const std::size_t end = cells.size() * (stretch + 1) / kStretches;
    // Sums and corners in variables of their own: so all of the loop fits into registers.
    std::uint32_t here = 0, right = 0, up = 0, both = 0;
    for (const Cell *cell = cells.data() + begin, *last = cells.data() + end; cell != last; ++cell) {
      const int u = cell->x + shift_x;
      const int v = cell->y + shift_y;
      if (static_cast<unsigned>(u) < all_inside_x && static_cast<unsigned>(v) < all_inside_y) {
        const std::uint32_t p = static_cast<std::uint32_t>(v) * stride + static_cast<std::uint32_t>(u);
        here += raster[p];
        right += raster_right[p];
        up += raster_up[p];
        both += raster_both[p];
      } else if (u > -pad - 2 && v > -pad - 2 && u < width && v < height) {
        here += at(u, v);
        right += at(u + half, v);
        up += at(u, v + half);
        both += at(u + half, v + half);
      }
    }
    const std::array<std::uint32_t, 4> part{here, right, up, both};
    looked_at += static_cast<Work>(end - begin);
    promised -= around.parts[stretch];
    std::uint32_t most = 0;
    for (std::size_t q = 0; q < 4; ++q) {
      sums[q].parts[stretch] = part[q];
      sums[q].whole += part[q];
      most = std::max(most, sums[q].whole);
    }
    if (most + promised <= floor) return std::nullopt;
  }
  return sums;
}

namespace {

/// Upper bounds for kGroup squares side by side, from what lies at these places of the coarse raster and behind.
std::array<std::uint32_t, kGroup> sums_of_group(const std::uint8_t* raster, const int* at, const int* end) {
  static_assert(kSafe == 4);
  std::array<std::uint32_t, kGroup> all{};
  while (at != end) {
    std::array<std::uint16_t, kGroup> sums{};
    const int* const safe = at + std::min<std::ptrdiff_t>(end - at, kSafeSums);
    // Four at once, for the compiler then keeps the bytes in a register.
    for (; safe - at >= 4; at += 4) {
      const std::uint8_t *a = raster + at[0], *b = raster + at[1], *c = raster + at[2], *d = raster + at[3];
      for (std::size_t i = 0; i < kGroup; ++i)
        sums[i] = static_cast<std::uint16_t>(sums[i] + static_cast<std::uint8_t>(a[i] + b[i] + c[i] + d[i]));
    }
    for (; at != safe; ++at)
      for (std::size_t i = 0; i < kGroup; ++i)
        sums[i] = static_cast<std::uint16_t>(sums[i] + raster[*at + static_cast<int>(i)]);
    for (std::size_t i = 0; i < kGroup; ++i) all[i] += sums[i];
  }
  for (std::uint32_t& sum : all) sum = (sum * 255U + kFine - 1U) / kFine;
  return all;
}

}  // namespace

void Correlator::roots(const std::vector<Cell>& cells, int x, int y, int columns, int rows, RootWork& work,
                       std::vector<Sums>& out) const {
  out.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), {});
  const std::size_t count = cells.size();
  work.column.resize(count);
  work.row.resize(count);
  work.at.resize(count);
  const int plane = coarse_height_ * coarse_stride_;
  for (int group = 0; group < columns; group += kGroup) {
    const auto used = static_cast<std::size_t>(std::min(kGroup, columns - group));
    for (std::size_t k = 0; k < count; ++k) {
      const int u = ((cells[k].x + x) >> kCoarseBits) + kCoarsePad;
      const int column = (u >> kStepBits) + kGroup + group;
      work.column[k] = (u & (kStep - 1)) * plane + std::clamp(column, 0, coarse_stride_ - kGroup);
      work.row[k] = ((cells[k].y + y) >> kCoarseBits) + kCoarsePad + 1;
    }
    for (int r = 0; r < rows; ++r) {
      for (std::size_t k = 0; k < count; ++k)
        work.at[k] = work.column[k] + std::clamp(work.row[k] + r * kStep, 0, coarse_height_ - 1) * coarse_stride_;
      Sums* const to = &out[static_cast<std::size_t>(r * columns + group)];
      std::array<std::uint32_t, kGroup> whole{};
      for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
        const std::array<std::uint32_t, kGroup> part =
            sums_of_group(coarse_, work.at.data() + count * stretch / kStretches,
                          work.at.data() + count * (stretch + 1) / kStretches);
        for (std::size_t i = 0; i < kGroup; ++i) whole[i] += part[i];
        for (std::size_t i = 0; i < used; ++i) to[i].parts[stretch] = part[i];
      }
      for (std::size_t i = 0; i < used; ++i) to[i].whole = whole[i];
    }
  }
}

void CorrelativeSearch::start(const Correlator& target, const std::vector<OrientedPoint>& points,
                              const SearchWindow& window, double floor, const std::optional<SearchExclusion>& exclusion,
                              double later_floor) {
  target_ = &target;
  // Dealt out, so that each stretch of them tells of all the target.
  points_.clear();
  points_.reserve(points.size());
  for (std::size_t from = 0; from < Correlator::kStretches; ++from)
    for (std::size_t k = from; k < points.size(); k += Correlator::kStretches) points_.push_back(points[k]);
  window_ = window;
  exclusion_ = exclusion;
  float reach = 0.5F;
  for (const OrientedPoint& p : points) reach = std::max(reach, std::sqrt(p.x * p.x + p.y * p.y));
  const double most_reach = kLongReach * target.coarser();
  angle_step_ = std::max(target.resolution() / std::min(static_cast<double>(reach), most_reach), kFinestAngle);
  angles_ = static_cast<int>(std::ceil(window.angle / angle_step_));
  cells_ = static_cast<int>(std::ceil(window.distance / target.resolution()));
  best_ = floor;
  kept_ = std::min(floor, later_floor);
  found_.reset();
  opened_ = 0;
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
    if (opened_ < 2 * angles_ + 1) {
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
  const int index = opened_++;
  const double phi = window_.centre.phi + (index - angles_) * angle_step_;
  const auto c = static_cast<float>(std::cos(phi));
  const auto s = static_cast<float>(std::sin(phi));
  const auto x = static_cast<float>(window_.centre.x);
  const auto y = static_cast<float>(window_.centre.y);
  if (opened_ > static_cast<int>(turned_.size())) turned_.emplace_back();
  std::vector<Cell>& cells = turned_[static_cast<std::size_t>(index)];
  cells.resize(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const OrientedPoint& p = points_[k];
    cells[k] = target_->cell(c * p.x - s * p.y + x, s * p.x + c * p.y + y);
  }
  const int side = 2 * cells_ / Correlator::kRootCells + 1;
  target_->roots(cells, -cells_, -cells_, side, side, root_work_, bounds_);
  used_ += static_cast<Work>(cells.size()) * (kWorkPerTurn + side * side / kRootsPerWork + side);
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      const Correlator::Sums& sums = bounds_[static_cast<std::size_t>(v * side + u)];
      const double bound = score(sums);
      if (bound > kept_)
        roots_.push_back({index, u * Correlator::kRootCells - cells_, v * Correlator::kRootCells - cells_,
                          kTopLevel + 1, bound, sums});
    }
}

double CorrelativeSearch::score(const Correlator::Sums& sums) const {
  return sums.whole / (255.0 * static_cast<double>(points_.size()));
}

void CorrelativeSearch::expand(const Node& parent) {
  if (parent.level == 0) {
    const TPose2D pose = pose_of(parent);
    if (excluded(pose)) return;
    best_ = parent.bound;
    found_ = Found{pose, parent.bound};
    return;
  }
  const int level = parent.level - 1;
  const int half = 1 << level;
  const auto floor = static_cast<std::uint32_t>(std::max(0.0, best_) * 255.0 * static_cast<double>(points_.size()));
  Work looked_at = 0;
  const auto quarters = target_->quarters(turned_[static_cast<std::size_t>(parent.angle)], parent.x, parent.y, level,
                                          parent.sums, floor, looked_at);
  used_ += kWorkPerLookup * looked_at;
  if (!quarters) return;
  const auto before = static_cast<std::ptrdiff_t>(stack_.size());
  for (std::size_t q = 0; q < 4; ++q) {
    const int x = parent.x + ((q & 1) != 0 ? half : 0);
    const int y = parent.y + ((q & 2) != 0 ? half : 0);
    const double bound = score((*quarters)[q]);
    if (x <= cells_ && y <= cells_ && bound > best_)
      stack_.push_back({parent.angle, x, y, level, bound, (*quarters)[q]});
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
  if (!exclusion_) return false;
  const double apart = std::max(exclusion_->distance, kApartCells * target_->resolution());
  return length(pose.x - exclusion_->pose.x, pose.y - exclusion_->pose.y) < apart &&
         std::abs(wrap_angle(pose.phi - exclusion_->pose.phi)) < exclusion_->angle;
}

void RivalSearch::start(const Correlator& target, const std::vector<OrientedPoint>& points,
                        const SearchWindow& window) {
  best_.reset();
  search_.start(target, points, window, config_.least_score, std::nullopt, config_.share * config_.least_score);
  stage_ = Stage::Best;
}

bool RivalSearch::advance(Work& budget) {
  while (running() && budget > 0) {
    if (!search_.advance(budget)) return false;
    const bool first = stage_ == Stage::Best;
    stage_ = Stage::Idle;
    if (!first || !search_.found()) continue;
    best_ = search_.found();
    search_.start_again(config_.share * best_->score, {best_->pose, config_.distance, config_.angle});
    stage_ = Stage::Rival;
  }
  return !running();
}

}  // namespace rubble::slam
