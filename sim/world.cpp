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
constexpr double kLookAround = 0.3;   ///< farther things are not looked for [m]
constexpr double kTouch = 0.05;       ///< nearer things are Box2D's: 0.7 m/s and 1.7 rad/s make 14 mm a step [m]
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

/// How far the robot's swing circle is from all others' bounding boxes, up to kLookAround [m].
double World::clearance() const {
  class Nearest : public b2QueryCallback {
   public:
    Nearest(const b2Vec2& centre, const b2Body* own) : centre_(centre), own_(own) {}
    bool ReportFixture(b2Fixture* fixture) override {
      if (fixture->GetBody() == own_) return true;
      const b2AABB& box = fixture->GetAABB(0);
      const b2Vec2 outside = b2Max(b2Max(box.lowerBound - centre_, centre_ - box.upperBound), b2Vec2(0.0f, 0.0f));
      nearest = std::min(nearest, static_cast<double>(outside.Length()));
      return true;
    }
    double nearest = 1e9;

   private:
    b2Vec2 centre_;
    const b2Body* own_;
  };
  const float reach = static_cast<float>(model_.swing_radius() + kLookAround);
  Nearest nearest(body_->GetPosition(), body_);
  b2AABB around;
  around.lowerBound = body_->GetPosition() - b2Vec2(reach, reach);
  around.upperBound = body_->GetPosition() + b2Vec2(reach, reach);
  box2d_.QueryAABB(&nearest, around);
  return std::min(kLookAround, nearest.nearest - model_.swing_radius());
}

void World::move_freely(const PlanVelocity& velocity) {
  moved_freely_ = true;
  state_.velocity = velocity;
  state_.pose.x += velocity.x * dt_;
  state_.pose.y += velocity.y * dt_;
  state_.pose.phi = wrap_angle(state_.pose.phi + velocity.w * dt_);
  free_way_ -= (std::hypot(velocity.x, velocity.y) + std::abs(velocity.w) * model_.swing_radius()) * dt_;
}

void World::move_among_others(const PlanVelocity& velocity) {
  if (moved_freely_) {
    body_->SetTransform(origin_.to_box2d({state_.pose.x, state_.pose.y}), static_cast<float>(state_.pose.phi));
    moved_freely_ = false;
  }
  body_->SetLinearVelocity({static_cast<float>(velocity.x), static_cast<float>(velocity.y)});
  body_->SetAngularVelocity(static_cast<float>(velocity.w));
  clutter_->brake(dt_);
  box2d_.Step(static_cast<float>(dt_), kVelocityIterations, kPositionIterations);
  const bool balls_move = clutter_->settle();

  const TPoint2D position = origin_.from_box2d(body_->GetPosition());
  state_.pose = {position.x, position.y, wrap_angle(static_cast<double>(body_->GetAngle()))};
  const b2Vec2 after = body_->GetLinearVelocity();
  state_.velocity = {static_cast<double>(after.x), static_cast<double>(after.y),
                     static_cast<double>(body_->GetAngularVelocity())};
  free_way_ = balls_move ? 0.0 : clearance() - kTouch;
}

void World::step() {
  const bool alone = free_way_ > 0.0;
  if (alone) {
    stops_.clear();
  } else {
    find_stops();
  }
  const PlanVelocity driven = drive_.step(state_.pose, ground_, state_.velocity, firmware_.demand(dt_), stops_, dt_);
  firmware_.observe(drive_.left(), drive_.right(), dt_);
  if (alone) {
    move_freely(driven);
  } else {
    move_among_others(driven);
  }
  ground_ = ground_under(terrain_, model_, state_.pose);
  attitude_.step(stance_on(ground_, model_), dt_);
  state_.stance = attitude_.stance();
  obstacles_.move(body_handle_, robot_band());
  servos_.step(static_cast<int>(std::lround(dt_ * 1e3)));
  state_.aim = servos_.angles();
  state_.stamp = state_.stamp + dt_;
}

}  // namespace rubble::sim
