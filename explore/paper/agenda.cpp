#include "explore/paper/agenda.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "base/planar.h"
#include "explore/paper/prospects.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kVisited = 0.30;                ///< closer to its target the robot has been there [m]
constexpr double kNearTarget = 1.0;              ///< turned away from so near, it was seen not to be had [m]
constexpr double kBarren = 240.0;                ///< spent on frontiers in vain for so long, the faces go first [s]
constexpr double kBarrenWalls = 90.0;            ///< the same without new ground where walls have holes [s]
constexpr int kCutShort = 3;                     ///< so many rounds that left faces out of reach are not the last
constexpr double kLookTurn = deg_to_rad(270.0);  ///< with a 240 deg scanner more than once around [rad]
constexpr double kGlance = deg_to_rad(40.0);     ///< [rad]
constexpr double kSearchReplan = 2.0;            ///< on the way to a viewpoint [s]
constexpr double kArrivedReplan = 0.3;           ///< standing at the end of the way [s]
constexpr double kDetour = 3.0;                  ///< way over distance where no way is known
constexpr double kFarther = 4.0;                 ///< the next place costs so much more: the way to this one is shut [m]
constexpr double kWandered = 0.5;                ///< nearer to its place, a turn has carried it off [m]
constexpr double kSmallShift = 0.10;             ///< of the robot's place by a correction of the map [m]

/// `search`: what a place to search from is for.
std::string target_text(Goal goal, bool niches, const char* search, const Plan& plan, double usual_d_min) {
  const char* what = goal == Goal::Home       ? "home"
                     : plan.doubtful          ? "a wall that may be a ramp"
                     : goal == Goal::Frontier ? "the frontier"
                     : niches                 ? "a place to look into a niche from"
                                              : search;
  std::array<char, 60> more{};
  std::snprintf(more.data(), more.size(), ", cost %.1f m", plan.cost);
  const std::string line = std::string("drives to ") + what + " at " + place_text(plan.target) + more.data();
  if (plan.d_min >= usual_d_min) return line;
  std::snprintf(more.data(), more.size(), ", as near as %.2f m to walls", plan.d_min);
  return line + more.data();
}

Order turn(double angle, TurnFor purpose) {
  Order order;
  order.kind = Order::Kind::Turn;
  order.angle = angle;
  order.purpose = purpose;
  return order;
}

}  // namespace

std::string place_text(const TPoint2D& p) {
  std::array<char, 40> line{};
  std::snprintf(line.data(), line.size(), "(%.1f, %.1f)", p.x, p.y);
  return line.data();
}

Agenda::Agenda(const PaperExplorerConfig& config)
    : config_(config),
      choice_(config.planner, config.bar_targets, config.felt.pallet, config.choice, config.priorities),
      pushing_(config.felt.pallet) {}

void Agenda::note(Stamp now, const std::string& why) {
  if (decisions_.empty() || decisions_.back().why != why) decisions_.push_back({now, why});
}

void Agenda::follow(const slam::Mapper& mapper, double shift) {
  choice_.follow(mapper);
  if (looked_from_) looked_from_->follow(mapper);
  for (AnchoredPoint& place : insisted_on_) place.follow(mapper);
  if (shift > kSmallShift) choice_.drop_target();
  plan_soon();
}

double Agenda::way_home(const Situation& situation, double way_come) {
  const Plan way = choice_.way_home(situation.floor, situation.T_map_base, situation.trail);
  // Blocked at the moment: a detour, but hardly longer than all the way it came.
  return way.found ? length_of(way) : std::min(way_come, kDetour * choice_.distance_home(situation.T_map_base));
}

void Agenda::arrived(Stamp now) {
  if (clock_.age(now) > kArrivedReplan) plan_soon();
}

bool Agenda::begin_plan(const slam::CountMap& map, Stamp now) {
  return clock_.plan(map.version(), goal() == Goal::Place ? kSearchReplan : config_.replan_period, now);
}

Plan Agenda::choose(const Situation& situation) {
  if (gained_.worth_a_try(situation.floor)) {
    gained_.mark(situation.floor);
    gained_at_ = situation.now;
    in_vain_ = 0.0;
  }
  TargetChoice::View view{situation.floor, situation.T_map_base, situation.now, situation.left_alone};
  view.speed = situation.speed;
  // What is off the grid may be solid after all: it is driven at for the place that is asked for, and for no other.
  view.places_only = pushing_.what() == Pushing::What::OffGrid;
  view.faces_first = faces_go_first(situation);
  const bool wanted =
      choice_.frontiers_done() && goal() == Goal::Place && target() && !situation.search.subject_seen(situation.floor);
  TargetChoice::Choice choice;
  if (goal() == Goal::Home)
    choice.plan = choice_.way_home(situation.floor, situation.T_map_base, situation.trail);
  else
    choice = choice_.choose(view, situation.search);
  if (choice.no_niche) {
    frontier_left_ = choice.plan.frontier_left;
    if (situation.search.squarely()) {  // niches are faces like others now
      if (pushes_for_niche_) end_pushing();
    } else if (push_for_niche(situation)) {
      return std::move(choice.plan);
    }
    const auto news = rounds_.before_all_faces(standing(situation), known_off_grid_.worth_a_try(situation.floor),
                                               situation.search, situation.left_alone);
    if (news) {
      begin_round(*news, situation.now);
      return choice_.choose_frontier(view, situation.search);
    }
    choice = choice_.choose_of_all_places(view, situation.search, std::move(choice.plan));
  }
  insist(wanted, choice.plan, situation);
  if (choice.into_reach) note(situation.now, "a frontier has come into reach");
  return std::move(choice.plan);
}

/// On the way to a place that is still `wanted` the floor of a slope may be drawn across the way, as seen from its
/// foot: it drives on all the same, once. From farther off the way would be free again, and the robot drive to and fro.
void Agenda::insist(bool wanted, const Plan& plan, const Situation& situation) {
  if (push_begun_) return;
  const bool shut = !plan.found || plan.cost > cost_left_ + kFarther;
  if (insists_) {
    if (!shut) return;
    end_pushing();
    push_begun_ = true;
  } else if (wanted && shut && !pushing_.on() && distance(*target(), position(situation.T_map_base)) > kWandered &&
             std::none_of(insisted_on_.begin(), insisted_on_.end(), [&](const AnchoredPoint& p) {
               return distance(p.p_map(), *target()) < config_.planner.same_target;
             })) {
    insisted_on_.emplace_back(situation.robot(), *target());
    pushing_.start_on_slopes();
    insists_ = push_begun_ = true;
    note(situation.now, "the way to the place is shut: what may be the floor of a slope is driven at");
  }
}

bool Agenda::turn_away(const Plan& plan, double left, const Situation& situation) {
  if (!plan.found || !target() || push_begun_) return false;
  if (!choice_.turns_away(plan)) return length_of(plan) > left + kLongerWay;
  if (goal() == Goal::Home) return false;
  const bool again = situation.left_alone.turned_away(*target());
  if (!again && left > kNearTarget &&
      !choice_.kept_away({situation.floor, situation.T_map_base, situation.now, situation.left_alone}, left))
    return false;
  note(situation.now, "something new stands in the way");
  leave_target(situation.left_alone, situation.robot());
  return true;
}

/// A niche is left, out of reach: before all other faces are searched, which takes most of the time, things in the way
/// to it are pushed aside, once for each piece of ground gained.
bool Agenda::push_for_niche(const Situation& situation) {
  if (push_begun_) return true;
  if (!situation.search.place_left() || (pushing_.on() && !pushes_for_niche_)) return false;
  if (!pushing_.on()) {
    if (!known_at_niche_.worth_a_try(situation.floor)) return false;
    known_at_niche_.mark(situation.floor);
  }
  pushes_for_niche_ = pushing_.more();
  if (pushing_.more())
    start_pushing(situation, "a niche is out of reach");
  else
    pushing_.end();
  push_begun_ = pushes_for_niche_;
  return push_begun_;
}

Order Agenda::decide(Plan plan, bool new_map, const Situation& situation) {
  if (push_begun_) {
    push_begun_ = false;
    return stay_and_plan();
  }
  frontier_left_ = plan.frontier_left;
  if (!plan.found) {
    choice_.drop_target();
    rounds_.no_way(new_map);
    return nothing_left(situation);
  }
  rounds_.way_found();
  const double away = distance(plan.target, position(situation.T_map_base));
  if (goal() == Goal::Home && away < kVisited) return finish(MissionEnd::Home, "home again", situation.now);
  if (goal() == Goal::Place && away < kAtViewpoint) return face_subject(situation);
  // From a hand's breadth farther down a slope it still looks like a wall.
  if (goal() == Goal::Frontier && away < (plan.doubtful ? kAtViewpoint : kVisited))
    return visited_in_vain(plan, situation);
  if (!insists_) cost_left_ = plan.cost;
  if (choice_.take(plan))
    note(situation.now, target_text(goal(), !choice_.frontiers_done(), situation.search.purpose(), plan,
                                    config_.planner.transform.d_min));
  Order order;
  order.kind = Order::Kind::Follow;
  order.plan = std::move(plan);
  return order;
}

/// At a viewpoint.
Order Agenda::face_subject(const Situation& situation) {
  end_pushing();
  if (situation.turning) return {};
  if (const auto angle = situation.search.turn_to_subject(situation.floor, situation.T_map_base))
    return turn(*angle, TurnFor::Place);
  situation.search.start_dwell(situation.now);
  return {};
}

/// The robot stands at a frontier that does not go away: look around, then bar it.
Order Agenda::visited_in_vain(const Plan& plan, const Situation& situation) {
  if (situation.turning) return {};
  const TPoint2D here = position(situation.T_map_base);
  if (!looked_from_ || distance(looked_from_->p_map(), here) > kVisited) {
    looked_from_.emplace(situation.robot(), here);
    // A wall that may be a ramp lies before it, and where its floor is one it slides as it turns.
    return turn(plan.doubtful ? kGlance : kLookTurn, TurnFor::View);
  }
  if (plan.doubtful && situation.close_looks &&
      situation.close_looks->judge(situation.floor, situation.robot()) == CloseLooks::Verdict::Floor) {
    note(situation.now, "the wall looked at from " + place_text(plan.target) + " is the floor of a slope: seen over");
    return stay_and_plan();
  }
  const std::string what = plan.doubtful ? "the wall looked at from " : "the frontier at ";
  note(situation.now, what + place_text(plan.target) + " stays although it was visited: left alone");
  situation.left_alone.bar_for_good(plan.target, situation.robot());
  choice_.drop_target();
  return stay_and_plan();
}

/// The goal cannot be reached: look around once more, try again what failed before, then go on to the next.
Order Agenda::nothing_left(const Situation& situation) {
  if (situation.turning) return {};
  const bool homeward = goal() == Goal::Home;
  const bool worth = goal() != Goal::Frontier || prospects_of(situation, true) > 0;
  const bool push = worth && may_push(situation);
  const bool patient = homeward || (goal() == Goal::Frontier && !choice_.frontiers_done());
  const Resort resort = patient ? rounds_.next_resort(homeward, push, situation.left_alone, situation.now, worth)
                        : push  ? Resort::Push
                                : Resort::GiveUp;
  if (goal() == Goal::Frontier && resort != Resort::LookAround) choice_.leave_pockets(!choice_.thorough());
  switch (resort) {
    case Resort::LookAround:
      return turn(kLookTurn, TurnFor::View);
    case Resort::TryAgain:
      note(situation.now, "nothing else can be reached: what failed before is tried again");
      return stay_and_plan();
    case Resort::Push:
      pushes_for_niche_ = false;
      return start_pushing(situation, "nothing else can be reached");
    case Resort::ForgetAll:
      note(situation.now, "no way home: all that was felt is forgotten");
      return stay_and_plan();
    case Resort::GiveUp:
      break;
  }
  if (homeward) return finish(MissionEnd::Explored, "no way home is left", situation.now);
  return goal() == Goal::Place ? finish_searching(situation) : finish_exploring(situation);
}

void Agenda::end_pushing() {
  pushing_.end();
  pushes_for_niche_ = insists_ = false;
}

/// Things in the way that were not seen yet when things were pushed aside last: once for each piece of ground gained.
bool Agenda::may_push(const Situation& situation) const {
  if (!pushing_.more()) return false;
  if (goal() == Goal::Home) return true;
  // It came here by pushing, or something rolled into its way: the rest of the arena is to be searched as well.
  if (goal() == Goal::Place) return situation.search.place_left();
  if (frontier_left_ == 0 || !pushing_.worth(situation.floor)) return false;
  const bool niches_first = situation.search.on() && !rounds_.tried_before_search();
  // New ground is not to be had so, as a rule, where a field of steps or a steep ramp keeps the robot from it: once for
  // each piece of ground gained, whatever the round.
  return pushing_.what() != Pushing::What::Strips || (!niches_first && known_off_grid_.worth_a_try(situation.floor));
}

Order Agenda::start_pushing(const Situation& situation, const std::string& why) {
  static constexpr std::array<const char*, 5> kWhat = {"nothing", "small things that stand alone",
                                                       "heaps that stand alone", "strips that hang in a row",
                                                       "what stands off the pallets' edges"};
  const auto what = static_cast<std::size_t>(pushing_.start(situation.floor));
  if (goal() == Goal::Frontier && pushing_.what() == Pushing::What::OffGrid) known_off_grid_.mark(situation.floor);
  note(situation.now, why + ": " + kWhat.at(what) + " may be pushed aside");
  return stay_and_plan();
}

Order Agenda::finish_exploring(const Situation& situation) {
  reason_ = "nothing reachable left to explore";
  if (frontier_left_ == 1) reason_ += " (1 frontier cannot be reached)";
  if (frontier_left_ > 1) reason_ += " (" + std::to_string(frontier_left_) + " frontiers cannot be reached)";
  if (!choice_.frontiers_done()) note(situation.now, reason_);
  choice_.set_frontiers_done();
  end_pushing();
  if (!situation.search.on()) return finish_searching(situation);
  choice_.search();
  return stay_and_plan();
}

/// As long as that gains something and time is left, all of it is tried once more.
Order Agenda::finish_searching(const Situation& situation) {
  const auto left = [&] { return frontier_left_; };
  const Rounds::Standing all{situation.now, situation.floor, situation.victims, left, left};
  if (const auto news = rounds_.another(all, situation.search, situation.left_alone)) {
    choice_.leave_pockets(false);
    if (!situation.search.faces_left() || ++rounds_cut_short_ > kCutShort) choice_.be_thorough();
    begin_round(*news, situation.now);
    return {};
  }
  const std::string why = goal() == Goal::Place ? situation.search.done() : "";
  if (!config_.return_home) return finish(MissionEnd::Explored, why, situation.now);
  go_home(why, situation.now);
  return {};
}

void Agenda::begin_round(const std::string& news, Stamp now) {
  note(now, news);
  choice_.explore();
  pushing_.new_round();
  pushes_for_niche_ = insists_ = false;
  known_at_niche_.forget();
  looked_from_.reset();
  plan_soon();
}

void Agenda::go_home(const std::string& why, Stamp now) {
  reason_ += (reason_.empty() || why.empty() ? "" : ", ") + why;
  note(now, "drives home: " + (why.empty() ? reason_ : why));
  choice_.go_home();
  end_pushing();
  rounds_.go_home();
  plan_soon();
}

Order Agenda::finish(MissionEnd end, const std::string& why, Stamp now) {
  end_ = end;
  reason_ += (reason_.empty() || why.empty() ? "" : ", ") + why;
  note(now, "ends: " + reason_);
  Order order;
  order.kind = Order::Kind::Stop;
  return order;
}

void Agenda::spend(double dt, const Situation& situation) {
  if (!target() || goal() == Goal::Home) return;
  if (goal() == Goal::Frontier) in_vain_ += dt;
  if (!situation.left_alone.overdrawn(*target(), choice_.cost(), dt, situation.robot())) return;
  if (goal() == Goal::Place) situation.search.give_up_subject(situation.floor, situation.robot());
  leave_target(situation.left_alone, situation.robot());
}

void Agenda::leave_target(LeftAlone& left_alone, const Anchor& robot) {
  // A place to search that comes back after a minute calls the robot back from the other end of the arena.
  if (goal() == Goal::Place && choice_.frontiers_done())
    left_alone.bar_for_good(*target(), robot);
  else
    left_alone.bar(*target(), robot, choice_.cost());
  choice_.drop_target();
  plan_soon();
}

/// A place that was seen on the way need not be driven to.
void Agenda::look_made(const Situation& situation) {
  if (goal() == Goal::Place && target() && situation.search.subject_seen(situation.floor)) plan_soon();
}

Order Agenda::stay_and_plan() {
  plan_soon();
  return {};
}

Rounds::Standing Agenda::standing(const Situation& situation) const {
  return {situation.now, situation.floor, situation.victims, [&] { return prospects_of(situation, true); },
          [&] { return prospects_of(situation, false); }};
}

/// Where walls have holes and no ground was gained for a while, walls that may be none wait for the faces as well.
bool Agenda::faces_go_first(const Situation& situation) const {
  return !choice_.thorough() && situation.search.on() && config_.bar_targets && situation.search.squarely() &&
         situation.now - gained_at_ > kBarrenWalls;
}

/// Frontiers that are worth another try; where things are `pushed` aside for it or, else, where what was felt alone
/// keeps the robot from them. Without a search of faces to go on to all are.
std::size_t Agenda::prospects_of(const Situation& situation, bool pushed) const {
  if (choice_.thorough() || !situation.search.on() || !config_.bar_targets) return frontier_left_;
  // Where all walls are looked at squarely the search takes more time than there is: second tries wait for it.
  if (in_vain_ > kBarren || situation.search.squarely()) return 0;
  const auto settled = [&](const TPoint2D& p) { return situation.left_alone.barred_for_good(p); };
  return prospects(pushed ? with_all_pushed(situation.floor, config_.felt.pallet, &grids_pushed_) : situation.floor,
                   situation.T_map_base, config_.planner.min_frontier_cells, settled);
}

}  // namespace rubble::explore
