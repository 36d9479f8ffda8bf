#include "explore/plan/box_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/angle.h"
#include "explore/plan/set_bytes.h"

namespace rubble::explore {
namespace {

constexpr double kShortest = 0.3;  ///< [m]
constexpr double kLongest = 0.7;   ///< [m]
constexpr int kGap = 1;            ///< a row may miss so many cells at once
constexpr int kSlopes = 24;        ///< directions tried in half a turn: 4 deg off at most, half a cell in half a metre

/// A step along a row, the longer of its sides one cell.
struct Slope {
  double x;
  double y;
};

std::array<Slope, kSlopes> make_slopes() {
  std::array<Slope, kSlopes> slopes{};
  for (int i = 0; i < kSlopes; ++i) {
    // East and north first: most walls lie so.
    const int nth = i / 2 + (i % 2) * kSlopes / 2;
    const double angle = nth * kPi / kSlopes;
    const auto exact = [](double v) { return std::round(v * 1e9) * 1e-9; };  // 0 and 1, where floor and ceil matter
    const double longer = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    slopes[static_cast<std::size_t>(i)] = {exact(std::cos(angle) / longer), exact(std::sin(angle) / longer)};
  }
  return slopes;
}

/// How many cells a row reaches from `c` along a slope (`way` 1 or -1), without `c`, and no farther than `most`. A row
/// that passes between two cells may hold either.
int reach(const Grid<std::uint8_t>& cells, Cell c, const Slope& slope, int way, int most, int gap) {
  const GridFrame& frame = cells.frame();
  int last = 0;
  for (int i = 1; i <= most && i - last <= gap + 1; ++i) {
    const double x = way * i * slope.x, y = way * i * slope.y;
    const Cell low{c.x + static_cast<int>(std::floor(x)), c.y + static_cast<int>(std::floor(y))};
    const Cell high{c.x + static_cast<int>(std::ceil(x)), c.y + static_cast<int>(std::ceil(y))};
    if (!frame.inside(low) || !frame.inside(high)) break;
    if ((cells[low] | cells[high]) != 0) last = i;
  }
  return last;
}

/// A board is a cell or two thick; wider is a piece of slope that scans from its foot met, and hides nothing.
void drop_bands(Grid<std::uint8_t>& seen_over) {
  const GridFrame& frame = seen_over.frame();
  std::vector<Cell> middles;
  for (int y = 1; y + 1 < frame.height; ++y)
    for_each_set(seen_over.row(y), frame.width, [&](int x) {
      if (x < 1 || x + 1 >= frame.width) return;
      int set = 0;
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) set += seen_over[{u, v}];
      if (set == 9) middles.push_back({x, y});
    });
  for (const Cell c : middles)
    for (int v = c.y - 1; v <= c.y + 1; ++v)
      for (int u = c.x - 1; u <= c.x + 1; ++u) seen_over[{u, v}] = 0;
}

}  // namespace

void keep_box_sides(Grid<std::uint8_t>& seen_over) {
  drop_bands(seen_over);
  static const std::array<Slope, kSlopes> kAll = make_slopes();
  const GridFrame& frame = seen_over.frame();
  std::vector<Cell> others;
  for (int y = 0; y < frame.height; ++y)
    for_each_set(seen_over.row(y), frame.width, [&](int x) {
      const Cell c{x, y};
      bool long_enough = false;
      for (const Slope& slope : kAll) {
        const double cell = frame.resolution * std::sqrt(slope.x * slope.x + slope.y * slope.y);
        const int most = static_cast<int>(kLongest / cell);
        const int shortest = static_cast<int>(std::lround(kShortest / cell));
        const auto row = [&](int gap) {
          const int ahead = reach(seen_over, c, slope, 1, most, gap);
          return 1 + ahead + reach(seen_over, c, slope, -1, most - ahead, gap);
        };
        if (row(kGap) > most) {
          others.push_back(c);
          return;
        }
        long_enough = long_enough || row(0) >= shortest;
      }
      if (!long_enough) others.push_back(c);
    });
  for (const Cell c : others) seen_over[c] = 0;
}

}  // namespace rubble::explore
