#include "scoring/measures/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/angle.h"
#include "base/distance_transform.h"
#include "scoring/measures/lattice_shifts.h"
#include "scoring/measures/wall_pieces.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

constexpr double kShortest = 0.5;       // line [m]
constexpr double kLongest = 1.8;        // [m]
constexpr double kClearEnds = 0.25;     // of walls at both ends [m]
constexpr double kClearBeside = 0.12;   // open lines have no wall so near, blocked ones are blocked so far aside [m]
constexpr double kGap = 0.15;           // free space between two pieces of one wall [m]
constexpr double kHole = 0.55;          // unknown stretch between known ground that says no wall: a halo around one [m]
constexpr double kPlaceOfWall = 0.1;    // to either side of a wall's middle: what must be known to miss it [m]
constexpr double kTau = 0.5;            // distance from which a wall is another one [m]
constexpr double kRaster = 0.5;         // of a cell: what drawing on a raster moves a wall by
constexpr double kLeastRaster = 0.025;  // finer pixels of the same walls are no finer a map [m]
constexpr double kMostRaster = 0.05;    // [m]
constexpr double kThickness = 0.04;     // what a metre of wrong thickness counts as a metre of wrong place
constexpr double kFee = 0.25;           // kappa that maps of other arenas reach at their best pose
constexpr double kPlenty = 44.0;        // places of inner walls from which luck is no greater than this
constexpr double kMostFee = 0.55;       // what luck reaches where the truth has two or three walls
constexpr double kBare = 15.0;          // places of inner walls; with fewer, the walls around are asked about, too
constexpr double kBareLuck = 23.0;      // over the number of all places: the square of what luck reaches then
constexpr double kBareFee = 0.8;        // walls around a place are few pieces, however long
constexpr double kMostBareFee = 0.88;   // of the smallest places
constexpr double kMoreOfOneKind = 2.0;  // times the known share of a bare truth's other kind of lines
constexpr double kOfOneKind = 0.05;     // ... and this
constexpr double kPlace = 0.4;          // along a wall [m]
constexpr double kPrior = 2.0;          // laid-over lines that the mean of all stands for
constexpr std::size_t kFewest = 40;     // of each kind
constexpr double kUnseen = 0.1;         // unknown stretch that leaves a line known as a whole [m]
constexpr double kLinesPerArea = 16.0;  // asked as a whole, of each kind, a square metre of free space
constexpr double kLeastLines = 1500.0;
constexpr double kMostLines = 3000.0;
constexpr std::size_t kBlockedLines = 4500;
constexpr std::size_t kOpenLines = 9000;  // half of them lie inside a pallet and say nothing
constexpr int kTries = 30;                // for each line wanted
constexpr std::size_t kShifts = 24;       // at which the truth is laid over itself

/// One wall on a line, [m] from its start.
struct Crossing {
  double from = 0.0;
  double to = 0.0;
  double strength = 0.0;
  double middle() const { return 0.5 * (from + to); }
  double thickness() const { return to - from; }
};

struct Stretch {
  double from = 0.0;
  double to = 0.0;
};

/// What a map shows on a line, [m] from its start.
struct Sight {
  std::vector<Crossing> walls;
  std::vector<Stretch> unseen;
  double unknown = 0.0;  ///< all of it [m]

  void leave_unseen(double from, double to) {
    const bool goes_on = !unseen.empty() && unseen.back().to >= from;
    if (!goes_on) unseen.push_back({from, to});
    unseen.back().to = to;
  }
  /// Short unknown stretches between known ground are open ground: whoever knows both sides of a wall knows the wall.
  void close_holes(double length) {
    const auto is_hole = [&](const Stretch& s) { return s.from > 0.0 && s.to < length && s.to - s.from <= kHole; };
    unseen.erase(std::remove_if(unseen.begin(), unseen.end(), is_hole), unseen.end());
  }
  bool sees(double at) const {
    return std::none_of(unseen.begin(), unseen.end(), [at](const Stretch& s) { return at >= s.from && at <= s.to; });
  }
};

using Unjudged = std::vector<std::pair<float, float>>;

/// Elements of an arena have faces that the truth does not know, behind the one it does. Near that one all is judged.
void note_unjudged(SightLines::Line& line, const Sight& sight) {
  constexpr double kNear = 0.2;  // [m]
  for (const Stretch& s : sight.unseen) {
    const double from = s.from >= line.middle ? std::max(s.from, sight.walls[0].to + kNear) : s.from;
    const double to = s.from >= line.middle ? s.to : std::min(s.to, sight.walls[0].from - kNear);
    if (from < to) line.unjudged.emplace_back(static_cast<float>(from), static_cast<float>(to));
  }
}

bool is_judged(const Unjudged& unjudged, double at) {
  return std::none_of(unjudged.begin(), unjudged.end(), [at](const std::pair<float, float>& s) {
    return at >= static_cast<double>(s.first) && at <= static_cast<double>(s.second);
  });
}

/// Looks across a map that is kept elsewhere.
struct Ground {
  explicit Ground(const SightMap& map) : grid(map.grid), pieces(map.pieces) {}
  bool is(const TPoint2D& p, Occupancy what) const {
    const Cell c = grid.cell(p);
    return grid.inside(c) && grid[c] == what;
  }
  bool known(const TPoint2D& p) const {
    const Cell c = grid.cell(p);
    return grid.inside(c) && grid[c] != Occupancy::Unknown;
  }
  /// Walks from a to b, which lie in this map and are `length` apart in the truth. Walls within `unjudged` are passed
  /// by.
  void look(const TPoint2D& a, const TPoint2D& b, double length, Sight& out, const Unjudged& unjudged = {}) const;

  const OccupancyGrid& grid;
  const WallPieces& pieces;
};

void Ground::look(const TPoint2D& a, const TPoint2D& b, double length, Sight& out, const Unjudged& unjudged) const {
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

/// The truth, asked which lines across it are worth asking a map about.
class Asker {
 public:
  Asker(const OccupancyGrid& truth, Ragged ragged, bool outer) : map_(truth, ragged), ground_(map_), outer_(outer) {
    Grid<std::uint8_t> walls(truth.frame());
    for (std::size_t i = 0; i < truth.cells().size(); ++i)
      walls.cells()[i] = truth.cells()[i] == Occupancy::Occupied ? 1 : 0;
    distance_ = distance_transform(walls, 1.0);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width(); ++x) {
        if (may_end(truth.centre({x, y}))) ends_.push_back(truth.centre({x, y}));
        if (truth[{x, y}] == Occupancy::Occupied) walls_.push_back(truth.centre({x, y}));
      }
  }
  /// Where a line may begin and end.
  const std::vector<TPoint2D>& ends() const { return ends_; }
  const std::vector<TPoint2D>& walls() const { return walls_; }
  double area() const { return static_cast<double>(ends_.size()) * std::pow(ground_.grid.resolution(), 2); }

  /// The line, if it is clearly open or clearly blocked by one wall.
  std::optional<SightLines::Line> ask(const TPoint2D& from, const TPoint2D& to) {
    const bool leads_out = outer_ && !ground_.known(to);
    if (!may_end(from) || !(leads_out || may_end(to))) return std::nullopt;
    const double length = (to - from).norm();
    ground_.look(from, to, length, sight_);
    SightLines::Line line{from, to};
    if (sight_.walls.empty()) {
      if (!sight_.unseen.empty() || !clear(from, to, length)) return std::nullopt;
      return line;
    }
    if (sight_.walls.size() > 1) return std::nullopt;
    if (leads_out && !sight_.unseen.empty() && sight_.unseen[0].from < sight_.walls[0].from) return std::nullopt;
    line.blocked = true;
    line.middle = sight_.walls[0].middle();
    line.thickness = sight_.walls[0].thickness();
    line.strength = sight_.walls[0].strength;
    note_unjudged(line, sight_);
    const TPoint2D aside((from.y - to.y) * kClearBeside / length, (to.x - from.x) * kClearBeside / length);
    for (const TPoint2D& side : {aside, aside * -1.0}) {
      ground_.look(from + side, to + side, length, sight_);
      if (sight_.walls.size() != 1) return std::nullopt;
    }
    return line;
  }

 private:
  bool may_end(const TPoint2D& p) const {
    return ground_.is(p, Occupancy::Free) && static_cast<double>(distance_[distance_.cell(p)]) >= kClearEnds;
  }
  bool clear(const TPoint2D& from, const TPoint2D& to, double length) const {
    const int steps = static_cast<int>(std::ceil(length / kClearBeside));
    for (int i = 1; i < steps; ++i) {
      const Cell c = distance_.cell(from + (to - from) * (static_cast<double>(i) / steps));
      if (static_cast<double>(distance_[c]) <= kClearBeside) return false;
    }
    return true;
  }

  SightMap map_;
  Ground ground_;
  bool outer_;
  Grid<float> distance_;  ///< to the next wall [m]
  std::vector<TPoint2D> ends_;
  std::vector<TPoint2D> walls_;
  Sight sight_;
};

/// Points that fill the unit cube evenly (Roberts 2018, generalised golden ratio): no random numbers needed.
struct EvenPoints {
  std::array<double, 4> next() {
    ++i_;
    std::array<double, 4> out;
    const double steps[] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101};
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double v = 0.5 + static_cast<double>(i_) * steps[k];
      out[k] = v - std::floor(v);
    }
    return out;
  }

 private:
  std::size_t i_ = 0;
};

const TPoint2D& pick(const std::vector<TPoint2D>& from, double share) {
  return from[std::min(from.size() - 1, static_cast<std::size_t>(share * static_cast<double>(from.size())))];
}

/// Lines of one kind, spread evenly over places and directions.
std::vector<SightLines::Line> spread(Asker& asker, bool blocked, std::size_t wanted) {
  std::vector<SightLines::Line> out;
  const std::vector<TPoint2D>& places = blocked ? asker.walls() : asker.ends();
  if (places.empty() || asker.ends().empty()) return out;
  EvenPoints points;
  for (std::size_t i = 0; i < kTries * wanted && out.size() < wanted; ++i) {
    const auto [place, turn, stretch, split] = points.next();
    const double angle = 2.0 * kPi * turn;
    const TPoint2D along = TPoint2D(std::cos(angle), std::sin(angle)) * (kShortest + stretch * (kLongest - kShortest));
    const TPoint2D from = pick(places, place) - along * (blocked ? split : 0.0);
    std::optional<SightLines::Line> line = asker.ask(from, from + along);
    if (line && line->blocked == blocked) out.push_back(*line);
  }
  return out;
}

/// How often the line is blocked where the truth is laid over itself. An open line that never is says nothing; it
/// remembers where it is.
double chance_of(SightLines::Line& line, Asker& asker, const std::vector<TPoint2D>& shifts, double mean,
                 SightLines::Credit credit) {
  double blocked = line.blocked || credit == SightLines::Credit::Whole ? kPrior * mean : 0.0;
  double asked = kPrior;
  for (const TPoint2D& shift : shifts) {
    const std::optional<SightLines::Line> other = asker.ask(line.from + shift, line.to + shift);
    if (!other) continue;
    asked += 1.0;
    blocked += other->blocked ? 1.0 : 0.0;
    if (other->blocked && !line.blocked) line.doubts.push_back(static_cast<float>(other->middle));
  }
  return blocked / asked;
}

/// Share of the lines between places that are blocked.
double blocked_share(Asker& asker) {
  constexpr std::size_t kSamples = 4000;
  double open = 0.0;
  double blocked = 0.0;
  EvenPoints points;
  if (asker.ends().empty()) return 0.0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const auto [place, turn, stretch, unused] = points.next();
    const double angle = 2.0 * kPi * turn;
    const TPoint2D along = TPoint2D(std::cos(angle), std::sin(angle)) * (kShortest + stretch * (kLongest - kShortest));
    const TPoint2D from = pick(asker.ends(), place);
    if (const auto line = asker.ask(from, from + along)) (line->blocked ? blocked : open) += 1.0;
  }
  return open + blocked > 0.0 ? blocked / (open + blocked) : 0.0;
}

/// At how many places, `kPlace` apart, inner walls of the truth are asked about.
std::size_t wall_places(const std::vector<SightLines::Line>& lines) {
  std::vector<TPoint2D> places;
  for (const SightLines::Line& line : lines) {
    if (!line.blocked) continue;
    const TPoint2D at = line.from + (line.to - line.from) * (line.middle / (line.to - line.from).norm());
    const auto near = [&](const TPoint2D& p) { return (p - at).sqrNorm() < kPlace * kPlace; };
    if (std::none_of(places.begin(), places.end(), near)) places.push_back(at);
    if (static_cast<double>(places.size()) >= kPlenty) break;
  }
  return places.size();
}

/// What a map says about one line.
struct Word {
  double known = 0.0;  ///< 0..1: how much of the question it answers
  double right = 0.0;  ///< -known..known
};

/// What the walls that a map draws on a blocked line are, and how near the best comes to the right one.
struct Drawn {
  Drawn(const SightLines::Line& line, const Sight& sight, double raster) {
    for (const Crossing& wall : sight.walls) {
      const double off = std::max(0.0, std::abs(wall.middle() - line.middle) - raster) +
                         kThickness * std::abs(wall.thickness() - line.thickness);
      const double strength = std::min(1.0, wall.strength / line.strength);
      all += strength;
      best = std::max(best, strength * std::clamp(1.0 - off / kTau, 0.0, 1.0));
    }
  }
  /// -1..1. A wall drawn twice is half wrong.
  double right() const { return 2.0 * best / std::max(1.0, all) - 1.0; }
  double all = 0.0;
  double best = 0.0;
};

double drawn_on_open(const Sight& sight) {
  double all = 0.0;
  for (const Crossing& wall : sight.walls) all += wall.strength;
  return std::min(1.0, all);
}

/// A wall that is drawn answers in full, seen from one side or both; none does where its place is known.
Word word_on_blocked(const SightLines::Line& line, const Sight& sight, double raster) {
  const Drawn drawn(line, sight, raster);
  constexpr double kAsked[] = {-1.0, -0.5, 0.0, 0.5, 1.0};
  double seen = 0.0;
  for (const double side : kAsked) seen += sight.sees(line.middle + side * kPlaceOfWall) ? 1.0 : 0.0;
  const double known = std::max(seen / static_cast<double>(std::size(kAsked)), std::min(1.0, drawn.all));
  return {known, known * drawn.right()};
}

/// An open line is known as far as the places are at which a wall might block it.
Word word_on_open(const SightLines::Line& line, const Sight& sight) {
  const double drawn = drawn_on_open(sight);
  const auto seen = std::count_if(line.doubts.begin(), line.doubts.end(),
                                  [&](float at) { return sight.sees(static_cast<double>(at)); });
  const double open = static_cast<double>(seen) / std::max(1.0, static_cast<double>(line.doubts.size()));
  return {std::max(open, drawn), std::max(-1.0, open - 2.0 * drawn)};
}

/// A wall seen from one side only, or at the edge of what the map knows, is half a line.
Word word_on_whole(const SightLines::Line& line, const Sight& sight, double raster, bool from_known, bool to_known) {
  if (sight.walls.empty() && sight.unknown > kUnseen) return {};
  const double known = 0.5 * from_known + 0.5 * to_known;
  return {known, known * (line.blocked ? Drawn(line, sight, raster).right() : 1.0 - 2.0 * drawn_on_open(sight))};
}

/// What a map says about all lines, by weight.
struct Sum {
  void take(const SightLines::Line& line, const Word& word) {
    all += line.weight;
    known += line.weight * word.known;
    gain += line.weight * word.right;
    all_of[line.blocked] += line.weight;
    known_of[line.blocked] += line.weight * word.known;
  }
  /// The lesser share of the two kinds that is known.
  double lesser() const {
    double out = 1.0;
    for (std::size_t i = 0; i < all_of.size(); ++i)
      if (all_of[i] > 0.0) out = std::min(out, known_of[i] / all_of[i]);
    return out;
  }
  double all = 0.0;
  double known = 0.0;
  double gain = 0.0;
  std::array<double, 2> all_of{};  ///< of open and of blocked lines
  std::array<double, 2> known_of{};
};

/// Luck is wrong about whole walls, an honest map a little about all: where one wall of ten decides, little errors must
/// not. A patch of free ground fits into any hall: it earns nothing without walls.
double beyond_bare_luck(const Sum& sum, double fee) {
  const double wrong = (1.0 - sum.gain / sum.known) / (1.0 - fee);
  const double known = std::min(sum.known / sum.all, kMoreOfOneKind * sum.lesser() + kOfOneKind);
  return std::clamp(known * (1.0 - wrong * wrong * wrong), 0.0, 1.0);
}

template <class Transform>
SightAgreement agreement(const std::vector<SightLines::Line>& lines, const SightMap& map, const Transform& T,
                         const SightLines::Luck& luck, SightLines::Credit credit) {
  const Ground ground(map);
  const double least = credit == SightLines::Credit::Located ? kLeastRaster : 0.0;
  const double raster = std::clamp(kRaster * map.grid.resolution(), least, kMostRaster);
  Sight sight;
  Sum sum;
  for (const SightLines::Line& line : lines) {
    const TPoint2D a = T.inverse(line.from);
    const TPoint2D b = T.inverse(line.to);
    const double length = (line.to - line.from).norm();
    ground.look(a, b, length, sight, credit == SightLines::Credit::Located ? line.unjudged : Unjudged());
    Word word;
    if (credit == SightLines::Credit::Whole) {
      word = word_on_whole(line, sight, raster, ground.known(a), ground.known(b));
    } else {
      sight.close_holes(length);
      word = line.blocked ? word_on_blocked(line, sight, raster) : word_on_open(line, sight);
    }
    sum.take(line, word);
  }
  SightAgreement out;
  if (sum.known <= 0.0) return out;
  out.known = sum.known / sum.all;
  out.kappa = sum.gain / sum.known;
  out.score = luck.bare ? beyond_bare_luck(sum, luck.fee)
                        : std::clamp((sum.gain / sum.all - luck.fee * out.known) / (1.0 - luck.fee), 0.0, 1.0);
  return out;
}

}  // namespace

SightLines::SightLines(const OccupancyGrid& truth, Credit credit) : credit_(credit) {
  // The fewer walls there are to be right about, the more often luck is right about most of them.
  const double places = ask(truth, false);
  luck_ = {std::clamp(kFee * kPlenty / places, kFee, kMostFee), false};
  if (credit == Credit::Whole || (usable() && places >= kBare)) return;
  luck_ = {std::clamp(std::sqrt(kBareLuck / ask(truth, true)), kBareFee, kMostBareFee), true};
}

double SightLines::ask(const OccupancyGrid& truth, bool outer) {
  Asker asker(truth, ragged(credit_), outer);
  lines_.clear();
  const std::vector<TPoint2D> shifts = lattice_shifts(truth, kShifts);
  const double mean = blocked_share(asker);
  const auto whole = static_cast<std::size_t>(std::clamp(kLinesPerArea * asker.area(), kLeastLines, kMostLines));
  for (const bool blocked : {false, true}) {
    const std::size_t first = lines_.size();
    double sum = 0.0;
    for (Line& line : spread(asker, blocked, credit_ == Credit::Whole ? whole : blocked ? kBlockedLines : kOpenLines)) {
      const double chance = chance_of(line, asker, shifts, mean, credit_);
      // Lines through a wall were found by its cells: as often as it is thick along them.
      line.weight = blocked ? (1.0 - chance) / std::max(line.thickness, truth.resolution()) : chance;
      if (line.weight <= 0.0) continue;
      sum += line.weight;
      lines_.push_back(std::move(line));
    }
    count_[blocked] = lines_.size() - first;
    for (std::size_t i = first; i < lines_.size(); ++i) lines_[i].weight *= sum > 0.0 ? 0.5 / sum : 0.0;
  }
  return std::max(1.0, static_cast<double>(wall_places(lines_)));
}

bool SightLines::usable() const { return count_[0] >= kFewest && count_[1] >= kFewest; }

SightAgreement SightLines::at(const SightMap& map, const PlanarTransform& T_truth_map) const {
  return agreement(lines_, map, T_truth_map, luck_, credit_);
}

SightAgreement SightLines::at(const SightMap& map, const Warp& warp) const {
  return agreement(lines_, map, warp, luck_, credit_);
}

}  // namespace rubble::scoring
