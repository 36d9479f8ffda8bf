#include "slam/grid/count_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr int kBlock = 128;  ///< cells by which the map grows
constexpr int kWord = 64;    ///< cells in a word of a raster, which is a row of a tile
static_assert(kWord == CountTiles::kSide && kBlock % kWord == 0);
constexpr std::uint16_t kFull = std::numeric_limits<std::uint16_t>::max();

/// Eq. (1), rounded to 1/255.
std::uint8_t ratio(std::uint32_t occupied, std::uint32_t seen) {
  return static_cast<std::uint8_t>((255u * occupied + seen / 2u) / seen);  // eq. (1)
}

struct Extent {
  int low;   ///< cells to add below
  int high;  ///< cells to add above
};

/// Whole blocks to add so that [low, high] fits, as far as `max_cells` allows.
Extent growth(double low, double high, int size, int max_cells) {
  const auto blocks = [](double cells) {
    return cells <= 0.0 ? 0 : kBlock * static_cast<int>(std::ceil(std::min(cells, 1e6) / kBlock));
  };
  const int room = std::max(0, (max_cells - size) / kBlock * kBlock);
  const int below = std::min(blocks(-low), room);
  const int above = std::min(blocks(high + 1.0 - size), room - below);
  return {below, above};
}

using Tile = CountTiles::Tile;

/// Counts that would overflow are halved, both alike.
void make_room(Tile& tile, std::size_t cell) {
  if (tile.seen[cell] != kFull) return;
  tile.seen[cell] = static_cast<std::uint16_t>(tile.seen[cell] / 2);
  tile.occupied[cell] = static_cast<std::uint16_t>(tile.occupied[cell] / 2);
}

void rate(Tile& tile, std::size_t cell) {
  tile.occupied[cell] = std::min(tile.occupied[cell], tile.seen[cell]);  // counts that were halved may not add up
  tile.p_occ[cell] = tile.occupied[cell] == 0 ? std::uint8_t{0} : ratio(tile.occupied[cell], tile.seen[cell]);
}

void count_hit(Tile& tile, std::size_t cell) {
  make_room(tile, cell);
  ++tile.seen[cell];
  ++tile.occupied[cell];
  tile.p_occ[cell] = ratio(tile.occupied[cell], tile.seen[cell]);
}

void count_passes(Tile& tile, std::size_t begin, std::size_t end, bool may_be_full) {
  if (may_be_full) {
    for (std::size_t cell = begin; cell < end; ++cell) make_room(tile, cell);
  }
  for (std::size_t cell = begin; cell < end; ++cell) ++tile.seen[cell];
  for (std::size_t cell = begin; cell < end;) {
    std::uint64_t eight = 1;
    if (cell + sizeof eight <= end) std::memcpy(&eight, &tile.p_occ[cell], sizeof eight);
    if (eight == 0) {  // most of what beams pass was never hit
      cell += sizeof eight;
      continue;
    }
    if (tile.p_occ[cell] != 0) tile.p_occ[cell] = ratio(tile.occupied[cell], tile.seen[cell]);
    ++cell;
  }
}

}  // namespace

CountMap::CountMap(int width, int height, double resolution, int max_cells)
    : max_cells_(max_cells), tiles_(std::max(width, 1), std::max(height, 1)) {
  if (width <= 0 || height <= 0 || !(resolution > 0.0)) {
    throw std::invalid_argument("CountMap: width, height and resolution must be positive");
  }
  frame_.width = width;
  frame_.height = height;
  frame_.resolution = resolution;
  frame_.x0 = -0.5 * width * resolution;
  frame_.y0 = -0.5 * height * resolution;
}

void CountMap::clear_hits(const std::vector<Cell>& cells) {
  for (const Cell c : cells) {
    Tile& tile = tiles_.at(c);
    tile.occupied[CountTiles::place(c)] = 0;
    rate(tile, CountTiles::place(c));
  }
  ++version_;
}

void CountMap::assign(const GridFrame& frame, const std::vector<std::uint16_t>& seen,
                      const std::vector<std::uint16_t>& occupied) {
  if (frame.width <= 0 || frame.height <= 0 || !(frame.resolution > 0.0) || seen.size() != frame.size() ||
      occupied.size() != frame.size())
    throw std::invalid_argument("CountMap: two planes of the frame's size are needed");
  for (std::size_t cell = 0; cell < seen.size(); ++cell)
    if (occupied[cell] > seen[cell]) throw std::invalid_argument("CountMap: occupied more often than seen");
  CountTiles tiles(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t from = frame.index({x, y});
      if (seen[from] == 0) continue;
      Tile& tile = tiles.at({x, y});
      const std::size_t cell = CountTiles::place({x, y});
      tile.seen[cell] = seen[from];
      tile.occupied[cell] = occupied[from];
      rate(tile, cell);
    }
  frame_ = frame;
  tiles_ = std::move(tiles);
  ++version_;
}

void CountMap::begin_anew(double dx, double dy) {
  frame_.x0 += dx;
  frame_.y0 += dy;
  tiles_.clear(frame_.width, frame_.height);
  dropped_hits_ = 0;
  ++version_;
}

double CountMap::p_occ(Cell c) const {
  if (!frame_.inside(c)) return 0.0;
  return seen(c) == 0 ? 0.0 : static_cast<double>(occupied(c)) / seen(c);  // eq. (1)
}

bool CountMap::draw(const TPose2D& T_map_base, const ScanPoints& scan) {
  rays_ = scan.rays.empty() ? rays_from_ends(scan.hits, scan.passes, scan.origin, scan.beam_width) : scan.rays;
  if (rays_.empty()) return false;

  const PlanarTransform to_map(T_map_base);
  TPoint2D origin = to_map(scan.origin);
  TPoint2D low = origin;
  TPoint2D high = origin;
  for (ScanRay& ray : rays_) {
    ray.end = to_map(ray.end);
    low = {std::min(low.x, ray.end.x), std::min(low.y, ray.end.y)};
    high = {std::max(high.x, ray.end.x), std::max(high.y, ray.end.y)};
  }
  grow_to_hold(low, high);

  const auto to_cells = [this](const TPoint2D& p) {
    return TPoint2D{(p.x - frame_.x0) / frame_.resolution, (p.y - frame_.y0) / frame_.resolution};
  };
  origin = to_cells(origin);
  for (ScanRay& ray : rays_) ray.end = to_cells(ray.end);

  // One cell of margin: half a beam of widening may reach a little over the ends.
  const Cell first = frame_.cell(low);
  const Cell last = frame_.cell(high);
  const int margin = 1 + static_cast<int>(0.5 * scan.beam_width * distance(low, high) / frame_.resolution);
  const Cell from{std::max(first.x - margin, 0) / kWord * kWord, std::max(first.y - margin, 0)};
  const Cell to{std::min(last.x + margin, frame_.width - 1), std::min(last.y + margin, frame_.height - 1)};
  if (to.x < from.x || to.y < from.y) return false;
  passed_.reset(from, to.x - from.x + 1, to.y - from.y + 1);
  fill_scan_polygons(rays_, origin, scan.beam_width, passed_);
  clear_surfaces(rays_, kSurfaceGap / frame_.resolution, passed_);
  return true;
}

void CountMap::stamp(const TPose2D& T_map_base, const ScanPoints& scan) {
  ++version_;
  if (!draw(T_map_base, scan)) {
    dropped_hits_ += static_cast<std::uint64_t>(
        std::count_if(rays_.begin(), rays_.end(), [](const ScanRay& ray) { return ray.hit; }));
    return;
  }
  dropped_hits_ += each_hit([this](Cell c) { count_hit(tiles_.at(c), CountTiles::place(c)); });
  const bool may_be_full = version_ >= kFull;
  each_pass([&](Tile& tile, std::size_t first, std::uint64_t bits) {
    std::size_t at = 0;
    while (bits != 0) {  // by runs of set ones
      const auto skipped = static_cast<std::size_t>(__builtin_ctzll(bits));
      at += skipped;
      bits >>= skipped;
      const std::size_t run = ~bits == 0 ? std::size_t{kWord} : static_cast<std::size_t>(__builtin_ctzll(~bits));
      count_passes(tile, first + at, first + at + run, may_be_full);
      at += run;
      bits = run < kWord ? bits >> run : 0;
    }
  });
}

void CountMap::restamp(const TPose2D& T_map_before, const TPose2D& T_map_base, const ScanPoints& scan) {
  ++version_;
  const auto mark = [&](const TPose2D& T) {
    if (draw(T, scan)) return each_hit([](Cell) {});
    passed_.reset({0, 0}, 0, 0);
    hit_.reset({0, 0}, 0, 0);
    return static_cast<std::uint64_t>(
        std::count_if(rays_.begin(), rays_.end(), [](const ScanRay& ray) { return ray.hit; }));
  };
  GridFrame drawn_in;
  std::uint64_t dropped = 0;
  do {  // a map that grows begins elsewhere
    dropped = mark(T_map_base);
    drawn_in = frame_;
    std::swap(passed_, passed_later_);
    std::swap(hit_, hit_later_);
    mark(T_map_before);
  } while (frame_ != drawn_in);
  dropped_hits_ += dropped;

  const auto low = [](const BitRaster& r) { return r.low().x / kWord; };
  const auto high = [&](const BitRaster& r) { return low(r) + r.words_per_row(); };
  const auto top = [](const BitRaster& r) { return r.low().y + r.height(); };
  const auto word = [&](const BitRaster& r, int y, int w) {
    const bool inside = y >= r.low().y && y < top(r) && w >= low(r) && w < high(r);
    return inside ? r.row(y - r.low().y)[w - low(r)] : std::uint64_t{0};
  };
  const int last_row = std::max(top(passed_), top(passed_later_));
  const int last_word = std::max(high(passed_), high(passed_later_));
  for (int y = std::min(passed_.low().y, passed_later_.low().y); y < last_row; ++y)
    for (int w = std::min(low(passed_), low(passed_later_)); w < last_word; ++w) {
      const std::uint64_t hit = word(hit_, y, w);
      const std::uint64_t hit_later = word(hit_later_, y, w);
      const std::uint64_t seen = hit | word(passed_, y, w);
      const std::uint64_t seen_later = hit_later | word(passed_later_, y, w);
      for (std::uint64_t changed = (hit ^ hit_later) | (seen ^ seen_later); changed != 0; changed &= changed - 1) {
        const std::uint64_t bit = changed & (~changed + 1);
        const Cell c{w * kWord + __builtin_ctzll(bit), y};
        Tile& tile = tiles_.at(c);
        const std::size_t cell = CountTiles::place(c);
        if ((seen & bit) != 0 && tile.seen[cell] > 0) --tile.seen[cell];
        if ((hit & bit) != 0 && tile.occupied[cell] > 0) --tile.occupied[cell];
        if ((seen_later & bit) != 0) {
          make_room(tile, cell);
          ++tile.seen[cell];
        }
        if ((hit_later & bit) != 0) ++tile.occupied[cell];
        rate(tile, cell);
      }
    }
}

std::size_t CountMap::drawn_cells() const {
  return static_cast<std::size_t>(passed_.width()) * static_cast<std::size_t>(passed_.height());
}

template <class Count>
std::uint64_t CountMap::each_hit(const Count& count) {
  std::uint64_t beyond = 0;
  hit_.reset(passed_.low(), passed_.width(), passed_.height());
  for (const ScanRay& ray : rays_) {
    if (!ray.hit) continue;
    const double x = std::floor(ray.end.x);
    const double y = std::floor(ray.end.y);
    if (!(x >= 0.0 && y >= 0.0 && x < frame_.width && y < frame_.height)) {
      ++beyond;
      continue;
    }
    const Cell c{static_cast<int>(x), static_cast<int>(y)};
    if (hit_.test(c)) continue;  // counts once per scan
    hit_.set(c);
    passed_.clear(c);  // a hit cell is not freed by other beams of the scan
    count(c);
  }
  return beyond;
}

template <class Count>
void CountMap::each_pass(const Count& count) {
  for (int y = 0; y < passed_.height(); ++y) {
    const std::uint64_t* words = passed_.row(y);
    for (int w = 0; w < passed_.words_per_row(); ++w) {
      if (words[w] == 0) continue;
      const Cell first{passed_.low().x + w * kWord, passed_.low().y + y};
      count(tiles_.at(first), CountTiles::place(first), words[w]);
    }
  }
}

void CountMap::grow_to_hold(const TPoint2D& low, const TPoint2D& high) {
  const double cell = frame_.resolution;
  const Extent x =
      growth(std::floor((low.x - frame_.x0) / cell), std::floor((high.x - frame_.x0) / cell), frame_.width, max_cells_);
  const Extent y = growth(std::floor((low.y - frame_.y0) / cell), std::floor((high.y - frame_.y0) / cell),
                          frame_.height, max_cells_);
  if (x.low + x.high + y.low + y.high == 0) return;
  GridFrame grown = frame_;
  grown.width += x.low + x.high;
  grown.height += y.low + y.high;
  grown.x0 -= x.low * cell;
  grown.y0 -= y.low * cell;
  tiles_.grow(x.low, y.low, grown.width, grown.height);
  frame_ = grown;
}

OccupancyGrid CountMap::classify(double threshold) const {
  OccupancyGrid grid(frame_, Occupancy::Unknown);
  for (int y = 0; y < frame_.height; ++y)
    for_seen(y, 0, frame_.width, [&](int x, int count, const std::uint16_t* seen, const std::uint16_t* occupied) {
      Occupancy* const out = grid.row(y) + x;
      for (int i = 0; i < count; ++i)
        if (seen[i] != 0) out[i] = occupied[i] >= threshold * seen[i] ? Occupancy::Occupied : Occupancy::Free;
    });
  return grid;
}

}  // namespace rubble::slam
