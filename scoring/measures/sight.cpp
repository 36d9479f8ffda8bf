#include "scoring/measures/sight.h"

#include <algorithm>
#include <cmath>

namespace rubble::scoring {
namespace {

constexpr double kGap = 0.15;  // free space between two pieces of one wall [m]

bool is_judged(const Unjudged& unjudged, double at) {
  return std::none_of(unjudged.begin(), unjudged.end(), [at](const std::pair<float, float>& s) {
    return at >= static_cast<double>(s.first) && at <= static_cast<double>(s.second);
  });
}

}  // namespace

void SightGround::look(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b, double length, Sight& out,
                       const Unjudged& unjudged) const {
  out.walls.clear();
  out.unseen.clear();
  out.unknown = 0.0;
  const GridFrame& f = grid.frame();
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * length / f.resolution)));
  const double step = length / steps;
  const double x0 = (a.x - f.x0) / f.resolution;
  const double y0 = (a.y - f.y0) / f.resolution;
  const double dx = (b.x - a.x) / f.resolution / steps;
  const double dy = (b.y - a.y) / f.resolution / steps;
  double free = 0.0;
  Cell last{static_cast<int>(std::floor(x0)), static_cast<int>(std::floor(y0))};
  for (int i = 0; i <= steps; ++i) {
    const Cell c{static_cast<int>(std::floor(x0 + i * dx)), static_cast<int>(std::floor(y0 + i * dy))};
    const double slipped = pieces.between(last, c);
    last = c;
    if (!grid.inside(c)) {
      out.leave_unseen(i * step, (i + 1) * step);
      out.unknown += step;
      continue;
    }
    const std::size_t at = f.index(c);
    const double wall = std::max(slipped, static_cast<double>(pieces.strength.cells()[at]));
    if (wall > 0.0 && is_judged(unjudged, i * step)) {
      if (out.walls.empty() || free > kGap) out.walls.push_back({i * step, i * step, wall});
      out.walls.back().to = i * step;
      out.walls.back().strength = std::max(out.walls.back().strength, wall);
      free = 0.0;
    } else if (wall > 0.0 || grid.cells()[at] == Occupancy::Unknown) {
      out.leave_unseen(i * step, (i + 1) * step);
      out.unknown += step;
    } else {
      free += step;
    }
  }
}

}  // namespace rubble::scoring
