#include "explore/plan/outlook.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/angle.h"

namespace rubble::explore {
namespace {

constexpr double kRange = 4.0;  ///< of the level laser [m]
constexpr double kInto = 1.2;   ///< the unknown [m]

}  // namespace

double expected_area(const Traversable& floor, Cell from) {
  const double resolution = floor.frame().resolution;
  const int reach = static_cast<int>(std::lround(kRange / resolution));
  const int into = static_cast<int>(std::lround(kInto / resolution));
  const int width = 2 * reach + 1;
  std::vector<std::uint8_t> met(static_cast<std::size_t>(width) * static_cast<std::size_t>(width));
  std::size_t cells = 0;
  const int rays = static_cast<int>(2.0 * kPi * reach);
  for (int i = 0; i < rays; ++i) {
    const double dx = std::cos(2.0 * kPi * i / rays), dy = std::sin(2.0 * kPi * i / rays);
    int unknown = 0;
    for (int step = 1; step <= reach && unknown < into; ++step) {
      const Cell off{static_cast<int>(std::lround(dx * step)), static_cast<int>(std::lround(dy * step))};
      const Cell c{from.x + off.x, from.y + off.y};
      // Beyond the known part all is unknown.
      const Occupancy what = floor.cells.inside(c) ? floor.cells[c] : Occupancy::Unknown;
      if (what == Occupancy::Occupied) break;
      if (what == Occupancy::Free) continue;
      ++unknown;
      std::uint8_t& seen = met[static_cast<std::size_t>((off.y + reach) * width + off.x + reach)];
      cells += seen == 0 ? 1u : 0u;
      seen = 1;
    }
  }
  return static_cast<double>(cells) * resolution * resolution;
}

}  // namespace rubble::explore
