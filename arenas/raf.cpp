#include "arenas/raf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "arenas/elements.h"
#include "arenas/geometry.h"
#include "arenas/raf_reader.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/grid.h"
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
    if (kind_of(e.type) == ElementKind::Wall) {
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

/// The file does not say where the robot starts: at the usable flat pallet nearest to (0, 0), in the hall round an open
/// arena only where a wall stands.
void find_start(const Layout& layout, const Grid<std::uint8_t>& outside, const std::string& name, Arena& arena) {
  std::vector<Cell> cells;
  for (int y = 0; y < layout.occupied.height(); ++y) {
    for (int x = 0; x < layout.occupied.width(); ++x) cells.push_back({x, y});
  }
  const auto far = [&](Cell c) {
    const TPoint2D p = layout.occupied.centre(c);
    const std::array<bool, 4>& walled = layout.walled[c];
    const bool is_hall = outside[c] != 0 && std::count(walled.begin(), walled.end(), true) == 0;
    return std::pair(is_hall, std::lround((p.x * p.x + p.y * p.y) / (kPallet * kPallet)));
  };
  std::stable_sort(cells.begin(), cells.end(), [&](Cell a, Cell b) { return far(a) < far(b); });
  for (const bool flat_only : {true, false}) {
    for (const Cell c : cells) {
      const TPoint2D p = layout.occupied.centre(c);
      arena.start = {p.x, p.y, wrap_angle(open_heading(layout, c))};
      if (flat_only && layout.occupied[c] != 0) continue;
      if (!start_trouble(arena)) return;
    }
  }
  throw InputError(name + ": no pallet of the arena has room for the robot to start: add an empty one");
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
  find_start(layout, outside, name, import.arena);
  set_bounds(import.arena);
  check(import.arena, name);
  return import;
}

RafImport import_raf(const std::string& path) { return parse_raf(read_text_file(path), path); }

}  // namespace rubble::arenas
