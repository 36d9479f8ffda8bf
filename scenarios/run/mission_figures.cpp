#include "scenarios/run/mission_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "arenas/model/rims.h"
#include "arenas/model/risers.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "base/angle.h"
#include "base/planar.h"
#include "robot/body.h"
#include "scenarios/config/viewer.h"
#include "scoring/figures/rooms_entered.h"
#include "sim/victim_sensor.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kContact = 0.012;  ///< nearer, the body touches [m]
constexpr double kFar = 0.5;        ///< clearances are not told apart beyond [m]
constexpr double kBucket = 1.2;     ///< [m]
constexpr double kAtHome = 1.0;     ///< who says that it is home and stands farther from the start is lost [m]
constexpr double kPeriod = 0.1;     ///< the truth is looked at this often [s]

/// An upright piece of something the body cannot pass.
struct Edge {
  TPoint2D a, b;
  double bottom, top;  ///< [m]
};

/// The edges of an arena, found by place.
class Edges {
 public:
  Edges(const arenas::Arena& arena, double climbable_step) {
    for (const arenas::Solid& solid : arena.solids) {
      if (solid.gives_way) continue;
      for (std::size_t i = 0; i < solid.outline.size(); ++i)
        edges_.push_back(
            {solid.outline[i], solid.outline[(i + 1) % solid.outline.size()], solid.z_bottom, solid.z_top});
    }
    for (const arenas::Riser& riser : arenas::risers(arena, climbable_step)) {
      const arenas::Stretch stretch = arenas::too_high(riser, climbable_step);
      if (stretch.from >= stretch.to) continue;
      const TPoint2D way = riser.b - riser.a;
      const TPoint2D from = riser.a + way * stretch.from;
      const TPoint2D to = stretch.to < 1.0 ? riser.a + way * stretch.to : riser.b;
      edges_.push_back({from, to, std::min(riser.low_a, riser.low_b), std::max(riser.high_a, riser.high_b)});
    }
    for (const arenas::Rim& rim : arenas::open_rims(arena, climbable_step))
      edges_.push_back({rim.a, rim.b, std::min(rim.z_a, rim.z_b), std::max(rim.z_a, rim.z_b) + 2.0 * robot::kGraze});
    frame_.resolution = kBucket;
    frame_.x0 = arena.min_corner.x - 2.0 * kBucket;
    frame_.y0 = arena.min_corner.y - 2.0 * kBucket;
    frame_.width = static_cast<int>((arena.max_corner.x - frame_.x0) / kBucket) + 3;
    frame_.height = static_cast<int>((arena.max_corner.y - frame_.y0) / kBucket) + 3;
    near_.resize(static_cast<std::size_t>(frame_.width) * static_cast<std::size_t>(frame_.height));
    for (std::size_t i = 0; i < edges_.size(); ++i) put(i);
  }

  const Edge& operator[](std::size_t i) const { return edges_[i]; }
  /// Those that may lie within a metre of p.
  const std::vector<std::size_t>& near(const TPoint2D& p) const {
    static const std::vector<std::size_t> none;
    const Cell c = frame_.cell(p);
    return frame_.inside(c) ? near_[frame_.index(c)] : none;
  }

 private:
  void put(std::size_t i) {
    const Edge& e = edges_[i];
    constexpr double kReach = 1.0;
    const Cell low = frame_.cell({std::min(e.a.x, e.b.x) - kReach, std::min(e.a.y, e.b.y) - kReach});
    const Cell high = frame_.cell({std::max(e.a.x, e.b.x) + kReach, std::max(e.a.y, e.b.y) + kReach});
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (frame_.inside({x, y})) near_[frame_.index({x, y})].push_back(i);
  }

  std::vector<Edge> edges_;
  GridFrame frame_;
  std::vector<std::vector<std::size_t>> near_;
};

double to_segment(const TPoint2D& p, const TPoint2D& a, const TPoint2D& b) {
  const TPoint2D way = b - a;
  const double size2 = way.x * way.x + way.y * way.y;
  const double t = size2 > 0.0 ? std::clamp(((p.x - a.x) * way.x + (p.y - a.y) * way.y) / size2, 0.0, 1.0) : 0.0;
  return distance(p, {a.x + t * way.x, a.y + t * way.y});
}

bool cross(const TPoint2D& a, const TPoint2D& b, const TPoint2D& c, const TPoint2D& d) {
  const auto side = [](const TPoint2D& p, const TPoint2D& q, const TPoint2D& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0.0;
  };
  return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
}

double between(const TPoint2D& a, const TPoint2D& b, const TPoint2D& c, const TPoint2D& d) {
  if (cross(a, b, c, d)) return 0.0;
  return std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
}

std::array<TPoint2D, 8> outline(const robot::RobotModel& model, const TPose2D& pose) {
  std::array<TPoint2D, 8> body = robot::body_outline<TPoint2D, double>(model);
  const PlanarTransform T(pose);
  std::transform(body.begin(), body.end(), body.begin(), T);
  return body;
}

double clearance(const arenas::Arena& arena, const Edges& edges, const robot::RobotModel& model, const TPose2D& pose) {
  const std::array<TPoint2D, 8> body = outline(model, pose);
  const double floor = arenas::floor_height(arena, {pose.x, pose.y});
  const double bottom = std::isfinite(floor) ? floor : 0.0;
  const double top = bottom + model.T_base_laser.z + robot::kAboveLaser;
  double nearest = kFar;
  for (const std::size_t i : edges.near({pose.x, pose.y})) {
    const Edge& e = edges[i];
    if (std::min(e.top, top) - std::max(e.bottom, bottom) < robot::kGraze) continue;
    for (std::size_t k = 0; k < body.size(); ++k)
      nearest = std::min(nearest, between(body[k], body[(k + 1) % body.size()], e.a, e.b));
  }
  return nearest;
}

const char* code_of(explore::MissionEnd end) {
  switch (end) {
    case explore::MissionEnd::UnderWay:
      return "time";
    case explore::MissionEnd::Explored:
      return "explored";
    case explore::MissionEnd::Home:
      return "home";
    case explore::MissionEnd::Stuck:
      return "stuck";
  }
  return "time";
}

double share_of(const OccupancyGrid& truth, const OccupancyGrid& visible) {
  const auto free = [](const OccupancyGrid& grid) {
    return std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Free);
  };
  const auto all = free(truth);
  return all == 0 ? 0.0 : static_cast<double>(free(visible)) / static_cast<double>(all);
}

/// The arena in the map: by where the robot was in both at first.
TPose2D arena_in_map(const Trajectory& truth, const slam::Mapper& mapper) {
  if (truth.empty() || mapper.trajectory().empty()) return {};
  const StampedPose& first = mapper.trajectory().front();
  const auto after =
      std::find_if(truth.begin(), truth.end(), [&](const StampedPose& p) { return p.stamp >= first.stamp; });
  const TPose2D& T_arena_base = after == truth.end() ? truth.back().pose : after->pose;
  return first.pose + (TPose2D() - T_arena_base);
}

}  // namespace

scoring::DriveFigures drive_figures(const arenas::Arena& arena, const Trajectory& truth,
                                    const robot::RobotModel& model) {
  scoring::DriveFigures figures;
  figures.min_clearance_m = kFar;
  if (truth.empty()) return figures;
  const Edges edges(arena, model.climbable_step);
  bool touches = false;
  std::int64_t contact_ns = 0;
  StampedPose last = truth.front();
  for (const StampedPose& at : truth) {
    const double dt = at.stamp - last.stamp;
    if (dt < kPeriod - 1e-6) continue;
    const double way = distance({last.pose.x, last.pose.y}, {at.pose.x, at.pose.y});
    figures.way_m += way;
    const double nearest = clearance(arena, edges, model, at.pose);
    figures.min_clearance_m = std::min(figures.min_clearance_m, nearest);
    const bool touched = touches;
    touches = nearest < kContact;
    if (touches) contact_ns += at.stamp.ns - last.stamp.ns;
    if (touches && !touched) {
      ++figures.contacts;
      figures.contact_speed = std::max(figures.contact_speed, way / dt);
    }
    last = at;
  }
  figures.contact_s = 1e-9 * static_cast<double>(contact_ns);
  const TPose2D& end = truth.back().pose;
  figures.home_m = distance({arena.start.x, arena.start.y}, {end.x, end.y});
  return figures;
}

std::string true_end(const std::string& said, double home) { return said == "home" && home > kAtHome ? "lost" : said; }

std::vector<std::string> unseen_victims(const arenas::Arena& arena, const robot::RobotModel& model) {
  const OccupancyGrid truth = arenas::truth_map(arena);
  const Grid<std::uint8_t> reachable = arenas::reachable_mask(arena, truth, viewer_of(model));
  const arenas::PatchIndex floor(arena);
  const sim::VictimView senses(arena);
  const auto seen_from = [&](const arenas::Victim& victim) {
    const double reach = senses.reach(victim);
    const Cell low = truth.cell({victim.position.x - reach, victim.position.y - reach});
    const Cell high = truth.cell({victim.position.x + reach, victim.position.y + reach});
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        if (!reachable.inside({x, y}) || reachable[{x, y}] == 0) continue;
        const TPoint2D p = truth.centre({x, y});
        if (senses.find(victim, {p.x, p.y, floor.floor_height(p)})) return true;
      }
    return false;
  };
  std::vector<std::string> names;
  for (const arenas::Victim& victim : arena.victims)
    if (!seen_from(victim)) names.push_back(victim.name);
  return names;
}

double visible_share(const arenas::Arena& arena, const robot::RobotModel& model) {
  const OccupancyGrid truth = arenas::truth_map(arena);
  return share_of(truth, arenas::visible_truth(arena, truth, viewer_of(model)));
}

double area_per_minute(const FirstSeen& seen, const OccupancyGrid& visible, const TPose2D& T_map_arena, double end) {
  constexpr double kAll = 0.95;
  const PlanarTransform T(T_map_arena);
  std::vector<double> times;
  std::size_t cells = 0;
  for (int y = 0; y < visible.height(); ++y)
    for (int x = 0; x < visible.width(); ++x) {
      if (visible[{x, y}] != Occupancy::Free) continue;
      ++cells;
      const double time = seen.at(T(visible.centre({x, y})));
      if (std::isfinite(time)) times.push_back(time);
    }
  const auto enough = static_cast<std::size_t>(std::ceil(kAll * static_cast<double>(cells)));
  if (times.size() >= enough && enough > 0) {
    std::sort(times.begin(), times.end());
    end = times[enough - 1];
    times.resize(enough);
  }
  const double area = static_cast<double>(times.size()) * visible.resolution() * visible.resolution();
  return end > 0.0 ? area / (end / 60.0) : 0.0;
}

bool off_the_floor(const arenas::PatchIndex& floor, const TPose2D& T_arena_base) {
  return !std::isfinite(floor.floor_height({T_arena_base.x, T_arena_base.y}));
}

scoring::MissionFigures mission_figures(const arenas::Arena& arena, const Trajectory& truth,
                                        const robot::RobotModel& model, const Core& core,
                                        const OccupancyGrid* known_visible) {
  scoring::MissionFigures out;
  out.end_code = core.explorer() != nullptr ? code_of(core.explorer()->end()) : "time";
  out.drive = drive_figures(arena, truth, model);
  out.end_code = true_end(out.end_code, out.drive.home_m);
  if (!truth.empty() && off_the_floor(arenas::PatchIndex(arena), truth.back().pose)) out.end_code = "fell";
  out.stalls = static_cast<std::uint64_t>(core.stalls());
  out.victims_withdrawn = static_cast<std::uint64_t>(core.victims_withdrawn());
  const OccupancyGrid all = arenas::truth_map(arena);
  const OccupancyGrid visible =
      known_visible != nullptr ? *known_visible : arenas::visible_truth(arena, all, viewer_of(model));
  const double time = truth.empty() ? 0.0 : truth.back().stamp - truth.front().stamp;
  out.area_per_min = area_per_minute(core.first_seen(), visible, arena_in_map(truth, core.mapper()), time);
  out.unseen_victims = unseen_victims(arena, model);
  out.victims_visible = arena.victims.size() - out.unseen_victims.size();
  out.visible_share = share_of(all, visible);
  const scoring::RoomsEntered rooms =
      scoring::rooms_entered(all, arenas::reachable_mask(arena, all, viewer_of(model)), truth);
  out.rooms_reachable = rooms.reachable;
  out.rooms_entered = rooms.entered;
  return out;
}

std::string decisions_text(const Core& core) {
  std::string text;
  if (core.explorer() == nullptr) return text;
  std::vector<explore::Decision> all = core.explorer()->decisions();
  if (const auto& waits = core.waits()) {
    const auto later = [](Stamp stamp, const explore::Decision& decision) { return stamp < decision.stamp; };
    all.insert(std::upper_bound(all.begin(), all.end(), waits->stamp, later), *waits);
  }
  for (const explore::Decision& decision : all) text += decision_line(decision);
  return text;
}

std::string decision_line(const explore::Decision& decision) {
  std::array<char, 24> time{};
  std::snprintf(time.data(), time.size(), "%8.2f ", decision.stamp.seconds());
  return time.data() + decision.why + "\n";
}

}  // namespace rubble::scenarios
