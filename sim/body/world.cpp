#include "sim/body/world.h"

#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "sim/body/chassis.h"
#include "sim/body/clutter.h"
#include "sim/body/obstacles.h"
#include "sim/body/terrain.h"

namespace rubble::sim {
namespace {

constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

PlanOrigin middle(const arenas::Arena& arena) {
  return {0.5 * (arena.min_corner.x + arena.max_corner.x), 0.5 * (arena.min_corner.y + arena.max_corner.y)};
}

/// An upright cylinder as a prism of twelve sides.
void add_cylinder(const Cylinder& cylinder, std::vector<arenas::Face>& faces) {
  constexpr int kSides = 12;
  arenas::Outline outline;
  for (int i = 0; i < kSides; ++i) {
    const double bearing = 2.0 * kPi * i / kSides;
    outline.push_back(
        {cylinder.x + cylinder.radius * std::cos(bearing), cylinder.y + cylinder.radius * std::sin(bearing)});
  }
  arenas::add_prism(outline, cylinder.bottom, cylinder.bottom + cylinder.height, faces);
}

bool is_within(const WorldState& from, double x, double y, double reach) {
  const double dx = x - from.pose.x;
  const double dy = y - from.pose.y;
  return dx * dx + dy * dy < reach * reach;
}

}  // namespace

struct World::Inside {
  Inside(const arenas::Arena& arena, const std::vector<Entrant>& entrants, double step)
      : dt(step),
        origin(middle(arena)),
        terrain(arena, entrants.at(0).model.climbable_step),
        box2d(b2Vec2(0.0f, 0.0f)),
        obstacles(box2d, origin, arena, entrants.at(0).model.climbable_step) {
    box2d.SetContinuousPhysics(false);  // a robot moves 7 mm a step at most
    for (const Entrant& entrant : entrants)
      robots.push_back(
          std::make_unique<Chassis>(box2d, origin, terrain, obstacles, entrant.model, entrant.servos, entrant.start));
    clutter = std::make_unique<Clutter>(box2d, origin, terrain, obstacles, arena.balls, arena.objects);
  }
  ~Inside() { box2d.SetContactListener(nullptr); }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

  /// Others near may come nearer on their own.
  void move_freely() {
    for (std::size_t i = 0; i < robots.size(); ++i) {
      double others = 0.0;
      for (std::size_t k = 0; k < robots.size(); ++k) {
        if (k != i) others = std::max(others, robots[k]->way(dt));
      }
      robots[i]->others_moved(others);
    }
    for (const auto& chassis : robots) chassis->move_freely(dt);
  }

  void move_among_others() {
    for (const auto& chassis : robots) chassis->enter_box2d();
    clutter->brake(dt);
    box2d.Step(static_cast<float>(dt), kVelocityIterations, kPositionIterations);
    const bool clutter_moves = clutter->settle();
    for (const auto& chassis : robots) chassis->leave_box2d(clutter_moves, dt);
  }

  double dt;
  PlanOrigin origin;
  Terrain terrain;
  b2World box2d;
  Obstacles obstacles;
  std::vector<std::unique_ptr<Chassis>> robots;
  std::unique_ptr<Clutter> clutter;
};

World::World(const arenas::Arena& arena, const std::vector<Entrant>& entrants, double step)
    : inside_(std::make_unique<Inside>(arena, entrants, step)) {}

World::World(const arenas::Arena& arena, const robot::RobotModel& model, const ServoParameters& servos, double step)
    : World(arena, {Entrant{model, servos, arena.start}}, step) {}

World::~World() = default;

void World::step() {
  const auto& robots = inside_->robots;
  const double dt = inside_->dt;
  const bool alone = std::all_of(robots.begin(), robots.end(), [](const auto& c) { return c->is_alone(); });
  for (const auto& chassis : robots) chassis->drive(dt);
  if (alone) {
    inside_->move_freely();
  } else {
    inside_->move_among_others();
  }
  for (const auto& chassis : robots) chassis->settle(dt);
}

void World::place(const mrpt::math::TPose2D& pose, std::size_t robot) { inside_->robots[robot]->place(pose); }
std::size_t World::robots() const { return inside_->robots.size(); }
const WorldState& World::state(std::size_t robot) const { return inside_->robots[robot]->state(); }
const Drive& World::drive(std::size_t robot) const { return inside_->robots[robot]->wheels(); }
Firmware& World::firmware(std::size_t robot) { return inside_->robots[robot]->firmware(); }
Servos& World::servos(std::size_t robot) { return inside_->robots[robot]->servos(); }
const std::vector<Sphere>& World::spheres() const { return inside_->clutter->spheres(); }
std::vector<arenas::PaperBall> World::balls() const { return inside_->clutter->balls(); }
std::vector<arenas::LooseObject> World::objects() const { return inside_->clutter->objects(); }

std::vector<arenas::Face> World::moving_faces(std::size_t seen_by, double range) const {
  std::vector<arenas::Face> faces;
  const auto& robots = inside_->robots;
  const WorldState& from = robots[seen_by]->state();
  for (const Cylinder& cylinder : inside_->clutter->cylinders()) {
    if (is_within(from, cylinder.x, cylinder.y, range)) add_cylinder(cylinder, faces);
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const mrpt::math::TPose2D& pose = robots[i]->state().pose;
    if (i != seen_by && is_within(from, pose.x, pose.y, range)) robots[i]->add_shell(faces);
  }
  return faces;
}

}  // namespace rubble::sim
