#include "explore/explorer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/trajectory.h"
#include "explore/explorer_impl.h"

namespace rubble::explore {
namespace {

constexpr double kCreepTime = 3.0;               ///< [s]
constexpr double kCreepSpeed = 0.15;             ///< [m/s]
constexpr double kVisited = 0.30;                ///< closer to its target the robot has been there [m]
constexpr double kLookTurn = deg_to_rad(270.0);  ///< with a 240 deg scanner more than once around [rad]
constexpr double kTrailStep = 0.15;              ///< [m]
constexpr double kTrailRadius = 0.20;            ///< [m]
constexpr double kNearFrontier = 1.0;            ///< frontier this close at the start: turn to see it [m]
constexpr int kMaxPardons = 2;                   ///< times that barred targets are tried again before giving up
constexpr double kSearchReplan = 2.0;            ///< on the way to a viewpoint [s]
constexpr double kArrivedReplan = 0.3;           ///< standing at the end of the way [s]
constexpr double kCueAge = 1.2;                  ///< an unconfirmed cue younger than this is worth waiting for [s]
constexpr double kTurningRoom = 0.06;            ///< [m]

PlannerConfig planner_config(const ExplorerConfig& config) {
  PlannerConfig planner;
  planner.transform = {config.alpha, config.d_min, config.d_opt};
  planner.d_min_floor = std::min(config.d_min_floor, config.d_min);
  planner.min_frontier_cells = config.min_frontier_cells;
  planner.switch_cost = config.switch_cost;
  planner.clearance_cap = config.d_opt + 0.6;
  return planner;
}

FollowerConfig follower_config(const ExplorerConfig& config) {
  FollowerConfig follower;
  follower.cruise_speed = config.cruise_speed;
  follower.turn_speed = config.turn_speed;
  follower.turn_in_place = config.turn_in_place;
  follower.look_ahead = config.look_ahead;
  return follower;
}

}  // namespace

Explorer::Impl::Impl(const robot::RobotModel& robot_model, const ExplorerConfig& explorer_config)
    : model(robot_model),
      config(explorer_config),
      planner(planner_config(explorer_config)),
      follower(robot_model, follower_config(explorer_config)),
      search(explorer_config.victims),
      // The robot turns on the spot there, so its swing circle must be free, with room for stopping a little beside
      // it.
      floor_search(explorer_config.search, std::max(explorer_config.d_min, robot_model.swing_radius()) + kTurningRoom) {
}

/// Takes in what arrived in this tick.
void Explorer::Impl::observe(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  dt = now == Stamp::never() ? 0.0 : inputs.now - now;
  now = inputs.now;
  const TPose2D before = pose;
  pose = mapper.pose();
  turned = wrap_angle(pose.phi - before.phi);
  if (!inputs.scans.empty()) last_scan = now;
  if (!inputs.odometry.empty()) stalled = inputs.odometry.back().stalled;
  for (const robot::VictimCue& cue : inputs.cues)
    search.add(cue, pose_at(mapper.trajectory(), cue.stamp).value_or(pose));
  if (state != ExplorerState::Starting && (trail.empty() || distance(trail.back(), position(pose)) > kTrailStep))
    trail.push_back(position(pose));
}

Drive Explorer::Impl::decide(const slam::Mapper& mapper) {
  if (state == ExplorerState::Finished) return {};
  if (last_scan == Stamp::never() || now - last_scan > config.scan_timeout) return {};
  switch (state) {
    case ExplorerState::Starting:
      return start(mapper);
    case ExplorerState::BackingUp:
      return back_up();
    default:
      return drive(mapper);
  }
}

/// Waits for the first scan in the map; when frontier is close by, the scanner's blind sector is worth a turn.
Drive Explorer::Impl::start(const slam::Mapper& mapper) {
  if (mapper.counts().mapped == 0) return {};
  state = ExplorerState::Driving;
  home = position(pose);
  trail.push_back(home);
  const Traversable floor = floor_now(mapper, false);
  const std::vector<Cell> frontier = frontier_cells(floor);
  const auto near = std::count_if(frontier.begin(), frontier.end(),
                                  [&](Cell c) { return distance(floor.cells.centre(c), home) < kNearFrontier; });
  if (near >= config.min_frontier_cells && config.first_turn > 0.0) look_around(config.first_turn, true);
  return {};
}

Drive Explorer::Impl::drive(const slam::Mapper& mapper) {
  mark_searched();
  if (holding_still()) return {};
  if (watch.stuck(pose, commanded, stalled, dt)) {
    got_stuck();
    return {};
  }
  check_path(mapper);
  const bool to_target = target && (state == ExplorerState::Driving || state == ExplorerState::Searching);
  if (to_target && attempts.overdrawn(*target, target_cost, dt)) {
    if (state == ExplorerState::Searching) floor_search.give_up_subject(last_floor);
    bar_target(*target);
  }
  if (state == ExplorerState::Searching && follower.arrived() && !looking.active() && now - last_plan > kArrivedReplan)
    plan_forced = true;
  if (plan_forced || now >= next_plan) replan(mapper);
  if (state == ExplorerState::Finished) return {};
  if (looking.active()) return look();
  if (blocked && now >= creep_until) return {};
  Drive drive = follower.drive(pose);
  if (now < creep_until && std::abs(drive.v) > kCreepSpeed) {
    drive.w *= kCreepSpeed / drive.v;
    drive.v = kCreepSpeed;
  }
  return drive;
}

Traversable Explorer::Impl::floor_now(const slam::Mapper& mapper, bool with_hits) const {
  Traversable floor = traversable(mapper.map(), config.occupied_threshold);
  free_body(floor, pose, model.length, model.width, 0.0);
  free_trail(floor, trail, kTrailRadius);
  if (with_hits) add_obstacles(floor, remembered_hits, 0.15);
  measure_clearance(floor, planner.clearance_cap());
  return floor;
}

Plan Explorer::Impl::plan_on(const Traversable& floor) {
  if (state == ExplorerState::GoingHome) return planner.to_point(floor, pose, home, 0.15);
  if (state == ExplorerState::Searching) return plan_search(floor);
  return planner.to_frontier(
      floor, pose, [this](const TPoint2D& p) { return blacklist.barred(p, now); }, target);
}

void Explorer::Impl::replan(const slam::Mapper& mapper) {
  if (!plan_forced && mapper.map().version() == planned_version) return;
  const bool new_map = mapper.map().version() != planned_version;
  plan_forced = false;
  planned_version = mapper.map().version();
  last_plan = now;
  next_plan = now + (state == ExplorerState::Searching ? kSearchReplan : config.replan_period);
  if (now >= forget_hits) remembered_hits.clear();

  last_floor = floor_now(mapper, !remembered_hits.empty());
  Plan plan = plan_on(last_floor);
  if (!plan.found && !remembered_hits.empty()) {
    // The map shows a way, the newest scans do not: go and see, slowly.
    last_floor = floor_now(mapper, false);
    plan = plan_on(last_floor);
    if (plan.found) creep_until = now + kCreepTime;
  }
  frontier_left = plan.frontier_left;
  if (plan.found) {
    accept(std::move(plan));
  } else {
    follower.clear();
    target.reset();
    if (new_map) ++failed_plans;
    nothing_left();
  }
  show_path();
}

void Explorer::Impl::accept(Plan plan) {
  failed_plans = 0;
  looks_in_vain = 0;
  const bool near = distance(plan.target, position(pose)) < kVisited;
  if (state == ExplorerState::GoingHome) {
    if (distance(home, position(pose)) < kVisited) return finish("home again");
  } else if (state == ExplorerState::Searching) {
    if (distance(plan.target, position(pose)) < kAtViewpoint) return face_subject();
  } else if (near) {
    return visited_in_vain(plan.target);
  }
  if (looking.active() && !looking.to_the_end) looking = {};
  if (!target || distance(*target, plan.target) > 0.5) target_cost = plan.cost;
  target = plan.target;
  path_d_min = plan.d_min;
  blocked = false;
  follower.set_path(std::move(plan.path));
}

/// The robot stands at a frontier that does not go away: look around, then bar it.
void Explorer::Impl::visited_in_vain(const TPoint2D& where) {
  follower.clear();
  if (looking.active()) return;
  if (!looked_from || distance(*looked_from, position(pose)) > kVisited) {
    looked_from = position(pose);
    return look_around(kLookTurn, false);
  }
  blacklist.bar_for_good(where, kBarRadius);
  target.reset();
  plan_forced = true;
}

/// No frontier can be reached: look around once more, try again what failed before, then finish.
void Explorer::Impl::nothing_left() {
  if (looking.active()) return;
  if (state == ExplorerState::GoingHome) return finish("no way home is left");
  if (state == ExplorerState::Searching) return finish_searching();
  if (looks_in_vain == 0 || (failed_plans < 2 && looks_in_vain < 2)) {
    ++looks_in_vain;
    return look_around(kLookTurn, false);
  }
  if (pardons < kMaxPardons && blacklist.pardon(now)) {
    ++pardons;
    plan_forced = true;
    return;
  }
  finish_exploring();
}

void Explorer::Impl::finish_exploring() {
  std::string why = "nothing reachable left to explore";
  if (frontier_left == 1) why += " (1 frontier cannot be reached)";
  if (frontier_left > 1) why += " (" + std::to_string(frontier_left) + " frontiers cannot be reached)";
  reason = why;
  plan_forced = true;
  if (floor_search.on()) {
    state = ExplorerState::Searching;
    return;
  }
  finish_searching();
}

void Explorer::Impl::finish_searching() {
  if (!config.return_home) return finish(state == ExplorerState::Searching ? "all visible floor searched" : "");
  state = ExplorerState::GoingHome;
  plan_forced = true;
}

/// Records what the victim sensors see; a place seen on the way need not be driven to.
void Explorer::Impl::mark_searched() {
  const bool looked = floor_search.look(last_floor, pose, turned / std::max(dt, 1e-9), now);
  if (looked && state == ExplorerState::Searching && target && floor_search.subject_seen(last_floor))
    plan_forced = true;
}

bool Explorer::Impl::holding_still() {
  if (floor_search.staring(search.undecided(now, kCueAge), now)) return true;
  if (floor_search.dwelling(last_floor, pose, now)) return true;
  plan_forced = plan_forced || floor_search.dwell_over();
  return false;
}

Plan Explorer::Impl::plan_search(const Traversable& floor) {
  const auto head_start = [&](const TPoint2D& p) -> std::optional<double> {
    if (blacklist.barred(p, now)) return std::nullopt;
    return target && distance(p, *target) > 0.5 ? config.switch_cost : 0.0;
  };
  Plan plan = planner.to_cells(floor, pose, floor_search.sources(floor, head_start));
  if (plan.found) floor_search.choose_subject(floor.cells.cell(plan.target));
  return plan;
}

/// At a viewpoint.
void Explorer::Impl::face_subject() {
  follower.clear();
  if (looking.active()) return;
  if (const std::optional<double> turn = floor_search.turn_to_subject(last_floor, pose))
    return look_around(*turn, true);
  floor_search.start_dwell(now);
}

void Explorer::Impl::finish(const std::string& why) {
  reason += (reason.empty() || why.empty() ? "" : ", ") + why;
  state = ExplorerState::Finished;
  follower.clear();
  looking = {};
  show_path();
}

void Explorer::Impl::show_path() {
  shown_path.clear();
  for (const PathPoint& point : follower.path()) shown_path.push_back(point.p_map);
}

Explorer::Explorer(const robot::RobotModel& model, const ExplorerConfig& config)
    : impl_(std::make_unique<Impl>(model, config)) {}

Explorer::~Explorer() = default;

robot::Commands Explorer::next(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  impl_->observe(mapper, inputs);
  impl_->commanded = impl_->decide(mapper);
  return {impl_->commanded, {}};
}

bool Explorer::finished() const { return impl_->state == ExplorerState::Finished; }
const std::string& Explorer::reason() const { return impl_->reason; }
ExplorerState Explorer::state() const { return impl_->state; }
const std::vector<TPoint2D>& Explorer::path() const { return impl_->shown_path; }
const std::vector<VictimReport>& Explorer::victims() const { return impl_->search.reports(); }

}  // namespace rubble::explore
