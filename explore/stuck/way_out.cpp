#include "explore/stuck/way_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/plan/path_follower.h"
#include "robot/body.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kStub = 0.035;        ///< the high corners reach so far into the pallet [m]
constexpr double kWindow = 0.45;       ///< poses and obstacles count up to so far beside the trap [m]
constexpr double kCell = 0.04;         ///< of the search [m]
constexpr double kStride = 0.05;       ///< [m]
constexpr int kHeadings = 36;          ///< in a circle
constexpr double kOnHeading = 0.05;    ///< so near a heading is that one, in steps between headings
constexpr double kOutTurnCost = 0.05;  ///< of the turn to the next heading, as way [m]
constexpr double kStopCost = 0.08;     ///< of a change between drive and turn or to and fro: each wanders a little [m]
constexpr double kNearFloor = 0.2;     ///< known floor is where the robot's middle was so near [m]
constexpr std::array<double, 4> kMargins{0.05, 0.03, 0.015,
                                         0.0};  ///< beside the body, the widest that leaves a way [m]
constexpr long kMostWork = 60'000'000;          ///< of one plan: obstacles held against poses

constexpr double kOutSpeed = 0.15;                  ///< [m/s]
constexpr double kGain = 1.2;                       ///< speed per way left [1/s]: the base brakes by 0.3 m/s2 only
constexpr double kLeastSpeed = 0.04;                ///< [m/s]
constexpr double kThere = 0.015;                    ///< [m]
constexpr double kTurned = deg_to_rad(2.5);         ///< [rad]
constexpr double kTurnGain = 2.0;                   ///< turn rate per angle left [1/s]
constexpr double kOutTurnSpeed = deg_to_rad(45.0);  ///< [rad/s]
constexpr double kBackToLine = 0.4;                 ///< beside its line it heads for the point so far on [m]
constexpr double kMostHeadIn = deg_to_rad(10.0);    ///< but by no more than this [rad]

}  // namespace

WayOut::WayOut(const robot::RobotModel& model, const Trap& trap, const std::vector<TPoint2D>& obstacles,
               const std::vector<TPoint2D>& known)
    : model_(model), trap_(trap) {
  const TPose2D T_map_pallet = trap_.T_map_pallet();
  const double half = 0.5 * trap.size;
  for (const TPoint2D& p : obstacles)
    if (trap_.holds(p, kWindow + 0.5 * model_.length)) obstacles_.push_back(T_map_pallet.inverseComposePoint(p));
  for (const TPoint2D& p : known)
    if (trap_.holds(p, kWindow + kNearFloor)) known_.push_back(T_map_pallet.inverseComposePoint(p));
  for (const double reach : {half, half - kStub})
    for (const TPoint2D& p : {TPoint2D{reach, 0.0}, TPoint2D{-reach, 0.0}, TPoint2D{0.0, reach}, TPoint2D{0.0, -reach}})
      obstacles_.push_back(p);
}

double WayOut::room(const TPoint2D& p_base) const { return robot::to_body(model_, p_base.x, p_base.y); }

bool WayOut::fits(const TPose2D& T_pallet_base, const std::vector<Keep>& keeps) const {
  const PlanarTransform T(T_pallet_base);
  const double far = 0.5 * length(model_.length, model_.width) + kMargins.front();
  return std::all_of(keeps.begin(), keeps.end(), [&](const Keep& keep) {
    const double dx = keep.at.x - T_pallet_base.x, dy = keep.at.y - T_pallet_base.y;
    return dx * dx + dy * dy > far * far || room(T.turned_back(dx, dy)) >= keep.away;
  });
}

bool WayOut::leaves(const TPose2D& T_pallet_base) const {
  return std::max(std::abs(T_pallet_base.x), std::abs(T_pallet_base.y)) > 0.5 * trap_.size + kBeside;
}

bool WayOut::is_known(const TPoint2D& p_pallet) const {
  return std::any_of(known_.begin(), known_.end(),
                     [&](const TPoint2D& q) { return distance(p_pallet, q) < kNearFloor; });
}

/// Of the way that ends in a node of the search.
WayOut::Piece WayOut::first_piece(const std::vector<Node>& nodes, int last) {
  const auto node = [&](int i) -> const Node& { return nodes[static_cast<std::size_t>(i)]; };
  std::vector<int> way;
  for (int at = last; node(at).before >= 0; at = node(at).before) way.push_back(at);
  std::reverse(way.begin(), way.end());
  const int move = node(way.front()).move;
  const auto end = std::find_if(way.begin(), way.end(), [&](int i) { return node(i).move != move; });
  const double length = std::abs(move) == 1 ? move * kStride * static_cast<double>(end - way.begin()) : 0.0;
  return {node(*(end - 1)).pose, std::abs(move) == 2, length};
}

/// The first pieces of the cheapest ways out that keep `margin` from everything. `work`: obstacles that it may yet hold
/// against poses.
WayOut::Ways WayOut::search(const TPose2D& T_pallet_base, double margin, long& work) const {
  // What the body touches as it stands, or nearly, it may not come nearer to.
  std::vector<Keep> keeps;
  for (const TPoint2D& p : obstacles_)
    keeps.push_back({p, std::min(margin, room(T_pallet_base.inverseComposePoint(p)) - 1e-6)});
  const double reach = 0.5 * trap_.size + kWindow;
  const int side = 1 + static_cast<int>(2.0 * reach / kCell);
  const double turn = 2.0 * kPi / kHeadings;
  const auto index = [&](const Node& node) -> std::optional<std::size_t> {
    const double x = std::floor((node.pose.x + reach) / kCell), y = std::floor((node.pose.y + reach) / kCell);
    if (x < 0.0 || y < 0.0 || x >= side || y >= side) return std::nullopt;
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)) * kHeadings +
           static_cast<std::size_t>(node.heading);
  };
  const auto places = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * kHeadings;
  std::vector<double> least(places, std::numeric_limits<double>::infinity());
  std::vector<Node> nodes{{T_pallet_base}};
  nodes.front().heading = (static_cast<int>(std::lround(T_pallet_base.phi / turn)) + kHeadings) % kHeadings;
  using Entry = std::pair<double, int>;  // equal costs: in the order found
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.push({0.0, 0});
  if (const auto start = index(nodes.front())) least[*start] = 0.0;
  Ways ways;
  while (!open.empty()) {
    const auto [cost, at] = open.top();
    open.pop();
    const Node node = nodes[static_cast<std::size_t>(at)];
    const auto own = index(node);
    if (own && cost > least[*own]) continue;
    if (leaves(node.pose)) {
      const bool is_start = node.before < 0;
      if (!is_start && !ways.anywhere) ways.anywhere = first_piece(nodes, at);
      if (known_.empty()) break;
      if (is_known(position(node.pose))) {
        if (!is_start) ways.to_known = first_piece(nodes, at);
        break;
      }
    }
    for (const int move : {1, -1, 2, -2}) {
      Node next = node;
      next.before = at;
      next.move = move;
      if (std::abs(move) == 1) {
        next.pose = node.pose + TPose2D{move * kStride, 0.0, 0.0};
      } else {
        // Headings lie on the pallet's axes, whatever the first one is: its lanes do.
        const double to = move > 0 ? std::floor(node.pose.phi / turn + kOnHeading) + 1.0
                                   : std::ceil(node.pose.phi / turn - kOnHeading) - 1.0;
        next.pose.phi = wrap_angle(to * turn);
        next.heading = (static_cast<int>(to) + kHeadings) % kHeadings;
      }
      const auto there = index(next);
      const double to = cost + (std::abs(move) == 1 ? kStride : kOutTurnCost) + (move == node.move ? 0.0 : kStopCost);
      if (!there || to >= least[*there]) continue;
      work -= static_cast<long>(keeps.size());
      if (work < 0) return ways;
      if (!fits(next.pose, keeps)) continue;
      least[*there] = to;
      open.push({to, static_cast<int>(nodes.size())});
      nodes.push_back(next);
    }
  }
  return ways;
}

std::optional<WayOut::Piece> WayOut::plan(const TPose2D& T_pallet_base) const {
  long work = kMostWork;
  std::optional<Piece> anywhere;
  for (const double margin : kMargins) {
    const Ways ways = search(T_pallet_base, margin, work);
    if (ways.to_known) return ways.to_known;
    if (!anywhere) anywhere = ways.anywhere;
    if (anywhere && known_.empty()) break;
  }
  return anywhere;
}

/// Nothing at the end of the piece.
std::optional<robot::Drive> WayOut::along(const TPose2D& T_pallet_base) const {
  const TPose2D left = piece_->to - T_pallet_base;
  const double turn = wrap_angle(left.phi);
  if (piece_->turns) {
    if (std::abs(turn) < kTurned) return std::nullopt;
    const double w = std::clamp(kTurnGain * std::abs(turn), kLeastTurn, kOutTurnSpeed);
    return robot::Drive{0.0, std::copysign(w, turn)};
  }
  // Along the line through the end of the piece.
  const TPoint2D here = piece_->to.inverseComposePoint(position(T_pallet_base));
  const double way = -here.x;
  if (way * piece_->way <= 0.0 || std::abs(way) < kThere) return std::nullopt;
  const double v = std::copysign(std::clamp(kGain * std::abs(way), kLeastSpeed, kOutSpeed), way);
  const double bend =
      std::clamp(std::atan2(-here.y, kBackToLine) * (way > 0.0 ? 1.0 : -1.0), -kMostHeadIn, kMostHeadIn);
  return robot::Drive{v, std::clamp(kTurnGain * wrap_angle(turn + bend), -0.3, 0.3)};
}

std::optional<robot::Drive> WayOut::drive(const TPose2D& T_map_base) {
  const TPose2D T_pallet_base = wrapped(T_map_base - trap_.T_map_pallet());
  if (piece_)
    if (const auto drive = along(T_pallet_base)) return drive;
  piece_ = plan(T_pallet_base);
  return piece_ ? along(T_pallet_base) : std::nullopt;
}

}  // namespace rubble::explore
