#include "explore/paper/paper_explorer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/planar.h"
#include "explore/plan/frontier.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kSameThing = 0.15;              ///< a hit this close to a wall of the map is that wall [m]
constexpr double kBlindWay = 5.0;                ///< by odometry alone, then it looks back [m]
constexpr double kAskEach = 1.0;                 ///< such way, the brake is asked whether it moves [m]
constexpr double kStandsStill = 0.2;             ///< of its speed: who feels no more of it go as it brakes stood
constexpr double kBlindAfterBlow = 1.0;          ///< the same after a blow [m]
constexpr double kEmptyBelowLow = 0.5;           ///< a Pioneer is low at 11.5 V and switches itself off at 11.0 V [V]
constexpr double kLookBack = deg_to_rad(130.0);  ///< with a 240 deg scanner far enough [rad]
constexpr double kOnEdge = 0.01;                 ///< what was felt so near to a pallet is felt on it [m]
constexpr double kTrailRadius = 0.20;            ///< [m]
constexpr double kNearFrontier = 1.0;            ///< frontier this close at the start: turn to see it [m]
constexpr double kAtWall = 0.35;                 ///< from where a wall that may be none is looked at [m]
constexpr double kTurningRoom = 0.06;            ///< beside the robot's swing circle, for stopping a little off [m]
constexpr double kLittleRoom = 0.01;             ///< likewise, where there is no more [m]
constexpr double kLongestTick = 0.2;             ///< commands of longer ticks are taken to have ended [s]
constexpr double kDetourSpeed = 0.15;   ///< a detour is driven so fast at least, turns and stops included [m/s]
constexpr double kWaitForMapper = 3.0;  ///< the robot stands for a pose in doubt, then it goes on [s]
constexpr double kWaitAgain = 20.0;     ///< from the beginning of one such wait to the next [s]
constexpr double kOtherPlace = 0.3;     ///< a victim that has moved so far is told of again [m]
constexpr int kSmoothFloor = 3;         ///< things felt so far where the robot may be fast

PaperExplorerConfig for_mission(PaperExplorerConfig config, const Mission& mission) {
  config.choice = config.choice.for_mission(mission.time_limit);
  return config;
}

}  // namespace

PaperExplorer::PaperExplorer(const robot::RobotModel& model, const PaperExplorerConfig& config, const Mission& mission)
    : model_(model),
      config_(for_mission(config, mission)),
      agenda_(config_),
      pilot_(model, config.follower),
      stuck_watch_(config.tilt),
      recovery_(model, config.follower.turn_speed),
      straight_on_(model),
      victims_(config.victims, config.search,
               std::max(config.planner.transform.d_min, model.swing_radius()) + kTurningRoom,
               model.swing_radius() + kLittleRoom, mission.senses),
      left_alone_(config.felt, config.planner.same_target),
      close_looks_(config.felt.pallet, {model.T_base_laser.x, model.T_base_laser.y}),
      home_way_(mission.time_limit),
      levelling_(model) {}

ExplorerState PaperExplorer::state() const {
  if (agenda_.finished()) return ExplorerState::Finished;
  if (stage_ == Stage::Starting) return ExplorerState::Starting;
  if (stage_ == Stage::BackingUp) return ExplorerState::BackingUp;
  switch (agenda_.goal()) {
    case Goal::Frontier:
      return ExplorerState::Driving;
    case Goal::Place:
      return ExplorerState::Searching;
    case Goal::Home:
      break;
  }
  return ExplorerState::GoingHome;
}

robot::Commands PaperExplorer::next(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  observe(mapper, inputs);
  brakes_ = false;
  commanded_ = decide(mapper);
  // In getting free each move is ended by what it meets: there blows are heard also right after it braked.
  if (brakes_ && stage_ != Stage::BackingUp) stuck_watch_.braked(now_);
  return {commanded_, {}, brakes_};
}

/// Takes in what arrived in this tick.
void PaperExplorer::observe(const slam::Mapper& mapper, const robot::Inputs& inputs) {
  const double passed = now_ == Stamp::never() ? 0.0 : inputs.now - now_;
  dt_ = std::min(passed, kLongestTick);
  const Stamp last = now_;
  now_ = inputs.now;
  TPose2D before = pose_;
  pose_ = mapper.pose();
  // A correction of the map is neither a turn nor a way: both are measured on the map as it is now.
  if (mapper.revision() != revision_ && last != Stamp::never()) before = mapper.pose_at(last).value_or(before);
  turned_ = wrap_angle(pose_.phi - before.phi);
  victims_.moved(pose_, mapper.covariance(), passed);
  if (!victims_.doubts_pose()) waits_since_.reset();
  if (mapper.revision() != revision_) follow_map(mapper);
  if (!inputs.scans.empty()) {
    last_scan_ = now_;
    const std::optional<TPoint2D> wall = agenda_.doubted_wall();
    if (wall && distance(*wall, position(pose_)) < kAtWall)
      close_looks_.look(mapper.last_hits(), pose_);
    else
      close_looks_.look_away();
  }
  home_way_.begin(now_);
  levelling_.update(inputs);
  heed_levelling();
  heed_battery(inputs);
  stuck_watch_.update(inputs, passed, dt_);
  // From ramp to ramp the platform lags behind, and its servos do not tell how the body leans.
  if (levelling_.level()) slope_ = robot::slope(stuck_watch_.lean());
  if (levelling_.given_up()) slope_ = 0.0;
  for (const robot::VictimCue& cue : inputs.cues) victims_.hear(cue, mapper, pose_, floor_);
  if (!inputs.cues.empty()) tell_victims();
  // What holds it up on the way will hold it up on the way home as well; what it moves to get free is no way.
  const ExplorerState state = this->state();
  const bool free = state == ExplorerState::Driving || state == ExplorerState::GoingHome;
  home_way_.moved(free ? distance(position(before), position(pose_)) : 0.0, dt_,
                  free || state == ExplorerState::BackingUp);
  recovery_.moved(now_, pose_);
  if (stage_ != Stage::OnTheWay && stage_ != Stage::StraightOn) return;
  left_alone_.passed(pose_, model_);
  trail_.add(now_, pose_, slope_);
}

/// Which victims are new, which lie elsewhere than was told or were told of by another sense, and which are none any
/// more: what told of them is of another, or of nobody.
void PaperExplorer::tell_victims() {
  std::vector<VictimReport> told;
  const auto of = [](const std::vector<VictimReport>& victims, int id) {
    const auto at = std::find_if(victims.begin(), victims.end(), [&](const VictimReport& v) { return v.id == id; });
    return at == victims.end() ? nullptr : &*at;
  };
  for (const VictimReport& victim : victims_.reports()) {
    const VictimReport* const before = of(told_victims_, victim.id);
    const bool news = before == nullptr || distance(before->p_map, victim.p_map) > kOtherPlace ||
                      before->cues.size() != victim.cues.size();
    if (news)
      agenda_.note(now_, victim_name(victim.id) + (before == nullptr ? " confirmed at " : " is at ") +
                             place_text(victim.p_map) + (before == nullptr ? " by " : " now, by ") + senses(victim));
    told.push_back(news ? victim : *before);
  }
  for (const VictimReport& before : told_victims_)
    if (of(told, before.id) == nullptr) agenda_.note(now_, victim_name(before.id) + " was another one, or none");
  told_victims_ = std::move(told);
}

/// Scans of a plane that nobody holds level show walls where floor is: what is seen of victims cannot be placed, and
/// new ground cannot be told from walls. Known ground can be driven home on.
void PaperExplorer::heed_levelling() {
  victims_.trust_scans(levelling_.works());
  if (levelling_.jammed()) stuck_watch_.distrust_tilt();
  if (const std::string news = levelling_.news(); !news.empty()) agenda_.note(now_, news);
  if (levelling_.given_up()) call_it_a_day("the laser is not levelled");
}

void PaperExplorer::heed_battery(const robot::Inputs& inputs) {
  if (inputs.battery && inputs.battery->low > 0.0) {
    if (!battery_) battery_.emplace(inputs.battery->low, inputs.battery->low - kEmptyBelowLow);
    battery_->look(inputs.battery->volts, now_);
  }
  if (battery_ && battery_->empty() && stage_ == Stage::BackingUp)  // it does not move, and nothing will make it
    obey(agenda_.finish(MissionEnd::Stuck, "the battery is empty", now_));
  if (battery_ && battery_->low()) call_it_a_day("the battery is low");
}

/// Nothing more is begun; home, where it is wanted.
void PaperExplorer::call_it_a_day(const std::string& why) {
  if (stage_ == Stage::Starting || finished()) return;
  if (!config_.return_home) {
    obey(agenda_.finish(MissionEnd::Explored, why, now_));
  } else if (agenda_.goal() != Goal::Home) {
    agenda_.go_home(why, now_);
    pilot_.end_turn();
  }
}

/// The mapper moved poses of the past: all that is kept moves with them, and the way is planned anew.
void PaperExplorer::follow_map(const slam::Mapper& mapper) {
  revision_ = mapper.revision();
  agenda_.follow(mapper, trail_.follow(mapper));
  recovery_.follow(mapper);
  straight_on_.follow(mapper);
  pilot_.follow_map(mapper);
  left_alone_.follow(mapper);
  close_looks_.follow(mapper);
  if (stage_ == Stage::StraightOn) stage_ = Stage::OnTheWay;  // how far it came is told by poses of two maps
  if (!victims_.follow(mapper)) return;
  floor_ = floor_now(mapper, {});
  victims_.search().look_again(floor_);
}

Drive PaperExplorer::decide(const slam::Mapper& mapper) {
  if (finished()) return {};
  if (last_scan_ == Stamp::never() || now_ - last_scan_ > config_.scan_timeout) return {};
  if (levelling_.waits()) return {};
  switch (stage_) {
    case Stage::Starting:
      return start(mapper);
    case Stage::OnTheWay:
      return go_on(mapper);
    case Stage::StraightOn:
      return drive_straight_on(mapper);
    case Stage::Braking:
      return brake(mapper);
    case Stage::BackingUp:
      break;
  }
  return back_up();
}

/// Waits for the first scan in the map; when frontier is close by, the scanner's blind sector is worth a turn.
Drive PaperExplorer::start(const slam::Mapper& mapper) {
  if (mapper.counts().mapped == 0) return {};
  stage_ = Stage::OnTheWay;
  agenda_.set_home({now_, pose_});
  const TPoint2D here = position(pose_);
  const Traversable floor = floor_now(mapper, {});
  const std::vector<Cell> frontier = frontier_cells(floor);
  const auto near = std::count_if(frontier.begin(), frontier.end(),
                                  [&](Cell c) { return distance(floor.cells.centre(c), here) < kNearFrontier; });
  const Cell own = floor.clearance.cell(here);
  const bool room = floor.clearance.inside(own) && floor.clearance[own] >= model_.swing_radius();
  if (room && near >= config_.planner.min_frontier_cells && config_.first_turn > 0.0)
    pilot_.turn(config_.first_turn, TurnFor::WholeView, now_);
  return {};
}

/// On the way to a frontier, to a place to search, or home.
Drive PaperExplorer::go_on(const slam::Mapper& mapper) {
  if (holds_still()) return {};
  if (waits_for_mapper()) {
    stuck_watch_.begin_anew();
    return {};
  }
  const bool on_purpose = pilot_.turning() || agenda_.goal() == Goal::Place;
  if (const auto hold = stuck_watch_.held(pose_, commanded_, on_purpose, dt_, now_)) {
    if (straight_on_.explains(*hold, commanded_, stuck_watch_.wheels()) &&
        straight_on_.worth(pose_, floor_, mapper.last_hits(), now_)) {
      agenda_.note(now_, "its wheels slip in a curve: drives straight on");
      pilot_.stop();
      straight_on_.begin(pose_, now_);
      stage_ = Stage::StraightOn;
      return drive_straight_on(mapper);
    }
    if (stuck_watch_.brake_can_tell(*hold, now_)) {
      doubted_hold_ = *hold;
      asks_blindly_ = false;
      stuck_watch_.begin_brake_test(now_);
      brakes_ = true;
      stage_ = Stage::Braking;
      return {};
    }
    get_free_of(*hold, mapper);
    return {};
  }
  if (asks_its_brake(mapper)) {
    brakes_ = true;
    stage_ = Stage::Braking;
    return {};
  }
  check_path(mapper);
  look_back(mapper);
  agenda_.spend(dt_, situation());
  // A mapper need not change its map where a robot stands on known ground.
  if (pilot_.arrived() && !pilot_.turning()) agenda_.arrived(now_);
  if (config_.return_home && agenda_.goal() != Goal::Home && home_way_.due(now_) &&
      home_way_.must_turn_back(agenda_.way_home(situation(), trail_.length()), now_)) {
    const bool searches = agenda_.goal() == Goal::Place;
    agenda_.go_home(
        searches ? "not all is searched: the time left is for the way home" : "the time left is for the way home",
        now_);
    pilot_.end_turn();
  }
  if (agenda_.due(mapper.map(), now_)) replan(mapper);
  if (finished()) return {};
  const Pilot::Step step = pilot_.step({pose_, turned_, stuck_watch_.wheels().value_or(commanded_),
                                        levelling_.level() ? stuck_watch_.lean() : robot::Tilt{}, slope_},
                                       floor_, mapper.last_hits(), now_);
  brakes_ = step.brakes;
  if (step.turn_ended) agenda_.plan_soon();
  // A turn in a tight place wanders off its viewpoint; driving back to it and turning again would never end.
  if (step.faced) victims_.search().start_dwell_as_turned(now_);
  return step.drive;
}

/// Between walls that look the same all along its wheels may spin before a step that it met slowly: no scan and no blow
/// tells. Its brake does.
bool PaperExplorer::asks_its_brake(const slam::Mapper& mapper) {
  const double blind = mapper.blind_way();
  if (blind < asked_at_) asked_at_ = 0.0;
  if (blind < asked_at_ + kAskEach || pilot_.turning()) return false;
  const StuckWatch::Hold hold{"braking it felt that it stands",
                              commanded_.v < 0.0 ? Escape::Met::Backwards : Escape::Met::Forwards, true};
  if (!stuck_watch_.brake_can_tell(hold, now_)) return false;
  asked_at_ = blind;
  doubted_hold_ = hold;
  asks_blindly_ = true;
  stuck_watch_.begin_brake_test(now_);
  return true;
}

/// Between walls that look the same all along its wheels may spin before a step while all seems well. It looks back for
/// where that way began soon after a blow, and where there was none before the way becomes long.
void PaperExplorer::look_back(const slam::Mapper& mapper) {
  const double blind = mapper.blind_way();
  if (blind < blind_) look_back_at_.reset();
  blind_ = blind;
  if (blind > 0.0 && stuck_watch_.shaken())
    look_back_at_ = std::min(look_back_at_.value_or(kBlindWay), blind + kBlindAfterBlow);
  if (blind < look_back_at_.value_or(kBlindWay) || pilot_.turning()) return;
  if (agenda_.goal() == Goal::Home && home_way_.hurries(pilot_.left(), now_)) return;
  look_back_at_ = blind + kBlindWay;
  agenda_.note(now_, "nothing but walls alongside for so long: looks back");
  pilot_.turn(kLookBack, TurnFor::WholeView, now_);
}

/// Records what the victim sensors see, and stands where they need time for it.
bool PaperExplorer::holds_still() {
  if (victims_.look(floor_, pose_, turned_ / std::max(dt_, 1e-9), now_)) agenda_.look_made(situation());
  if (victims_.holds_still(floor_, pose_, now_)) {
    stuck_watch_.begin_anew();
    return true;
  }
  if (victims_.search().dwell_over()) agenda_.plan_soon();
  return false;
}

/// A pose that has lost its place may find it again by the scans to come: driving on, the robot would only get farther
/// from where it was sure. One that stays lost is no reason to stand for ever.
bool PaperExplorer::waits_for_mapper() {
  if (!victims_.doubts_pose()) return false;
  if (!waits_since_) {
    if (next_wait_ != Stamp::never() && now_ < next_wait_) return false;
    waits_since_ = now_;
    next_wait_ = now_ + kWaitAgain;
    agenda_.note(now_, "the pose is in doubt: waits for the mapper");
  }
  return now_ - *waits_since_ < kWaitForMapper;
}

void PaperExplorer::check_path(const slam::Mapper& mapper) {
  if (!pilot_.check_due(now_)) return;
  const std::vector<TPoint2D> hits = agenda_.pushing().without_loose_things(mapper.last_hits(), pose_, floor_);
  close_looks_.met(agenda_.pushing().solid(), {now_, pose_});
  if (agenda_.pushing().near_loose_things()) pilot_.slow_down(now_);
  if (pilot_.check(hits, pose_, commanded_.v, now_)) agenda_.plan_soon();
}

/// Something holds the robot that the scanner cannot see: it is remembered, and the robot gets free of it. Which corner
/// met it in a turn nobody knows: that is not remembered, but where it holds it twice the target is left alone.
void PaperExplorer::get_free_of(const StuckWatch::Hold& hold, const slam::Mapper& mapper) {
  // On its ramp the base would push on for a second, and every turn of the wheels in vain is a lie of the odometry.
  brakes_ = true;
  pilot_.stop();
  std::optional<WayOut> way_out = this->way_out(mapper);
  const bool trapped = way_out.has_value();
  const bool again = recovery_.begin(hold.met, pose_, now_, std::move(way_out));
  if (again && agenda_.target() && agenda_.goal() != Goal::Home) agenda_.leave_target(left_alone_, {now_, pose_});
  const bool pallet =
      hold.met != Escape::Met::Turning &&
      left_alone_.feel({now_, pose_}, hold.met == Escape::Met::Backwards, model_, floor_.cells, trail_, !hold.stands);
  agenda_.note(now_, hold.how + (pallet                             ? ": backs off and keeps clear of the pallet ahead"
                                 : trapped                          ? ": leaves the pallet"
                                 : hold.met == Escape::Met::Turning ? ": tries to get away"
                                                                    : ": backs off and plans around it"));
  stage_ = Stage::BackingUp;
}

/// Nothing where the robot is in no trap.
std::optional<WayOut> PaperExplorer::way_out(const slam::Mapper& mapper) {
  const std::optional<Trap> trap = left_alone_.trap(pose_);
  if (!trap) return std::nullopt;
  // What was felt on the pallet are its own high corners, as far as anybody knows.
  std::vector<TPoint2D> obstacles;
  for (const TPoint2D& p : left_alone_.obstacles(now_))
    if (!trap->holds(p, kOnEdge)) obstacles.push_back(p);
  const Traversable walls = traversable(mapper.map(), config_.occupied_threshold);
  for (int y = 0; y < walls.cells.height(); ++y)
    for (int x = 0; x < walls.cells.width(); ++x)
      if (walls.cells[{x, y}] == Occupancy::Occupied) obstacles.push_back(walls.cells.centre({x, y}));
  return WayOut(model_, *trap, obstacles, trail_.points());
}

Drive PaperExplorer::drive_straight_on(const slam::Mapper& mapper) {
  if (const auto hold = stuck_watch_.held(pose_, commanded_, false, dt_, now_)) {
    get_free_of(*hold, mapper);
    return {};
  }
  brakes_ = !straight_on_.room(pose_, floor_, mapper.last_hits());
  if (const auto drive = straight_on_.drive(pose_, now_); drive && !brakes_) return *drive;
  stage_ = Stage::OnTheWay;
  agenda_.plan_soon();
  return {};
}

/// Nothing but its pose says that the robot is held: its brake tells.
Drive PaperExplorer::brake(const slam::Mapper& mapper) {
  brakes_ = true;
  switch (stuck_watch_.brake_verdict(now_)) {
    case BrakeTest::Verdict::Open:
      break;
    case BrakeTest::Verdict::Moved:
      brake_tells_ = true;
      stage_ = Stage::OnTheWay;
      if (asks_blindly_) break;
      agenda_.note(now_, "its pose stands, but braking it felt that it moved: drives on");
      stuck_watch_.doubt_pose(now_);
      agenda_.plan_soon();
      break;
    case BrakeTest::Verdict::Stood:
      // A base that cannot stop at once feels little as well, and one that tips over a crest.
      if (asks_blindly_ && (!brake_tells_ || stuck_watch_.lost_by_braking() > kStandsStill)) {
        stage_ = Stage::OnTheWay;
        break;
      }
      if (asks_blindly_) look_back_at_ = mapper.blind_way();  // its pose has driven on: soon it looks for where it is
      get_free_of(doubted_hold_, mapper);
      break;
  }
  return {};
}

Drive PaperExplorer::back_up() {
  const Recovery::Result result = recovery_.step(pose_, commanded_, stuck_watch_, dt_, now_, trail_, floor_);
  brakes_ = recovery_.met();
  if (result == Recovery::Result::UnderWay) return recovery_.drive();
  stage_ = Stage::OnTheWay;
  if (result != Recovery::Result::Free) {
    agenda_.note(now_, "could not get free");
    if (recovery_.caught()) left_alone_.not_got_free({now_, pose_}, floor_.cells);
  }
  if (result == Recovery::Result::Stuck) {
    obey(agenda_.finish(MissionEnd::Stuck, "stuck", now_));
    return {};
  }
  stuck_watch_.begin_anew();
  agenda_.plan_soon();
  return {};
}

void PaperExplorer::replan(const slam::Mapper& mapper) {
  const bool new_map = agenda_.begin_plan(mapper.map(), now_);
  const std::vector<TPoint2D> new_things = pilot_.new_things(now_);
  floor_ = floor_now(mapper, new_things);
  if (mapper.settled()) judge_holes(mapper.map());
  Plan plan = agenda_.choose(situation());
  if (!plan.found && !new_things.empty()) {
    // The map shows a way, the newest scans do not: go and see, slowly.
    floor_ = floor_now(mapper, {});
    plan = agenda_.choose(situation());
    if (plan.found) pilot_.creep(now_);
  }
  if (agenda_.begins_to_insist()) pilot_.forget_new_things();
  if (!new_things.empty() && agenda_.turn_away(plan, pilot_.left(), situation()) && pilot_.waits(now_))
    pilot_.remember_new_things(length_of(plan) / kDetourSpeed, now_);
  obey(agenda_.decide(std::move(plan), new_map, situation()));
}

void PaperExplorer::judge_holes(const slam::CountMap& map) {
  const bool expected = victims_.search().squarely();
  victims_.judge_holes(floor_, map, now_);
  if (!expected && victims_.search().squarely())
    agenda_.note(now_, "a victim shows through a hole in a wall: each face is to be looked at squarely");
}

void PaperExplorer::obey(Order order) {
  switch (order.kind) {
    case Order::Kind::Follow:
      for (PathPoint& point : order.plan.path) look_up_ground(point);
      pilot_.follow(std::move(order.plan));
      break;
    case Order::Kind::Stay:
      pilot_.leave_path();
      break;
    case Order::Kind::Turn:
      pilot_.turn(order.angle, order.purpose, now_);
      break;
    case Order::Kind::Stop:
      pilot_.stop();
      break;
  }
  shown_path_.clear();
  for (const PathPoint& point : pilot_.path()) shown_path_.push_back(point.p_map);
}

/// Where several things were felt the floor has more of them than the trail's width tells.
void PaperExplorer::look_up_ground(PathPoint& point) const {
  const std::optional<double> slope = trail_.slope(point.p_map);
  point.slope = slope.value_or(0.0);
  point.ground = recovery_.times() > kSmoothFloor ? Ground::Rough : slope ? Ground::Passed : Ground::New;
}

Traversable PaperExplorer::floor_now(const slam::Mapper& mapper, const std::vector<TPoint2D>& hits) const {
  Traversable floor = traversable(mapper.map(), config_.occupied_threshold, config_.search.low_walls);
  close_looks_.apply(floor);
  agenda_.pushing().free_things(floor);
  // The last resort homewards is the way it came, whatever has rolled into it since.
  const bool same_way = agenda_.goal() == Goal::Home && !agenda_.pushing().more();
  if (same_way) loosen_trail(floor, trail_.points(), 0.5 * model_.width);
  free_body(floor, pose_, model_.length, model_.width, 0.0);
  free_trail(floor, trail_.points(), kTrailRadius);
  add_obstacles(floor, hits, kSameThing);
  const std::vector<TPoint2D> felt = left_alone_.obstacles(now_);
  add_obstacles(floor, felt, kSameThing);
  measure_clearance(floor, agenda_.clearance_cap());
  if (same_way) widen_trail(floor, trail_.points(), config_.planner.transform.d_min, felt);
  return floor;
}

Agenda::Situation PaperExplorer::situation() {
  return {now_,
          pose_,
          floor_,
          pilot_.turning(),
          victims_.reports().size(),
          left_alone_,
          victims_.search(),
          home_way_.speed(),
          recovery_.times() > 0 ? &trail_ : nullptr,
          &close_looks_};
}

}  // namespace rubble::explore
