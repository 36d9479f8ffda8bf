#include "explore/search/searched_area.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "base/planar.h"
#include "explore/plan/set_bytes.h"
#include "explore/search/wall_holes.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kFloorStride = 0.30;  ///< subjects on open floor are so far apart [m]
constexpr double kNicheStride = 0.10;  ///< and at the back of a niche [m]
constexpr double kNarrowest = 0.20;    ///< niche [m]; what is narrower is a wall seen twice
constexpr double kWidest = 0.55;       ///< [m]
constexpr int kManyDirections = 32;    ///< tried around a subject that is to be looked at squarely
// Of viewpoints from their subjects [m]. Before a niche there is little choice: its box takes a third of a corridor.
const std::vector<double> kDistances = {0.5, 0.8, 1.1, 1.4};
const std::vector<double> kNicheDistances = {0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4};
const std::vector<double> kSquareDistances = {0.65, 0.7, 0.8, 0.95, 1.1, 1.3};
// The same where the look itself is to be squarely: a robot stops a hand's breadth off its viewpoint.
const std::vector<double> kSureDistances = {0.65, 0.75, 0.85, 1.0, 1.15, 1.3, 1.5};
const std::vector<double> kFarDistances = {1.65};
constexpr double kSureIncidence = deg_to_rad(15.0);  ///< [rad]

/// Follows a line of sight to where it comes down behind something that most scans pass over. That itself is in view;
/// where the line starts in it, as on a slope that scans met from its foot, it hides nothing.
class SightLine {
 public:
  bool goes_on(bool seen_over) {
    if (came_to_it_ && !seen_over) return false;
    clear_ = clear_ || !seen_over;
    came_to_it_ = clear_ && seen_over;
    return true;
  }

 private:
  bool clear_ = false;
  bool came_to_it_ = false;
};

/// Cells from c in a direction up to the next wall; nothing when there is none within `most`.
std::optional<int> to_wall(const Traversable& floor, Cell c, Cell step, int most) {
  for (int i = 1; i <= most; ++i) {
    const Cell next{c.x + i * step.x, c.y + i * step.y};
    if (!floor.cells.inside(next)) return std::nullopt;
    if (floor.cells[next] == Occupancy::Occupied) return i;
  }
  return std::nullopt;
}

/// A cell with what is left to be looked at in it.
struct Unsearched {
  Cell cell;
  Faces missing;
};

/// The backs of niches that were not searched, every few cells.
std::vector<Unsearched> unsearched_niches(const Traversable& floor, const SearchedArea& searched) {
  Grid<Faces> open = searched.unsearched(floor);
  for (Faces& faces : open.cells()) faces = static_cast<Faces>(faces & ~kFloor);
  const int stride = cells_apart(kNicheStride, floor.frame().resolution);
  std::vector<Unsearched> found;
  for (int y = 1; y + 1 < floor.cells.height(); ++y)
    for_each_set(open.row(y), floor.cells.width(), [&](int x) {
      const Faces faces = open[{x, y}];
      if ((x + y) % stride == 0 && in_niche(floor, {x, y}, faces)) found.push_back({{x, y}, faces});
    });
  return found;
}

/// Free cells of which something in `asked` was not searched, as 8-connected clusters of at least `min_cells`.
std::vector<std::vector<Unsearched>> unsearched_clusters(const Traversable& floor, const SearchedArea& searched,
                                                         Faces asked, int min_cells) {
  Grid<Faces> open = searched.unsearched(floor);
  for (Faces& faces : open.cells()) faces = static_cast<Faces>(faces & asked);
  std::vector<std::vector<Unsearched>> clusters;
  for (int y = 1; y + 1 < floor.cells.height(); ++y)
    for_each_set(open.row(y), floor.cells.width(), [&](int x) {  // the rim is never open
      std::vector<Unsearched> cluster;
      const auto take = [&](Cell c) {
        cluster.push_back({c, open[c]});
        open[c] = 0;
      };
      take({x, y});
      for (std::size_t next = 0; next < cluster.size(); ++next) {
        const Cell c = cluster[next].cell;
        for (int v = c.y - 1; v <= c.y + 1; ++v)
          for (int u = c.x - 1; u <= c.x + 1; ++u)
            if (open[{u, v}] != 0) take({u, v});
      }
      if (static_cast<int>(cluster.size()) >= min_cells) clusters.push_back(std::move(cluster));
    });
  return clusters;
}

/// A place beside a subject to look from, and the faces that are inspected from there.
struct LookFrom {
  Cell step;
  Faces faces;
};

/// Each place with its faces, which are the same beside all subjects.
std::vector<LookFrom> looks_from(const std::vector<Cell>& steps, double incidence) {
  std::vector<LookFrom> looks;
  for (const Cell step : steps) {
    const double way = length(step.x, step.y);
    looks.push_back({step, faces_along(-step.x / way, -step.y / way, incidence)});
  }
  return looks;
}

}  // namespace

int cells_apart(double length, double cell) { return std::max(1, static_cast<int>(std::lround(length / cell))); }

Faces faces_along(double x, double y, double incidence) {
  const double cosine = std::cos(incidence);
  Faces faces = kFloor;
  if (x >= cosine) faces |= kEastFace;
  if (y >= cosine) faces |= kNorthFace;
  if (x <= -cosine) faces |= kWestFace;
  if (y <= -cosine) faces |= kSouthFace;
  return faces;
}

Faces faces_of(const Traversable& floor, Cell c) {
  const auto wall = [&](int dx, int dy) { return floor.cells[{c.x + dx, c.y + dy}] == Occupancy::Occupied; };
  Faces faces = kFloor;
  if (wall(1, 0)) faces |= kEastFace;
  if (wall(0, 1)) faces |= kNorthFace;
  if (wall(-1, 0)) faces |= kWestFace;
  if (wall(0, -1)) faces |= kSouthFace;
  return faces;
}

bool in_niche(const Traversable& floor, Cell c, Faces faces) {
  const double cell = floor.frame().resolution;
  const int most = static_cast<int>(std::lround(kWidest / cell));
  const auto between_walls = [&](Cell step) {
    const auto one = to_wall(floor, c, step, most), other = to_wall(floor, c, {-step.x, -step.y}, most);
    const double width = one && other ? (*one + *other - 1) * cell : 0.0;
    return width >= kNarrowest - 0.5 * cell && width <= kWidest;
  };
  return ((faces & (kEastFace | kWestFace)) != 0 && between_walls({0, 1})) ||
         ((faces & (kNorthFace | kSouthFace)) != 0 && between_walls({1, 0}));
}

OccupancyGrid with_holes_shut(const OccupancyGrid& cells) {
  OccupancyGrid shut = cells;
  const int most = static_cast<int>(std::lround(kWidestHole / cells.frame().resolution));
  const auto wall = [&](int x, int y) { return cells.inside({x, y}) && cells[{x, y}] == Occupancy::Occupied; };
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width(); ++x) {
      if (cells[{x, y}] != Occupancy::Occupied) continue;
      for (const Cell step : {Cell{1, 0}, Cell{0, 1}}) {
        int wide = 0;
        while (wide <= most && !wall(x + (wide + 1) * step.x, y + (wide + 1) * step.y)) ++wide;
        if (wide > most) continue;
        for (int i = 1; i <= wide; ++i) shut[{x + i * step.x, y + i * step.y}] = Occupancy::Occupied;
      }
    }
  return shut;
}

namespace {

/// Calls visit(c) for the cells between two cells, the last one included, while it says so; says whether it always did.
template <typename Visit>
bool along(Cell from, Cell to, Visit visit) {
  const int dx = to.x - from.x;
  const int dy = to.y - from.y;
  // One step a cell along the longer axis, then half a cell more often: no diagonal gap between two walls is slipped
  // through.
  const int steps = std::max(1, (3 * std::max(std::abs(dx), std::abs(dy)) + 1) / 2);
  const double sx = static_cast<double>(dx) / steps;
  const double sy = static_cast<double>(dy) / steps;
  double x = from.x + 0.5;
  double y = from.y + 0.5;
  for (int i = 0; i < steps; ++i) {
    x += sx;
    y += sy;
    if (!visit(Cell{static_cast<int>(x), static_cast<int>(y)})) return false;
  }
  return true;
}

}  // namespace

bool in_sight(const Traversable& floor, Cell from, Cell to) {
  return along(from, to, [&](Cell c) { return floor.cells[c] == Occupancy::Free; });
}

bool in_view(const Traversable& floor, Cell from, Cell to) {
  SightLine line;
  line.goes_on(floor.seen_over[from] != 0);
  return along(from, to,
               [&](Cell c) { return floor.cells[c] == Occupancy::Free && line.goes_on(floor.seen_over[c] != 0); });
}

Cell SearchedArea::shift_from(const GridFrame& f) const {
  const GridFrame& own = twice_.frame();
  return {static_cast<int>(std::lround((f.x0 - own.x0) / f.resolution)),
          static_cast<int>(std::lround((f.y0 - own.y0) / f.resolution))};
}

/// Lets the record hold at least `frame`; the map's cells keep their places when it grows.
void SearchedArea::cover(const GridFrame& frame) {
  const GridFrame own = twice_.frame();
  const double margin = 2.0;
  const auto east = [](const GridFrame& f) { return f.x0 + f.width * f.resolution; };
  const auto north = [](const GridFrame& f) { return f.y0 + f.height * f.resolution; };
  if (own.width > 0 && frame.x0 >= own.x0 && frame.y0 >= own.y0 && east(frame) <= east(own) + 1e-9 &&
      north(frame) <= north(own) + 1e-9)
    return;
  const int rim = static_cast<int>(std::ceil(margin / frame.resolution));
  GridFrame wider = frame;
  wider.x0 -= rim * frame.resolution;
  wider.y0 -= rim * frame.resolution;
  wider.width += 2 * rim;
  wider.height += 2 * rim;
  if (own.width > 0) {
    const int west = std::max(0, static_cast<int>(std::lround((wider.x0 - own.x0) / frame.resolution)));
    const int south = std::max(0, static_cast<int>(std::lround((wider.y0 - own.y0) / frame.resolution)));
    wider.x0 -= west * frame.resolution;
    wider.y0 -= south * frame.resolution;
    const auto cells = [&](double length) { return static_cast<int>(std::lround(length / frame.resolution)); };
    wider.width = std::max(wider.width + west, cells(east(own) - wider.x0));
    wider.height = std::max(wider.height + south, cells(north(own) - wider.y0));
  }
  for (Grid<Faces>* record : {&once_, &twice_}) {
    Grid<Faces> grown(wider);
    const Cell shift{static_cast<int>(std::lround((own.x0 - wider.x0) / frame.resolution)),
                     static_cast<int>(std::lround((own.y0 - wider.y0) / frame.resolution))};
    const GridFrame old = record->frame();
    for (int y = 0; y < old.height; ++y)
      for (int x = 0; x < old.width; ++x) grown[{x + shift.x, y + shift.y}] = (*record)[{x, y}];
    *record = std::move(grown);
  }
}

void see_floor(const Traversable& floor, const SearchConfig& config, const TPose2D& T_map_base, FloorInView& view) {
  view.rays.clear();
  if (floor.cells.width() == 0) return;
  const GridFrame& frame = floor.frame();
  view.step = 0.7 * frame.resolution;
  const double turn = view.step / config.range;  // neighbouring rays end less than a cell apart
  const int rays = static_cast<int>(std::ceil(config.field_of_view / turn));
  const int steps = static_cast<int>(config.range / view.step);
  const double x0 = (T_map_base.x - frame.x0) / frame.resolution;
  const double y0 = (T_map_base.y - frame.y0) / frame.resolution;
  const Occupancy* const cells = floor.cells.data();
  const std::uint8_t* const seen_over = floor.seen_over.data();
  view.cells.resize(static_cast<std::size_t>(rays + 1) * static_cast<std::size_t>(steps + 1));
  Cell* const seen = view.cells.data();
  std::size_t count = 0;
  Cell low{frame.width, frame.height};
  Cell high{-1, -1};
  for (int i = 0; i <= rays; ++i) {
    const double bearing = T_map_base.phi + config.field_of_view * (static_cast<double>(i) / rays - 0.5);
    const double dx = std::cos(bearing);
    const double dy = std::sin(bearing);
    const std::size_t first = count;
    SightLine line;
    for (int k = 0; k <= steps; ++k) {
      const double way = 0.7 * static_cast<double>(k);
      const Cell c{static_cast<int>(std::floor(x0 + way * dx)), static_cast<int>(std::floor(y0 + way * dy))};
      if (!frame.inside(c) || cells[frame.index(c)] != Occupancy::Free) break;
      if (!line.goes_on(seen_over[frame.index(c)] != 0)) break;
      seen[count++] = c;
      low = {std::min(low.x, c.x), std::min(low.y, c.y)};
      high = {std::max(high.x, c.x), std::max(high.y, c.y)};
    }
    view.rays.push_back({dx, dy, first, count});
  }
  view.low = low;
  view.high = high;
}

bool SearchedArea::look(const Traversable& floor, const FloorInView& view) {
  seen_ = Grid<Faces>();
  if (floor.cells.width() == 0 || view.rays.back().end == 0) return false;
  const auto nearest = static_cast<std::size_t>(std::ceil(inspection_.nearest / view.step));
  const auto beyond = static_cast<std::size_t>(inspection_.farthest / view.step) + 1;
  // Rays overlap near the robot: what they see is put together in a small window first.
  GridFrame window = floor.frame();
  window.x0 += view.low.x * window.resolution;
  window.y0 += view.low.y * window.resolution;
  window.width = view.high.x - view.low.x + 1;
  window.height = view.high.y - view.low.y + 1;
  seen_ = Grid<Faces>(window);
  const auto mark = [&](std::size_t first, std::size_t end, Faces faces) {
    for (std::size_t k = first; k < end; ++k) {
      Faces& seen = seen_[{view.cells[k].x - view.low.x, view.cells[k].y - view.low.y}];
      seen = static_cast<Faces>(seen | faces);
    }
  };
  for (const FloorInView::Ray& ray : view.rays) {
    const std::size_t near = std::min(ray.first + nearest, ray.end);
    const std::size_t far = std::max(near, std::min(ray.first + beyond, ray.end));
    mark(ray.first, near, kFloor);
    mark(near, far, faces_along(ray.dx, ray.dy, inspection_.incidence));
    mark(far, ray.end, kFloor);
  }
  return look(floor.frame(), seen_);
}

namespace {

/// Marks what was seen of as many cells as a word has bytes; what is seen again counts as seen twice. Returns what that
/// changed.
template <typename Word>
Word mark(const Faces* seen, Faces* once, Faces* twice) {
  const auto load = [](const Faces* from) {
    Word word;
    std::memcpy(&word, from, sizeof word);
    return word;
  };
  const Word s = load(seen), o = load(once), t = load(twice);
  const auto again = static_cast<Word>(o & s & ~t), more = static_cast<Word>(s & ~o);
  const auto now_once = static_cast<Word>(o | s), now_twice = static_cast<Word>(t | again);
  std::memcpy(once, &now_once, sizeof now_once);
  std::memcpy(twice, &now_twice, sizeof now_twice);
  return static_cast<Word>(again | more);
}

}  // namespace

bool SearchedArea::look(const GridFrame& frame, const Grid<Faces>& seen) {
  cover(frame);
  if (seen.width() == 0) return false;
  const Cell low = shift_from(seen.frame());
  // A map that was corrected may have become smaller.
  const int south = std::max(0, -low.y), north = std::min(seen.height(), twice_.height() - low.y);
  const int west = std::max(0, -low.x), east = std::min(seen.width(), twice_.width() - low.x);
  std::uint64_t news = 0;
  for (int y = south; y < north; ++y) {
    const Faces* const row = seen.row(y);
    Faces* const once = once_.row(low.y + y);
    Faces* const twice = twice_.row(low.y + y);
    int x = west;
    for (; x + 8 <= east; x += 8) news |= mark<std::uint64_t>(row + x, once + low.x + x, twice + low.x + x);
    for (; x < east; ++x) news |= mark<Faces>(row + x, once + low.x + x, twice + low.x + x);
  }
  return news != 0;
}

void SearchedArea::give_up(const Traversable& floor, const TPoint2D& place, double radius, Faces faces) {
  if (floor.cells.width() == 0) return;
  cover(floor.frame());
  const Cell shift = shift_from(floor.frame());
  const Cell low = floor.cells.cell({place.x - radius, place.y - radius});
  const Cell high = floor.cells.cell({place.x + radius, place.y + radius});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      if (!floor.cells.inside({x, y}) || (floor.cells.centre({x, y}) - place).norm() > radius) continue;
      Faces& record = twice_[{x + shift.x, y + shift.y}];
      record = static_cast<Faces>(record | faces);
    }
}

bool SearchedArea::saw(const TPoint2D& place) const {
  // The cells along walls, which these fill in part, are no floor: those beside them tell. Giving up marks the second
  // look only.
  const Cell c = twice_.frame().cell(place);
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (twice_.inside({x, y}) && (once_[{x, y}] & twice_[{x, y}] & kFloor) != 0) return true;
  return false;
}

Faces SearchedArea::looked_at(const GridFrame& frame, Cell c) const {
  if (twice_.width() == 0) return 0;
  const Cell shift = shift_from(frame);
  const Cell own{c.x + shift.x, c.y + shift.y};
  return twice_.inside(own) ? twice_[own] : Faces{0};
}

Faces SearchedArea::missing(const Traversable& floor, Cell c) const {
  const auto all = static_cast<Faces>(config_.faces ? faces_of(floor, c) : kFloor);
  return static_cast<Faces>(all & ~looked_at(floor.frame(), c));
}

namespace {

/// What there is to be looked at in the free cells of a row, but for the outermost. Branch-free and on plain arrays, so
/// that compilers use vector code.
void faces_of_row(const Occupancy* __restrict cells, const Occupancy* __restrict below,
                  const Occupancy* __restrict above, int width, bool walls, Faces* __restrict row) {
  const auto asked = static_cast<Faces>(walls ? ~0 : kFloor);
  const auto face = [](Occupancy o, Faces f) { return static_cast<Faces>(o == Occupancy::Occupied ? f : 0); };
  for (int x = 1; x + 1 < width; ++x) {
    const auto all = static_cast<Faces>(kFloor | face(cells[x + 1], kEastFace) | face(above[x], kNorthFace) |
                                        face(cells[x - 1], kWestFace) | face(below[x], kSouthFace));
    row[x] = static_cast<Faces>(cells[x] == Occupancy::Free ? all & asked : 0);
  }
}

}  // namespace

Grid<Faces> SearchedArea::unsearched(const Traversable& floor) const {
  Grid<Faces> open(floor.frame());
  const Cell shift = twice_.width() == 0 ? Cell{} : shift_from(floor.frame());
  const int width = floor.cells.width();
  for (int y = 1; y + 1 < floor.cells.height(); ++y) {
    const Occupancy* cells = floor.cells.row(y);
    Faces* row = open.row(y);
    faces_of_row(cells, floor.cells.row(y - 1), floor.cells.row(y + 1), width, config_.faces, row);
    const int own = y + shift.y;
    if (own < 0 || own >= twice_.height()) continue;
    const Faces* looked_at = twice_.row(own);
    const int first = std::max(1, -shift.x);
    const int last = std::min(width - 2, twice_.width() - 1 - shift.x);
    for (int x = first; x <= last; ++x) row[x] = static_cast<Faces>(row[x] & ~looked_at[x + shift.x]);
  }
  return open;
}

std::vector<Cell> steps_around(const std::vector<double>& distances, double range, double cell, int directions) {
  std::vector<Cell> steps;
  for (const double distance : distances)
    for (int k = 0; k < directions && distance <= range; ++k) {
      const double bearing = 2.0 * kPi * k / directions;
      steps.push_back({static_cast<int>(std::lround(distance * std::cos(bearing) / cell)),
                       static_cast<int>(std::lround(distance * std::sin(bearing) / cell))});
    }
  return steps;
}

std::vector<Viewpoint> viewpoints(const Traversable& floor, const SearchedArea& searched, const SearchConfig& config,
                                  double room, double tight, Subjects subjects) {
  const double cell = floor.frame().resolution;
  const std::vector<LookFrom> squarely =
      looks_from(steps_around(kSquareDistances, config.range, cell), kSquarely.incidence);
  const bool square = subjects == Subjects::Squarely;
  std::vector<LookFrom> sure, far;
  if (square) {
    sure = looks_from(steps_around(kSureDistances, config.range, cell, kManyDirections), kSureIncidence);
    far = looks_from(steps_around(kFarDistances, config.range, cell, kManyDirections), kSureIncidence);
  }
  const std::vector<LookFrom> anyhow =
      looks_from(steps_around(subjects == Subjects::Niches ? kNicheDistances : kDistances, config.range, cell),
                 Inspection{}.incidence);
  std::vector<Viewpoint> found;
  const auto add_of = [&](Cell subject, Faces missing, const std::vector<LookFrom>& looks, double d_min) {
    const std::size_t before = found.size();
    for (const LookFrom& look : looks) {
      const auto faces = static_cast<Faces>(missing & look.faces);
      if (faces == 0) continue;
      const Cell c{subject.x + look.step.x, subject.y + look.step.y};
      if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Free || floor.clearance[c] < d_min) continue;
      if (in_view(floor, c, subject)) found.push_back({c, floor.cells.centre(subject), faces});
    }
    return found.size() > before;
  };
  const auto add = [&](Cell subject, Faces missing) {
    const auto walls = static_cast<Faces>(missing & ~kFloor);
    for (const double d_min : {room, tight})
      if (square && add_of(subject, walls, sure, d_min)) return;
    for (const double d_min : {room, tight}) {
      if (subjects != Subjects::Niches && walls != 0 && add_of(subject, walls, squarely, d_min)) return;
      if (square && add_of(subject, walls, far, d_min)) return;
      if (subjects != Subjects::Squarely && add_of(subject, missing, anyhow, d_min)) return;
    }
  };
  if (subjects == Subjects::Niches) {
    for (const auto& [subject, missing] : unsearched_niches(floor, searched)) add(subject, missing);
    return found;
  }
  const auto asked = static_cast<Faces>(subjects == Subjects::Squarely ? ~kFloor : ~0);
  const int stride = cells_apart(kFloorStride, cell), face_stride = cells_apart(kFaceStride, cell);
  for (const auto& cluster : unsearched_clusters(floor, searched, asked, config.min_cells))
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      const auto& [subject, missing] = cluster[i];
      // Every so far, and the first one of each cluster, so that none goes without.
      const bool on_face = (missing & ~kFloor) != 0 && (subject.x + subject.y) % face_stride == 0;
      if (i != 0 && !on_face && (subject.x % stride != 0 || subject.y % stride != 0)) continue;
      add(subject, missing);
    }
  return found;
}

}  // namespace rubble::explore
