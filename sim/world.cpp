#include "sim/world.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.h"

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;
constexpr double kAboveLaser = 0.05;  ///< the laser's housing ends so far above its beams [m]
/// Two Box2D polygons keep a gap of both skins less the slop; the body is drawn smaller by it.
constexpr double kSkin = 2.0 * static_cast<double>(b2_polygonRadius) - static_cast<double>(b2_linearSlop);

PlanOrigin middle(const arenas::Arena& arena) {
  return {0.5 * (arena.min_corner.x + arena.max_corner.x), 0.5 * (arena.min_corner.y + arena.max_corner.y)};
}

/// The body from above: a rectangle whose corners are cut by a tenth of the length.
b2PolygonShape body_shape(const robot::RobotModel& model) {
  const float x = static_cast<float>(0.5 * model.length - kSkin);
  const float y = static_cast<float>(0.5 * model.width - kSkin);
  const float cut = static_cast<float>(0.1 * model.length);
  const std::array<b2Vec2, 8> corners{b2Vec2{x, y - cut},  b2Vec2{x - cut, y},  b2Vec2{cut - x, y},
                                      b2Vec2{-x, y - cut}, b2Vec2{-x, cut - y}, b2Vec2{cut - x, -y},
                                      b2Vec2{x - cut, -y}, b2Vec2{x, cut - y}};
  b2PolygonShape shape;
  shape.Set(corners.data(), static_cast<int32>(corners.size()));
  return shape;
}

}  // namespace

World::World(const arenas::Arena& arena, const robot::RobotModel& model, const ServoParameters& servos, double step)
    : model_(model),
      dt_(step),
      origin_(middle(arena)),
      terrain_(arena, model.climbable_step),
      box2d_(b2Vec2(0.0f, 0.0f)),
      obstacles_(box2d_, origin_, arena, model.climbable_step),
      drive_(model),
      firmware_(model),
      servos_(servos),
      ground_(ground_under(terrain_, model, arena.start)),
      attitude_(stance_on(ground_, model)) {
  box2d_.SetContinuousPhysics(false);  // the robot moves 7 mm a step at most
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  definition.position = origin_.to_box2d({arena.start.x, arena.start.y});
  definition.angle = static_cast<float>(arena.start.phi);
  definition.allowSleep = false;
  body_ = box2d_.CreateBody(&definition);
  const b2PolygonShape shape = body_shape(model);
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = 0.3f;
  state_.pose = arena.start;
  state_.stance = attitude_.stance();
  body_handle_ = obstacles_.add_moving(robot_band());
  fixture.userData.pointer = body_handle_;
  body_->CreateFixture(&fixture);
  const b2MassData mass{static_cast<float>(model.mass), b2Vec2(0.0f, 0.0f), static_cast<float>(drive_.yaw_inertia())};
  body_->SetMassData(&mass);
  clutter_ = std::make_unique<Clutter>(box2d_, origin_, terrain_, obstacles_, arena.balls);
}

World::~World() { box2d_.SetContactListener(nullptr); }

HeightBand World::robot_band() const {
  return {state_.stance.z, state_.stance.z + model_.T_base_laser.z + kAboveLaser};
}

/// Walls and edges the body leans on, from Box2D's contacts of the last step: the wheels have to know them, or they
/// would turn against a wall as if it were not there.
void World::find_stops() {
  stops_.clear();
  for (b2ContactEdge* edge = body_->GetContactList(); edge != nullptr; edge = edge->next) {
    b2Contact* contact = edge->contact;
    if (!contact->IsTouching() || edge->other->GetType() != b2_staticBody || !obstacles_.meet(*contact)) continue;
    b2WorldManifold manifold;
    contact->GetWorldManifold(&manifold);
    const double sign = contact->GetFixtureB()->GetBody() == body_ ? 1.0 : -1.0;
    const TPoint2D normal{sign * static_cast<double>(manifold.normal.x), sign * static_cast<double>(manifold.normal.y)};
    for (int i = 0; i < contact->GetManifold()->pointCount; ++i) {
      stops_.push_back({origin_.from_box2d(manifold.points[i]), normal});
    }
  }
}

void World::step() {
  const b2Vec2 v = body_->GetLinearVelocity();
  const PlanVelocity before{static_cast<double>(v.x), static_cast<double>(v.y),
                            static_cast<double>(body_->GetAngularVelocity())};
  find_stops();
  const PlanVelocity driven = drive_.step(state_.pose, ground_, before, firmware_.demand(dt_), stops_, dt_);
  firmware_.observe(drive_.left(), drive_.right(), dt_);
  body_->SetLinearVelocity({static_cast<float>(driven.x), static_cast<float>(driven.y)});
  body_->SetAngularVelocity(static_cast<float>(driven.w));
  clutter_->brake(dt_);
  box2d_.Step(static_cast<float>(dt_), kVelocityIterations, kPositionIterations);
  clutter_->settle();

  const TPoint2D position = origin_.from_box2d(body_->GetPosition());
  state_.pose = {position.x, position.y, wrap_angle(static_cast<double>(body_->GetAngle()))};
  const b2Vec2 after = body_->GetLinearVelocity();
  state_.velocity = {static_cast<double>(after.x), static_cast<double>(after.y),
                     static_cast<double>(body_->GetAngularVelocity())};
  ground_ = ground_under(terrain_, model_, state_.pose);
  attitude_.step(stance_on(ground_, model_), dt_);
  state_.stance = attitude_.stance();
  obstacles_.move(body_handle_, robot_band());
  servos_.step(static_cast<int>(std::lround(dt_ * 1e3)));
  state_.aim = servos_.angles();
  state_.stamp = state_.stamp + dt_;
}

}  // namespace rubble::sim
