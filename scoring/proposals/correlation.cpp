#include "scoring/proposals/correlation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "base/angle.h"
#include "base/distance_transform.h"
#include "scoring/walls/wall_directions.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Walls and free space of one map as metric points around a centre of rotation.
struct PointSet {
  TPoint2D centre;
  double radius = 0.0;  ///< of the circle around `centre` that holds all points [m]
  std::vector<TPoint2D> walls;
  std::vector<TPoint2D> free;  ///< one for each `free_area`
};

/// The classes of `grid` on a lattice of `cell` metres: occupied where any wall is, else free where half of it is free.
OccupancyGrid coarsen(const OccupancyGrid& grid, double cell) {
  const int factor = std::max(1, static_cast<int>(std::lround(cell / grid.resolution())));
  GridFrame frame = grid.frame();
  frame.resolution = grid.resolution() * factor;
  frame.width = (grid.width() + factor - 1) / factor;
  frame.height = (grid.height() + factor - 1) / factor;
  Grid<int> walls(frame);
  Grid<int> free(frame);
  for (int y = 0; y < grid.height(); ++y) {
    const Occupancy* row = grid.row(y);
    for (int x = 0; x < grid.width(); ++x) {
      walls[{x / factor, y / factor}] += row[x] == Occupancy::Occupied ? 1 : 0;
      free[{x / factor, y / factor}] += row[x] == Occupancy::Free ? 1 : 0;
    }
  }
  OccupancyGrid out(frame);
  for (std::size_t i = 0; i < out.cells().size(); ++i) {
    if (walls.cells()[i] > 0)
      out.cells()[i] = Occupancy::Occupied;
    else if (2 * free.cells()[i] >= factor * factor)
      out.cells()[i] = Occupancy::Free;
  }
  return out;
}

PointSet points_of(const OccupancyGrid& grid) {
  PointSet set;
  TPoint2D sum(0.0, 0.0);
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const Cell c{x, y};
      if (grid[c] == Occupancy::Unknown) continue;
      (grid[c] == Occupancy::Occupied ? set.walls : set.free).push_back(grid.centre(c));
      sum += grid.centre(c);
    }
  }
  const double n = static_cast<double>(set.walls.size() + set.free.size());
  if (n == 0.0) return set;
  set.centre = {sum.x / n, sum.y / n};
  for (std::vector<TPoint2D>* points : {&set.walls, &set.free}) {
    for (TPoint2D& p : *points) {
      p -= set.centre;
      set.radius = std::max(set.radius, p.norm());
    }
  }
  return set;
}

/// Where shift (0, 0) of the moved map's centre lies on the correlation canvas, and how large the canvas is.
struct Canvas {
  double cell = 0.0;
  double x0 = 0.0;  ///< truth coordinates of the canvas corner [m]
  double y0 = 0.0;
  int width = 0;
  int height = 0;
  int half = 0;  ///< cells from the moved map's raster corner to its centre
};

/// Spectra of what a map wall (or free cell) is worth at each place of the truth.
struct Targets {
  cv::Mat wall;
  cv::Mat free;
};

Targets make_targets(const OccupancyGrid& truth, const Canvas& canvas, const CorrelationConfig& config) {
  cv::Mat wall = cv::Mat::zeros(canvas.height, canvas.width, CV_32F);
  cv::Mat free = cv::Mat::zeros(canvas.height, canvas.width, CV_32F);
  const WallField field(truth, config.reach);
  const OccupancyGrid coarse = coarsen(truth, 0.5 * config.cell);
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      const TPoint2D p(canvas.x0 + (x + 0.5) * canvas.cell, canvas.y0 + (y + 0.5) * canvas.cell);
      const double met = 1.0 - field.distance(p) / config.reach;
      const Cell c = coarse.cell(p);
      const bool is_free = coarse.inside(c) && coarse[c] == Occupancy::Free;
      const bool is_wall = coarse.inside(c) && coarse[c] == Occupancy::Occupied;
      wall.at<float>(y, x) =
          static_cast<float>(config.wall_on_wall * met + (is_free ? config.wall_on_free * (1.0 - met) : 0.0));
      free.at<float>(y, x) = static_cast<float>(is_wall ? config.free_on_wall : is_free ? config.free_on_free : 0.0);
    }
  }
  Targets targets;
  cv::dft(wall, targets.wall);
  cv::dft(free, targets.free);
  return targets;
}

/// Adds bilinear mass, so that the raster turns smoothly with the angle.
void splat(cv::Mat& raster, double x, double y, float mass) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const int ix = static_cast<int>(fx);
  const int iy = static_cast<int>(fy);
  const float u = static_cast<float>(x - fx);
  const float v = static_cast<float>(y - fy);
  float* a = raster.ptr<float>(iy) + ix;
  float* b = raster.ptr<float>(iy + 1) + ix;
  a[0] += mass * (1.0F - u) * (1.0F - v);
  a[1] += mass * u * (1.0F - v);
  b[0] += mass * (1.0F - u) * v;
  b[1] += mass * u * v;
}

cv::Mat rasterise(const std::vector<TPoint2D>& points, double angle, float mass, const Canvas& canvas) {
  cv::Mat raster = cv::Mat::zeros(canvas.height, canvas.width, CV_32F);
  const double c = std::cos(angle) / canvas.cell;
  const double s = std::sin(angle) / canvas.cell;
  for (const TPoint2D& p : points)
    splat(raster, c * p.x - s * p.y + canvas.half, s * p.x + c * p.y + canvas.half, mass);
  return raster;
}

/// Spectra of a turned map.
struct Turned {
  cv::Mat wall;
  cv::Mat free;
};

Turned turn(const PointSet& map, double angle, const Canvas& canvas, float wall_mass, float free_mass) {
  Turned out{rasterise(map.walls, angle, wall_mass, canvas), rasterise(map.free, angle, free_mass, canvas)};
  cv::dft(out.wall, out.wall);
  cv::dft(out.free, out.free);
  return out;
}

/// The evidence at every shift. `opposite`: for the map turned by another half turn, whose raster is the same read
/// backwards, so that its correlation is a convolution.
cv::Mat correlation(const Turned& map, const Targets& targets, bool opposite) {
  cv::Mat product;
  cv::Mat product_free;
  cv::mulSpectrums(targets.wall, map.wall, product, 0, !opposite);
  cv::mulSpectrums(targets.free, map.free, product_free, 0, !opposite);
  product += product_free;
  cv::Mat surface;
  cv::dft(product, surface, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return surface;
}

bool same(const TPose2D& a, const TPose2D& b, const TPoint2D& centre, const CorrelationConfig& config) {
  return (a.composePoint(centre) - b.composePoint(centre)).norm() < config.distinct_shift &&
         std::abs(wrap_angle(a.phi - b.phi)) < config.distinct_turn;
}

/// The highest local maxima of a surface, as poses.
void collect_peaks(cv::Mat surface, double angle, bool opposite, const Canvas& canvas, const TPoint2D& centre,
                   const CorrelationConfig& config, std::vector<PoseGuess>& guesses) {
  const int clear = static_cast<int>(std::ceil(config.distinct_shift / canvas.cell));
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (int i = 0; i < config.peaks_per_rotation; ++i) {
    double best = 0.0;
    cv::Point at;
    cv::minMaxLoc(surface, nullptr, &best, nullptr, &at);
    if (best <= 0.0) return;
    // Where the map's centre comes to lie. Shifts beyond the far edge of the canvas are negative ones.
    const auto cell = [&](int shift, int size) {
      if (opposite) return shift - canvas.half;
      return (shift > size - 2 * canvas.half - 2 ? shift - size : shift) + canvas.half;
    };
    const TPoint2D moved(canvas.x0 + (cell(at.x, canvas.width) + 0.5) * canvas.cell,
                         canvas.y0 + (cell(at.y, canvas.height) + 0.5) * canvas.cell);
    guesses.push_back({TPose2D(moved.x - (c * centre.x - s * centre.y), moved.y - (s * centre.x + c * centre.y), angle),
                       best, AlignBy::Walls});
    for (int dy = -clear; dy <= clear; ++dy)
      for (int dx = -clear; dx <= clear; ++dx)
        surface.at<float>((at.y + dy + canvas.height) % canvas.height, (at.x + dx + canvas.width) % canvas.width) =
            -1.0F;
  }
}

Canvas make_canvas(const OccupancyGrid& truth, double map_radius, double cell) {
  Canvas canvas;
  canvas.cell = cell;
  canvas.half = static_cast<int>(std::ceil(map_radius / cell)) + 1;
  canvas.x0 = truth.frame().x0;
  canvas.y0 = truth.frame().y0;
  const auto size = [&](int cells) {
    const int needed = static_cast<int>(std::ceil(cells * truth.resolution() / cell)) + 2 * canvas.half + 2;
    return cv::getOptimalDFTSize(needed);
  };
  canvas.width = size(truth.width());
  canvas.height = size(truth.height());
  return canvas;
}

}  // namespace

std::vector<PoseGuess> correlate(const OccupancyGrid& map, const OccupancyGrid& truth,
                                 const CorrelationConfig& config) {
  const double sample = 0.5 * config.cell;
  const OccupancyGrid sampled = coarsen(map, sample);
  const PointSet points = points_of(sampled);
  if (points.walls.empty()) return {};
  const Canvas canvas = make_canvas(truth, points.radius, config.cell);
  const Targets targets = make_targets(truth, canvas, config);
  const double free_share = std::pow(sampled.resolution() / config.cell, 2.0);
  const double wall_share = sampled.resolution() / config.cell;

  std::vector<PoseGuess> all;
  const int half_rotations = std::max(2, static_cast<int>(std::lround(kPi / config.rotation_step)));
  const std::vector<bool> plausible = plausible_rotations(map, truth, half_rotations, config.direction_share);
  for (int i = 0; i < half_rotations; ++i) {
    if (!plausible[static_cast<std::size_t>(i)]) continue;
    const double angle = kPi * i / half_rotations;
    const Turned turned = turn(points, angle, canvas, static_cast<float>(wall_share), static_cast<float>(free_share));
    for (const bool opposite : {false, true})
      collect_peaks(correlation(turned, targets, opposite), wrap_angle(opposite ? angle + kPi : angle), opposite,
                    canvas, points.centre, config, all);
  }
  std::stable_sort(all.begin(), all.end(), [](const PoseGuess& a, const PoseGuess& b) { return a.score > b.score; });
  std::vector<PoseGuess> distinct;
  for (const PoseGuess& guess : all) {
    if (static_cast<int>(distinct.size()) >= config.guesses) break;
    const bool seen = std::any_of(distinct.begin(), distinct.end(), [&](const PoseGuess& other) {
      return same(guess.T_truth_map, other.T_truth_map, points.centre, config);
    });
    if (!seen) distinct.push_back(guess);
  }
  return distinct;
}

}  // namespace rubble::scoring
