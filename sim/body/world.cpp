#include "sim/body/world.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

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

World::World(const arenas::Arena& arena, const std::vector<Entrant>& entrants, double step)
    : dt_(step),
      origin_(middle(arena)),
      terrain_(arena, entrants.at(0).model.climbable_step),
      box2d_(b2Vec2(0.0f, 0.0f)),
      obstacles_(box2d_, origin_, arena, entrants.at(0).model.climbable_step) {
  box2d_.SetContinuousPhysics(false);  // a robot moves 7 mm a step at most
  for (const Entrant& entrant : entrants) {
    chassis_.push_back(
        std::make_unique<Chassis>(box2d_, origin_, terrain_, obstacles_, entrant.model, entrant.servos, entrant.start));
  }
  clutter_ = std::make_unique<Clutter>(box2d_, origin_, terrain_, obstacles_, arena.balls, arena.objects);
}

World::World(const arenas::Arena& arena, const robot::RobotModel& model, const ServoParameters& servos, double step)
    : World(arena, {Entrant{model, servos, arena.start}}, step) {}

World::~World() { box2d_.SetContactListener(nullptr); }

/// Others near may come nearer on their own.
void World::move_freely() {
  for (std::size_t i = 0; i < chassis_.size(); ++i) {
    double others = 0.0;
    for (std::size_t k = 0; k < chassis_.size(); ++k) {
      if (k != i) others = std::max(others, chassis_[k]->way(dt_));
    }
    chassis_[i]->others_moved(others);
  }
  for (const auto& chassis : chassis_) chassis->move_freely(dt_);
}

void World::move_among_others() {
  for (const auto& chassis : chassis_) chassis->enter_box2d();
  clutter_->brake(dt_);
  box2d_.Step(static_cast<float>(dt_), kVelocityIterations, kPositionIterations);
  const bool clutter_moves = clutter_->settle();
  for (const auto& chassis : chassis_) chassis->leave_box2d(clutter_moves, dt_);
}

void World::step() {
  const bool alone = std::all_of(chassis_.begin(), chassis_.end(), [](const auto& c) { return c->is_alone(); });
  for (const auto& chassis : chassis_) chassis->drive(dt_);
  if (alone) {
    move_freely();
  } else {
    move_among_others();
  }
  for (const auto& chassis : chassis_) chassis->settle(dt_);
}

std::vector<arenas::Face> World::moving_faces(std::size_t seen_by, double range) const {
  std::vector<arenas::Face> faces;
  const WorldState& from = chassis_[seen_by]->state();
  for (const Cylinder& cylinder : clutter_->cylinders()) {
    if (is_within(from, cylinder.x, cylinder.y, range)) add_cylinder(cylinder, faces);
  }
  for (std::size_t i = 0; i < chassis_.size(); ++i) {
    const mrpt::math::TPose2D& pose = chassis_[i]->state().pose;
    if (i != seen_by && is_within(from, pose.x, pose.y, range)) chassis_[i]->add_shell(faces);
  }
  return faces;
}

}  // namespace rubble::sim
