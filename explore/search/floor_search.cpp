#include "explore/search/floor_search.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

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

}  // namespace

bool FloorSearch::look(const Traversable& floor, const TPose2D& T_map_base, double turn_rate, Stamp now) {
  if (!config_.on || now < next_look_ || std::abs(turn_rate) > kTurnRate) return false;
  next_look_ = now + kLookPeriod;
  // A look that shows nothing new need not be repeated.
  if (look_around(floor, T_map_base)) looks_.push_back(last_look(floor, {now, T_map_base}));
  return true;
}

/// Says whether it showed anything new.
bool FloorSearch::look_around(const Traversable& floor, const TPose2D& T_map_base) {
  see_floor(floor, config_, T_map_base, view_);
  const bool anyhow = searched_.look(floor, view_);
  return squarely_.look(floor, view_) || anyhow;
}

FloorSearch::Look FloorSearch::last_look(const Traversable& floor, const Anchor& from) const {
  return {from, from.T_map_base, searched_.seen(), squarely_.seen(), ground_of(searched_.seen(), floor.cells)};
}

bool FloorSearch::moved(const Look& look) {
  const TPose2D& T = look.anchor.T_map_base;
  return distance({T.x, T.y}, {look.made_at.x, look.made_at.y}) > kMoved ||
         std::abs(wrap_angle(T.phi - look.made_at.phi)) > kMovedTurn;
}

bool FloorSearch::follow(const slam::Mapper& mapper) {
  bool any = false;
  for (Look& look : looks_) {
    look.anchor.follow(mapper);
    any = any || moved(look);
  }
  for (GivenUp& place : given_up_) place.anchor.follow(mapper);
  return any;
}

void FloorSearch::look_again(const Traversable& floor) {
  searched_.clear();
  squarely_.clear();
  for (Look& look : looks_) {
    if (moved(look) || look.ground.cells() != ground_of(look.anyhow, floor.cells).cells()) {
      look_around(floor, look.anchor.T_map_base);
      look = last_look(floor, look.anchor);
    } else {
      searched_.look(floor.frame(), look.anyhow);
      squarely_.look(floor.frame(), look.squarely);
    }
  }
  for (const GivenUp& place : given_up_)
    record(place.squarely)
        .give_up(floor, place.anchor.T_map_base.composePoint(place.p_base), kSubjectRadius, place.faces);
}

bool FloorSearch::reconsider(const Traversable& floor) {
  if (given_up_.empty()) return false;
  given_up_.clear();
  look_again(floor);
  return true;
}

bool FloorSearch::subject_seen(const Traversable& floor) const {
  const Cell c = floor.cells.cell(subject_.at);
  if (c.x < 1 || c.y < 1 || c.x + 1 >= floor.cells.width() || c.y + 1 >= floor.cells.height()) return false;
  return (record(subject_.squarely).missing(floor, c) & subject_.faces) == 0;
}

void FloorSearch::give_up_subject(const Traversable& floor, const Anchor& here) {
  given_up_.push_back({here, here.T_map_base.inverseComposePoint(subject_.at), subject_.faces, subject_.squarely});
  record(subject_.squarely).give_up(floor, subject_.at, kSubjectRadius, subject_.faces);
}

std::vector<Source> FloorSearch::sources(const Traversable& floor, Subjects subjects,
                                         const std::function<std::optional<double>(const TPoint2D&)>& head_start) {
  views_squarely_ = subjects == Subjects::Squarely;
  views_ = viewpoints(floor, record(views_squarely_), config_, room_, tight_, subjects);
  std::vector<Source> sources;
  for (const Viewpoint& view : views_) {
    if (const std::optional<double> start = head_start(floor.cells.centre(view.cell)))
      sources.push_back({view.cell, *start});
  }
  return sources;
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
      if (missing == 0 || !in_sight(floor, from, {x, y})) continue;
      for (const Faces face : {kEastFace, kNorthFace, kWestFace, kSouthFace}) faces += (missing & face) != 0 ? 1 : 0;
    }
  return faces * resolution;
}

void FloorSearch::choose_subject(Cell viewpoint) {
  for (const Viewpoint& view : views_)
    if (view.cell == viewpoint) subject_ = {view.subject, view.faces, views_squarely_};
}

std::optional<double> FloorSearch::turn_to_subject(const Traversable& floor, const TPose2D& T_map_base) {
  double turn = kPi;
  for (const Viewpoint& view : views_) {
    if (distance(floor.cells.centre(view.cell), {T_map_base.x, T_map_base.y}) > kAtViewpoint) continue;
    const double bearing = std::atan2(view.subject.y - T_map_base.y, view.subject.x - T_map_base.x);
    const double to = wrap_angle(bearing - T_map_base.phi);
    if (std::abs(to) >= std::abs(turn)) continue;
    turn = to;
    subject_ = {view.subject, view.faces, views_squarely_};
  }
  turned_to_ = subject_;
  return std::abs(turn) > kFacing ? std::optional<double>(turn) : std::nullopt;
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
  if (!subject_seen(floor)) give_up_subject(floor, {now, T_map_base});
  return false;
}

bool FloorSearch::staring(bool undecided, Stamp now) {
  if (!config_.on || !undecided) return false;
  if (now >= next_stare_) {
    stare_until_ = now + config_.stare;
    next_stare_ = now + 4.0 * config_.stare;
  }
  return now < stare_until_;
}

}  // namespace rubble::explore
