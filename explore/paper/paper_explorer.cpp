#include "explore/paper/paper_explorer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/trajectory.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kVisited = 0.30;                ///< closer to its target the robot has been there [m]
constexpr double kLookTurn = deg_to_rad(270.0);  ///< with a 240 deg scanner more than once around [rad]
constexpr double kTrailStep = 0.15;              ///< [m]
constexpr double kSameThing = 0.15;              ///< a hit this close to a wall of the map is that wall [m]
constexpr double kTrailRadius = 0.20;            ///< [m]
constexpr double kNearFrontier = 1.0;            ///< frontier this close at the start: turn to see it [m]
constexpr int kMaxPardons = 3;                   ///< times that barred targets are tried again before giving up
constexpr double kSearchReplan = 2.0;            ///< on the way to a viewpoint [s]
constexpr double kOdometryLate = 0.25;           ///< the wheels are silent [s]
constexpr double kArrivedReplan = 0.3;           ///< standing at the end of the way [s]
constexpr double kCueAge = 1.2;                  ///< an unconfirmed cue younger than this is worth waiting for [s]
constexpr double kDetour = 3.0;                  ///< way over distance where no way is known
constexpr double kWorthARound = 1.0;             ///< newly known floor that makes one more round worth while [m^2]
constexpr int kBarrenRounds = 2;                 ///< rounds in a row that gain nothing end the mission
constexpr double kBesideTheWay = 1.0;  ///< a niche that costs no more is looked into while frontiers are left [m]
constexpr double kDetourCost = 2.0;    ///< a frontier may cost so much more than the next viewpoint [m]
constexpr double kHomeTolerances[] = {0.15, 0.4, 0.8};  ///< [m]
constexpr double kSameTarget = 0.5;                     ///< [m]
constexpr double kLongerWay = 2.0;                      ///< [m]
constexpr double kSmallShift = 0.10;                    ///< of the robot's place by a correction of the map [m]
constexpr double kTurningRoom = 0.06;                   ///< [m]
constexpr double kLongestTick = 0.2;                    ///< commands of longer ticks are taken to have ended [s]
constexpr double kHeld = 0.5;                           ///< a tick so long: the robot was held, a device was away [s]
constexpr double kPatience = 2.0;                       ///< then its motors may still be off for a while [s]
constexpr double kCornerRoom = 0.08;                    ///< beside corners that turn [m]
constexpr double kLittleRoom = 0.01;                    ///< [m]
constexpr double kPaper = 0.5;                          ///< what stands alone and is not wider may be paper [m]
constexpr double kHeap = 1.1;                ///< several balls side by side; a panel of wall is 1.2 m wide [m]
constexpr int kSmoothFloor = 3;              ///< things felt so far where the robot may be fast
constexpr std::size_t kWorthForgetting = 3;  ///< frontiers
constexpr int kForgets = 4;                  ///< times that all that was felt is forgotten for the sake of new ground
constexpr int kHomeTries = 6;                ///< times that all that was felt is forgotten on the way home

std::string text(const TPoint2D& p) {
  std::array<char, 40> line{};
  std::snprintf(line.data(), line.size(), "(%.1f, %.1f)", p.x, p.y);
  return line.data();
}

std::string target_text(ExplorerState state, bool niches, const Plan& plan, double usual_d_min) {
  const char* what = state == ExplorerState::GoingHome   ? "home"
                     : state != ExplorerState::Searching ? "the frontier"
                     : niches                            ? "a place to look into a niche from"
                                                         : "a place to search from";
  std::array<char, 60> more{};
  std::snprintf(more.data(), more.size(), ", cost %.1f m", plan.cost);
  const std::string line = std::string("drives to ") + what + " at " + text(plan.target) + more.data();
  if (plan.d_min >= usual_d_min) return line;
  std::snprintf(more.data(), more.size(), ", as near as %.2f m to walls", plan.d_min);
  return line + more.data();
}

std::size_t known_cells(const Traversable& floor) {
  std::size_t known = 0;
  for (int y = 0; y < floor.cells.height(); ++y)
    known += static_cast<std::size_t>(std::count_if(floor.cells.row(y), floor.cells.row(y) + floor.cells.width(),
                                                    [](Occupancy o) { return o != Occupancy::Unknown; }));
  return known;
}

double way_of(const Plan& plan) {
  double way = 0.0;
  for (std::size_t i = 1; i < plan.path.size(); ++i) way += distance(plan.path[i - 1].p_map, plan.path[i].p_map);
  return way;
}

double way_of(const std::vector<TPoint2D>& points) {
  double way = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) way += distance(points[i - 1], points[i]);
  return way;
}

}  // namespace

PaperExplorer::PaperExplorer(const robot::RobotModel& model, const PaperExplorerConfig& config, const Mission& mission)
    : model_(model),
      config_(config),
      planner_(config.planner),
      follower_(model, config.follower),
      search_(config.victims),
      // The robot turns on the spot there, so its swing circle must be free, with room for stopping a little beside
      // it.
      floor_search_(config.search, std::max(config.planner.transform.d_min, model.swing_radius()) + kTurningRoom,
                    model.swing_radius() + kLittleRoom),
      path_watch_(model),
      looking_(model, config.follower.turn_speed),
      pivot_(model.swing_radius() + kCornerRoom),
      tilt_(config.tilt),
      felt_(config.felt),
      escape_(config.follower.turn_speed),
      home_way_(mission.time_limit) {}

robot::Commands PaperExplorer::next(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  observe(mapper, inputs);
  brakes_ = false;
  commanded_ = decide(mapper);
  return {commanded_, {}, brakes_};
}

/// Takes in what arrived in this tick.
void PaperExplorer::observe(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  const double passed = now_ == Stamp::never() ? 0.0 : inputs.now - now_;
  dt_ = std::min(passed, kLongestTick);
  now_ = inputs.now;
  if (passed > kHeld) {
    watch_.reset();
    patient_until_ = now_ + kPatience;
  }
  const TPose2D before = pose_;
  pose_ = mapper.pose();
  turned_ = wrap_angle(pose_.phi - before.phi);
  doubt_.update(pose_, mapper.covariance(), passed);
  if (mapper.revision() != revision_) follow_map(mapper);
  if (!inputs.scans.empty()) last_scan_ = now_;
  if (!inputs.odometry.empty()) {
    stalled_ = inputs.odometry.back().stalled;
    odometry_at_ = now_;
  }
  tilt_.update(inputs, dt_);
  jolt_.update(inputs);
  for (const robot::VictimCue& cue : inputs.cues) hear(mapper, cue);
  // What holds it up on the way will hold it up on the way home as well; what it moves to get free is no way.
  const bool free = state_ == ExplorerState::Driving || state_ == ExplorerState::GoingHome;
  home_way_.moved(free ? distance(position(before), position(pose_)) : 0.0, dt_,
                  free || state_ == ExplorerState::BackingUp);
  way_back_.add(now_, pose_);
  if (state_ == ExplorerState::Starting || state_ == ExplorerState::BackingUp) return;
  felt_.passed(pose_, model_);
  if (!trail_.empty() && distance(trail_.back(), position(pose_)) <= kTrailStep) return;
  trail_anchors_.push_back({now_, pose_});
  trail_.push_back(position(pose_));
  passed_.add(trail_.back());
}

/// A cue seen while the pose is unsure would put a victim where none is.
void PaperExplorer::hear(const slam::Mapper& mapper, const robot::VictimCue& cue) {
  if (doubt_.unsure()) return;
  const Anchor anchor{cue.stamp, mapper.pose_at(cue.stamp).value_or(pose_)};
  const auto same_side = [this](const TPoint2D& a, const TPoint2D& b) {
    const Cell from = last_floor_.cells.cell(a);
    const Cell to = last_floor_.cells.cell(b);
    if (!last_floor_.cells.inside(from) || !last_floor_.cells.inside(to)) return true;
    return in_sight(last_floor_, from, to);
  };
  const std::size_t before = search_.reports().size();
  search_.add(cue, anchor, same_side);
  if (search_.reports().size() > before) note("victim " + std::to_string(search_.reports().back().id) + " confirmed");
}

/// The mapper moved poses of the past: all that is kept moves with them, and the way is planned anew. The target stays
/// when the robot's own place hardly moved.
void PaperExplorer::follow_map(const slam::Mapper& mapper) {
  revision_ = mapper.revision();
  home_.follow(mapper);
  const TPoint2D last = trail_.empty() ? TPoint2D() : trail_.back();
  way_back_.follow(mapper);
  passed_.clear();
  for (std::size_t i = 0; i < trail_.size(); ++i) {
    trail_anchors_[i].follow(mapper);
    trail_[i] = position(trail_anchors_[i].T_map_base);
    passed_.add(trail_[i]);
  }
  felt_.follow(mapper);
  search_.follow(mapper);
  if (floor_search_.follow(mapper)) {
    last_floor_ = floor_now(mapper, {});
    floor_search_.look_again(last_floor_);
  }
  if (trail_.empty() || distance(trail_.back(), last) > kSmallShift) target_.reset();
  plan_forced_ = true;
}

void PaperExplorer::note(const std::string& why) {
  if (decisions_.empty() || decisions_.back().why != why) decisions_.push_back({now_, why});
}

Drive PaperExplorer::decide(const slam::Mapper& mapper) {
  if (state_ == ExplorerState::Finished) return {};
  if (last_scan_ == Stamp::never() || now_ - last_scan_ > config_.scan_timeout) return {};
  switch (state_) {
    case ExplorerState::Starting:
      return start(mapper);
    case ExplorerState::BackingUp:
      return escape();
    default:
      return drive(mapper);
  }
}

/// Waits for the first scan in the map; when frontier is close by, the scanner's blind sector is worth a turn.
Drive PaperExplorer::start(const slam::Mapper& mapper) {
  if (mapper.counts().mapped == 0) return {};
  state_ = ExplorerState::Driving;
  home_ = {now_, pose_};
  const TPoint2D here = position(pose_);
  const Traversable floor = floor_now(mapper, {});
  const std::vector<Cell> frontier = frontier_cells(floor);
  const auto near = std::count_if(frontier.begin(), frontier.end(),
                                  [&](Cell c) { return distance(floor.cells.centre(c), here) < kNearFrontier; });
  const Cell own = floor.clearance.cell(here);
  const bool room = floor.clearance.inside(own) && floor.clearance[own] >= model_.swing_radius();
  if (room && near >= config_.planner.min_frontier_cells && config_.first_turn > 0.0)
    look_around(config_.first_turn, true);
  return {};
}

Drive PaperExplorer::drive(const slam::Mapper& mapper) {
  mark_searched();
  if (holding_still()) {
    watch_.reset();
    return {};
  }
  if (looking_.active() || state_ == ExplorerState::Searching) watch_.turns_on_purpose();
  const bool patient = now_ < patient_until_;
  // Nobody knows whether a base that is silent moves: a pulled plug is no obstacle.
  if (odometry_at_ && now_ - *odometry_at_ > kOdometryLate) watch_.reset();
  const bool held = watch_.stuck(pose_, patient ? Drive{} : commanded_, stalled_, dt_);
  if (tilt_.too_steep() || jolt_.struck() || held) {
    got_stuck(tilt_.too_steep() ? "it leans too much here"
              : jolt_.struck()  ? "a blow stops it"
              : stalled_        ? "the motors stall"
                                : "it does not move");
    return {};
  }
  check_path(mapper);
  const bool to_target = target_ && (state_ == ExplorerState::Driving || state_ == ExplorerState::Searching);
  if (to_target && attempts_.overdrawn(*target_, target_cost_, dt_)) {
    if (state_ == ExplorerState::Searching) floor_search_.give_up_subject(last_floor_, {now_, pose_});
    bar_target(*target_);
  }
  // A mapper need not change its map where a robot stands on known ground.
  if (follower_.arrived() && !looking_.active() && now_ - last_plan_ > kArrivedReplan) plan_forced_ = true;
  if (must_turn_back()) go_home("the time left is for the way home");
  if (plan_forced_ || now_ >= next_plan_) replan(mapper);
  if (state_ == ExplorerState::Finished) return {};
  if (looking_.active()) {
    const std::optional<Drive> turn = looking_.turn(turned_, now_);
    plan_forced_ = plan_forced_ || !turn;
    // A turn in a tight place wanders off its viewpoint; driving back to it and turning again would never end.
    if (!turn && facing_) floor_search_.start_dwell_as_turned(now_);
    return pivot_.keep(turn.value_or(Drive{}), pose_, last_floor_);
  }
  if (path_watch_.waits(now_)) return {};
  return path_watch_.limited(pivot_.keep(follower_.drive(pose_), pose_, last_floor_), now_);
}

Traversable PaperExplorer::floor_now(const slam::Mapper& mapper, const std::vector<TPoint2D>& hits) const {
  Traversable floor = traversable(mapper.map(), config_.occupied_threshold);
  if (pushed_aside_ > 0.0) free_small_things(floor, pushed_aside_);
  free_body(floor, pose_, model_.length, model_.width, 0.0);
  free_trail(floor, trail_, kTrailRadius);
  add_obstacles(floor, hits, kSameThing);
  add_obstacles(floor, felt_.points(now_), kSameThing);
  measure_clearance(floor, planner_.clearance_cap());
  return floor;
}

Plan PaperExplorer::plan_on(const Traversable& floor) {
  if (state_ == ExplorerState::GoingHome) return plan_home(floor);
  const auto to_frontier = [&](const std::optional<TPoint2D>& previous) {
    return planner_.to_frontier(
        floor, pose_, [this](const TPoint2D& p) { return config_.bar_targets && blacklist_.barred(p, now_); },
        previous);
  };
  const bool driving = state_ == ExplorerState::Driving;
  if (driving && (frontiers_done_ || !floor_search_.on())) return to_frontier(target_);
  Plan frontier = to_frontier(driving ? target_ : std::nullopt);
  Plan search = plan_search(floor, Subjects::Niches);
  if (frontiers_done_ && !search.found) {
    // New ground is worth more than the faces that are left, none of which is the back of a niche.
    if (frontier.frontier_left > 0 && !tried_before_search_ && pardon()) {
      tried_before_search_ = true;
      explore_again();
      note("no niche is left: what could not be reached is tried again before the rest is searched");
      return to_frontier(std::nullopt);
    }
    // The search takes all the time that is left in a large arena: one try comes before it.
    if (frontier.frontier_left >= kWorthForgetting && forgets_ == 0 && forget_what_was_felt())
      return to_frontier(std::nullopt);
    search = plan_search(floor, Subjects::All);
  }
  if (!frontiers_done_) {
    // What lies in a niche beside the way is looked at now: coming back for it costs more.
    const double most = std::min(frontier.cost, kBesideTheWay) + (driving ? 0.0 : kDetourCost);
    const bool look = search.found && frontier.found && search.cost <= most;
    state_ = look ? ExplorerState::Searching : ExplorerState::Driving;
    if (!look) return frontier;
    search.frontier_left = frontier.frontier_left;
    return search;
  }
  search.frontier_left = frontier.frontier_left;
  if (!frontier.found || (search.found && frontier.cost > search.cost + kDetourCost)) return search;
  note("a frontier has come into reach");
  state_ = ExplorerState::Driving;
  return frontier;
}

/// To the start, or as near to it as can be reached.
Plan PaperExplorer::plan_home(const Traversable& floor) {
  Plan plan;
  for (const double tolerance : kHomeTolerances) {
    plan = planner_.to_point(floor, pose_, position(home_.T_map_base), tolerance);
    if (plan.found) break;
  }
  return plan;
}

void PaperExplorer::replan(const slam::Mapper& mapper) {
  if (!plan_forced_ && mapper.map().version() == planned_version_) return;
  const bool new_map = mapper.map().version() != planned_version_;
  plan_forced_ = false;
  planned_version_ = mapper.map().version();
  last_plan_ = now_;
  next_plan_ = now_ + (state_ == ExplorerState::Searching ? kSearchReplan : config_.replan_period);

  const std::vector<TPoint2D>& new_things = path_watch_.obstacles(now_);
  last_floor_ = floor_now(mapper, new_things);
  Plan plan = plan_on(last_floor_);
  if (!plan.found && !new_things.empty()) {
    // The map shows a way, the newest scans do not: go and see, slowly.
    last_floor_ = floor_now(mapper, {});
    plan = plan_on(last_floor_);
    if (plan.found) path_watch_.creep(now_);
  }
  frontier_left_ = plan.frontier_left;
  // It would turn round again once the new thing is forgotten, and again when it is seen anew.
  const bool turned_away =
      plan.found && target_ && !new_things.empty() && distance(*target_, plan.target) > kSameTarget;
  if (turned_away && state_ != ExplorerState::GoingHome && keeps_away(*target_)) {
    note("something new stands in the way");
    bar_target(*target_);
  }
  if (plan.found) {
    accept(std::move(plan));
  } else {
    follower_.clear();
    target_.reset();
    if (new_map) ++failed_plans_;
    nothing_left();
  }
  show_path();
}

/// Whether the floor as seen now makes the way to where the robot was driving longer than a detour, or impossible.
bool PaperExplorer::keeps_away(const TPoint2D& target) {
  const Plan way = planner_.to_point(last_floor_, pose_, target, kSameTarget);
  return !way.found || way_of(way) > follower_.left() + kLongerWay;
}

void PaperExplorer::accept(Plan plan) {
  failed_plans_ = 0;
  looks_in_vain_ = 0;
  const bool near = distance(plan.target, position(pose_)) < kVisited;
  if (state_ == ExplorerState::GoingHome) {
    if (near) return finish(MissionEnd::Home, "home again");
  } else if (state_ == ExplorerState::Searching) {
    if (distance(plan.target, position(pose_)) < kAtViewpoint) return face_subject();
  } else if (near) {
    return visited_in_vain(plan.target);
  }
  if (looking_.active() && !looking_.to_the_end()) looking_.end();
  if (!target_ || distance(*target_, plan.target) > kSameTarget) {
    target_cost_ = plan.cost;
    note(target_text(state_, !frontiers_done_, plan, config_.planner.transform.d_min));
  }
  target_ = plan.target;
  path_d_min_ = plan.d_min;
  path_watch_.unblock();
  // Where several things were felt the floor has more of them than the trail's width tells.
  if (times_stuck_ <= kSmoothFloor)
    for (PathPoint& point : plan.path) point.passed = passed_.holds(point.p_map);
  follower_.set_path(std::move(plan.path));
}

/// The robot stands at a frontier that does not go away: look around, then bar it.
void PaperExplorer::visited_in_vain(const TPoint2D& where) {
  follower_.clear();
  if (looking_.active()) return;
  if (!looked_from_ || distance(*looked_from_, position(pose_)) > kVisited) {
    looked_from_ = position(pose_);
    return look_around(kLookTurn, false);
  }
  note("the frontier at " + text(where) + " stays although it was visited: left alone");
  blacklist_.bar_for_good(where, kBarRadius);
  target_.reset();
  plan_forced_ = true;
}

/// No frontier can be reached: look around once more, try again what failed before, then finish.
void PaperExplorer::nothing_left() {
  if (looking_.active()) return;
  if (state_ == ExplorerState::Searching) return may_push() ? start_pushing() : finish_searching();
  if (state_ == ExplorerState::Driving && frontiers_done_) return may_push() ? start_pushing() : finish_exploring();
  if (looks_in_vain_ == 0 || (failed_plans_ < 2 && looks_in_vain_ < 2)) {
    ++looks_in_vain_;
    return look_around(kLookTurn, false);
  }
  if (pardons_ < kMaxPardons) {
    const bool barred = blacklist_.pardon(now_), felt = felt_.pardon(now_);
    if (barred || felt) {
      ++pardons_;
      note("nothing else can be reached: what failed before is tried again");
      plan_forced_ = true;
      return;
    }
  }
  if (may_push()) return start_pushing();
  if (state_ == ExplorerState::GoingHome) {
    if (home_tries_ >= kHomeTries || !felt_.forget(now_)) return finish(MissionEnd::Explored, "no way home is left");
    ++home_tries_;
    note("no way home: all that was felt is forgotten");
    plan_forced_ = true;
    return;
  }
  finish_exploring();
}

/// Things in the way that were not seen yet when things were pushed aside last: once for each piece of ground gained.
bool PaperExplorer::may_push() const {
  if (pushed_aside_ >= kHeap) return false;
  if (state_ == ExplorerState::GoingHome) return true;
  // It came here by pushing, or something rolled into its way: the rest of the arena is to be searched as well.
  if (state_ == ExplorerState::Searching) return floor_search_.place_left();
  if (pushed_aside_ > 0.0) return frontier_left_ > 0;
  return frontier_left_ > 0 && (known_when_pushing_ == 0 || ground_gained_since(known_when_pushing_) >= kWorthARound);
}

void PaperExplorer::start_pushing() {
  const bool single = pushed_aside_ == 0.0;
  pushed_aside_ = single ? kPaper : kHeap;
  if (single) known_when_pushing_ = known_cells(last_floor_);
  note(std::string("nothing else can be reached: ") + (single ? "small things" : "heaps") +
       " that stand alone are pushed aside");
  plan_forced_ = true;
}

/// [m^2]
double PaperExplorer::ground_gained_since(std::size_t known_then) const {
  const std::size_t known = known_cells(last_floor_);
  const double cell = last_floor_.frame().resolution;
  return known > known_then ? static_cast<double>(known - known_then) * cell * cell : 0.0;
}

void PaperExplorer::finish_exploring() {
  std::string why = "nothing reachable left to explore";
  if (frontier_left_ == 1) why += " (1 frontier cannot be reached)";
  if (frontier_left_ > 1) why += " (" + std::to_string(frontier_left_) + " frontiers cannot be reached)";
  reason_ = why;
  if (!frontiers_done_) note(why);
  frontiers_done_ = true;
  pushed_aside_ = 0.0;
  plan_forced_ = true;
  if (floor_search_.on()) {
    state_ = ExplorerState::Searching;
    return;
  }
  finish_searching();
}

/// What could not be reached or seen may be had from another side, or when the map has changed: as long as that gains
/// something and time is left, all of it is tried once more.
bool PaperExplorer::another_round() {
  const bool barren = ground_gained_since(known_then_) < kWorthARound && search_.reports().size() <= victims_then_;
  barren_rounds_ = barren ? barren_rounds_ + 1 : 0;
  known_then_ = known_cells(last_floor_);
  victims_then_ = search_.reports().size();
  if (barren_rounds_ >= kBarrenRounds) return forget_what_was_felt();
  const bool given_up = floor_search_.reconsider(last_floor_);
  if (!pardon() && !given_up) return forget_what_was_felt();
  note("round " + std::to_string(++rounds_) + ": what could not be reached or seen is tried again");
  tried_before_search_ = false;
  explore_again();
  return true;
}

/// What was felt may bar the only way to half of the arena, and be wrong: where there is ground to be seen behind it,
/// even what was felt for certain is tried anew, a few times in a mission.
bool PaperExplorer::forget_what_was_felt() {
  if (frontier_left_ == 0 || forgets_ >= kForgets || !felt_.forget(now_)) return false;
  ++forgets_;
  barren_rounds_ = 0;
  floor_search_.reconsider(last_floor_);
  pardon();
  note("round " + std::to_string(++rounds_) + ": all that was felt is forgotten");
  tried_before_search_ = false;
  explore_again();
  return true;
}

/// Forgives what was barred or felt; says whether there was any.
bool PaperExplorer::pardon() {
  const bool barred = blacklist_.pardon_all(now_);
  const bool felt = felt_.pardon(now_);
  return barred || felt;
}

void PaperExplorer::explore_again() {
  state_ = ExplorerState::Driving;
  frontiers_done_ = false;
  known_when_pushing_ = 0;
  failed_plans_ = looks_in_vain_ = 0;
  pardons_ = std::min(pardons_, kMaxPardons - 1);
  looked_from_.reset();
  plan_forced_ = true;
}

void PaperExplorer::finish_searching() {
  if (another_round()) return;
  const std::string why = state_ == ExplorerState::Searching ? "all visible floor searched" : "";
  if (!config_.return_home) return finish(MissionEnd::Explored, why);
  go_home(why);
}

void PaperExplorer::go_home(const std::string& why) {
  reason_ += (reason_.empty() || why.empty() ? "" : ", ") + why;
  note("drives home: " + (why.empty() ? reason_ : why));
  state_ = ExplorerState::GoingHome;
  pardons_ = std::min(pardons_, kMaxPardons - 1);  // one more for the way home
  looks_in_vain_ = 1;                              // no looking round first
  target_.reset();
  looking_.end();
  plan_forced_ = true;
}

/// Measures the way home from time to time.
bool PaperExplorer::must_turn_back() {
  if (!config_.return_home || state_ == ExplorerState::GoingHome || !home_way_.due(now_)) return false;
  const Plan way = plan_home(last_floor_);
  if (way.found) return home_way_.must_turn_back(way_of(way), now_);
  // Blocked at the moment: a detour, but hardly longer than all the way it came.
  const double straight = distance(position(home_.T_map_base), position(pose_));
  return home_way_.must_turn_back(std::min(way_of(trail_), kDetour * straight), now_);
}

/// Records what the victim sensors see; a place seen on the way need not be driven to.
void PaperExplorer::mark_searched() {
  if (doubt_.unsure()) return;
  const bool looked = floor_search_.look(last_floor_, pose_, turned_ / std::max(dt_, 1e-9), now_);
  if (looked && state_ == ExplorerState::Searching && target_ && floor_search_.subject_seen(last_floor_))
    plan_forced_ = true;
}

bool PaperExplorer::holding_still() {
  if (floor_search_.staring(search_.undecided(now_, kCueAge), now_)) return true;
  if (floor_search_.dwelling(last_floor_, pose_, now_)) return true;
  plan_forced_ = plan_forced_ || floor_search_.dwell_over();
  return false;
}

Plan PaperExplorer::plan_search(const Traversable& floor, Subjects subjects) {
  const auto head_start = [&](const TPoint2D& p) -> std::optional<double> {
    if (blacklist_.barred(p, now_)) return std::nullopt;
    return target_ && distance(p, *target_) > 0.5 ? config_.planner.switch_cost : 0.0;
  };
  Plan plan = planner_.to_cells(floor, pose_, floor_search_.sources(floor, subjects, head_start));
  if (plan.found) floor_search_.choose_subject(floor.cells.cell(plan.target));
  return plan;
}

/// At a viewpoint.
void PaperExplorer::face_subject() {
  follower_.clear();
  pushed_aside_ = 0.0;
  if (looking_.active()) return;
  if (const std::optional<double> turn = floor_search_.turn_to_subject(last_floor_, pose_)) {
    look_around(*turn, true);
    facing_ = true;
    return;
  }
  floor_search_.start_dwell(now_);
}

void PaperExplorer::finish(MissionEnd end, const std::string& why) {
  end_ = end;
  reason_ += (reason_.empty() || why.empty() ? "" : ", ") + why;
  note("ends: " + reason_);
  state_ = ExplorerState::Finished;
  follower_.clear();
  looking_.end();
  show_path();
}

void PaperExplorer::show_path() {
  shown_path_.clear();
  for (const PathPoint& point : follower_.path()) shown_path_.push_back(point.p_map);
}

}  // namespace rubble::explore
