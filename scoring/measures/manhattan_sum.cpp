#include "scoring/measures/manhattan_sum.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include "scoring/measures/lanes.h"

namespace rubble::scoring {
namespace {

constexpr auto kNoClass = static_cast<Occupancy>(3);  ///< of the cells that fill up the last tiles
constexpr std::array<Occupancy, 3> kAllClasses = {Occupancy::Unknown, Occupancy::Free, Occupancy::Occupied};

std::size_t whole(int cells, std::size_t block) { return (static_cast<std::size_t>(cells) + block - 1) / block; }

template <class V>
V all(Occupancy colour) {
  return kNothing<V> + static_cast<std::uint8_t>(colour);
}

/// A square of kLanes x kLanes cells, transposed: one vector a column. The steps to each of N classes, and the classes
/// of the grid in which they start.
template <class V, std::size_t N>
struct Tile {
  V steps[N][kLanes<V>];
  V from[kLanes<V>];
};

/// kLanes columns of a grid, a vector a row; where they reach past its east edge, in a copy.
class Strip {
 public:
  Strip(const OccupancyGrid& grid, std::size_t column, std::size_t lanes) : height_(grid.height()) {
    const auto begin = static_cast<int>(column * lanes);
    const int inside = std::min(static_cast<int>(lanes), grid.width() - begin);
    cells_ = grid.data() + begin;
    stride_ = static_cast<std::size_t>(grid.width());
    if (inside == static_cast<int>(lanes)) return;
    copy_.assign(lanes * static_cast<std::size_t>(height_), kNoClass);
    for (int y = 0; y < height_; ++y)
      std::copy_n(grid.row(y) + begin, inside, copy_.data() + static_cast<std::size_t>(y) * lanes);
    cells_ = copy_.data();
    stride_ = lanes;
  }
  int height() const { return height_; }
  const Occupancy* row(std::size_t y) const { return cells_ + y * stride_; }

 private:
  int height_;
  const Occupancy* cells_;
  std::size_t stride_;
  std::vector<Occupancy> copy_;
};

/// The sweeps of N classes at once through kLanes cells at once. They go through strips of columns from west to east,
/// in each north, then south, and leave transposed tiles, already swept east; last, each strip of tiles is swept west.
template <class V, std::size_t N>
class Sweeps {
 public:
  /// `memory`: of bytes_needed(), which need not be clear.
  Sweeps(const std::array<Occupancy, N>& classes, int width, int height, std::byte* memory)
      : columns_(whole(width, kLanes<V>)),
        rows_(whole(height, kLanes<V>)),
        steps_(rows_ * kLanes<V>, far()),
        east_(rows_, far()),
        tiles_(new (memory) Tile<V, N>[rows_ * columns_]) {
    for (std::size_t k = 0; k < N; ++k) class_[k] = all<V>(classes[k]);
  }

  static std::size_t bytes_needed(int width, int height) {
    return whole(width, kLanes<V>) * whole(height, kLanes<V>) * sizeof(Tile<V, N>);
  }

  struct Sum {
    std::array<std::int64_t, N> value{};
    std::array<bool, N> too_far{};  ///< a distance that counts is too far for V
  };

  Sum sum(const OccupancyGrid& from, const OccupancyGrid& to) {
    std::fill(east_.begin(), east_.end(), far());
    for (std::size_t column = 0; column < columns_; ++column) {
      sweep_north(Strip(to, column, kLanes<V>));
      sweep_south_and_east(column);
      transpose_classes(Strip(from, column, kLanes<V>), column);
    }
    Sum out;
    for (std::size_t row = 0; row < rows_; ++row) sweep_west(&tile(row, 0), out);
    return out;
  }

 private:
  using Vectors = std::array<V, N>;

  static Vectors far() {
    Vectors out;
    out.fill(kFar<V>);
    return out;
  }
  Tile<V, N>& tile(std::size_t row, std::size_t column) { return tiles_[row * columns_ + column]; }

  void sweep_north(const Strip& to) {
    Vectors near = far();
    for (std::size_t y = 0; y < static_cast<std::size_t>(to.height()); ++y) {
      V classes;
      load(to.row(y), classes);
      for (std::size_t k = 0; k < N; ++k) {
        near[k] = further(near[k]) & ~equal(classes, class_[k]);
        steps_[y][k] = near[k];
      }
    }
  }

  void sweep_south_and_east(std::size_t column) {
    Vectors near = far();
    for (std::size_t row = rows_; row-- > 0;) {
      Tile<V, N>& out = tile(row, column);
      for (std::size_t k = 0; k < N; ++k) {
        V square[kLanes<V>];
        V last = near[k];
        for (std::size_t i = kLanes<V>; i-- > 0;) {
          last = nearer(steps_[row * kLanes<V> + i][k], further(last));
          square[i] = last;
        }
        near[k] = last;
        transpose(square);
        last = east_[row][k];
        for (std::size_t i = 0; i < kLanes<V>; ++i) {
          last = nearer(square[i], further(last));
          out.steps[k][i] = last;
        }
        east_[row][k] = last;
      }
    }
  }

  void transpose_classes(const Strip& from, std::size_t column) {
    for (std::size_t row = 0; row < rows_; ++row) {
      V square[kLanes<V>];
      const std::size_t south = row * kLanes<V>;
      const std::size_t inside = std::min(kLanes<V>, static_cast<std::size_t>(from.height()) - south);
      if (inside < kLanes<V>) std::fill(square, square + kLanes<V>, kFar<V>);
      for (std::size_t i = 0; i < inside; ++i) load(from.row(south + i), square[i]);
      transpose(square);
      std::copy(square, square + kLanes<V>, tile(row, column).from);
    }
  }

  void sweep_west(const Tile<V, N>* strip, Sum& out) const {
    Vectors near = far();
    Vectors farthest{};
    std::array<LaneSum, N> sums;
    for (std::size_t column = columns_; column-- > 0;) {
      const Tile<V, N>& tile = strip[column];
      for (std::size_t i = kLanes<V>; i-- > 0;)
        for (std::size_t k = 0; k < N; ++k) {
          near[k] = nearer(tile.steps[k][i], further(near[k]));
          const V counts = near[k] & equal(tile.from[i], class_[k]);
          farthest[k] = farther(farthest[k], counts);
          sums[k].add(counts);
        }
    }
    for (std::size_t k = 0; k < N; ++k) {
      out.value[k] += sums[k].value();
      const V lost = equal(farthest[k], kFar<V>);
      for (std::size_t i = 0; i < kLanes<V>; ++i) out.too_far[k] = out.too_far[k] || lost[i] != 0;
    }
  }

  Vectors class_;
  std::size_t columns_;         ///< tiles
  std::size_t rows_;            ///< tiles
  std::vector<Vectors> steps_;  ///< of a strip, row by row; past the grid's north edge they stay far
  std::vector<Vectors> east_;   ///< last column swept east, for each row of tiles
  Tile<V, N>* tiles_;
};

OfClass count_classes(const OccupancyGrid& grid) {
  const std::vector<Occupancy>& cells = grid.cells();
  const std::size_t in_lanes = cells.size() / kLanes<Bytes> * kLanes<Bytes>;
  OfClass out;
  for (const Occupancy colour : {Occupancy::Free, Occupancy::Occupied}) {
    LaneSum count;
    for (std::size_t i = 0; i < in_lanes; i += kLanes<Bytes>) {
      Bytes classes;
      load(cells.data() + i, classes);
      count.add(equal(classes, all<Bytes>(colour)) & 1);
    }
    out[colour] =
        count.value() + std::count(cells.begin() + static_cast<std::ptrdiff_t>(in_lanes), cells.end(), colour);
  }
  out[Occupancy::Unknown] = static_cast<std::int64_t>(cells.size()) - out[Occupancy::Free] - out[Occupancy::Occupied];
  return out;
}

using InBytes = Sweeps<Bytes, kAllClasses.size()>;
using InWords = Sweeps<Words, 1>;

OfClass sums_of(const OccupancyGrid& from, const OccupancyGrid& to, const OfClass& count_to, std::byte* memory) {
  const InBytes::Sum near = InBytes(kAllClasses, from.width(), from.height(), memory).sum(from, to);
  OfClass out;
  for (std::size_t k = 0; k < kAllClasses.size(); ++k) {
    const Occupancy colour = kAllClasses[k];
    if (count_to[colour] == 0) continue;
    out[colour] =
        near.too_far[k] ? InWords({colour}, from.width(), from.height(), memory).sum(from, to).value[0] : near.value[k];
  }
  return out;
}

}  // namespace

ManhattanSums manhattan_sums(const OccupancyGrid& map, const OccupancyGrid& truth) {
  assert(map.width() == truth.width() && map.height() == truth.height() && map.width() + map.height() < 65000);
  ManhattanSums out;
  out.map_count = count_classes(map);
  out.truth_count = count_classes(truth);
  // One for all sweeps, as fresh pages cost as much as they do, and not a vector, which would clear it.
  const std::unique_ptr<std::byte[]> memory(new std::byte[std::max(InBytes::bytes_needed(map.width(), map.height()),
                                                                   InWords::bytes_needed(map.width(), map.height()))]);
  out.map_to_truth = sums_of(map, truth, out.truth_count, memory.get());
  out.truth_to_map = sums_of(truth, map, out.map_count, memory.get());
  return out;
}

}  // namespace rubble::scoring
