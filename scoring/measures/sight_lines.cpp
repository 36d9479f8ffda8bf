#include "scoring/measures/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angle.h"
#include "base/distance_transform.h"
#include "scoring/measures/lattice_shifts.h"
#include "scoring/measures/sight_words.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

constexpr double kShortest = 0.5;       // line [m]
constexpr double kLongest = 1.8;        // [m]
constexpr double kClearEnds = 0.25;     // of walls at both ends [m]
constexpr double kClearBeside = 0.12;   // open lines have no wall so near, blocked ones are blocked so far aside [m]
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

/// Elements of an arena have faces that the truth does not know, behind the one it does. Near that one all is judged.
void note_unjudged(SightLines::Line& line, const Sight& sight) {
  constexpr double kNear = 0.2;  // [m]
  for (const Stretch& s : sight.unseen) {
    const double from = s.from >= line.middle ? std::max(s.from, sight.walls[0].to + kNear) : s.from;
    const double to = s.from >= line.middle ? s.to : std::min(s.to, sight.walls[0].from - kNear);
    if (from < to) line.unjudged.emplace_back(static_cast<float>(from), static_cast<float>(to));
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
  SightGround ground_;
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

/// A wall seen from one side only, or at the edge of what the map knows, is half a line.
SightWord word_on_whole(const SightLines::Line& line, const Sight& sight, double raster, bool from_known,
                        bool to_known) {
  if (sight.walls.empty() && sight.unknown > kUnseen) return {};
  const double known = 0.5 * from_known + 0.5 * to_known;
  return {known,
          known * (line.blocked ? DrawnOnBlocked(line, sight, raster).right() : 1.0 - 2.0 * drawn_on_open(sight))};
}

/// What a map says about all lines, by weight.
struct Sum {
  void take(const SightLines::Line& line, const SightWord& word) {
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
  const SightGround ground(map);
  const double raster = raster_of(map.grid, credit);
  Sight sight;
  Sum sum;
  for (const SightLines::Line& line : lines) {
    const TPoint2D a = T.inverse(line.from);
    const TPoint2D b = T.inverse(line.to);
    const double length = (line.to - line.from).norm();
    ground.look(a, b, length, sight, credit == SightLines::Credit::Located ? line.unjudged : Unjudged());
    SightWord word;
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
