#include "scoring/walls/wall_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angle.h"

namespace rubble::scoring {
namespace {

constexpr double kLattice = 0.1;    // walls are looked at on cells of this edge [m]
constexpr int kHalfWindow = 5;      // [cells of the lattice]
constexpr double kSmooth = 0.035;   // half width of the triangle that smooths the histogram [rad]
constexpr double kStandsOut = 0.2;  // rise over the mean, as a share of the mean, below which no rotation stands out

/// The cells of a coarse lattice that hold walls, and a raster of them.
struct CoarseWalls {
  explicit CoarseWalls(const OccupancyGrid& grid) {
    const int factor = std::max(1, static_cast<int>(std::lround(kLattice / grid.resolution())));
    width = (grid.width() + factor - 1) / factor;
    height = (grid.height() + factor - 1) / factor;
    marks.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (int y = 0; y < grid.height(); ++y) {
      const Occupancy* row = grid.row(y);
      for (int x = 0; x < grid.width(); ++x) {
        if (row[x] != Occupancy::Occupied) continue;
        char& mark = marks[index(x / factor, y / factor)];
        if (mark == 0) cells.push_back({x / factor, y / factor});
        mark = 1;
      }
    }
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  int width = 0;
  int height = 0;
  std::vector<char> marks;  ///< 1: a wall
  std::vector<Cell> cells;
};

/// Sums of 1, x, y, x^2, xy, y^2 over the walls of the window around a cell. Whole numbers, and so exact. Walls are
/// few: sums over the rectangles from the origin, which would do for all cells, take longer.
std::array<double, 6> moments_around(const CoarseWalls& walls, const Cell& c) {
  std::array<double, 6> out{};
  const int x0 = std::max(0, c.x - kHalfWindow);
  const int x1 = std::min(walls.width - 1, c.x + kHalfWindow);
  const int y1 = std::min(walls.height - 1, c.y + kHalfWindow);
  for (int y = std::max(0, c.y - kHalfWindow); y <= y1; ++y) {
    double n = 0.0;
    double sx = 0.0;
    double sxx = 0.0;
    const char* const row = walls.marks.data() + walls.index(0, y);
    for (int x = x0; x <= x1; ++x) {
      const double here = row[x];
      n += here;
      sx += here * x;
      sxx += here * x * x;
    }
    out[0] += n;
    out[1] += sx;
    out[2] += n * y;
    out[3] += sxx;
    out[4] += sx * y;
    out[5] += n * y * y;
  }
  return out;
}

std::vector<double> smoothed(const std::vector<double>& histogram, int half) {
  const int n = static_cast<int>(histogram.size());
  std::vector<double> out(histogram.size(), 0.0);
  for (int i = 0; i < n; ++i)
    for (int d = -half; d <= half; ++d)
      out[static_cast<std::size_t>(i)] +=
          histogram[static_cast<std::size_t>((i + d + n) % n)] * (1.0 - std::abs(d) / (half + 1.0));
  return out;
}

}  // namespace

std::vector<double> wall_directions(const OccupancyGrid& grid, int bins) {
  std::vector<double> histogram(static_cast<std::size_t>(bins), 0.0);
  const CoarseWalls walls(grid);
  for (const Cell& c : walls.cells) {
    const std::array<double, 6> m = moments_around(walls, c);
    const double xx = m[3] / m[0] - m[1] * m[1] / (m[0] * m[0]);
    const double xy = m[4] / m[0] - m[1] * m[2] / (m[0] * m[0]);
    const double yy = m[5] / m[0] - m[2] * m[2] / (m[0] * m[0]);
    const double spread = std::hypot(xx - yy, 2.0 * xy);
    if (spread <= 0.0) continue;
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const double coherence = spread / (xx + yy);
    const int bin = static_cast<int>(std::floor((angle < 0.0 ? angle + kPi : angle) / kPi * bins));
    histogram[static_cast<std::size_t>(std::clamp(bin, 0, bins - 1))] += coherence * coherence;
  }
  return smoothed(histogram, std::max(1, static_cast<int>(std::lround(kSmooth / kPi * bins))));
}

std::vector<bool> plausible_rotations(const OccupancyGrid& map, const OccupancyGrid& truth, int half_rotations,
                                      double share) {
  const std::vector<double> of_map = wall_directions(map, half_rotations);
  const std::vector<double> of_truth = wall_directions(truth, half_rotations);
  const auto n = static_cast<std::size_t>(half_rotations);
  std::vector<double> match(n, 0.0);
  for (std::size_t turn = 0; turn < n; ++turn)
    for (std::size_t i = 0; i < n; ++i) match[turn] += of_map[i] * of_truth[(i + turn) % n];
  const double mean = std::accumulate(match.begin(), match.end(), 0.0) / static_cast<double>(n);
  const double best = *std::max_element(match.begin(), match.end());
  if (best <= (1.0 + kStandsOut) * mean) return std::vector<bool>(n, true);
  std::vector<bool> out(n);
  for (std::size_t turn = 0; turn < n; ++turn) out[turn] = match[turn] >= mean + share * (best - mean);
  return out;
}

}  // namespace rubble::scoring
