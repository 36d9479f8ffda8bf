#include "slam/robust/map/crisp_walls.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "base/planar.h"

namespace rubble::slam {

namespace {

constexpr double kAlone = 0.15;       ///< a hit this far from those beside it stands alone [m] ...
constexpr double kAloneBeams = 12.0;  ///< ... or so many times what lies between two beams there
constexpr int kBeside = 2;            ///< beams

}  // namespace

void drop_lone_hits(ScanPoints& points) {
  std::vector<std::size_t> hits;
  hits.reserve(points.hits.size());
  for (std::size_t i = 0; i < points.rays.size(); ++i)
    if (points.rays[i].hit) hits.push_back(i);
  const auto apart = [&](std::size_t a, std::size_t b) {
    const ScanRay& ray = points.rays[hits[a]];
    const ScanRay& other = points.rays[hits[b]];
    const double step = points.beam_width * distance(ray.end, points.origin);
    return std::abs(other.beam - ray.beam) > kBeside ||
           distance(ray.end, other.end) > std::max(kAlone, kAloneBeams * step);
  };
  std::vector<char> alone(points.rays.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!((i == 0 || apart(i, i - 1)) && (i + 1 == hits.size() || apart(i, i + 1)))) continue;
    alone[hits[i]] = 1;
    any = true;
    if (hits[i] > 0) points.rays[hits[i] - 1].joined = false;
  }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.rays.size(); ++i)
    if (alone[i] == 0) points.rays[kept++] = points.rays[i];
  points.rays.resize(kept);
  points.hits.clear();
  for (const ScanRay& ray : points.rays)
    if (ray.hit) points.hits.push_back(ray.end);
}

namespace {

constexpr int kAlong = 4;      ///< cells of the wall to each side that vote
constexpr int kLeastRun = 3;   ///< cells of wall that must be two wide before it is thinned
constexpr double kWall = 0.5;  ///< share of hits that makes a wall

/// The map with its axes named by the wall: `across` it and `along` it.
class WallView {
 public:
  WallView(const CountMap& map, bool along_y) : map_(map), along_y_(along_y) {}

  int across() const { return along_y_ ? map_.frame().width : map_.frame().height; }
  int along() const { return along_y_ ? map_.frame().height : map_.frame().width; }
  Cell cell(int across, int along) const { return along_y_ ? Cell{across, along} : Cell{along, across}; }
  bool wall(int across, int along) const {
    const Cell c = cell(across, along);
    return map_.frame().inside(c) && map_.occupied(c) > 0 && map_.occupied(c) >= kWall * map_.seen(c);
  }
  /// Exactly the cells `across` and the next are wall.
  bool two_wide(int across, int along) const {
    return wall(across, along) && wall(across + 1, along) && !wall(across - 1, along) && !wall(across + 2, along);
  }
  double hits(int across, int along) const { return map_.occupied(cell(across, along)); }

 private:
  const CountMap& map_;
  bool along_y_;
};

/// The weaker cells of walls that run along one axis.
void find_weaker(const WallView& view, std::vector<Cell>& weaker) {
  for (int along = 0; along < view.along(); ++along)
    for (int across = 0; across + 1 < view.across(); ++across) {
      if (!view.two_wide(across, along)) continue;
      double first = 0.0, second = 0.0;
      int longest = 1;
      for (const int step : {-1, 1}) {
        for (int k = step > 0 ? 0 : 1; k <= kAlong; ++k) {
          const int at = along + step * k;
          if (!view.wall(across, at) && !view.wall(across + 1, at)) break;
          first += view.hits(across, at);
          second += view.hits(across + 1, at);
          longest += k > 0 ? 1 : 0;
        }
      }
      if (longest >= kLeastRun) weaker.push_back(view.cell(first < second ? across : across + 1, along));
    }
}

}  // namespace

void thin_walls(CountMap& map) {
  std::vector<Cell> weaker;
  for (const bool along_y : {true, false}) find_weaker(WallView(map, along_y), weaker);
  map.clear_hits(weaker);
}

}  // namespace rubble::slam
