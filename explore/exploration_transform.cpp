#include "explore/exploration_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace rubble::explore {
namespace {

// Steps of 12 : 17 come within 0.2 % of 1 : sqrt(2); four times that, so that discomfort is resolved to 1 %.
constexpr int kStraight = 4 * 12;
constexpr int kDiagonal = 4 * 17;
constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr float kMaxWeight = 60.0f;  // a diagonal step must stay below the number of buckets
constexpr double kRounding = 1e-4;   // [m] 7 cells of 0.05 m are 0.35 m, also in float

static_assert(kDiagonal * 60 < 4096, "Dial's queue needs more buckets than the dearest step costs");

unsigned lowest_bit(std::uint64_t word) { return static_cast<unsigned>(__builtin_ctzll(word)); }

}  // namespace

double danger(double d, const TransformConfig& config) {
  if (d < config.d_min - kRounding) return std::numeric_limits<double>::infinity();
  return (config.d_opt - d) * (config.d_opt - d);  // eq. (4)
}

void ExplorationTransform::prepare(const Traversable& floor, const TransformConfig& config) {
  assert(floor.clearance.frame() == floor.frame());
  frame_ = floor.frame();
  step_.resize(frame_.size());
  cost_.resize(frame_.size());
  entries_.clear();
  head_.fill(kNone);
  filled_.fill(0);
  filled_words_ = 0;

  const float alpha = static_cast<float>(config.alpha);
  const float d_min = static_cast<float>(config.d_min - kRounding);
  const float d_opt = static_cast<float>(config.d_opt);
  const Occupancy* cells = floor.cells.data();
  const float* clearance = floor.clearance.data();
  for (std::size_t i = 0; i < frame_.size(); ++i) {
    const float d = clearance[i];
    const bool passable = cells[i] == Occupancy::Free && d >= d_min;
    const float discomfort = (d_opt - d) * (d_opt - d);  // eq. (4)
    const float weight = passable ? std::min(1.0f + alpha * discomfort, kMaxWeight) : 0.0f;
    step_[i].straight = static_cast<std::uint16_t>(weight * kStraight + 0.5f);
    step_[i].diagonal = static_cast<std::uint16_t>(weight * kDiagonal + 0.5f);
    cost_[i] = passable ? kFar : 0;  // zero is never undercut: impassable cells need no test in the inner loop
  }
}

void ExplorationTransform::push(std::uint32_t cell, std::uint32_t cost) {
  const std::uint32_t bucket = cost % kBuckets;
  entries_.push_back({cell, head_[bucket]});
  head_[bucket] = static_cast<std::uint32_t>(entries_.size() - 1);
  filled_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
  filled_words_ |= std::uint64_t{1} << (bucket / 64);
}

/// The lowest cost >= `from` that has entries; kFar: the queue is empty. All costs in it lie in [from, from +
/// kBuckets).
std::uint32_t ExplorationTransform::next_cost(std::uint32_t from) const {
  if (filled_words_ == 0) return kFar;
  const std::uint32_t start = from % kBuckets;
  const std::uint64_t here = filled_[start / 64] >> (start % 64);
  if (here != 0) return from + lowest_bit(here);
  const std::uint32_t word = start / 64;
  const std::uint64_t after = word == 63 ? 0 : filled_words_ & (~std::uint64_t{0} << (word + 1));
  const std::uint32_t found = lowest_bit(after != 0 ? after : filled_words_);
  const std::uint32_t bucket = found * 64 + lowest_bit(filled_[found]);
  return from + (bucket + kBuckets - start) % kBuckets;
}

void ExplorationTransform::expand(const std::vector<Start>& starts, std::uint32_t until) {
  const std::int32_t width = frame_.width;
  std::size_t next_start = 0;
  for (std::uint32_t cost = 0;;) {
    std::uint32_t upcoming = next_cost(cost);
    while (next_start < starts.size() && starts[next_start].cost <= upcoming) {
      const Start& s = starts[next_start++];
      if (s.cost >= cost_[s.cell]) continue;
      cost_[s.cell] = s.cost;
      push(s.cell, s.cost);
      upcoming = s.cost;
    }
    if (upcoming == kFar) return;
    cost = upcoming;

    const std::uint32_t bucket = cost % kBuckets;
    std::uint32_t entry = head_[bucket];
    head_[bucket] = kNone;
    filled_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
    if (filled_[bucket / 64] == 0) filled_words_ &= ~(std::uint64_t{1} << (bucket / 64));

    while (entry != kNone) {
      const std::uint32_t c = entries_[entry].cell;
      entry = entries_[entry].next;
      if (cost_[c] != cost) continue;  // a cheaper way was found meanwhile
      if (c == until) return;
      const auto relax = [&](std::int32_t offset, std::uint16_t StepCost::*step) {
        const std::uint32_t n = c + static_cast<std::uint32_t>(offset);
        const std::uint32_t through = cost + step_[n].*step;
        if (through >= cost_[n]) return;
        cost_[n] = through;  // eq. (3)
        push(n, through);
      };
      relax(-1, &StepCost::straight);
      relax(1, &StepCost::straight);
      relax(-width, &StepCost::straight);
      relax(width, &StepCost::straight);
      relax(-width - 1, &StepCost::diagonal);
      relax(-width + 1, &StepCost::diagonal);
      relax(width - 1, &StepCost::diagonal);
      relax(width + 1, &StepCost::diagonal);
    }
  }
}

void ExplorationTransform::run(const Traversable& floor, const std::vector<Source>& sources,
                               const TransformConfig& config, std::optional<Cell> until) {
  prepare(floor, config);
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

bool ExplorationTransform::passable(Cell c) const { return frame_.inside(c) && step_[index(c)].straight != 0; }

bool ExplorationTransform::reached(Cell c) const { return passable(c) && cost_[index(c)] != kFar; }

double ExplorationTransform::cost(Cell c) const {
  if (!reached(c)) return std::numeric_limits<double>::infinity();
  return static_cast<double>(cost_[index(c)]) / kStraight * frame_.resolution;
}

std::vector<Cell> ExplorationTransform::descend(Cell from) const {
  std::vector<Cell> way;
  if (!reached(from)) return way;
  Cell direction{0, 0};
  for (Cell c = from;;) {
    way.push_back(c);
    // The neighbour this cell got its cost from; straight on where several did.
    const std::uint32_t cost = cost_[index(c)];
    std::optional<Cell> best;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if ((dx == 0 && dy == 0) || !reached(n)) continue;
        const StepCost step = step_[index(c)];
        const std::uint32_t through = cost_[index(n)] + (dx != 0 && dy != 0 ? step.diagonal : step.straight);
        if (through == cost && (!best || Cell{dx, dy} == direction)) best = Cell{dx, dy};
      }
    if (!best) return way;
    direction = *best;
    c = {c.x + direction.x, c.y + direction.y};
  }
}

}  // namespace rubble::explore
