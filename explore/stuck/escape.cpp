#include "explore/stuck/escape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kFree = 0.5;   ///< away from where it was held, the robot is free [m]
constexpr double kSpeed = 0.2;  ///< [m/s]
constexpr double kTurns[] = {deg_to_rad(60.0), deg_to_rad(100.0), deg_to_rad(35.0), deg_to_rad(140.0)};  ///< [rad]
constexpr double kArcSpeed = 0.15;                                                                       ///< [m/s]
constexpr double kArcTurn = 0.4;                                                                         ///< [rad/s]
constexpr double kMoveTime = 5.0;                                                                        ///< [s]
constexpr double kRetraceTime = 15.0;                                                                    ///< [s]
constexpr double kOldStall = 0.7;                 ///< the report of a stall outlives it by less [s]
constexpr double kPlace = 0.06;                   ///< within so much of a place [m]
constexpr double kPlaceTurn = deg_to_rad(10.0);   ///< and so much turn [rad]
constexpr double kPlaceTime = 2.5;                ///< for so long, a move gets nowhere [s]
constexpr double kFeeler = 0.25;                  ///< room is asked for about a point so far ahead of the motion [m]
constexpr double kCornerTime = 0.25;              ///< turning, it looks so far ahead [s]
constexpr double kCornerGap = 0.015;              ///< and brings no corner nearer to a wall [m]
constexpr double kCurved = deg_to_rad(30.0);      ///< from then on a curve may have led off a wall [rad]
constexpr double kOpenStep = 0.1;                 ///< straight on, room is asked for at each such step [m]
constexpr double kOpenGap = 0.04;                 ///< to either side [m]
constexpr double kHeldWithin = deg_to_rad(45.0);  ///< of where it was held straight on is no way out [rad]
constexpr double kBehind = 0.35;                  ///< the point of the trail that is steered to [m]
constexpr double kMostBend = deg_to_rad(60.0);    ///< a trail that bends more is not followed [rad]
constexpr double kBendGain = 1.2;                 ///< turn rate per error [1/s]
constexpr int kRounds = 2;                        ///< times that all moves are tried

}  // namespace

void Escape::begin(Met met, const TPose2D& T_map_base, Stamp now, int failures, std::optional<WayOut> way_out) {
  way_out_ = std::move(way_out);
  turn_ = kTurns[static_cast<std::size_t>(failures) % std::size(kTurns)];
  const Move first = met == Met::Backwards ? Move::Ahead : Move::Back;
  const Move last = met == Met::Backwards ? Move::Back : Move::Ahead;
  moves_.clear();
  for (int round = 0; round < kRounds; ++round) {
    // It came in on floor that let it through: where straight back leads off the pallet no plan is better.
    if (way_out_ && round == 0) moves_.push_back(first);
    if (way_out_) moves_.push_back(Move::Out);
    // Retracing asks for poses to a few centimetres: first what is quick and robust.
    if (round > 0 || failures > 0 || way_out_) moves_.push_back(Move::Retrace);
    std::vector<Move> tries{first};
    // On paper a bend spins the outer wheels and lets the inner ones hold the body: with all alike it comes away.
    if (first == Move::Back) tries.push_back(Move::StraightBack);
    // Beside a wall or the side of a box neither a turn on the spot nor straight back leads off it.
    if (failures > 0) tries.insert(tries.end(), {Move::BackLeft, Move::AheadRight, Move::BackRight, Move::AheadLeft});
    tries.insert(tries.end(), {Move::Left, first, Move::Right, Move::Right, first, last});
    for (const Move move : tries) {
      moves_.push_back(move);
      // From elsewhere the plan may be another.
      if (way_out_ && (move == first || move == last)) moves_.push_back(Move::Out);
    }
  }
  held_behind_ = met == Met::Backwards;
  straight_in_vain_ = false;
  scrapes_ = failures > 0;
  roamed_ = 0.0;
  at_ = 0;
  begun_ = {now, T_map_base};
  start_move(T_map_base, now);
}

void Escape::follow(const slam::Mapper& mapper) {
  if (way_out_) way_out_->follow(mapper);
  for (Anchor* const anchor : {&begun_, &move_begun_, &place_}) anchor->follow(mapper);
  watch_.reset();  // by the pose alone it would have moved
}

void Escape::start_move(const TPose2D& T_map_base, Stamp now) {
  move_begun_ = {now, T_map_base};
  const Move move = moves_[at_];
  const bool turns = move == Move::Left || move == Move::Right;
  const bool far = move == Move::Retrace || move == Move::Out || (way_out_ && !turns);
  move_until_ = now + (far ? kRetraceTime : kMoveTime);
  old_stall_until_ = now + kOldStall;
  place_ = {now, T_map_base};
  there_since_ = now;
  watch_.reset();
  opened_ = false;
  if (way_out_) way_out_->begin_anew();
  drive_ = {};
}

bool Escape::free(const TPoint2D& p_map) const {
  return distance(position(begun_.T_map_base), p_map) >= kFree && (!way_out_ || way_out_->out(p_map));
}

/// The move under way would take the body to a wall that is known.
bool Escape::meets_wall(const TPose2D& T_map_base, const Around& around) const {
  const Move move = moves_[at_];
  if (move == Move::Back || move == Move::StraightBack || move == Move::Ahead)
    return !around.room(T_map_base + TPose2D{move == Move::Ahead ? kFeeler : -kFeeler, 0.0, 0.0});
  // Flush with a wall every turn does, and yet one leads off it: its corners scrape along, and the wall gives way to
  // nobody, so the body does.
  if (scrapes_ || (move != Move::Left && move != Move::Right)) return false;
  const double soon = turn_speed_ * kCornerTime * (move == Move::Left ? 1.0 : -1.0);
  const double then = around.gap(T_map_base + TPose2D{0.0, 0.0, soon});
  return then < kCornerGap && then < around.gap(T_map_base);
}

/// On a curve: straight on there is room as far as the map tells, or behind it, and not where it was held. Curves lead
/// off a wall, and on again into the next; at the foot of a slope, beside a wall, it has to leave them in time.
std::optional<Escape::Move> Escape::opens(const TPose2D& T_map_base, const Around& around) const {
  const Move move = moves_[at_];
  if (move != Move::BackLeft && move != Move::BackRight && move != Move::AheadLeft && move != Move::AheadRight)
    return std::nullopt;
  if (straight_in_vain_ || std::abs(wrap_angle(T_map_base.phi - move_begun_.T_map_base.phi)) < kCurved)
    return std::nullopt;
  const double held_towards = begun_.T_map_base.phi + (held_behind_ ? kPi : 0.0);
  for (const Move straight : {Move::Ahead, Move::Back}) {
    const double sign = straight == Move::Ahead ? 1.0 : -1.0;
    if (std::abs(wrap_angle(T_map_base.phi + (sign > 0.0 ? 0.0 : kPi) - held_towards)) < kHeldWithin) continue;
    bool room = true;
    for (double way = kOpenStep; room && way <= kFree + kOpenStep; way += kOpenStep)
      room = around.gap(T_map_base + TPose2D{sign * way, 0.0, 0.0}) >= kOpenGap;
    if (room) return straight;
  }
  return std::nullopt;
}

/// Retracing poses, the robot may rock to and fro between two that it cannot get to.
bool Escape::gets_nowhere(const TPose2D& T_map_base, Stamp now) {
  if (distance(position(place_.T_map_base), position(T_map_base)) > kPlace ||
      std::abs(wrap_angle(T_map_base.phi - place_.T_map_base.phi)) > kPlaceTurn) {
    place_ = {now, T_map_base};
    there_since_ = now;
  }
  return now - there_since_ > kPlaceTime;
}

Escape::Result Escape::step(const TPose2D& T_map_base, const robot::Drive& commanded, bool stalled,
                            const std::optional<robot::Drive>& wheels, bool struck, double dt, Stamp now,
                            const std::vector<TPoint2D>& trail, const WayBack& way_back, const Around& around) {
  met_ = false;
  roamed_ = std::max(roamed_, distance(position(begun_.T_map_base), position(T_map_base)));
  if (free(position(T_map_base))) {
    drive_ = {};
    return Result::Free;
  }
  const Move move = moves_[at_];
  if (!stalled) old_stall_until_ = now;
  const bool held = watch_.stuck(T_map_base, commanded, stalled && now > old_stall_until_, dt, wheels) || struck;
  const bool turned = (move == Move::Left || move == Move::Right) &&
                      std::abs(wrap_angle(T_map_base.phi - move_begun_.T_map_base.phi)) >= turn_;
  met_ = held;
  const bool wall = meets_wall(T_map_base, around);
  const std::optional<robot::Drive> next = command(T_map_base, trail, way_back);
  if (const auto straight = opens(T_map_base, around)) {
    moves_.insert(moves_.begin() + static_cast<std::ptrdiff_t>(at_) + 1, *straight);
    ++at_;
    start_move(T_map_base, now);
    opened_ = true;
    return Result::UnderWay;
  }
  if (held || turned || wall || !next || gets_nowhere(T_map_base, now) || now >= move_until_) {
    // What holds it there the map does not show.
    straight_in_vain_ =
        straight_in_vain_ || (opened_ && distance(position(move_begun_.T_map_base), position(T_map_base)) < kOpenStep);
    if (++at_ == moves_.size()) {
      drive_ = {};
      return Result::Failed;
    }
    start_move(T_map_base, now);
    return Result::UnderWay;
  }
  drive_ = *next;
  return Result::UnderWay;
}

/// Of the move under way; nothing where it is at its end.
std::optional<robot::Drive> Escape::command(const TPose2D& T_map_base, const std::vector<TPoint2D>& trail,
                                            const WayBack& way_back) {
  switch (moves_[at_]) {
    case Move::Left:
      return robot::Drive{0.0, turn_speed_};
    case Move::Right:
      return robot::Drive{0.0, -turn_speed_};
    case Move::Ahead:
      return robot::Drive{kSpeed, 0.0};
    case Move::StraightBack:
      return robot::Drive{-kSpeed, 0.0};
    case Move::BackLeft:
      return robot::Drive{-kArcSpeed, kArcTurn};
    case Move::BackRight:
      return robot::Drive{-kArcSpeed, -kArcTurn};
    case Move::AheadLeft:
      return robot::Drive{kArcSpeed, kArcTurn};
    case Move::AheadRight:
      return robot::Drive{kArcSpeed, -kArcTurn};
    case Move::Retrace:
      return way_back.drive(T_map_base);
    case Move::Out:
      return way_out_->drive(T_map_base);
    case Move::Back:
      break;
  }
  // From the place of the trail where it is: what it has backed away from lies farther than that, but ahead. Of floor
  // that was driven to and fro the last time counts.
  const auto away = [&](const TPoint2D& p) { return distance(p, position(T_map_base)); };
  auto here = trail.rbegin();
  while (here != trail.rend() && std::next(here) != trail.rend() && away(*std::next(here)) <= away(*here)) ++here;
  const auto behind = std::find_if(here, trail.rend(), [&](const TPoint2D& p) { return away(p) >= kBehind; });
  if (behind == trail.rend()) return robot::Drive{-kSpeed, 0.0};
  const double bearing = std::atan2(behind->y - T_map_base.y, behind->x - T_map_base.x);
  const double error = wrap_angle(bearing - T_map_base.phi - kPi);
  return robot::Drive{-kSpeed, std::abs(error) < kMostBend ? kBendGain * error : 0.0};
}

}  // namespace rubble::explore
