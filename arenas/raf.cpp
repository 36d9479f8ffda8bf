#include "arenas/raf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "arenas/elements.h"
#include "arenas/geometry.h"
#include "arenas/raf_reader.h"
#include "arenas/truth_map.h"
#include "arenas/visible.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/grid.h"
#include "base/number_text.h"
#include "base/text_file.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kPallet = 1.2;  ///< [m]
constexpr std::array<Cell, 4> kSteps{Cell{0, 1}, Cell{1, 0}, Cell{0, -1},
                                     Cell{-1, 0}};  ///< rotation 0, 90, 180, 270 deg

/// The pallets of the file as a grid with a rim of one pallet all round.
struct Layout {
  Grid<std::uint8_t> occupied;       ///< something other than a wall stands or lies here
  Grid<std::uint8_t> covered;        ///< a floor hides the ground
  Grid<std::array<bool, 4>> walled;  ///< sides with a wall, in the order of kSteps

  explicit Layout(const GridFrame& frame) : occupied(frame), covered(frame), walled(frame) {}
  Cell cell(const Element& e) const { return occupied.cell(e.position); }
};

Cell step(Cell c, std::size_t direction) { return {c.x + kSteps[direction].x, c.y + kSteps[direction].y}; }

std::size_t direction_of(const Element& element) {
  return static_cast<std::size_t>((std::lround(rad_to_deg(element.rotation) / 90.0) % 4 + 4) % 4);
}

bool is_quarter_turn(const Element& element) {
  const double quarters = rad_to_deg(element.rotation) / 90.0;
  return std::abs(quarters - std::round(quarters)) < 1e-6;
}

Layout layout_of(const std::vector<Element>& elements) {
  TPoint2D low = elements[0].position;
  TPoint2D high = low;
  for (const Element& e : elements) {
    low = {std::min(low.x, e.position.x), std::min(low.y, e.position.y)};
    high = {std::max(high.x, e.position.x), std::max(high.y, e.position.y)};
  }
  const int width = static_cast<int>(std::lround((high.x - low.x) / kPallet)) + 3;
  const int height = static_cast<int>(std::lround((high.y - low.y) / kPallet)) + 3;
  Layout layout(GridFrame{width, height, kPallet, low.x - 1.5 * kPallet, low.y - 1.5 * kPallet});
  for (const Element& e : elements) {
    const Cell c = layout.cell(e);
    if (kind_of(e.type) == ElementKind::Wall && is_quarter_turn(e)) {
      const std::size_t d = direction_of(e);
      layout.walled[c][d] = true;
      layout.walled[step(c, d)][(d + 2) % 4] = true;
    } else if (kind_of(e.type) == ElementKind::Floor || kind_of(e.type) == ElementKind::Diagonal) {
      layout.occupied[c] = 1;
    }
    if (covers_pallet(e.type)) layout.covered[c] = 1;
  }
  return layout;
}

/// Pallets that are connected to the rim without a wall between, and empty: the hall round the arena.
Grid<std::uint8_t> outside_of(const Layout& layout) {
  Grid<std::uint8_t> outside(layout.occupied.frame());
  std::vector<Cell> open{{0, 0}};
  outside[{0, 0}] = 1;
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    for (std::size_t d = 0; d < 4; ++d) {
      const Cell next = step(c, d);
      if (!outside.inside(next) || outside[next] != 0 || layout.walled[c][d] || layout.occupied[next] != 0) continue;
      outside[next] = 1;
      open.push_back(next);
    }
  }
  return outside;
}

/// Whether some wall has the hall on both sides: then the arena is not closed, and its pallets cannot be told from the
/// hall.
bool is_open(const Layout& layout, const Grid<std::uint8_t>& outside) {
  for (int y = 0; y < outside.height(); ++y) {
    for (int x = 0; x < outside.width(); ++x) {
      for (std::size_t d = 0; d < 2; ++d) {
        if (outside[{x, y}] != 0 && layout.walled[{x, y}][d] && outside[step({x, y}, d)] != 0) return true;
      }
    }
  }
  return false;
}

/// Flat floor on every pallet inside the arena that has none of its own; on all pallets when the arena is open.
void lay_ground(const Layout& layout, const Grid<std::uint8_t>& outside, Arena& arena) {
  const bool everywhere = is_open(layout, outside);
  for (int y = 1; y + 1 < outside.height(); ++y) {
    for (int x = 1; x + 1 < outside.width(); ++x) {
      if ((!everywhere && outside[{x, y}] != 0) || layout.covered[{x, y}] != 0) continue;
      arena.floor.push_back({rectangle(outside.centre({x, y}), kPallet, kPallet), 0.0, 0.0, 0.0, "flat"});
    }
  }
}

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
  for (const Cell c : pallets) {
    if (known[c] != 0 || !can_start(layout, c, arena)) continue;
    const OccupancyGrid truth = truth_map(arena, kCoarse);
    const Grid<std::uint8_t> reached = reachable_mask(arena, truth);
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

/// The file does not say where the robot starts, unless it has a start check.
void find_start(const Layout& layout, const std::vector<Element>& elements, const std::string& name,
                RafImport& import) {
  const Grid<std::uint8_t> enclosed = enclosed_by(layout);
  const std::vector<Cell> pallets = ranked_pallets(layout, enclosed);
  std::string type;
  if (const auto marked = marked_start(layout, elements, pallets, import.arena, type)) {
    import.start_note = "the robot starts on pallet " + pallet_name(layout, *marked) + ", at the '" + type + "'";
    can_start(layout, *marked, import.arena);
    return;
  }
  const std::vector<Region> regions = regions_of(layout, enclosed, pallets, import.arena);
  if (regions.empty())
    throw InputError(name + ": no pallet of the arena has room for the robot to start: add an empty one (" +
                     import.summary() + ")");
  const auto largest = std::max_element(regions.begin(), regions.end(),
                                        [](const Region& a, const Region& b) { return a.inside < b.inside; });
  const Cell start = start_in(*largest, layout, enclosed, import.arena);
  import.start_note = "the file names no start: the robot starts on pallet " + pallet_name(layout, start) +
                      ", in the largest of " + std::to_string(regions.size()) + " parts that can be driven on";
  if (regions.size() == 1) {
    import.start_note = "the file names no start: the robot starts on pallet " + pallet_name(layout, start);
  }
  can_start(layout, start, import.arena);
}

std::string list(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [type, count] : counts) text += (text.empty() ? "" : ", ") + type + " " + std::to_string(count);
  return text;
}

}  // namespace

std::string RafImport::summary() const {
  int parts = 0;
  for (const auto& [type, count] : built) parts += count;
  std::string text = std::to_string(parts) + " parts built";
  if (!labels.empty()) text += "; without a shape: " + list(labels);
  if (!unknown.empty()) text += "; UNKNOWN, left out: " + list(unknown);
  return text;
}

std::vector<std::string> RafImport::notes() const {
  std::vector<std::string> lines;
  if (!labels.empty() || !unknown.empty()) lines.push_back(summary());
  if (!askew.empty()) lines.push_back("at other than quarter turns: " + list(askew) + "; their walls close no room");
  if (!start_note.empty()) lines.push_back(start_note);
  return lines;
}

RafImport parse_raf(const std::string& text, const std::string& name) {
  const std::vector<Element> elements = read_raf_elements(text, name);
  RafImport import;
  const std::string file = name.substr(name.find_last_of('/') + 1);
  import.arena.name = file.substr(0, file.find_last_of('.'));
  const Layout layout = layout_of(elements);
  const Grid<std::uint8_t> outside = outside_of(layout);
  lay_ground(layout, outside, import.arena);
  for (const Element& element : elements) {
    const ElementKind kind = kind_of(element.type);
    if (!is_quarter_turn(element)) ++import.askew[element.type];
    if (kind == ElementKind::Unknown) {
      ++import.unknown[element.type];
    } else if (kind == ElementKind::Label) {
      ++import.labels[element.type];
    } else {
      ++import.built[element.type];
      import.elements.push_back(element);
      place(element, wall_behind(element, elements), import.arena);
    }
  }
  set_bounds(import.arena);
  find_start(layout, elements, name, import);
  check(import.arena, name);
  return import;
}

RafImport import_raf(const std::string& path) { return parse_raf(read_text_file(path), path); }

}  // namespace rubble::arenas
