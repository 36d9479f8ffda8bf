#include "scoring/alignment/drawing_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/angle.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_directions.h"

namespace rubble::scoring {
namespace {

constexpr double kMostSize = 5.0;    // times as large or small
constexpr double kStretched = 1.08;  // more along one axis than along the other

/// How far what is known reaches along and across its walls [m], but for the outermost hundredth to each side (a strip
/// that joins it to something), and the direction of these walls, which is below a right angle.
struct Reach {
  double direction = 0.0;  // [rad]
  double along = 0.0;
  double across = 0.0;
};

double main_direction(const OccupancyGrid& grid) {
  constexpr int kBins = 180;  // of a degree
  const std::vector<double> walls = wall_directions(grid, kBins);
  std::size_t best = 0;
  const auto both = [&](std::size_t i) { return walls[i] + walls[i + kBins / 2]; };
  for (std::size_t i = 1; i < kBins / 2; ++i)
    if (both(i) > both(best)) best = i;
  return (static_cast<double>(best) + 0.5) * kPi / kBins;
}

double between_hundredths(std::vector<double>& values) {
  const auto at = [&](double share) {
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  return values.empty() ? 0.0 : at(0.99) - at(0.01);
}

Reach reach_of(const OccupancyGrid& grid) {
  Reach out;
  out.direction = main_direction(grid);
  const double c = std::cos(out.direction);
  const double s = std::sin(out.direction);
  std::vector<double> along, across;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] == Occupancy::Unknown) continue;
      const mrpt::math::TPoint2D p = grid.centre({x, y});
      along.push_back(c * p.x + s * p.y);
      across.push_back(c * p.y - s * p.x);
    }
  out.along = between_hundredths(along);
  out.across = between_hundredths(across);
  return out;
}

}  // namespace

double known_m2(const OccupancyGrid& grid) {
  const auto unknown = std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Unknown);
  return grid.resolution() * grid.resolution() *
         static_cast<double>(grid.cells().size() - static_cast<std::size_t>(unknown));
}

ToldSizes sizes_told(const OccupancyGrid& drawing, const OccupancyGrid& other) {
  ToldSizes out;
  const Reach own = reach_of(drawing);
  const Reach reach = reach_of(other);
  if (own.along <= 0.0 || own.across <= 0.0) return out;
  const auto possible = [](double size) { return size <= kMostSize && size >= 1.0 / kMostSize; };
  const auto offer = [&](double size) {
    if (possible(size)) out.sizes.push_back(size);
  };
  offer(std::sqrt(known_m2(other) / known_m2(drawing)));
  for (const auto& [along, across] : {std::pair(reach.along, reach.across), std::pair(reach.across, reach.along)}) {
    const AxisSizes by{own.direction, along / own.along, across / own.across};
    if (!possible(by.along) || !possible(by.across)) continue;
    if (std::max(by.along, by.across) < kStretched * std::min(by.along, by.across))
      offer(std::sqrt(by.along * by.across));
    else
      out.stretches.push_back(by);
  }
  return out;
}

OccupancyGrid stretched(const OccupancyGrid& drawing, const AxisSizes& by) {
  const mrpt::math::TPose2D upright(0.0, 0.0, -by.direction);
  const GridFrame frame = common_frame(drawing, OccupancyGrid(drawing.frame()), upright, 0.0);
  const OccupancyGrid turned = resample(drawing, upright, frame);
  GridFrame wide = frame;
  wide.resolution *= by.along;
  wide.height = std::max(1, static_cast<int>(std::lround(frame.height * by.across / by.along)));
  OccupancyGrid out(wide);
  for (int y = 0; y < wide.height; ++y) {
    const int from = std::min(frame.height - 1, static_cast<int>((y + 0.5) * by.along / by.across));
    std::copy(turned.row(from), turned.row(from) + frame.width, out.row(y));
  }
  for (int y = 0; y < frame.height; ++y) {  // no wall is lost between the rows
    const int to = std::min(wide.height - 1, static_cast<int>((y + 0.5) * by.across / by.along));
    for (int x = 0; x < frame.width; ++x)
      if (turned[{x, y}] == Occupancy::Occupied) out[{x, to}] = Occupancy::Occupied;
  }
  return out;
}

}  // namespace rubble::scoring
