#include "scoring/walls/resample.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::scoring {
namespace {

struct CellBox {
  int x_min = 0, y_min = 0, x_max = -1, y_max = -1;
  bool empty() const { return x_max < x_min; }
};

CellBox known_box(const OccupancyGrid& grid) {
  CellBox box{grid.width(), grid.height(), -1, -1};
  for (int y = 0; y < grid.height(); ++y) {
    const Occupancy* row = grid.row(y);
    for (int x = 0; x < grid.width(); ++x) {
      if (row[x] == Occupancy::Unknown) continue;
      box.x_min = std::min(box.x_min, x);
      box.x_max = std::max(box.x_max, x);
      box.y_min = std::min(box.y_min, y);
      box.y_max = std::max(box.y_max, y);
    }
  }
  return box;
}

GridFrame grown(const GridFrame& lattice, const CellBox& box, int margin) {
  GridFrame frame = lattice;
  frame.x0 = lattice.x0 + (box.x_min - margin) * lattice.resolution;
  frame.y0 = lattice.y0 + (box.y_min - margin) * lattice.resolution;
  frame.width = box.x_max - box.x_min + 1 + 2 * margin;
  frame.height = box.y_max - box.y_min + 1 + 2 * margin;
  return frame;
}

int cells(double length, double resolution) { return static_cast<int>(std::ceil(length / resolution)); }

}  // namespace

std::optional<GridFrame> known_frame(const OccupancyGrid& grid, double margin) {
  const CellBox box = known_box(grid);
  if (box.empty()) return std::nullopt;
  return grown(grid.frame(), box, cells(margin, grid.resolution()));
}

OccupancyGrid crop_to_known(const OccupancyGrid& grid, double margin) {
  const std::optional<GridFrame> frame = known_frame(grid, margin);
  if (!frame) return grid;
  const int dx = static_cast<int>(std::lround((frame->x0 - grid.frame().x0) / grid.resolution()));
  const int dy = static_cast<int>(std::lround((frame->y0 - grid.frame().y0) / grid.resolution()));
  OccupancyGrid out(*frame);
  for (int y = std::max(0, -dy); y < std::min(frame->height, grid.height() - dy); ++y) {
    const int x_first = std::max(0, -dx);
    const int x_last = std::min(frame->width, grid.width() - dx);
    std::copy(grid.row(y + dy) + x_first + dx, grid.row(y + dy) + x_last + dx, out.row(y) + x_first);
  }
  return out;
}

OccupancyGrid mirror_image(const OccupancyGrid& grid) {
  OccupancyGrid out(grid.frame());
  for (int y = 0; y < grid.height(); ++y) std::reverse_copy(grid.row(y), grid.row(y) + grid.width(), out.row(y));
  return out;
}

OccupancyGrid at_size(const OccupancyGrid& map, double times) {
  GridFrame frame = map.frame();
  frame.resolution *= times;
  return with_frame(map, frame);
}

std::vector<double> sizes_about(double middle, double step, int steps) {
  std::vector<double> out;
  for (int i = -steps; i <= steps; ++i) out.push_back(middle * std::pow(step, i));
  return out;
}

GridFrame common_frame(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                       double margin) {
  CellBox box = known_box(truth);
  if (box.empty()) box = {truth.width(), truth.height(), -1, -1};
  const PlanarTransform T(T_truth_map);
  // The ends of each row's known stretch hold all extreme points, at any angle.
  for (int y = 0; y < map.height(); ++y) {
    const Occupancy* row = map.row(y);
    const auto is_known = [](Occupancy o) { return o != Occupancy::Unknown; };
    const Occupancy* first = std::find_if(row, row + map.width(), is_known);
    if (first == row + map.width()) continue;
    const Occupancy* last = row + map.width() - 1;
    while (!is_known(*last)) --last;
    for (const Occupancy* end : {first, last}) {
      const Cell c = truth.cell(T(map.centre({static_cast<int>(end - row), y})));
      box.x_min = std::min(box.x_min, c.x);
      box.x_max = std::max(box.x_max, c.x);
      box.y_min = std::min(box.y_min, c.y);
      box.y_max = std::max(box.y_max, c.y);
    }
  }
  if (box.empty()) return truth.frame();
  return grown(truth.frame(), box, cells(margin, truth.resolution()));
}

OccupancyGrid resample(const OccupancyGrid& map, const mrpt::math::TPose2D& T_frame_map, const GridFrame& frame) {
  OccupancyGrid out(frame);
  const PlanarTransform T(T_frame_map);
  const double c = T.cosine();
  const double s = T.sine();
  const double step = frame.resolution / map.resolution();
  for (int y = 0; y < frame.height; ++y) {
    const mrpt::math::TPoint2D first = T.inverse(frame.centre({0, y}));
    const double u = (first.x - map.frame().x0) / map.resolution();
    const double v = (first.y - map.frame().y0) / map.resolution();
    Occupancy* row = out.row(y);
    for (int x = 0; x < frame.width; ++x) {
      const Cell cell{static_cast<int>(std::floor(u + c * step * x)), static_cast<int>(std::floor(v - s * step * x))};
      if (map.inside(cell)) row[x] = map[cell];
    }
  }
  if (map.resolution() > 0.9 * frame.resolution) return out;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      const Cell cell = frame.cell(T(map.centre({x, y})));
      if (frame.inside(cell)) out[cell] = Occupancy::Occupied;
    }
  }
  return out;
}

}  // namespace rubble::scoring
