#include "explore/plan/pockets.h"

#include <array>
#include <cstddef>
#include <vector>

namespace rubble::explore {
namespace {

std::array<Cell, 4> beside(Cell c) { return {{{c.x + 1, c.y}, {c.x, c.y + 1}, {c.x - 1, c.y}, {c.x, c.y - 1}}}; }

}  // namespace

Grid<std::uint8_t> pockets(const OccupancyGrid& cells, double most) {
  const GridFrame& frame = cells.frame();
  const auto small = static_cast<std::size_t>(most / (frame.resolution * frame.resolution));
  Grid<std::uint8_t> found(frame);
  Grid<std::uint8_t> seen(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      if (cells[{x, y}] != Occupancy::Unknown || seen[{x, y}] != 0) continue;
      std::vector<Cell> piece{{x, y}};
      seen[{x, y}] = 1;
      bool open = false;  // to the end of the map
      for (std::size_t next = 0; next < piece.size(); ++next)
        for (const Cell c : beside(piece[next])) {
          if (!frame.inside(c)) {
            open = true;
          } else if (cells[c] == Occupancy::Unknown && seen[c] == 0) {
            seen[c] = 1;
            piece.push_back(c);
          }
        }
      if (open || piece.size() >= small) continue;
      for (const Cell c : piece) found[c] = 1;
    }
  return found;
}

bool leads_on(const OccupancyGrid& cells, const Grid<std::uint8_t>& pockets, Cell c) {
  for (const Cell n : beside(c))
    if (cells.inside(n) && cells[n] == Occupancy::Unknown && pockets[n] == 0) return true;
  return false;
}

}  // namespace rubble::explore
