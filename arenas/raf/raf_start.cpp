#include "arenas/raf/raf_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "arenas/truth/start_region.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// The first of the four directions in which the next pallet is open, as a bearing [rad].
double open_heading(const Layout& layout, Cell c) {
  for (std::size_t d = 0; d < 4; ++d) {
    if (!layout.walled[c][d]) return 0.5 * kPi - 0.5 * kPi * static_cast<double>(d);
  }
  return 0.0;
}

/// Pallets with a wall or a part, or more of them, to all four sides: what lies between walls even where the arena is
/// open.
Grid<std::uint8_t> enclosed_by(const Layout& layout) {
  const GridFrame& frame = layout.occupied.frame();
  Grid<std::uint8_t> enclosed(frame);
  const auto ends_view = [&](Cell from, std::size_t d) {
    for (Cell c = from; frame.inside(c); c = step(c, d))
      if (layout.walled[c][d] || (c != from && layout.occupied[c] != 0)) return true;
    return false;
  };
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      bool all = true;
      for (std::size_t d = 0; d < 4; ++d) all = all && ends_view({x, y}, d);
      enclosed[{x, y}] = all ? 1 : 0;
    }
  }
  return enclosed;
}

/// All pallets, the likelier starts first: between walls, flat, near (0, 0).
std::vector<Cell> ranked_pallets(const Layout& layout, const Grid<std::uint8_t>& enclosed) {
  std::vector<Cell> cells;
  for (int y = 0; y < layout.occupied.height(); ++y) {
    for (int x = 0; x < layout.occupied.width(); ++x) cells.push_back({x, y});
  }
  const auto rank = [&](Cell c) {
    const TPoint2D p = layout.occupied.centre(c);
    return std::tuple(enclosed[c] == 0, layout.occupied[c] != 0,
                      std::lround((p.x * p.x + p.y * p.y) / (kPallet * kPallet)));
  };
  std::stable_sort(cells.begin(), cells.end(), [&](Cell a, Cell b) { return rank(a) < rank(b); });
  return cells;
}

bool can_start(const Layout& layout, Cell c, Arena& arena) {
  const TPoint2D p = layout.occupied.centre(c);
  arena.start = {p.x, p.y, wrap_angle(open_heading(layout, c))};
  return !start_trouble(arena);
}

/// A stretch of floor the robot can drive about on.
struct Region {
  std::vector<Cell> pallets;  ///< in the order of ranked_pallets; the robot can start on the first
  double inside = 0.0;        ///< area between the walls that the robot's middle gets to [m2]
};

std::vector<Region> regions_of(const Layout& layout, const Grid<std::uint8_t>& enclosed,
                               const std::vector<Cell>& pallets, Arena arena) {
  constexpr double kCoarse = 0.1;  ///< [m]
  Grid<std::uint8_t> known(layout.occupied.frame());
  std::vector<Region> regions;
  std::optional<OccupancyGrid> drawn;  // for the first pallet: without any there is nothing to draw
  Grid<float> room;
  for (const Cell c : pallets) {
    if (known[c] != 0 || !can_start(layout, c, arena)) continue;
    if (!drawn) {
      drawn = drawn_map(arena, kCoarse);
      room = standing_room(arena, *drawn);
    }
    const OccupancyGrid truth = around_start(arena, *drawn);
    const Grid<std::uint8_t> reached = reachable_mask({arena.start.x, arena.start.y}, truth, room);
    Region region;
    for (int y = 0; y < reached.height(); ++y) {
      for (int x = 0; x < reached.width(); ++x) {
        const Cell pallet = known.cell(reached.frame().centre({x, y}));
        if (reached[{x, y}] == 0 || !known.inside(pallet)) continue;
        known[pallet] = 1;
        if (enclosed[pallet] != 0) region.inside += kCoarse * kCoarse;
      }
    }
    for (const Cell other : pallets) {
      const Cell middle = reached.frame().cell(layout.occupied.centre(other));
      if (other == c || (reached.frame().inside(middle) && reached[middle] != 0)) region.pallets.push_back(other);
    }
    known[c] = 1;
    regions.push_back(region);
  }
  return regions;
}

constexpr int kRoom = 3;  ///< pallets between a good start and the next ramp or step field

/// How far the next pallet with a part on it is, up to kRoom.
int room_around(const Layout& layout, Cell c) {
  for (int room = 1; room < kRoom; ++room) {
    for (int y = c.y - room; y <= c.y + room; ++y) {
      for (int x = c.x - room; x <= c.x + room; ++x) {
        if (layout.occupied.inside({x, y}) && layout.occupied[{x, y}] != 0) return room;
      }
    }
  }
  return kRoom;
}

/// A pallet in the middle of ramps is a poor start: on the largest flat stretch between the walls, if there is any.
Cell start_in(const Region& region, const Layout& layout, const Grid<std::uint8_t>& enclosed, Arena arena) {
  Grid<std::uint8_t> open(layout.occupied.frame());
  for (const Cell c : region.pallets) open[c] = enclosed[c] != 0 && layout.occupied[c] == 0 ? 1 : 0;
  std::size_t most = 0;
  Cell start = region.pallets.front();
  for (const Cell c : region.pallets) {
    if (open[c] == 0) continue;
    std::vector<Cell> stretch{c};
    open[c] = 0;
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      for (std::size_t d = 0; d < 4; ++d) {
        const Cell next = step(stretch[i], d);
        if (!open.inside(next) || open[next] == 0 || layout.walled[stretch[i]][d]) continue;
        open[next] = 0;
        stretch.push_back(next);
      }
    }
    if (stretch.size() <= most) continue;
    const auto roomy = [&](int room) {
      return std::find_if(region.pallets.begin(), region.pallets.end(), [&](Cell p) {
        return std::find(stretch.begin(), stretch.end(), p) != stretch.end() && room_around(layout, p) >= room &&
               can_start(layout, p, arena);
      });
    };
    auto usable = region.pallets.end();
    for (int room = kRoom; room > 0 && usable == region.pallets.end(); --room) usable = roomy(room);
    if (usable == region.pallets.end()) continue;
    most = stretch.size();
    start = *usable;
  }
  return start;
}

std::string pallet_name(const Layout& layout, Cell c) {
  const TPoint2D p = layout.occupied.centre(c) * (1.0 / kPallet);
  return "x=\"" + number_text(std::round(100.0 * p.x) / 100.0) + "\" y=\"" +
         number_text(std::round(100.0 * p.y) / 100.0) + "\"";
}

/// The usable pallet nearest to a part whose name begins with `start`, at most two pallets away.
std::optional<Cell> marked_start(const Layout& layout, const std::vector<Element>& elements,
                                 const std::vector<Cell>& pallets, Arena arena, std::string& type) {
  for (const Element& e : elements) {
    if (e.type.rfind("start", 0) != 0) continue;
    const auto far = [&](Cell c) {
      const TPoint2D d = layout.occupied.centre(c) - e.position;
      return std::hypot(d.x, d.y);
    };
    std::vector<Cell> near;
    for (const Cell c : pallets)
      if (far(c) < 2.0 * kPallet + 1e-6) near.push_back(c);
    std::stable_sort(near.begin(), near.end(), [&](Cell a, Cell b) { return far(a) < far(b) - 1e-6; });
    const auto usable = std::find_if(near.begin(), near.end(), [&](Cell c) { return can_start(layout, c, arena); });
    if (usable == near.end()) continue;
    type = e.type;
    return *usable;
  }
  return std::nullopt;
}

}  // namespace

void find_start(const Layout& layout, const std::vector<Element>& elements, const std::string& name,
                RafImport& import) {
  const Grid<std::uint8_t> enclosed = enclosed_by(layout);
  std::vector<Cell> pallets = ranked_pallets(layout, enclosed);
  std::string type;
  const auto marked = marked_start(layout, elements, pallets, import.arena, type);
  if (marked) std::stable_partition(pallets.begin(), pallets.end(), [&](Cell c) { return c == *marked; });
  const std::vector<Region> regions = regions_of(layout, enclosed, pallets, import.arena);
  if (regions.empty())
    throw InputError(name + ": no pallet of the arena has room for the robot to start: add an empty one (" +
                     import.summary() + ")");
  const auto largest = std::max_element(regions.begin(), regions.end(),
                                        [](const Region& a, const Region& b) { return a.inside < b.inside; });
  if (marked && regions.front().inside >= kSmallShare * largest->inside) {
    import.start_note = "the robot starts on pallet " + pallet_name(layout, *marked) + ", at the '" + type + "'";
    can_start(layout, *marked, import.arena);
    return;
  }
  const Cell start = start_in(*largest, layout, enclosed, import.arena);
  can_start(layout, start, import.arena);
  import.start_note = (marked ? "the '" + type + "' stands where the robot gets to little of the floor"
                              : std::string("the file names no start")) +
                      ": the robot starts on pallet " + pallet_name(layout, start);
  if (regions.size() > 1)
    import.start_note += ", in the largest of " + std::to_string(regions.size()) + " parts that can be driven on";
}

}  // namespace rubble::arenas
