#include "slam/robust/map/thin_walls.h"

#include <utility>
#include <vector>

namespace rubble::slam {

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
void find_weaker(const WallView& view, const GridFrame& frame, std::vector<char>& weaker) {
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
      if (longest >= kLeastRun) weaker[frame.index(view.cell(first < second ? across : across + 1, along))] = 1;
    }
}

}  // namespace

void thin_walls(CountMap& map) {
  const GridFrame frame = map.frame();
  std::vector<char> weaker(frame.size(), 0);
  for (const bool along_y : {true, false}) find_weaker(WallView(map, along_y), frame, weaker);
  std::vector<std::uint16_t> seen(map.seen_row(0), map.seen_row(0) + frame.size());
  std::vector<std::uint16_t> occupied(map.occupied_row(0), map.occupied_row(0) + frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (weaker[i] != 0) occupied[i] = 0;
  map.assign(frame, std::move(seen), std::move(occupied));
}

}  // namespace rubble::slam
