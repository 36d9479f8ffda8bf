#include "arenas/files/plan.h"

#include <cmath>

#include "arenas/files/piece.h"
#include "arenas/model/geometry.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// The floor of one pallet; `foot` is the height of its low edge [m].
FloorPatch pallet(char shape, const TPoint2D& centre, double edge, double foot, double slope) {
  FloorPatch patch;
  patch.outline = rectangle(centre, edge, edge);
  patch.element = shape == '.' ? kFlatElement : "ramp";
  if (shape == '>') patch.gx = slope;
  if (shape == '<') patch.gx = -slope;
  if (shape == '^') patch.gy = slope;
  if (shape == 'v') patch.gy = -slope;
  patch.z = foot + (shape == '<' || shape == 'v' ? slope * edge : 0.0);  // outline[0] is the south-western corner
  return patch;
}

}  // namespace

Plan::Plan(const YamlMap& root, Arena& arena)
    : cell_size_(root.number("cell_m", kPallet, 0.5, 5.0)),
      wall_height_(root.number("wall_height_m", 1.2, 0.05, 5.0)),
      wall_thickness_(root.number("wall_thickness_m", 0.02, 0.005, 0.3)) {
  const double slope = std::tan(deg_to_rad(root.number("ramp_deg", 10.0, 0.0, 45.0)));
  arena.cell_size = cell_size_;
  if (!root.has("maze")) return;
  const Drawing drawing = read_drawing(root, "maze");
  add_cells(root, arena, drawing, slope);
  add_walls(arena, drawing);
}

void Plan::add_cells(const YamlMap& root, Arena& arena, const Drawing& drawing, double ramp_slope) {
  const double rise = ramp_slope * cell_size_;
  for (int y = 0; y < drawing.cells.height(); ++y) {
    for (int x = 0; x < drawing.cells.width(); ++x) {
      const DrawnCell& cell = drawing.cells[{x, y}];
      if (cell.shape == ' ') continue;
      const TPoint2D centre{(x + 0.5) * cell_size_, (y + 0.5) * cell_size_};
      if (cell.shape == '#') {
        arena.solids.push_back({rectangle(centre, cell_size_, cell_size_), 0.0, wall_height_, "block"});
      } else {
        arena.floor.push_back(pallet(cell.shape, centre, cell_size_, cell.level * rise, ramp_slope));
      }
      if (cell.mark == 'S') {
        if (start_cell_) root.fail_at("maze", cell.row, cell.column, "a second S: the robot starts in one pallet");
        start_cell_ = cell;
        start_ = centre;
      }
      if (cell.mark == 0) continue;
      Mark& mark = marks_[cell.mark];
      if (mark.centres.empty()) mark.first = cell;
      mark.centres.push_back(centre);
    }
  }
}

/// Walls in line become one solid: the laser and the wheels see the same, at a fraction of the cost.
void Plan::add_walls(Arena& arena, const Drawing& drawing) const {
  const int columns = drawing.cells.width();
  const int rows = drawing.cells.height();
  const auto add = [&](double x0, double y0, double x1, double y1) {
    const Outline outline =
        strip({x0 * cell_size_, y0 * cell_size_}, {x1 * cell_size_, y1 * cell_size_}, wall_thickness_);
    arena.solids.push_back({outline, 0.0, wall_height_, kWallElement});
  };
  for (int y = 0; y <= rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int first = x;
      while (x < columns && drawing.wall_south(x, y)) ++x;
      if (x > first) add(first, y, x, y);
    }
  }
  for (int x = 0; x <= columns; ++x) {
    for (int y = 0; y < rows; ++y) {
      const int first = y;
      while (y < rows && drawing.wall_west(x, y)) ++y;
      if (y > first) add(x, first, x, y);
    }
  }
}

std::vector<TPoint2D> Plan::places(const YamlMap& entry) {
  if (!entry.has("cell")) {
    if (!entry.has("x_m")) entry.fail("", "where is it? give 'cell: A' (a letter of the drawing) or 'x_m' and 'y_m'");
    const double x = entry.number("x_m", std::nullopt, -kFar, kFar);
    const double y = entry.number("y_m", std::nullopt, -kFar, kFar);
    return {{x, y}};
  }
  const std::string letter = entry.text("cell", std::nullopt);
  const auto found = letter.size() == 1 ? marks_.find(letter[0]) : marks_.end();
  if (found == marks_.end()) {
    entry.fail("cell", "no pallet of the drawing is marked '" + letter + "': write that letter into one");
  }
  found->second.used = true;
  const double dx = entry.number("dx_m", 0.0, -kFar, kFar);
  const double dy = entry.number("dy_m", 0.0, -kFar, kFar);
  std::vector<TPoint2D> moved = found->second.centres;
  for (TPoint2D& p : moved) p = p + TPoint2D{dx, dy};
  return moved;
}

TPoint2D Plan::place(const YamlMap& entry) {
  const std::vector<TPoint2D> all = places(entry);
  if (all.size() > 1) {
    entry.fail("cell", "several pallets are marked '" + entry.text("cell", std::nullopt) +
                           "', but this can lie in one only: use a letter of its own");
  }
  return all.front();
}

void Plan::finish(const YamlMap& root) const {
  for (const auto& [letter, mark] : marks_) {
    if (mark.used || letter == 'S') continue;
    root.fail_at("maze", mark.first.row, mark.first.column,
                 std::string("nothing below refers to the letter '") + letter + "': use it as 'cell: " + letter +
                     "' or take it out");
  }
}

}  // namespace rubble::arenas
