#include "scoring/manhattan_sum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <type_traits>

namespace rubble::scoring {
namespace {

constexpr int kBlock = 64;  // cells swept together; they fit in a few vector registers

/// Both classes of a cell in one byte, and how to ask for one of them. Padding is of no class in either layer.
constexpr std::uint8_t kNone = 0x33;
constexpr int shift_of(Layer layer) { return layer == Layer::Map ? 0 : 4; }

struct Wanted {
  std::uint8_t mask;
  std::uint8_t value;
};

Wanted wanted(Layer layer, Occupancy colour) {
  return {static_cast<std::uint8_t>(0x0f << shift_of(layer)),
          static_cast<std::uint8_t>(static_cast<int>(colour) << shift_of(layer))};
}

std::size_t offset(int row, int width) { return static_cast<std::size_t>(row) * static_cast<std::size_t>(width); }

int whole_blocks(int n) { return (n + kBlock - 1) / kBlock * kBlock; }

/// One step further than `steps`; the largest value of T stays what it is and means "too far to say".
template <class T>
T further(T steps) {
  constexpr T kLast = std::numeric_limits<T>::max() - 1;
  return static_cast<T>((steps < kLast ? steps : kLast) + 1);
}

template <class T>
T nearer(T a, T b) {
  return a < b ? a : b;
}

constexpr std::size_t kTile = 16;  ///< edge of the square that is transposed at once [cells]

/// Interleaves the halves of a tile: the bits of each cell's index (four of the row, four of the column) turn by one.
template <class T>
[[gnu::noinline]] void shuffle(const T* __restrict from, T* __restrict to) {
  constexpr std::size_t kHalf = kTile * kTile / 2;
  for (std::size_t i = 0; i < kHalf; ++i) {
    to[2 * i] = from[i];
    to[2 * i + 1] = from[kHalf + i];
  }
}

/// `from`: kBlock columns of `height` rows; `to`: kBlock rows of `height` columns.
template <class T>
void transpose_strip(const T* from, std::size_t from_stride, int height, T* to) {
  const auto to_stride = static_cast<std::size_t>(height);
  T a[kTile * kTile];
  T b[kTile * kTile];
  for (std::size_t y = 0; y < to_stride; y += kTile)
    for (std::size_t x = 0; x < kBlock; x += kTile) {
      for (std::size_t i = 0; i < kTile; ++i) std::copy_n(from + (y + i) * from_stride + x, kTile, a + i * kTile);
      for (int twice = 0; twice < 2; ++twice) {  // four turns exchange row and column
        shuffle(a, b);
        shuffle(b, a);
      }
      for (std::size_t i = 0; i < kTile; ++i) std::copy_n(a + i * kTile, kTile, to + (x + i) * to_stride + y);
    }
}

// One row of a sweep, kBlock cells. Kept out of line and free of references: only so does the compiler see that it can
// use vectors.

/// out = 0 on cells that are wanted, else one step further than `last`.
template <class T>
inline void step_from(const std::uint8_t* __restrict classes, Wanted wanted, const T* __restrict last,
                      T* __restrict out) {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const T next = further(last[i]);
    out[i] = (classes[i] & wanted.mask) == wanted.value ? T{0} : next;
  }
}

/// row = the nearer of itself and one step further than `last`.
template <class T>
inline void step_over(const T* __restrict last, T* __restrict row) {
  for (std::size_t i = 0; i < kBlock; ++i) row[i] = nearer(row[i], further(last[i]));
}

/// Adds the distances on cells that are wanted, and keeps the largest.
template <class T, class Lane>
inline void add_up(const std::uint8_t* __restrict classes, Wanted wanted, const T* __restrict distance,
                   Lane* __restrict sums, T* __restrict largest) {
  T counts[kBlock];
  for (std::size_t i = 0; i < kBlock; ++i)
    counts[i] =
        static_cast<T>(distance[i] & ((classes[i] & wanted.mask) == wanted.value ? std::numeric_limits<T>::max() : 0));
  for (std::size_t i = 0; i < kBlock; ++i) largest[i] = largest[i] > counts[i] ? largest[i] : counts[i];
  for (std::size_t i = 0; i < kBlock; ++i) sums[i] = static_cast<Lane>(sums[i] + counts[i]);
}

/// Steps along the column to the nearest cell that are wanted, for a strip of kBlock columns; `steps`: height x kBlock.
template <class T>
void sweep_columns(const std::uint8_t* classes, int stride, int height, Wanted wanted, T* steps) {
  std::array<T, kBlock> outside;
  outside.fill(std::numeric_limits<T>::max());
  const T* last = outside.data();
  for (int y = 0; y < height; ++y) {
    T* const row = steps + offset(y, kBlock);
    step_from(classes + offset(y, stride), wanted, last, row);
    last = row;
  }
  for (int y = height - 2; y >= 0; --y) step_over(steps + offset(y + 1, kBlock), steps + offset(y, kBlock));
}

/// What a strip of kBlock rows (columns of the transpose) adds to the sum.
struct StripSum {
  std::int64_t sum = 0;
  bool too_far = false;  ///< a distance that counts was too long for T
};

/// The same sweep along the rows, which finishes the distances; those that are wanted in `from` are added up.
/// `steps` and `from`: transposed, width x stride.
template <class T>
StripSum sweep_rows(const std::uint8_t* from, Wanted wanted, T* steps, int width, int stride) {
  using Lane = std::conditional_t<sizeof(T) == 1, std::uint16_t, std::uint32_t>;
  constexpr int kFlush = 256;  // so many largest values fit in a Lane
  for (int x = 1; x < width; ++x) step_over(steps + offset(x - 1, stride), steps + offset(x, stride));
  StripSum out;
  std::array<T, kBlock> largest{};
  for (int end = width; end > 0; end -= kFlush) {
    std::array<Lane, kBlock> sums{};
    for (int x = end - 1; x >= std::max(0, end - kFlush); --x) {
      T* const row = steps + offset(x, stride);
      if (x + 1 < width) step_over(row + stride, row);
      add_up(from + offset(x, stride), wanted, row, sums.data(), largest.data());
    }
    for (const Lane sum : sums) out.sum += sum;
  }
  out.too_far = *std::max_element(largest.begin(), largest.end()) == std::numeric_limits<T>::max();
  return out;
}

/// Both classes of each cell, and where they are to be looked for.
struct Planes {
  const std::uint8_t* rows;
  const std::uint8_t* columns;
  int width;
  int height;
  Wanted from;
  Wanted to;
};

template <class T>
std::optional<std::int64_t> sum_with(const Planes& planes, std::vector<T>& memory) {
  const int width = planes.width;
  const int height = planes.height;
  memory.resize(offset(width + kBlock, height));
  T* const steps = memory.data();
  T* const strip = steps + offset(width, height);
  for (int x = 0; x < width; x += kBlock) {
    sweep_columns<T>(planes.rows + x, width, height, planes.to, strip);
    transpose_strip(strip, kBlock, height, steps + offset(x, height));
  }
  std::int64_t sum = 0;
  for (int y = 0; y < height; y += kBlock) {
    const StripSum part = sweep_rows<T>(planes.columns + y, planes.from, steps + y, width, height);
    if (part.too_far) return std::nullopt;
    sum += part.sum;
  }
  return sum;
}

/// `n`: whole blocks.
int count_of(const std::uint8_t* classes, int n, Wanted wanted) {
  int count = 0;
  for (int begin = 0; begin < n; begin += kBlock) {
    std::uint8_t in_block = 0;  // bytes add up in vectors
    for (int i = begin; i < begin + kBlock; ++i)
      in_block = static_cast<std::uint8_t>(in_block + ((classes[i] & wanted.mask) == wanted.value ? 1 : 0));
    count += in_block;
  }
  return count;
}

[[gnu::noinline]] void combine(const Occupancy* __restrict map, const Occupancy* __restrict truth, int n,
                               std::uint8_t* __restrict out) {
  for (int i = 0; i < n; ++i) {
    const auto low = static_cast<std::uint8_t>(map[i]);
    const auto high = static_cast<std::uint8_t>(static_cast<std::uint8_t>(truth[i]) << shift_of(Layer::Truth));
    out[i] = static_cast<std::uint8_t>(low | high);
  }
}

}  // namespace

ManhattanSum::ManhattanSum(const OccupancyGrid& map, const OccupancyGrid& truth)
    : width_(whole_blocks(map.width())),
      height_(whole_blocks(map.height())),
      rows_(offset(height_, width_), kNone),
      columns_(offset(height_, width_)) {
  assert(map.width() == truth.width() && map.height() == truth.height() && width_ + height_ < 65535);
  for (int y = 0; y < map.height(); ++y) {
    std::uint8_t* const row = rows_.data() + offset(y, width_);
    combine(map.row(y), truth.row(y), map.width(), row);
    for (const Layer layer : {Layer::Map, Layer::Truth})
      for (const Occupancy colour : {Occupancy::Free, Occupancy::Occupied})
        count_[static_cast<std::size_t>(layer)][static_cast<std::size_t>(colour)] +=
            count_of(row, width_, wanted(layer, colour));
  }
  for (auto& of_layer : count_) of_layer[0] = static_cast<std::int64_t>(map.cells().size()) - of_layer[1] - of_layer[2];
  for (int x = 0; x < width_; x += kBlock)
    transpose_strip(rows_.data() + x, static_cast<std::size_t>(width_), height_, columns_.data() + offset(x, height_));
}

std::int64_t ManhattanSum::count(Layer layer, Occupancy colour) const {
  return count_[static_cast<std::size_t>(layer)][static_cast<std::size_t>(colour)];
}

std::int64_t ManhattanSum::from(Layer from, Occupancy colour) {
  const Layer to = from == Layer::Map ? Layer::Truth : Layer::Map;
  const Planes planes{rows_.data(), columns_.data(), width_, height_, wanted(from, colour), wanted(to, colour)};
  if (const std::optional<std::int64_t> sum = sum_with(planes, bytes_)) return *sum;
  return sum_with(planes, words_).value();
}

}  // namespace rubble::scoring
