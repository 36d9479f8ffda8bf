#include "base/distance_transform.h"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
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

constexpr int kReach = 127;  ///< kReach^2 + (kReach + 1)^2 fits in 16 bits
constexpr int kBlock = 64;   ///< cells that look around together: eight vectors of eight
constexpr int kBatch = 4;    ///< steps outwards between two looks at whether it was enough

/// best[x] = min over dx in [first, first + kBatch) of centre[x +- dx] + dx^2; returns the largest of `best`.
/// Kept out of line and free of references: only so does the compiler see that it can use vectors.
[[gnu::noinline]] int widen(const std::int16_t* __restrict centre, int first, std::int16_t* __restrict best) {
  std::int16_t largest = 0;
  for (int x = 0; x < kBlock; ++x) {
    std::int16_t least = best[x];
    for (int i = 0; i < kBatch; ++i) {
      const int dx = first + i;
      const std::int16_t left = centre[x - dx];
      const std::int16_t right = centre[x + dx];
      const auto through = static_cast<std::int16_t>((left < right ? left : right) + dx * dx);
      least = through < least ? through : least;
    }
    best[x] = least;
    largest = least > largest ? least : largest;
  }
  return largest;
}

/// Squared distances of one row from its column distances, cell by cell outwards: min over dx of steps(x + dx)^2 +
/// dx^2. A block of cells stops looking as soon as dx^2 alone exceeds what all of them have; so no cell looks further
/// than its distance along the column. Exact for distances up to kReach.
class WindowRow {
 public:
  explicit WindowRow(int width)
      : width_(width), squares_(static_cast<std::size_t>(width + 2 * kMargin + kBlock), kReach * kReach) {}

  void load(const Steps* steps) {
    std::int16_t* const squares = squares_.data() + kMargin;
    for (int x = 0; x < width_; ++x) {
      const int s = std::min<int>(steps[x], kReach);
      squares[x] = static_cast<std::int16_t>(s * s);
    }
  }

  /// Calls emit(first cell, count, squared distances) for blocks that cover the row. Returns the largest square.
  template <class Emit>
  int transform(Emit emit) const {
    int largest_of_row = 0;
    for (int start = 0; start < width_; start += kBlock) {
      const int begin = std::max(0, std::min(start, width_ - kBlock));  // the last block overlaps the one before
      const std::int16_t* const centre = squares_.data() + kMargin + begin;
      std::int16_t best[kBlock];
      std::copy_n(centre, kBlock, best);
      int largest = *std::max_element(best, best + kBlock);
      for (int dx = 1; dx * dx < largest; dx += kBatch) largest = widen(centre, dx, best);
      emit(begin, std::min(kBlock, width_ - begin), best);
      largest_of_row = std::max(largest_of_row, largest);
    }
    return largest_of_row;
  }

 private:
  static constexpr int kMargin = kReach + kBatch;  ///< cells outside that a batch may look at

  int width_;
  std::vector<std::int16_t> squares_;
};

/// The same by the lower envelope of the parabolas steps(x)^2 + (. - x)^2, for distances of any length.
/// Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions", algorithm 1.
class EnvelopeRow {
 public:
  explicit EnvelopeRow(int width)
      : width_(width), parabolas_(static_cast<std::size_t>(width)), half_inverse_(static_cast<std::size_t>(width)) {
    for (std::size_t i = 1; i < half_inverse_.size(); ++i) half_inverse_[i] = 0.5 / static_cast<double>(i);
  }

  /// `limit`: steps of a column without a set cell. False: there is no set cell in any column.
  bool transform(const Steps* steps, Steps limit, std::int32_t* squares) {
    const int count = build(steps, limit);
    int begin = 0;
    for (int i = 0; i < count; ++i) {
      const Parabola& p = parabolas_[static_cast<std::size_t>(i)];
      const int end = i + 1 < count ? static_cast<int>(parabolas_[static_cast<std::size_t>(i) + 1].from + 1.0) : width_;
      for (int x = begin; x < end; ++x) squares[x] = p.square + (x - p.x) * (x - p.x);
      begin = std::max(begin, end);
    }
    return count > 0;
  }

 private:
  struct Parabola {
    int x;
    std::int32_t square;
    double from;  ///< it is the lowest right of here
  };

  int build(const Steps* steps, Steps limit) {
    int count = 0;
    for (int x = 0; x < width_; ++x) {
      if (steps[x] == limit) continue;
      const std::int32_t square = static_cast<std::int32_t>(steps[x]) * steps[x];
      double from = -1.0;
      for (; count > 0; --count) {
        // Where both are equal. A rounding error matters nowhere: cells lie on whole numbers, and where two parabolas
        // meet on a whole number either gives the value.
        const Parabola& last = parabolas_[static_cast<std::size_t>(count) - 1];
        const double rise = static_cast<double>(square) - static_cast<double>(last.square);
        from = 0.5 * (x + last.x) + rise * half_inverse_[static_cast<std::size_t>(x - last.x)];
        if (from > last.from) break;
      }
      if (count == 0) from = -1.0;
      if (from < width_ - 1) parabolas_[static_cast<std::size_t>(count++)] = {x, square, from};
    }
    return count;
  }

  int width_;
  std::vector<Parabola> parabolas_;
  std::vector<double> half_inverse_;  ///< 1 / (2 i)
};

/// Few columns have a set cell and the cap is far: the envelope then beats looking around (measured).
bool is_sparse(const Steps* steps, int width, Steps limit) {
  int sites = 0;
  for (int x = 0; x < width; ++x) sites += steps[x] < limit ? 1 : 0;
  return limit > 40 && 5 * sites < width;
}

/// min(cap, resolution * root of the square), the same bits as one by one.
void to_metres(const std::vector<std::int32_t>& squares, double resolution, double cap, float* out) {
  const auto count = static_cast<Eigen::Index>(squares.size());
  const Eigen::Map<const Eigen::Array<std::int32_t, Eigen::Dynamic, 1>> square(squares.data(), count);
  Eigen::Map<Eigen::ArrayXf>(out, count) = (square.cast<double>().sqrt() * resolution).min(cap).cast<float>();
}

}  // namespace

Grid<float> distance_transform(const Grid<std::uint8_t>& mask, double cap) {
  const int width = mask.width();
  const int height = mask.height();
  assert(cap >= 0.0 && width + height < 46341);  // whose square still fits in 32 bits
  Grid<float> distance(mask.frame(), static_cast<float>(cap));
  // Everything from `limit` cells on is at the cap; no two cells are width + height apart.
  const double cap_cells = std::ceil(cap / mask.resolution());
  const auto limit = static_cast<Steps>(std::min(cap_cells, static_cast<double>(width + height)));
  const Grid<Steps> steps = column_distance(mask, limit);

  const int known = std::min<int>(limit, kReach);  // from here on a window tells nothing
  std::vector<float> metres(static_cast<std::size_t>(kReach * kReach + 1), static_cast<float>(cap));
  for (int i = 0; i < known * known; ++i)
    metres[static_cast<std::size_t>(i)] = static_cast<float>(std::min(cap, mask.resolution() * std::sqrt(double(i))));

  WindowRow window(width);
  EnvelopeRow envelope(width);
  std::vector<std::int32_t> squares(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    float* const out = distance.row(y);
    bool complete = false;
    if (!is_sparse(steps.row(y), width, limit)) {
      window.load(steps.row(y));
      const int largest = window.transform([&](int start, int count, const std::int16_t* square) {
        for (int i = 0; i < count; ++i) out[start + i] = metres[static_cast<std::size_t>(square[i])];
      });
      complete = limit <= kReach || largest < kReach * kReach;
    }
    if (!complete && envelope.transform(steps.row(y), limit, squares.data()))
      to_metres(squares, mask.resolution(), cap, out);
  }
  return distance;
}

}  // namespace rubble
