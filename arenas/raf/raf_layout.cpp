#include "arenas/raf/raf_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arenas/model/geometry.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

std::size_t direction_of(const Element& element) {
  return static_cast<std::size_t>((std::lround(rad_to_deg(element.rotation) / 90.0) % 4 + 4) % 4);
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

}  // namespace

Cell step(Cell c, std::size_t direction) {
  const Cell side = clockwise_side(direction);
  return {c.x + side.x, c.y + side.y};
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

void lay_ground(const Layout& layout, Arena& arena) {
  const Grid<std::uint8_t> outside = outside_of(layout);
  const bool everywhere = is_open(layout, outside);
  for (int y = 1; y + 1 < outside.height(); ++y) {
    for (int x = 1; x + 1 < outside.width(); ++x) {
      if ((!everywhere && outside[{x, y}] != 0) || layout.covered[{x, y}] != 0) continue;
      arena.floor.push_back({rectangle(outside.centre({x, y}), kPallet, kPallet), 0.0, 0.0, 0.0, kFlatElement});
    }
  }
}

}  // namespace rubble::arenas
