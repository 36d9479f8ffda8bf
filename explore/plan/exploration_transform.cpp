#include "explore/plan/exploration_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace rubble::explore {
namespace {

// Steps of 12 : 17 come within 0.2 % of 1 : sqrt(2); six times that, so that discomfort is resolved to 1 %.
constexpr int kStraight = 6 * 12;
constexpr int kDiagonal = 6 * 17;
constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr float kMaxWeight = 60.0f;  ///< of a metre; dearer ones would not fit into the ring of buckets

// No step is cheaper than a bucket is wide: cells of one bucket cannot improve each other, so their order is free.
constexpr std::uint32_t kBucketWidth = 64;
static_assert(kBucketWidth <= kStraight);

unsigned lowest_bit(unsigned word) { return static_cast<unsigned>(__builtin_ctz(word)); }

/// Eq. (4) where it is finite, in the precision asked for.
template <typename Real>
Real discomfort(Real d, Real d_opt) {
  const Real from_best = d_opt - d;
  return from_best * from_best;
}

}  // namespace

double danger(double d, const TransformConfig& config) {
  if (!(d >= config.d_min - kClearanceRounding)) return std::numeric_limits<double>::infinity();
  return discomfort(d, config.d_opt);
}

void ExplorationTransform::prepare(const Traversable& floor, const TransformConfig& config) {
  assert(floor.clearance.frame() == floor.frame());
  frame_ = floor.frame();
  nodes_.resize(frame_.size());
  for (std::vector<std::uint32_t>& bucket : buckets_) bucket.clear();

  const float alpha = static_cast<float>(config.alpha);
  const Occupancy* cells = floor.cells.data();
  const float* clearance = floor.clearance.data();
  const auto least = static_cast<float>(config.d_min - kClearanceRounding);
  const auto best = static_cast<float>(config.d_opt);
  Node* const nodes = nodes_.data();
  for (std::size_t i = 0, count = frame_.size(); i < count; ++i) {  // free of branches, which walls would mispredict
    const bool open = (cells[i] == Occupancy::Free) & (clearance[i] >= least);
    const float comfortable = std::min(1.0f + alpha * discomfort(clearance[i], best), kMaxWeight);
    const float weight = open ? comfortable : 0.0f;
    // A cost of zero is never undercut: impassable cells need no test in the inner loop.
    nodes[i] = {open ? kFar : 0, static_cast<std::uint16_t>(static_cast<int>(weight * kStraight + 0.5f)),
                static_cast<std::uint16_t>(static_cast<int>(weight * kDiagonal + 0.5f))};
  }
}

void ExplorationTransform::push(std::uint32_t cell, std::uint32_t cost) {
  buckets_[cost / kBucketWidth % kBuckets].push_back(cell);
}

std::uint32_t ExplorationTransform::next_bucket(std::uint32_t from) const {
  for (std::uint32_t b = from; b < from + kBuckets; ++b)
    if (!buckets_[b % kBuckets].empty()) return b;
  return kFar;
}

void ExplorationTransform::expand(const std::vector<Start>& starts, std::uint32_t until) {
  const std::int32_t width = frame_.width;
  const std::int32_t offset[8] = {-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1};
  constexpr unsigned kIsDiagonal = 0b10100101;
  Node* const nodes = nodes_.data();
  std::size_t next_start = 0;
  for (std::uint32_t now = 0;;) {
    std::uint32_t upcoming = next_bucket(now);
    for (; next_start < starts.size() && starts[next_start].cost / kBucketWidth <= upcoming; ++next_start) {
      const Start& start = starts[next_start];
      if (start.cost >= nodes[start.cell].cost) continue;
      nodes[start.cell].cost = start.cost;
      push(start.cell, start.cost);
      upcoming = start.cost / kBucketWidth;
    }
    if (upcoming == kFar) return;
    now = upcoming;

    std::vector<std::uint32_t>& bucket = buckets_[now % kBuckets];
    for (const std::uint32_t c : bucket) {
      const std::uint32_t cost = nodes[c].cost;
      if (cost / kBucketWidth != now) continue;  // it was done when a cheaper way had been found
      // First find which neighbours gain, without branches (they would often be mispredicted), then visit those.
      const auto gain = [&](unsigned i, std::uint16_t Node::*step) {
        const Node& node = nodes[c + static_cast<std::uint32_t>(offset[i])];
        return static_cast<unsigned>(cost + node.*step < node.cost) << i;
      };
      unsigned gains = gain(0, &Node::diagonal) | gain(1, &Node::straight) | gain(2, &Node::diagonal) |
                       gain(3, &Node::straight) | gain(4, &Node::straight) | gain(5, &Node::diagonal) |
                       gain(6, &Node::straight) | gain(7, &Node::diagonal);
      for (; gains != 0; gains &= gains - 1) {
        const unsigned i = lowest_bit(gains);
        const std::uint32_t n = c + static_cast<std::uint32_t>(offset[i]);
        Node& node = nodes[n];
        node.cost = cost + ((kIsDiagonal >> i & 1u) != 0 ? node.diagonal : node.straight);  // eq. (3)
        push(n, node.cost);
      }
    }
    bucket.clear();
    if (until != kNone && nodes[until].cost / kBucketWidth <= now) return;
  }
}

void ExplorationTransform::run(const Traversable& floor, const std::vector<Source>& sources,
                               const TransformConfig& config, std::optional<Cell> until) {
  prepare(floor, config);
  per_cell_.clear();
  if (config.discomfort == Discomfort::PerCell) return run_per_cell(floor, sources, config);
  std::vector<Start> starts;
  starts.reserve(sources.size());
  for (const Source& s : sources) {
    if (!passable(s.cell)) continue;
    const double cost = std::max(s.head_start, 0.0) / frame_.resolution * kStraight;
    starts.push_back({static_cast<std::uint32_t>(std::lround(cost)), static_cast<std::uint32_t>(index(s.cell))});
  }
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  expand(starts, until && frame_.inside(*until) ? static_cast<std::uint32_t>(index(*until)) : kNone);
}

/// cost(c) = alpha c_danger(c) + min over the neighbours n of (length of the step + cost(n)), eq. (3) unrolled: the sum
/// runs over all cells of the way.
void ExplorationTransform::run_per_cell(const Traversable& floor, const std::vector<Source>& sources,
                                        const TransformConfig& config) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  per_cell_.assign(frame_.size(), kInfinite);
  towards_.resize(frame_.size());
  const auto own = [&](std::size_t i) { return config.alpha * danger(floor.clearance.data()[i], config); };
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto offer = [&](std::uint32_t cell, double cost, std::uint32_t towards) {
    if (cost >= per_cell_[cell]) return;
    per_cell_[cell] = cost;
    towards_[cell] = towards;
    queue.push({cost, cell});
  };
  for (const Source& s : sources) {
    if (!passable(s.cell)) continue;
    const auto cell = static_cast<std::uint32_t>(index(s.cell));
    offer(cell, std::max(s.head_start, 0.0) + own(cell), cell);
  }
  const double straight = frame_.resolution, diagonal = std::sqrt(2.0) * frame_.resolution;
  while (!queue.empty()) {
    const auto [cost, cell] = queue.top();
    queue.pop();
    if (cost > per_cell_[cell]) continue;
    const Cell c{static_cast<int>(cell) % frame_.width, static_cast<int>(cell) / frame_.width};
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if ((dx == 0 && dy == 0) || !passable(n)) continue;
        const auto to = static_cast<std::uint32_t>(index(n));
        offer(to, cost + (dx != 0 && dy != 0 ? diagonal : straight) + own(to), cell);
      }
  }
}

bool ExplorationTransform::passable(Cell c) const { return frame_.inside(c) && nodes_[index(c)].straight != 0; }

bool ExplorationTransform::reached(Cell c) const {
  if (!passable(c)) return false;
  return per_cell_.empty() ? nodes_[index(c)].cost != kFar : std::isfinite(per_cell_[index(c)]);
}

double ExplorationTransform::cost(Cell c) const {
  if (!reached(c)) return std::numeric_limits<double>::infinity();
  if (!per_cell_.empty()) return per_cell_[index(c)];
  return static_cast<double>(nodes_[index(c)].cost) / kStraight * frame_.resolution;
}

std::vector<Cell> ExplorationTransform::descend(Cell from) const {
  std::vector<Cell> way;
  if (!reached(from)) return way;
  if (!per_cell_.empty()) {
    for (auto cell = static_cast<std::uint32_t>(index(from));; cell = towards_[cell]) {
      way.push_back({static_cast<int>(cell) % frame_.width, static_cast<int>(cell) / frame_.width});
      if (towards_[cell] == cell) return way;
    }
  }
  Cell direction{0, 0};
  for (Cell c = from;;) {
    way.push_back(c);
    // The neighbour this cell got its cost from; straight on where several did.
    const Node& own = nodes_[index(c)];
    std::optional<Cell> best;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if ((dx == 0 && dy == 0) || !reached(n)) continue;
        const std::uint32_t through = nodes_[index(n)].cost + (dx != 0 && dy != 0 ? own.diagonal : own.straight);
        if (through == own.cost && (!best || Cell{dx, dy} == direction)) best = Cell{dx, dy};
      }
    if (!best) return way;
    direction = *best;
    c = {c.x + direction.x, c.y + direction.y};
  }
}

}  // namespace rubble::explore
