#include "scoring/walls/wall_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/distance_transform.h"

namespace rubble::scoring {
namespace {

/// Cell of the bilinear patch that holds p and the position inside it.
struct Patch {
  Cell cell;
  double u = 0.0;
  double v = 0.0;
  bool inside = false;
};

Patch patch(const GridFrame& frame, const mrpt::math::TPoint2D& p) {
  const double x = (p.x - frame.x0) / frame.resolution - 0.5;
  const double y = (p.y - frame.y0) / frame.resolution - 0.5;
  Patch out;
  if (!(x >= 0.0 && y >= 0.0 && x < frame.width - 1 && y < frame.height - 1)) return out;
  out.cell = {static_cast<int>(x), static_cast<int>(y)};
  out.u = x - out.cell.x;
  out.v = y - out.cell.y;
  out.inside = true;
  return out;
}

}  // namespace

std::vector<mrpt::math::TPoint2D> wall_points(const OccupancyGrid& grid) {
  std::vector<mrpt::math::TPoint2D> points;
  points.reserve(static_cast<std::size_t>(std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Occupied)));
  for (int y = 0; y < grid.height(); ++y) {
    const Occupancy* row = grid.row(y);
    for (int x = 0; x < grid.width(); ++x)
      if (row[x] == Occupancy::Occupied) points.push_back(grid.centre({x, y}));
  }
  return points;
}

WallField::WallField(const OccupancyGrid& grid, double cap) : cap_(cap) {
  const std::vector<mrpt::math::TPoint2D> walls = wall_points(grid);
  if (walls.empty()) return;
  Cell low{grid.width(), grid.height()};
  Cell high{-1, -1};
  for (const mrpt::math::TPoint2D& p : walls) {
    const Cell c = grid.cell(p);
    low = {std::min(low.x, c.x), std::min(low.y, c.y)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y)};
  }
  const int margin = static_cast<int>(std::ceil(cap / grid.resolution())) + 1;
  GridFrame frame = grid.frame();
  frame.x0 += (low.x - margin) * frame.resolution;
  frame.y0 += (low.y - margin) * frame.resolution;
  frame.width = high.x - low.x + 1 + 2 * margin;
  frame.height = high.y - low.y + 1 + 2 * margin;
  Grid<std::uint8_t> mask(frame);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      if (grid[{x, y}] == Occupancy::Occupied) mask[{x - low.x + margin, y - low.y + margin}] = 1;
  distance_ = distance_transform(mask, cap);
}

double WallField::distance(const mrpt::math::TPoint2D& p) const {
  const Patch at = patch(distance_.frame(), p);
  if (!at.inside) return cap_;
  const float* south = distance_.row(at.cell.y) + at.cell.x;
  const float* north = distance_.row(at.cell.y + 1) + at.cell.x;
  const double a = south[0] + at.u * (south[1] - south[0]);
  const double b = north[0] + at.u * (north[1] - north[0]);
  return a + at.v * (b - a);
}

WallField::Slope WallField::slope(const mrpt::math::TPoint2D& p) const {
  const Patch at = patch(distance_.frame(), p);
  if (!at.inside) return {cap_, 0.0, 0.0};
  const float* south = distance_.row(at.cell.y) + at.cell.x;
  const float* north = distance_.row(at.cell.y + 1) + at.cell.x;
  const double a = south[0] + at.u * (south[1] - south[0]);
  const double b = north[0] + at.u * (north[1] - north[0]);
  const double scale = 1.0 / distance_.resolution();
  const double gx = ((1.0 - at.v) * (south[1] - south[0]) + at.v * (north[1] - north[0])) * scale;
  return {a + at.v * (b - a), gx, (b - a) * scale};
}

}  // namespace rubble::scoring
