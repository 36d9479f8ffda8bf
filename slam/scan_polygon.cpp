#include "slam/scan_polygon.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

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
    sorted.push_back({std::atan2(p.y - origin.y, p.x - origin.x), {p, hit, false}});
  };
  for (const TPoint2D& p : hits) add(p, true);
  for (const TPoint2D& p : passes) add(p, false);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Bearing& a, const Bearing& b) { return a.angle < b.angle; });
  std::vector<ScanRay> rays;
  rays.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ScanRay ray = sorted[i].ray;
    ray.joined = i + 1 < sorted.size() && sorted[i + 1].angle - sorted[i].angle < 1.5 * beam_width;
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace rubble::slam
