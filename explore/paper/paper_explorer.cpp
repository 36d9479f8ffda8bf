#include "explore/paper/paper_explorer.h"

#include <algorithm>
#include <cmath>
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
constexpr int kMaxPardons = 2;                   ///< times that barred targets are tried again before giving up
constexpr double kSearchReplan = 2.0;            ///< on the way to a viewpoint [s]
constexpr double kArrivedReplan = 0.3;           ///< standing at the end of the way [s]
constexpr double kCueAge = 1.2;                  ///< an unconfirmed cue younger than this is worth waiting for [s]
constexpr double kTurningRoom = 0.06;            ///< [m]

TPoint2D position(const mrpt::math::TPose2D& pose) { return {pose.x, pose.y}; }

}  // namespace

PaperExplorer::PaperExplorer(const robot::RobotModel& model, const PaperExplorerConfig& config)
    : model_(model),
      config_(config),
      planner_(config.planner),
      follower_(model, config.follower),
      search_(config.victims),
      // The robot turns on the spot there, so its swing circle must be free, with room for stopping a little beside
      // it.
      floor_search_(config.search, std::max(config.planner.transform.d_min, model.swing_radius()) + kTurningRoom),
      path_watch_(model),
      looking_(model, config.follower.turn_speed) {}

robot::Commands PaperExplorer::next(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  observe(mapper, inputs);
  commanded_ = decide(mapper);
  return {commanded_, {}};
}

/// Takes in what arrived in this tick.
void PaperExplorer::observe(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  dt_ = now_ == Stamp::never() ? 0.0 : inputs.now - now_;
  now_ = inputs.now;
  const TPose2D before = pose_;
  pose_ = mapper.pose();
  turned_ = wrap_angle(pose_.phi - before.phi);
  if (!inputs.scans.empty()) last_scan_ = now_;
  if (!inputs.odometry.empty()) stalled_ = inputs.odometry.back().stalled;
  for (const robot::VictimCue& cue : inputs.cues)
    search_.add(cue, pose_at(mapper.trajectory(), cue.stamp).value_or(pose_));
  if (state_ != ExplorerState::Starting && (trail_.empty() || distance(trail_.back(), position(pose_)) > kTrailStep))
    trail_.push_back(position(pose_));
}

Drive PaperExplorer::decide(const slam::Mapper& mapper) {
  if (state_ == ExplorerState::Finished) return {};
  if (last_scan_ == Stamp::never() || now_ - last_scan_ > config_.scan_timeout) return {};
  switch (state_) {
    case ExplorerState::Starting:
      return start(mapper);
    case ExplorerState::BackingUp:
      return back_up();
    default:
      return drive(mapper);
  }
}

/// Waits for the first scan in the map; when frontier is close by, the scanner's blind sector is worth a turn.
Drive PaperExplorer::start(const slam::Mapper& mapper) {
  if (mapper.counts().mapped == 0) return {};
  state_ = ExplorerState::Driving;
  home_ = position(pose_);
  trail_.push_back(home_);
  const Traversable floor = floor_now(mapper, {});
  const std::vector<Cell> frontier = frontier_cells(floor);
  const auto near = std::count_if(frontier.begin(), frontier.end(),
                                  [&](Cell c) { return distance(floor.cells.centre(c), home_) < kNearFrontier; });
  if (near >= config_.planner.min_frontier_cells && config_.first_turn > 0.0) look_around(config_.first_turn, true);
  return {};
}

Drive PaperExplorer::drive(const slam::Mapper& mapper) {
  mark_searched();
  if (holding_still()) return {};
  if (watch_.stuck(pose_, commanded_, stalled_, dt_)) {
    got_stuck();
    return {};
  }
  check_path(mapper);
  const bool to_target = target_ && (state_ == ExplorerState::Driving || state_ == ExplorerState::Searching);
  if (to_target && attempts_.overdrawn(*target_, target_cost_, dt_)) {
    if (state_ == ExplorerState::Searching) floor_search_.give_up_subject(last_floor_);
    bar_target(*target_);
  }
  if (state_ == ExplorerState::Searching && follower_.arrived() && !looking_.active() &&
      now_ - last_plan_ > kArrivedReplan)
    plan_forced_ = true;
  if (plan_forced_ || now_ >= next_plan_) replan(mapper);
  if (state_ == ExplorerState::Finished) return {};
  if (looking_.active()) {
    const std::optional<Drive> turn = looking_.turn(turned_, now_);
    plan_forced_ = plan_forced_ || !turn;
    return turn.value_or(Drive{});
  }
  if (path_watch_.waits(now_)) return {};
  return path_watch_.limited(follower_.drive(pose_), now_);
}

Traversable PaperExplorer::floor_now(const slam::Mapper& mapper, const std::vector<TPoint2D>& hits) const {
  Traversable floor = traversable(mapper.map(), config_.occupied_threshold);
  free_body(floor, pose_, model_.length, model_.width, 0.0);
  free_trail(floor, trail_, kTrailRadius);
  add_obstacles(floor, hits, kSameThing);
  measure_clearance(floor, planner_.clearance_cap());
  return floor;
}

Plan PaperExplorer::plan_on(const Traversable& floor) {
  if (state_ == ExplorerState::GoingHome) return planner_.to_point(floor, pose_, home_, 0.15);
  if (state_ == ExplorerState::Searching) return plan_search(floor);
  return planner_.to_frontier(
      floor, pose_, [this](const TPoint2D& p) { return blacklist_.barred(p, now_); }, target_);
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

void PaperExplorer::accept(Plan plan) {
  failed_plans_ = 0;
  looks_in_vain_ = 0;
  const bool near = distance(plan.target, position(pose_)) < kVisited;
  if (state_ == ExplorerState::GoingHome) {
    if (distance(home_, position(pose_)) < kVisited) return finish("home again");
  } else if (state_ == ExplorerState::Searching) {
    if (distance(plan.target, position(pose_)) < kAtViewpoint) return face_subject();
  } else if (near) {
    return visited_in_vain(plan.target);
  }
  if (looking_.active() && !looking_.to_the_end()) looking_.end();
  if (!target_ || distance(*target_, plan.target) > 0.5) target_cost_ = plan.cost;
  target_ = plan.target;
  path_d_min_ = plan.d_min;
  path_watch_.unblock();
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
  blacklist_.bar_for_good(where, kBarRadius);
  target_.reset();
  plan_forced_ = true;
}

/// No frontier can be reached: look around once more, try again what failed before, then finish.
void PaperExplorer::nothing_left() {
  if (looking_.active()) return;
  if (state_ == ExplorerState::GoingHome) return finish("no way home is left");
  if (state_ == ExplorerState::Searching) return finish_searching();
  if (looks_in_vain_ == 0 || (failed_plans_ < 2 && looks_in_vain_ < 2)) {
    ++looks_in_vain_;
    return look_around(kLookTurn, false);
  }
  if (pardons_ < kMaxPardons && blacklist_.pardon(now_)) {
    ++pardons_;
    plan_forced_ = true;
    return;
  }
  finish_exploring();
}

void PaperExplorer::finish_exploring() {
  std::string why = "nothing reachable left to explore";
  if (frontier_left_ == 1) why += " (1 frontier cannot be reached)";
  if (frontier_left_ > 1) why += " (" + std::to_string(frontier_left_) + " frontiers cannot be reached)";
  reason_ = why;
  plan_forced_ = true;
  if (floor_search_.on()) {
    state_ = ExplorerState::Searching;
    return;
  }
  finish_searching();
}

void PaperExplorer::finish_searching() {
  if (!config_.return_home) return finish(state_ == ExplorerState::Searching ? "all visible floor searched" : "");
  state_ = ExplorerState::GoingHome;
  plan_forced_ = true;
}

/// Records what the victim sensors see; a place seen on the way need not be driven to.
void PaperExplorer::mark_searched() {
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

Plan PaperExplorer::plan_search(const Traversable& floor) {
  const auto head_start = [&](const TPoint2D& p) -> std::optional<double> {
    if (blacklist_.barred(p, now_)) return std::nullopt;
    return target_ && distance(p, *target_) > 0.5 ? config_.planner.switch_cost : 0.0;
  };
  Plan plan = planner_.to_cells(floor, pose_, floor_search_.sources(floor, head_start));
  if (plan.found) floor_search_.choose_subject(floor.cells.cell(plan.target));
  return plan;
}

/// At a viewpoint.
void PaperExplorer::face_subject() {
  follower_.clear();
  if (looking_.active()) return;
  if (const std::optional<double> turn = floor_search_.turn_to_subject(last_floor_, pose_))
    return look_around(*turn, true);
  floor_search_.start_dwell(now_);
}

void PaperExplorer::finish(const std::string& why) {
  reason_ += (reason_.empty() || why.empty() ? "" : ", ") + why;
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
