#include "base/distance_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace rubble {
namespace {

using Steps = std::uint16_t;  ///< distance along a column or row [cells]

/// Distance to the nearest set cell of the same column, at most `limit`. Whole rows at a time: vector code.
Grid<Steps> column_distance(const Grid<std::uint8_t>& mask, Steps limit) {
  const int width = mask.width();
  const int height = mask.height();
  Grid<Steps> steps(mask.frame());
  const std::vector<Steps> outside(static_cast<std::size_t>(width), limit);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* const set = mask.row(y);
    const Steps* const below = y > 0 ? steps.row(y - 1) : outside.data();
    Steps* const row = steps.row(y);
    for (int x = 0; x < width; ++x) {
      const auto next = static_cast<Steps>(below[x] + (below[x] < limit ? 1 : 0));
      row[x] = set[x] != 0 ? Steps{0} : next;
    }
  }
  for (int y = height - 2; y >= 0; --y) {
    const Steps* const above = steps.row(y + 1);
    Steps* const row = steps.row(y);
    for (int x = 0; x < width; ++x) {
      const auto next = static_cast<Steps>(above[x] + (above[x] < limit ? 1 : 0));
      row[x] = std::min(row[x], next);
    }
  }
  return steps;
}

/// Squared distances of one row from its column distances, cell by cell outwards: min over dx of steps(x + dx)^2 +
/// dx^2. A cell at most n steps from a set cell of its column need not look further than n, and a block of cells stops
/// looking as soon as dx^2 alone exceeds what all of them have. Exact for distances up to kReach.
class WindowRow {
 public:
  static constexpr int kReach = 127;  ///< kReach^2 + kReach^2 fits in 16 bits

  explicit WindowRow(int width)
      : width_(width), squares_(static_cast<std::size_t>(width + 2 * kReach + kBlock), kReach * kReach) {}

  void load(const Steps* steps) {
    for (int x = 0; x < width_; ++x) {
      const int s = std::min<int>(steps[x], kReach);
      squares_[static_cast<std::size_t>(kReach + x)] = static_cast<std::int16_t>(s * s);
    }
  }

  template <class Emit>
  void transform(Emit emit) const {
    for (int start = 0; start < width_; start += kBlock) {
      const std::int16_t* const centre = squares_.data() + kReach + start;
      const int count = std::min(kBlock, width_ - start);
      std::int16_t best[kBlock];
      std::copy_n(centre, kBlock, best);
      int largest = *std::max_element(best, best + count);
      for (int dx = 1; dx * dx < largest; dx += kBatch) {
        for (int i = dx; i < dx + kBatch; ++i) widen(centre, std::min(i, kReach), best);
        std::int16_t top = 0;
        for (int x = 0; x < count; ++x) top = std::max(top, best[x]);
        largest = top;
      }
      emit(start, count, best);
    }
  }

 private:
  static constexpr int kBlock = 64;
  static constexpr int kBatch = 4;

  static void widen(const std::int16_t* centre, int dx, std::int16_t* best) {
    const auto square = static_cast<std::int16_t>(dx * dx);
    for (int x = 0; x < kBlock; ++x) {
      const std::int16_t nearer = std::min(centre[x - dx], centre[x + dx]);
      best[x] = std::min(best[x], static_cast<std::int16_t>(nearer + square));
    }
  }

  int width_;
  std::vector<std::int16_t> squares_;
};

/// The same by the lower envelope of the parabolas steps(x)^2 + (. - x)^2, for distances of any length.
/// Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions", algorithm 1.
class EnvelopeRow {
 public:
  explicit EnvelopeRow(int width) : width_(width), parabolas_(static_cast<std::size_t>(width)) {}

  /// `limit`: steps of a column without a set cell. Calls emit(x, squared distance); -1: no set cell in any column.
  template <class Emit>
  void transform(const Steps* steps, Steps limit, Emit emit) {
    std::size_t count = 0;
    for (int x = 0; x < width_; ++x) {
      if (steps[x] == limit) continue;
      const double square = static_cast<double>(steps[x]) * steps[x];
      const double key = square + static_cast<double>(x) * x;
      double from = -1.0;
      while (count > 0) {
        const Parabola& last = parabolas_[count - 1];
        from = (key - last.key) / (2.0 * (x - last.x));
        if (from > last.from) break;
        --count;
      }
      parabolas_[count++] = {x, square, key, count == 1 ? -1.0 : from};
    }
    if (count == 0) {
      for (int x = 0; x < width_; ++x) emit(x, -1.0);
      return;
    }
    std::size_t i = 0;
    for (int x = 0; x < width_; ++x) {
      while (i + 1 < count && parabolas_[i + 1].from < x) ++i;
      const double dx = x - parabolas_[i].x;
      emit(x, parabolas_[i].square + dx * dx);
    }
  }

 private:
  struct Parabola {
    int x;
    double square;
    double key;   ///< square + x^2
    double from;  ///< it is the lowest right of here
  };
  int width_;
  std::vector<Parabola> parabolas_;
};

}  // namespace

Grid<float> distance_transform(const Grid<std::uint8_t>& mask, double cap) {
  const int width = mask.width();
  const int height = mask.height();
  assert(cap >= 0.0 && width + height < 65535);
  Grid<float> distance(mask.frame());
  // Everything from `limit` cells on is at the cap; no two cells are width + height apart.
  const double cap_cells = std::ceil(cap / mask.resolution());
  const auto limit = static_cast<Steps>(std::min(cap_cells, static_cast<double>(width + height)));
  const Grid<Steps> steps = column_distance(mask, limit);

  const double limit_square = static_cast<double>(limit) * limit;
  const auto metres = [&](double square) {
    if (square < 0.0 || square >= limit_square) return static_cast<float>(cap);
    return static_cast<float>(std::min(cap, mask.resolution() * std::sqrt(square)));
  };
  constexpr int kReach = WindowRow::kReach;
  std::vector<float> table(static_cast<std::size_t>(kReach * kReach + 1));
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = metres(static_cast<double>(i));

  WindowRow window(width);
  EnvelopeRow envelope(width);
  for (int y = 0; y < height; ++y) {
    float* const out = distance.row(y);
    const Steps* const row = steps.row(y);
    const Steps farthest = width > 0 ? *std::max_element(row, row + width) : Steps{0};
    if (farthest <= kReach) {
      window.load(row);
      window.transform([&](int start, int count, const std::int16_t* squares) {
        for (int i = 0; i < count; ++i) out[start + i] = table[static_cast<std::size_t>(squares[i])];
      });
    } else {
      envelope.transform(row, limit, [&](int x, double square) { out[x] = metres(square); });
    }
  }
  return distance;
}

Grid<std::uint16_t> manhattan_transform(const Grid<std::uint8_t>& mask) {
  Grid<Steps> steps = column_distance(mask, 65535);
  const int width = mask.width();
  const auto wider = [](int s) { return std::min(s + 1, 65535); };
  for (int y = 0; y < mask.height(); ++y) {
    Steps* const row = steps.row(y);
    int s = 65535;
    for (int x = 0; x < width; ++x) row[x] = static_cast<Steps>(s = std::min<int>(row[x], wider(s)));
    for (int x = width - 1; x >= 0; --x) row[x] = static_cast<Steps>(s = std::min<int>(row[x], wider(s)));
  }
  return steps;
}

}  // namespace rubble
