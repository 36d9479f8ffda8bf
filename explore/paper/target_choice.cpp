#include "explore/paper/target_choice.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/planar.h"
#include "explore/caution/local_grids.h"
#include "explore/caution/pallet_grid.h"
#include "explore/caution/step_field.h"
#include "explore/paper/doubtful_walls.h"
#include "explore/paper/prospects.h"
#include "explore/plan/pockets.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kHomeTolerances[] = {0.15, 0.4, 0.8};  ///< [m]
constexpr double kCarried = 0.35;                       ///< from its trail floor carried the robot [m]
constexpr double kKeep = 3.0;     ///< looks on the way change what a look squarely is worth: times the usual head start
constexpr double kBeside = 0.25;  ///< [m]
constexpr double kBeyond = 0.3;   ///< behind a face its wall's other pallet begins [m]
constexpr double kNarrow = 4.0;   ///< what a way near to walls has to save on one that is not [m]
const std::optional<PalletGrid> kNoGrid;

/// The fields of steps that a map shows, each looked for once.
class StepFields {
 public:
  explicit StepFields(const OccupancyGrid& cells) : cells_(cells) {}
  bool shown_at(const PalletGrid& grid, const TPoint2D& p_map) {
    const Cell pallet = grid.pallet(p_map);
    const Cell middle = cells_.cell(grid.middle(pallet));  // the pallets of two grids are counted apart
    const auto [at, is_new] = shown_.emplace(std::pair(middle.x, middle.y), false);
    if (is_new) at->second = shows_step_field(cells_, grid, pallet);
    return at->second;
  }
  /// There or a little beside it: of the last pallet of a field too few steps may show.
  bool shown_near(const PalletGrid& grid, const TPoint2D& p_map) {
    for (const TPoint2D& off : {TPoint2D{0.0, 0.0}, {kBeside, 0.0}, {0.0, kBeside}, {-kBeside, 0.0}, {0.0, -kBeside}})
      if (shown_at(grid, p_map + off)) return true;
    return false;
  }

 private:
  const OccupancyGrid& cells_;
  std::map<std::pair<int, int>, bool> shown_;
};

/// A place behind what a look at a face is for, where that is no wall that all scans hit: a field of steps begins on
/// the edge of its pallet as well [m].
std::optional<TPoint2D> behind_unsure_wall(const Traversable& floor, const Viewpoint& look) {
  for (const auto& [face, step] :
       {std::pair<Faces, Cell>{kEastFace, {1, 0}}, {kNorthFace, {0, 1}}, {kWestFace, {-1, 0}}, {kSouthFace, {0, -1}}}) {
    if ((look.faces & face) == 0) continue;
    const Cell subject = floor.cells.cell(look.subject);
    const Cell wall{subject.x + step.x, subject.y + step.y};
    if (!floor.cells.inside(wall) || (floor.cells[wall] == Occupancy::Occupied && floor.unsure[wall] == 0)) continue;
    return look.subject + TPoint2D(step.x, step.y) * kBeyond;
  }
  return std::nullopt;
}

}  // namespace

void TargetChoice::explore() {
  goal_ = Goal::Frontier;
  frontiers_done_ = false;
}

void TargetChoice::go_home() {
  goal_ = Goal::Home;
  target_.reset();
}

TargetChoice::Choice TargetChoice::choose(const View& view, FloorSearch& search) {
  assert(goal_ != Goal::Home);
  const bool driving = goal_ == Goal::Frontier;
  if (driving && (frontiers_done_ || !search.on())) return {to_frontier(view, search, target_)};
  Plan frontier = to_frontier(view, search, driving ? target_ : std::nullopt);
  if (frontiers_done_ && view.places_only) frontier.found = false;
  if (!frontiers_done_) {
    Plan place = beside_the_way(view, search, frontier);
    return weigh(std::move(frontier), std::move(place));
  }
  // Where all faces are looked at squarely, niches are faces like others.
  Plan niche;
  if (!search.squarely()) niche = to_place(view, search, Subjects::Niches);
  if (!niche.found) return {std::move(frontier), true};
  return weigh(std::move(frontier), std::move(niche));
}

TargetChoice::Choice TargetChoice::choose_of_all_places(const View& view, FloorSearch& search, Plan frontier) {
  // A face that was looked at squarely was looked at: where that is asked for it need not be done twice.
  Plan place;
  if (search.squarely()) place = to_place(view, search, Subjects::Squarely);
  if (!place.found) place = to_place(view, search, Subjects::All);
  return weigh(std::move(frontier), std::move(place));
}

/// A way to a place to look at before the next frontier; none is found where that goes first.
Plan TargetChoice::beside_the_way(const View& view, FloorSearch& search, const Plan& frontier) {
  Plan niche = to_place(view, search, Subjects::Niches);
  if (goes_first(niche, frontier, priorities_.niches)) return niche;
  if (priorities_.faces <= 0.0) return {};
  Plan face = to_place(view, search, Subjects::All);
  return goes_first(face, frontier, priorities_.faces) ? std::move(face) : Plan{};
}

/// What lies beside the way is looked at now: coming back for it costs more.
bool TargetChoice::goes_first(const Plan& place, const Plan& frontier, double most) const {
  if (!place.found || !frontier.found || most <= 0.0) return false;
  return place.cost <= std::min(frontier.cost, most) + (goal_ == Goal::Frontier ? 0.0 : priorities_.frontiers);
}

/// A way to a frontier against one to a place to search from.
TargetChoice::Choice TargetChoice::weigh(Plan frontier, Plan place) {
  place.frontier_left = frontier.frontier_left;
  if (!frontiers_done_) {
    goal_ = place.found ? Goal::Place : Goal::Frontier;
    return {place.found ? std::move(place) : std::move(frontier)};
  }
  // New ground is worth more than the faces that are left, none of which is the back of a niche.
  if (!frontier.found || (place.found && frontier.cost > place.cost + priorities_.frontiers)) return {std::move(place)};
  goal_ = Goal::Frontier;
  return {std::move(frontier), false, true};
}

Plan TargetChoice::to_frontier(const View& view, const FloorSearch& search, const std::optional<TPoint2D>& previous) {
  const bool tells_pockets = search.on() && bar_targets_;
  Grid<std::uint8_t> small;
  if (tells_pockets && leaves_pockets_) small = pockets(view.floor.cells, kPocket);
  const auto barred = [&](const TPoint2D& p) { return bar_targets_ && view.left_alone.barred(p, view.now); };
  const auto left_alone = [&](const TPoint2D& p) {
    return barred(p) ||
           (tells_pockets && leaves_pockets_ && !leads_on(view.floor.cells, small, view.floor.cells.cell(p)));
  };
  Plan plan = planner_.to_frontier(view.floor, view.T_map_base, left_alone, previous,
                                   frontier_worth(by_, config_, view.floor, search, view.speed));
  if (plan.found || view.faces_first) return plan;
  if (tells_pockets && !thorough_ && !leaves_pockets_) small = pockets(view.floor.cells, kPocket);
  std::vector<Source> sources =
      doubtful_walls(view.floor, pallet_, tells_pockets && !thorough_ ? &small : nullptr, &grids_);
  const auto place = [&](const Source& source) { return view.floor.cells.centre(source.cell); };
  sources.erase(std::remove_if(sources.begin(), sources.end(), [&](const Source& s) { return barred(place(s)); }),
                sources.end());
  // Of what is driven to as such, a part may vanish on the way: the rest is looked at from there as well.
  if (previous && doubtful_ && !barred(*previous)) sources.push_back({view.floor.cells.cell(*previous), 0.0});
  if (sources.empty()) return plan;
  for (Source& source : sources) source.head_start = planner_.head_start(previous, place(source));
  Plan look = planner_.to_cells(view.floor, view.T_map_base, sources);
  look.frontier_left = plan.frontier_left;
  look.doubtful = look.found;
  return look;
}

Plan TargetChoice::to_place(const View& view, FloorSearch& search, Subjects subjects) {
  const auto head_start = [&](const TPoint2D& p) -> std::optional<double> {
    if (view.left_alone.barred(p, view.now)) return std::nullopt;
    return (subjects == Subjects::Squarely ? kKeep : 1.0) * planner_.head_start(target_, p);
  };
  OccupancyGrid shown = view.floor.cells;
  for (const std::vector<Cell>& freed : {view.floor.loose, view.floor.doubtful})
    for (const Cell c : freed) shown[c] = Occupancy::Occupied;
  LocalGrids grids(shown, pallet_, &grids_shown_);
  StepFields fields(shown);
  // Well inside the pallets stand no walls with holes, and among steps no boxes.
  const auto idle = [&](const Viewpoint& look) {
    const std::optional<PalletGrid>& grid = pallet_ > 0.0 ? grids.near(look.subject) : kNoGrid;
    if (!grid) return false;
    if (subjects == Subjects::Niches) return fields.shown_near(*grid, look.subject);
    if (grid->depth(look.subject) < kInsidePallet) {
      const std::optional<TPoint2D> beyond = behind_unsure_wall(view.floor, look);
      return subjects == Subjects::Squarely && beyond && fields.shown_at(*grid, *beyond);
    }
    return subjects == Subjects::Squarely || fields.shown_at(*grid, look.subject);
  };
  // Looking squarely at all takes more time than there is: what is rich is not left for the end for its narrow way.
  const auto detour = subjects == Subjects::Squarely ? std::optional(kNarrow) : std::nullopt;
  Plan plan = planner_.to_cells(view.floor, view.T_map_base, search.sources(view.floor, subjects, head_start, idle),
                                detour, target_);
  if (plan.found) plan.cost -= search.choose_subject(view.floor.cells.cell(plan.target));
  return plan;
}

Plan TargetChoice::way_home(const Traversable& floor, const TPose2D& T_map_base, const Trail* trail) {
  if (trail != nullptr) {
    Traversable carried = floor;
    keep_to_trail(carried, trail->points(), kCarried);
    if (Plan back = straight_home(carried, T_map_base); back.found) return back;
  }
  return straight_home(floor, T_map_base);
}

Plan TargetChoice::straight_home(const Traversable& floor, const TPose2D& T_map_base) {
  Plan plan;
  for (const double tolerance : kHomeTolerances) {
    plan = planner_.to_point(floor, T_map_base, position(home_.T_map_base), tolerance);
    if (plan.found) break;
  }
  return plan;
}

double TargetChoice::distance_home(const TPose2D& T_map_base) const {
  return distance(position(home_.T_map_base), position(T_map_base));
}

bool TargetChoice::turns_away(const Plan& plan) const {
  return plan.found && target_ && distance(*target_, plan.target) > config_.same_target;
}

bool TargetChoice::take(const Plan& plan) {
  const bool another = !target_ || turns_away(plan);
  if (another) cost_ = plan.cost;
  target_ = plan.target;
  doubtful_ = plan.doubtful;
  return another;
}

bool TargetChoice::kept_away(const View& view, double left) {
  const Plan way = planner_.to_point(view.floor, view.T_map_base, *target_, config_.same_target);
  return !way.found || length_of(way) > left + kLongerWay;
}

}  // namespace rubble::explore
