#include "explore/search/floor_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/planar.h"
#include "base/wall_between.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kLookPeriod = 0.35;            ///< [s]
constexpr double kTurnRate = deg_to_rad(40.0);  ///< turning faster the sensors see too little [rad/s]
constexpr double kFacing = deg_to_rad(8.0);     ///< [rad]
constexpr double kMoved = 0.05;                 ///< a look that moved less shows the same, to a cell [m]
constexpr double kMovedTurn = deg_to_rad(2.0);  ///< likewise
constexpr double kSubjectRadius = 0.25;         ///< given up together with a place that cannot be seen [m]
constexpr double kSquareRadius = 0.12;          ///< the same of what is to be looked at squarely [m]
constexpr double kHearing = 1.4;                ///< floor so near is listened to, a little less than sound reaches [m]
constexpr double kSmelling = 0.9;               ///< and so near it is smelt [m]
constexpr int kBoxCells = 20;                   ///< a box has more floor than this
constexpr double kNose = deg_to_rad(160.0);     ///< by a probe that points ahead
constexpr double kAtSuspect = 4.0;              ///< stands so long for one [s]
constexpr double kSameSuspect = 0.3;            ///< [m]
constexpr double kAnotherSide = 0.5;            ///< it is visited again from so far from where it was before [m]
constexpr double kSameStare = 0.5;              ///< cues so near to each other are stared at together [m]
constexpr double kBox = 0.35;                   ///< a wall so near before a suspect may be the side of its box [m]
constexpr double kLookCost = 1.5;               ///< what a look takes, in way, standing still and turning to it [m]
/// More way than this is driven to a board with a hole first: chosen on eight drives of one arena, where a box lies
/// behind one hole of three; at other holes, and with other seeds, it finds more as well [m].
constexpr double kSolidCost = 4.0;
constexpr int kTries = 1;            ///< that slid off before a place is given up
constexpr double kFullLook = 0.6;    ///< of wall that it shows squarely at best [m]
constexpr double kScrapCost = 16.0;  ///< as much more way is driven to where there is plenty instead of nothing [m]
constexpr double kPlenty = 1.0;      ///< as much as this, of wall ... [m]
constexpr double kNeighbours = 1.2;  ///< ... so near to what a look is for, that included [m]
constexpr double kSameScans = 0.10;  ///< the scans count that saw most of the floor so near to a place [m]
constexpr double kKnownCost = 14.0;  ///< as much more way is driven to what no scan saw instead of what is known [m]
constexpr double kSamePlace = 0.5;   ///< what lies so near to the place being driven to goes with it [m]
constexpr double kWellKnown = 60.0;  ///< scans; a box would have shown to so many
const std::vector<double> kSuspectDistances = {0.6, 0.75, 0.5, 0.9, 1.1};

/// The floor that decides what a look sees: what it saw, and the cells around, where its rays ended.
OccupancyGrid ground_of(const Grid<Faces>& seen, const OccupancyGrid& floor) {
  GridFrame frame = seen.frame();
  frame.x0 -= frame.resolution;
  frame.y0 -= frame.resolution;
  frame.width += 2;
  frame.height += 2;
  OccupancyGrid ground(frame, Occupancy::Unknown);
  const Cell low = floor.cell(frame.centre({0, 0}));
  const int west = std::max(0, -low.x), east = std::min(frame.width, floor.width() - low.x);
  for (int y = std::max(0, -low.y); y < std::min(frame.height, floor.height() - low.y) && west < east; ++y)
    std::copy(floor.row(low.y + y) + low.x + west, floor.row(low.y + y) + low.x + east, ground.row(y) + west);
  return ground;
}

/// Whether ground_of() would give the same ground again. All looks are asked this whenever the map was corrected, so no
/// other grid is made for it.
bool is_ground_of(const OccupancyGrid& ground, const OccupancyGrid& floor) {
  const Cell low = floor.cell(ground.frame().centre({0, 0}));
  const int width = ground.width();
  const int west = std::clamp(-low.x, 0, width), east = std::clamp(floor.width() - low.x, west, width);
  const auto unknown = [](const Occupancy* from, const Occupancy* to) {
    return std::all_of(from, to, [](Occupancy o) { return o == Occupancy::Unknown; });
  };
  for (int y = 0; y < ground.height(); ++y) {
    const Occupancy* const row = ground.row(y);
    const bool on_map = west < east && low.y + y >= 0 && low.y + y < floor.height();
    if (!on_map) {
      if (!unknown(row, row + width)) return false;
      continue;
    }
    if (!unknown(row, row + west) || !unknown(row + east, row + width)) return false;
    // std::equal compares values of an enumeration one by one.
    static_assert(sizeof(Occupancy) == 1);
    const auto bytes = static_cast<std::size_t>(east - west);
    if (std::memcmp(row + west, floor.row(low.y + y) + low.x + west, bytes) != 0) return false;
  }
  return true;
}

}  // namespace

FloorSearch::FloorSearch(const SearchConfig& config, double room, double tight, const OtherSenses& others)
    : config_(config), room_(room), tight_(tight), searched_(config), squarely_(config, kSquarely) {
  SearchConfig heard = config, smelt = config;
  // The floor in a box is in view from its open side only: what comes out of it comes there.
  heard.faces = smelt.faces = false;
  heard.min_cells = smelt.min_cells = std::max(config.min_cells, kBoxCells);
  heard.field_of_view = 2.0 * kPi;
  heard.range = kHearing;
  smelt.field_of_view = kNose;
  smelt.range = kSmelling;
  by_cameras_ = config.other_senses == OtherSearch::Suspects && (others.microphones || others.co2_probe);
  if (config.other_senses == OtherSearch::Suspects) return;
  if (others.microphones) others_.push_back({Record::Heard, heard, SearchedArea(heard)});
  if (others.co2_probe) others_.push_back({Record::Smelt, smelt, SearchedArea(smelt)});
}

/// To be changed or not, as the search is.
template <class Search>
auto& FloorSearch::record_of(Search& search, Record record) {
  for (auto& other : search.others_)
    if (other.record == record) return other.area;
  return record == Record::Squarely ? search.squarely_ : search.searched_;
}

SearchedArea& FloorSearch::record(Record record) { return record_of(*this, record); }

const SearchedArea& FloorSearch::record(Record record) const { return record_of(*this, record); }

const char* FloorSearch::purpose() const {
  switch (subject_.record) {
    case Record::Heard:
      return "a place to listen from";
    case Record::Smelt:
      return "a place to smell from";
    case Record::Suspect:
      return "what was heard or smelt and may be a victim,";
    case Record::Squarely:
      return "a place to look squarely from";
    case Record::Anyhow:
      break;
  }
  return "a place to search from";
}

std::string FloorSearch::done() const {
  std::string text = "all visible floor searched";
  if (by_cameras_) text += " by cameras";
  for (std::size_t i = 0; i < others_.size(); ++i)
    text += std::string(i + 1 == others_.size() ? " and " : ", ") +
            (others_[i].record == Record::Heard ? "listened to" : "smelt");
  if (!given_up_.empty())
    text += " but for " + std::to_string(given_up_.size()) + (given_up_.size() == 1 ? " place" : " places") +
            " out of reach";
  return text;
}

bool FloorSearch::look(const Traversable& floor, const TPose2D& T_map_base, double turn_rate, Stamp now) {
  if (!config_.on || now < next_look_ || std::abs(turn_rate) > kTurnRate) return false;
  next_look_ = now + kLookPeriod;
  looked_ = {now, T_map_base};
  looked_at_ = T_map_base;
  // A look that shows nothing new need not be repeated.
  if (look_around(floor, T_map_base)) looks_.push_back(last_look(floor, {now, T_map_base}));
  return true;
}

/// Says whether it showed anything new.
bool FloorSearch::look_around(const Traversable& floor, const TPose2D& T_map_base) {
  see_floor(floor, config_, T_map_base, view_);
  const bool anyhow = searched_.look(floor, view_);
  bool news = squarely_.look(floor, view_) || anyhow;
  for (Other& other : others_) {
    see_floor(floor, other.config, T_map_base, other.view);
    news = other.area.look(floor, other.view) || news;
  }
  return news;
}

FloorSearch::Look FloorSearch::last_look(const Traversable& floor, const Anchor& from) const {
  Look look{from, from.T_map_base, searched_.seen(), squarely_.seen(), ground_of(searched_.seen(), floor.cells), {}};
  for (const Other& other : others_)
    look.others.push_back({other.area.seen(), ground_of(other.area.seen(), floor.cells)});
  return look;
}

/// Whether the floor is as it was when the look was made, wherever it saw.
bool FloorSearch::same_ground(const Look& look, const Traversable& floor) const {
  return is_ground_of(look.ground, floor.cells) &&
         std::all_of(look.others.begin(), look.others.end(),
                     [&](const OtherLook& o) { return is_ground_of(o.ground, floor.cells); });
}

bool FloorSearch::moved(const Anchor& anchor, const TPose2D& was) {
  const TPose2D& T = anchor.T_map_base;
  return distance({T.x, T.y}, {was.x, was.y}) > kMoved || std::abs(wrap_angle(T.phi - was.phi)) > kMovedTurn;
}

/// While the robot stands before it; on the way to it, another is chosen at once with the plan on the new map.
void FloorSearch::follow_subject(const slam::Mapper& mapper) {
  if (dwell_until_ == Stamp::never()) return;
  looked_.follow(mapper);
  if (!moved(looked_, looked_at_)) return;
  subject_.at = looked_.T_map_base.composePoint(looked_at_.inverseComposePoint(subject_.at));
  looked_at_ = looked_.T_map_base;
}

bool FloorSearch::follow(const slam::Mapper& mapper) {
  follow_subject(mapper);
  bool any = false;
  for (Look& look : looks_) {
    look.anchor.follow(mapper);
    any = any || moved(look.anchor, look.made_at);
  }
  for (GivenUp& place : given_up_) place.anchor.follow(mapper);
  for (AnchoredPoint& place : slid_) place.follow(mapper);
  return any;
}

void FloorSearch::look_again(const Traversable& floor) {
  searched_.clear();
  squarely_.clear();
  for (Other& other : others_) other.area.clear();
  for (Look& look : looks_) {
    if (moved(look.anchor, look.made_at) || !same_ground(look, floor)) {
      look_around(floor, look.anchor.T_map_base);
      look = last_look(floor, look.anchor);
    } else {
      searched_.look(floor.frame(), look.anyhow);
      squarely_.look(floor.frame(), look.squarely);
      for (std::size_t i = 0; i < others_.size(); ++i) others_[i].area.look(floor.frame(), look.others[i].seen);
    }
  }
  for (const GivenUp& place : given_up_)
    if (place.record != Record::Suspect)
      record(place.record)
          .give_up(floor, place.anchor.T_map_base.composePoint(place.p_base), radius_of(place.record), place.faces);
}

bool FloorSearch::reconsider(const Traversable& floor) {
  if (given_up_.empty()) return false;
  given_up_.clear();
  look_again(floor);
  return true;
}

bool FloorSearch::subject_seen(const Traversable& floor) const {
  if (subject_.record == Record::Suspect) return !is_suspect(subject_.at);
  const Cell c = floor.cells.cell(subject_.at);
  if (c.x < 1 || c.y < 1 || c.x + 1 >= floor.cells.width() || c.y + 1 >= floor.cells.height()) return false;
  const SearchedArea& searched = record(subject_.record);
  if (subject_.record == Record::Squarely) return (subject_.faces & ~searched.looked_at(floor.frame(), c)) == 0;
  return (searched.missing(floor, c) & subject_.faces) == 0;
}

void FloorSearch::give_up_subject(const Traversable& floor, const Anchor& here) {
  given_up_.push_back({here, here.T_map_base.inverseComposePoint(subject_.at), subject_.faces, subject_.record});
  if (subject_.record != Record::Suspect)
    record(subject_.record).give_up(floor, subject_.at, radius_of(subject_.record), subject_.faces);
}

std::vector<Source> FloorSearch::sources(const Traversable& map, Subjects subjects,
                                         const std::function<std::optional<double>(const TPoint2D&)>& head_start,
                                         const std::function<bool(const Viewpoint&)>& idle) {
  const Record cameras = subjects == Subjects::Squarely ? Record::Squarely : Record::Anyhow;
  std::optional<Traversable> shut;
  if (subjects == Subjects::Squarely) {
    shut = map;
    shut->cells = with_holes_shut(map.cells);
  }
  const Traversable& floor = shut ? *shut : map;
  views_.clear();
  std::vector<Viewpoint> views = viewpoints(floor, record(cameras), config_, room_, tight_, subjects);
  if (idle) views.erase(std::remove_if(views.begin(), views.end(), idle), views.end());
  add_views(views, cameras);
  if (subjects == Subjects::All) {
    for (const Other& other : others_)
      add_views(viewpoints(floor, other.area, other.config, room_, tight_, subjects), other.record);
    add_suspects(floor);
  }
  if (subjects == Subjects::Squarely) {
    faces_left_ = !views_.empty();
    find_holes(map);
  }
  const double cell = map.frame().resolution;
  find_scraps(cells_apart(kFaceStride, cell) * cell);
  // Where other senses search with the cameras, their places would all come first.
  if (subjects == Subjects::All && others_.empty()) find_known(map);
  std::vector<Source> sources;
  for (View& view : views_) {
    const std::optional<double> start = head_start(floor.cells.centre(view.cell));
    if (!start) continue;
    // A look that shows little has to be made good by others.
    const double lost = view.record == Record::Squarely ? 1.0 - std::min(1.0, shown(floor, view) / kFullLook) : 0.0;
    view.solid = view.record == Record::Squarely && !view.hole ? kSolidCost : 0.0;
    view.cost = *start + kLookCost * lost + view.scrap + view.solid + view.known;
    sources.push_back({view.cell, view.cost});
  }
  return sources;
}

/// Tells of each view how little else there is to be looked at squarely around its subject: scraps here and there would
/// take all the time that whole lanes at the other end of the arena need. `apart`: two subjects along a wall [m].
void FloorSearch::find_scraps(double apart) {
  std::vector<TPoint2D> subjects;  // the views of each follow one another
  for (const View& view : views_)
    if (view.record == Record::Squarely && (subjects.empty() || distance(subjects.back(), view.subject) > 0.0))
      subjects.push_back(view.subject);
  std::size_t subject = 0;
  double scrap = -1.0;  // of the subject, once it was asked for
  for (View& view : views_) {
    if (view.record != Record::Squarely) continue;
    if (distance(subjects[subject], view.subject) > 0.0) {
      ++subject;
      scrap = -1.0;
    }
    if (view.hole) continue;  // what is left of a board with holes is no scrap
    if (scrap < 0.0) {
      const auto near = std::count_if(subjects.begin(), subjects.end(),
                                      [&](const TPoint2D& q) { return distance(view.subject, q) < kNeighbours; });
      scrap = kScrapCost * (1.0 - std::min(1.0, apart * static_cast<double>(near) / kPlenty));
    }
    view.scrap = scrap;
  }
}

/// Tells of each view how well the scanner knows the place. What few scans saw was seen from afar, or from a ramp,
/// whose plane passes over boxes: there one may stand that the map does not show. Many scans would have shown it.
void FloorSearch::find_known(const Traversable& floor) {
  const int around = cells_apart(kSameScans, floor.frame().resolution);
  const View* before = nullptr;  // the views of each subject follow one another
  for (View& view : views_) {
    if (view.record != Record::Anyhow) continue;
    if (before != nullptr && distance(before->subject, view.subject) == 0.0) {
      view.known = before->known;
      continue;
    }
    const Cell at = floor.cells.cell(view.subject);
    int scans = 0;
    for (int y = std::max(0, at.y - around); y <= std::min(floor.scans.height() - 1, at.y + around); ++y)
      for (int x = std::max(0, at.x - around); x <= std::min(floor.scans.width() - 1, at.x + around); ++x)
        if (floor.cells[{x, y}] == Occupancy::Free) scans = std::max<int>(scans, floor.scans[{x, y}]);
    view.known = kKnownCost * std::min(1.0, scans / kWellKnown);
    // On the way there the scanner sees more and more of a place: turning back then, the robot would get nowhere. What
    // lies beside the last one goes with it as well: the robot is there.
    if (distance(view.subject, subject_.at) < kSamePlace) view.known = std::min(view.known, subject_.known);
    before = &view;
  }
}

/// Tells of each view whether the scanner saw a hole in the board that it faces.
void FloorSearch::find_holes(const Traversable& floor) {
  const std::vector<WallHole> holes = wall_holes(floor);
  for (View& view : views_)
    view.hole = ((view.faces & (kEastFace | kWestFace)) != 0 && beside_hole(holes, view.subject, {0, 1})) ||
                ((view.faces & (kNorthFace | kSouthFace)) != 0 && beside_hole(holes, view.subject, {1, 0}));
}

/// Length of the wall beside the subject of a view that a look at it shows squarely for the first time [m].
double FloorSearch::shown(const Traversable& floor, const View& view) const {
  const double cell = floor.frame().resolution;
  const Cell subject = floor.cells.cell(view.subject);
  const double cos_view = std::cos(0.5 * config_.field_of_view), cos_square = std::cos(kSquarely.incidence);
  const double ahead_x = subject.x - view.cell.x, ahead_y = subject.y - view.cell.y;
  const double ahead = length(ahead_x, ahead_y);
  int most = 0;
  for (const auto& [face, normal] :
       {std::pair<Faces, Cell>{kEastFace, {1, 0}}, {kNorthFace, {0, 1}}, {kWestFace, {-1, 0}}, {kSouthFace, {0, -1}}}) {
    if ((view.faces & face) == 0) continue;
    int cells = 0;
    const int reach = static_cast<int>(kSquarely.farthest / cell);
    for (int i = -reach; i <= reach; ++i) {
      // Walls lie slightly askew in the map.
      for (int off = -1; off <= 1; ++off) {
        const Cell c{subject.x + i * normal.y + off * normal.x, subject.y + i * normal.x + off * normal.y};
        if (c.x < 1 || c.y < 1 || c.x + 1 >= floor.cells.width() || c.y + 1 >= floor.cells.height()) continue;
        if (floor.cells[c] != Occupancy::Free || (squarely_.missing(floor, c) & face) == 0) continue;
        const double dx = c.x - view.cell.x, dy = c.y - view.cell.y;
        const double away = length(dx, dy);
        if (away * cell < kSquarely.nearest || away * cell > kSquarely.farthest) continue;
        if (dx * normal.x + dy * normal.y < cos_square * away) continue;
        if (dx * ahead_x + dy * ahead_y < cos_view * away * ahead) continue;
        ++cells;
        break;
      }
    }
    most = std::max(most, cells);
  }
  return most * cell;
}

double FloorSearch::faces_in_view(const Traversable& floor, Cell from) const {
  if (!config_.on) return 0.0;
  const double resolution = floor.frame().resolution;
  const int reach = static_cast<int>(std::lround(config_.range / resolution));
  int faces = 0;
  for (int y = std::max(1, from.y - reach); y <= std::min(floor.cells.height() - 2, from.y + reach); ++y)
    for (int x = std::max(1, from.x - reach); x <= std::min(floor.cells.width() - 2, from.x + reach); ++x) {
      const double dx = x - from.x, dy = y - from.y;
      const double away = length(dx, dy);
      if (away < 1.0 || away > reach || floor.cells[{x, y}] != Occupancy::Free) continue;
      const int missing = searched_.missing(floor, {x, y}) & ~kFloor & faces_along(dx / away, dy / away);
      if (missing == 0 || !in_view(floor, from, {x, y})) continue;
      for (const Faces face : {kEastFace, kNorthFace, kWestFace, kSouthFace}) faces += (missing & face) != 0 ? 1 : 0;
    }
  return faces * resolution;
}

void FloorSearch::add_views(const std::vector<Viewpoint>& views, Record record) {
  for (const Viewpoint& view : views) views_.push_back({view, record});
}

bool FloorSearch::is_suspect(const TPoint2D& place) const {
  return std::any_of(suspects_.begin(), suspects_.end(),
                     [&](const Suspect& s) { return distance(s.p_map, place) < kSameSuspect; });
}

/// From near, where nothing but the side of its box stands between; not from where it was visited before.
void FloorSearch::add_suspects(const Traversable& floor) {
  const double cell = floor.frame().resolution;
  for (const Suspect& suspect : suspects_) {
    const bool given_up = std::any_of(given_up_.begin(), given_up_.end(), [&](const GivenUp& g) {
      return g.record == Record::Suspect &&
             distance(g.anchor.T_map_base.composePoint(g.p_base), suspect.p_map) < kSameSuspect;
    });
    if (given_up) continue;
    const Cell at = floor.cells.cell(suspect.p_map);
    const std::size_t before = views_.size();
    for (const double d_min : {room_, tight_}) {
      if (views_.size() > before) break;
      for (const Cell step : steps_around(kSuspectDistances, kSuspectDistances.back(), cell)) {
        const Cell c{at.x + step.x, at.y + step.y};
        if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Free || floor.clearance[c] < d_min) continue;
        const TPoint2D from = floor.cells.centre(c);
        const bool again = std::any_of(suspect.visited_from.begin(), suspect.visited_from.end(),
                                       [&](const TPoint2D& p) { return distance(p, from) < kAnotherSide; });
        const TPoint2D way = suspect.p_map - from;
        const double open = std::max(0.0, way.norm() - kBox);
        if (again || wall_between(floor.cells, from, from + way * (open / way.norm()))) continue;
        views_.push_back({{c, suspect.p_map, kFloor}, Record::Suspect});
      }
    }
  }
}

/// How exactly a sense must be turned to a place [rad].
double FloorSearch::facing(Record record) const {
  constexpr double kMargin = deg_to_rad(30.0);
  for (const Other& other : others_)
    if (other.record == record) return std::max(kFacing, 0.5 * other.config.field_of_view - kMargin);
  return kFacing;
}

void FloorSearch::start_dwell(Stamp now) {
  dwell_until_ = now + (subject_.record == Record::Suspect ? kAtSuspect : config_.dwell);
}

double FloorSearch::choose_subject(Cell viewpoint) {
  const View* best = nullptr;
  for (const View& view : views_)
    if (view.cell == viewpoint && (best == nullptr || view.cost <= best->cost)) best = &view;
  if (best == nullptr) return 0.0;
  subject_ = {best->subject, best->faces, best->record, best->known};
  return best->scrap + best->solid + best->known;
}

/// How far around a place that could not be looked at is given up with it [m].
double FloorSearch::radius_of(Record record) { return record == Record::Squarely ? kSquareRadius : kSubjectRadius; }

/// Whether a look from where the robot stands would be what it is for.
bool FloorSearch::serves(const Subject& view, const TPose2D& T_map_base) {
  if (view.record != Record::Squarely) return true;
  const double dx = view.at.x - T_map_base.x, dy = view.at.y - T_map_base.y;
  const double away = length(dx, dy);
  return away > kSquarely.nearest && away < kSquarely.farthest &&
         (faces_along(dx / away, dy / away, kSquarely.incidence) & view.faces) != 0;
}

std::optional<double> FloorSearch::turn_to_subject(const Traversable& floor, const TPose2D& T_map_base) {
  double turn = kPi;
  bool any = false;
  for (const View& view : views_) {
    if (distance(floor.cells.centre(view.cell), {T_map_base.x, T_map_base.y}) > kAtViewpoint) continue;
    const bool good = serves({view.subject, view.faces, view.record}, T_map_base);
    if (any && !good) continue;
    if (good && !any) turn = kPi;
    any = any || good;
    const double bearing = std::atan2(view.subject.y - T_map_base.y, view.subject.x - T_map_base.x);
    const double to = wrap_angle(bearing - T_map_base.phi);
    if (std::abs(to) >= std::abs(turn)) continue;
    turn = to;
    subject_ = {view.subject, view.faces, view.record, view.known};
  }
  turned_to_ = subject_;
  return std::abs(turn) > facing(subject_.record) ? std::optional<double>(turn) : std::nullopt;
}

void FloorSearch::start_dwell_as_turned(Stamp now) {
  subject_ = turned_to_;
  start_dwell(now);
}

bool FloorSearch::dwelling(const Traversable& floor, const TPose2D& T_map_base, Stamp now) {
  dwell_over_ = false;
  if (dwell_until_ == Stamp::never()) return false;
  if (now < dwell_until_) return true;
  dwell_until_ = Stamp::never();
  dwell_over_ = true;
  look_around(floor, T_map_base);
  const Anchor here{now, T_map_base};
  if (subject_.record != Record::Suspect && !subject_seen(floor) && !try_again(here)) give_up_subject(floor, here);
  return false;
}

/// Whether the robot did not stand where the place to face shows squarely, as where it slid while it turned on a slope:
/// that says nothing of the place, but not more often than `kTries` times.
bool FloorSearch::try_again(const Anchor& here) {
  if (subject_.record != Record::Squarely || serves(subject_, here.T_map_base)) return false;
  const auto before = std::count_if(slid_.begin(), slid_.end(), [&](const AnchoredPoint& p) {
    return distance(p.p_map(), subject_.at) < kSquareRadius;
  });
  if (before >= kTries) return false;
  slid_.emplace_back(here, subject_.at);
  return true;
}

bool FloorSearch::staring(const std::vector<TPoint2D>& seen, bool smelt, Stamp now) {
  if (!config_.on || (seen.empty() && !smelt)) return false;
  const double pause = 4.0 * config_.stare;
  // A false alarm somewhere else must not take the stare from a victim that shows a few seconds later; no more
  // than `stares` of them hold the robot, though.
  stared_at_.erase(
      std::remove_if(stared_at_.begin(), stared_at_.end(), [&](const Stare& s) { return now - s.since >= pause; }),
      stared_at_.end());
  for (const TPoint2D& at : seen) {
    if (static_cast<int>(stared_at_.size()) >= config_.stares) break;
    if (std::any_of(stared_at_.begin(), stared_at_.end(),
                    [&](const Stare& s) { return distance(s.at, at) < kSameStare; }))
      continue;
    stared_at_.push_back({at, now});
    stare_until_ = now + config_.stare;
  }
  if (smelt && now >= next_sniff_) {
    stare_until_ = now + config_.stare;
    next_sniff_ = now + pause;
  }
  return now < stare_until_;
}

}  // namespace rubble::explore
