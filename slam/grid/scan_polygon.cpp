#include "slam/grid/scan_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;

namespace {

/// Even-odd filling without sorting: each edge flips, in every row it crosses, the first cell whose centre lies to its
/// right; a running xor along the row then tells inside from outside.
class EdgeFlipper {
 public:
  explicit EdgeFlipper(BitRaster& raster) : raster_(raster) {}

  /// Rows whose centre line y satisfies min <= y < max: shared vertices count once.
  void edge(const TPoint2D& from, const TPoint2D& to) {
    const double x0 = from.x - raster_.low().x;
    const double y0 = from.y - raster_.low().y;
    const double y1 = to.y - raster_.low().y;
    const int first = row_at_or_above(std::min(y0, y1));
    const int last = row_at_or_above(std::max(y0, y1));
    if (first >= last) return;
    const double slope = (to.x - from.x) / (y1 - y0);
    for (int row = first; row < last; ++row) {
      const double crossing = x0 + (row + 0.5 - y0) * slope;
      const double column = std::ceil(crossing - 0.5);
      if (column >= raster_.width()) continue;
      const int bit = column > 0.0 ? static_cast<int>(column) : 0;
      raster_.row(row)[bit >> 6] ^= std::uint64_t{1} << (bit & 63);
    }
  }

  void finish() {
    for (int y = 0; y < raster_.height(); ++y) {
      std::uint64_t inside_before = 0;  // all ones while the running xor at the end of the last word is one
      std::uint64_t* row = raster_.row(y);
      for (int w = 0; w < raster_.words_per_row(); ++w) {
        std::uint64_t x = row[w];
        for (int shift = 1; shift < 64; shift *= 2) x ^= x << shift;
        x ^= inside_before;
        inside_before = std::uint64_t{0} - (x >> 63);
        row[w] = x;
      }
      const int used = raster_.width() & 63;
      if (used != 0) row[raster_.words_per_row() - 1] &= (std::uint64_t{1} << used) - 1;
    }
  }

 private:
  int row_at_or_above(double y) const {
    return static_cast<int>(std::clamp(std::ceil(y - 0.5), 0.0, static_cast<double>(raster_.height())));
  }

  BitRaster& raster_;
};

TPoint2D turned(const TPoint2D& p, const TPoint2D& origin, double cosine, double sine) {
  const double dx = p.x - origin.x;
  const double dy = p.y - origin.y;
  return {origin.x + cosine * dx - sine * dy, origin.y + sine * dx + cosine * dy};
}

/// Clears all cells that the line from a to b runs through (Amanatides and Woo 1987).
void clear_line(const TPoint2D& a, const TPoint2D& b, BitRaster& raster) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  Cell c{static_cast<int>(std::floor(a.x)), static_cast<int>(std::floor(a.y))};
  const Cell end{static_cast<int>(std::floor(b.x)), static_cast<int>(std::floor(b.y))};
  const int step_x = dx > 0.0 ? 1 : -1;
  const int step_y = dy > 0.0 ? 1 : -1;
  const double never = std::numeric_limits<double>::infinity();
  double next_x = dx != 0.0 ? (c.x + (dx > 0.0 ? 1 : 0) - a.x) / dx : never;
  double next_y = dy != 0.0 ? (c.y + (dy > 0.0 ? 1 : 0) - a.y) / dy : never;
  const double per_x = dx != 0.0 ? std::abs(1.0 / dx) : never;
  const double per_y = dy != 0.0 ? std::abs(1.0 / dy) : never;
  for (int left = std::abs(end.x - c.x) + std::abs(end.y - c.y); left >= 0; --left) {
    if (raster.inside(c)) raster.clear(c);
    if (next_x < next_y) {
      c.x += step_x;
      next_x += per_x;
    } else {
      c.y += step_y;
      next_y += per_y;
    }
  }
}

}  // namespace

void clear_surfaces(const std::vector<ScanRay>& rays, double max_gap, BitRaster& raster) {
  for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
    const ScanRay& a = rays[i];
    const ScanRay& b = rays[i + 1];
    if (!a.joined || !a.hit || !b.hit) continue;
    const bool same_cell = std::floor(a.end.x) == std::floor(b.end.x) && std::floor(a.end.y) == std::floor(b.end.y);
    if (same_cell || distance(a.end, b.end) > max_gap) continue;
    clear_line(a.end, b.end, raster);
  }
}

void fill_scan_polygons(const std::vector<ScanRay>& rays, const TPoint2D& origin, double beam_width,
                        BitRaster& raster) {
  const double cosine = std::cos(0.5 * beam_width);
  const double sine = std::sin(0.5 * beam_width);
  EdgeFlipper flipper(raster);
  for (std::size_t i = 0; i < rays.size();) {
    TPoint2D corner = turned(rays[i].end, origin, cosine, -sine);
    flipper.edge(origin, corner);
    bool more = true;
    for (; more; ++i) {
      flipper.edge(corner, rays[i].end);
      corner = rays[i].end;
      more = rays[i].joined && i + 1 < rays.size();
    }
    const TPoint2D last = turned(corner, origin, cosine, sine);
    flipper.edge(corner, last);
    flipper.edge(last, origin);
  }
  flipper.finish();
}

std::vector<ScanRay> rays_from_ends(const std::vector<TPoint2D>& hits, const std::vector<TPoint2D>& passes,
                                    const TPoint2D& origin, double beam_width) {
  struct Bearing {
    double angle;
    ScanRay ray;
  };
  std::vector<Bearing> sorted;
  sorted.reserve(hits.size() + passes.size());
  const auto add = [&](const TPoint2D& p, bool hit) {
    sorted.push_back({std::atan2(p.y - origin.y, p.x - origin.x), {p, hit, false, 0}});
  };
  for (const TPoint2D& p : hits) add(p, true);
  for (const TPoint2D& p : passes) add(p, false);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Bearing& a, const Bearing& b) { return a.angle < b.angle; });
  std::vector<ScanRay> rays;
  rays.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ScanRay ray = sorted[i].ray;
    ray.beam = beam_width > 0.0 ? static_cast<int>(std::lround(sorted[i].angle / beam_width)) : static_cast<int>(i);
    ray.joined = i + 1 < sorted.size() && sorted[i + 1].angle - sorted[i].angle < 1.5 * beam_width;
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace rubble::slam
