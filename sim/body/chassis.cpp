#include "sim/body/chassis.h"

#include <box2d/b2_distance.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "robot/body.h"

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kLookAround = 0.3;  ///< farther things are not looked for [m]
constexpr float kSurelyFar = 0.1f;   ///< a way that lasts for twenty steps and more need not be known exactly [m]
/// Two Box2D polygons keep a gap of both skins less the slop; the body is drawn smaller by it.
constexpr double kSkin = 2.0 * static_cast<double>(b2_polygonRadius) - static_cast<double>(b2_linearSlop);

b2PolygonShape body_shape(const robot::RobotModel& model) {
  const std::array<b2Vec2, 8> corners = robot::body_outline<b2Vec2, float>(model, kSkin);
  b2PolygonShape shape;
  shape.Set(corners.data(), static_cast<int32>(corners.size()));
  return shape;
}

}  // namespace

Chassis::Chassis(b2World& box2d, const PlanOrigin& origin, const Terrain& terrain, Obstacles& obstacles,
                 const robot::RobotModel& model, const ServoParameters& servos, const TPose2D& start)
    : box2d_(box2d),
      origin_(origin),
      terrain_(terrain),
      obstacles_(obstacles),
      model_(model),
      drive_(model),
      firmware_(model),
      servos_(servos),
      ground_(ground_under(terrain_, model, start)),
      attitude_(stance_on(ground_, model)) {
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  definition.position = origin_.to_box2d({start.x, start.y});
  definition.angle = static_cast<float>(start.phi);
  definition.allowSleep = false;
  body_ = box2d_.CreateBody(&definition);
  const b2PolygonShape shape = body_shape(model);
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = 0.3f;
  state_.pose = start;
  state_.stance = attitude_.stance();
  body_handle_ = obstacles_.add_moving(band());
  fixture.userData.pointer = body_handle_;
  body_->CreateFixture(&fixture);
  const b2MassData mass{static_cast<float>(model.mass), b2Vec2(0.0f, 0.0f), static_cast<float>(drive_.yaw_inertia())};
  body_->SetMassData(&mass);
}

HeightBand Chassis::band() const {
  return {state_.stance.z, state_.stance.z + model_.T_base_laser.z + robot::kAboveLaser};
}

/// Walls and edges the body leans on, from Box2D's contacts of the last step: the wheels have to know them, or they
/// would turn against a wall as if it were not there.
void Chassis::find_stops() {
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

/// How far the outline moves in a step at the most [m].
double Chassis::most_way(double dt) const {
  return std::max(way(dt), (model_.max_v + model_.max_w * model_.swing_radius()) * dt);
}

/// How far the body can go before it touches anything that rests or takes a step, up to kLookAround [m]. Bounding boxes
/// and the body's swing circle tell what is far; the outlines themselves only what is not.
double Chassis::clearance(double dt) const {
  class Nearest : public b2QueryCallback {
   public:
    Nearest(const b2Body& own, double swing_radius, double step)
        : own_(own), swing_(static_cast<float>(swing_radius)), step_(static_cast<float>(step)) {
      around_.Set(own.GetFixtureList()->GetShape(), 0);
    }
    bool ReportFixture(b2Fixture* fixture) override {
      if (fixture->GetBody() == &own_) return true;
      const b2AABB& box = fixture->GetAABB(0);
      const b2Vec2& centre = own_.GetPosition();
      const b2Vec2 outside = b2Max(b2Max(box.lowerBound - centre, centre - box.upperBound), b2Vec2(0.0f, 0.0f));
      const bool moves = fixture->GetBody()->GetType() == b2_dynamicBody && fixture->GetBody()->IsAwake();
      const float approach = moves ? step_ : 0.0f;
      const float boxes = outside.Length() - swing_ - approach;
      if (boxes >= nearest) return true;
      nearest = std::min(nearest, boxes > kSurelyFar ? boxes : outlines(*fixture) - approach);
      return true;
    }
    float nearest = static_cast<float>(kLookAround);

   private:
    float outlines(const b2Fixture& fixture) const {
      b2DistanceInput input;
      input.proxyA = around_;
      input.proxyB.Set(fixture.GetShape(), 0);
      input.transformA = own_.GetTransform();
      input.transformB = fixture.GetBody()->GetTransform();
      input.useRadii = true;
      b2SimplexCache cache;
      cache.count = 0;
      b2DistanceOutput output;
      b2Distance(&output, &cache, &input);
      return output.distance;
    }

    const b2Body& own_;
    float swing_, step_;
    b2DistanceProxy around_;
  };
  const float reach = static_cast<float>(model_.swing_radius() + kLookAround);
  Nearest nearest(*body_, model_.swing_radius(), most_way(dt));
  b2AABB around;
  around.lowerBound = body_->GetPosition() - b2Vec2(reach, reach);
  around.upperBound = body_->GetPosition() + b2Vec2(reach, reach);
  box2d_.QueryAABB(&nearest, around);
  return static_cast<double>(nearest.nearest);
}

void Chassis::drive(double dt) {
  if (is_alone()) {
    stops_.clear();
  } else {
    find_stops();
  }
  driven_ = drive_.step(state_.pose, ground_, state_.velocity, firmware_.demand(dt), stops_, dt);
  firmware_.observe(drive_.left(), drive_.right(), dt);
}

double Chassis::way(double dt) const {
  return (std::hypot(driven_.x, driven_.y) + std::abs(driven_.w) * model_.swing_radius()) * dt;
}

void Chassis::move_freely(double dt) {
  moved_freely_ = true;
  state_.velocity = driven_;
  state_.pose.x += driven_.x * dt;
  state_.pose.y += driven_.y * dt;
  state_.pose.phi = wrap_angle(state_.pose.phi + driven_.w * dt);
  free_way_ -= way(dt);
}

void Chassis::enter_box2d() {
  if (moved_freely_) {
    body_->SetTransform(origin_.to_box2d({state_.pose.x, state_.pose.y}), static_cast<float>(state_.pose.phi));
    moved_freely_ = false;
  }
  body_->SetLinearVelocity({static_cast<float>(driven_.x), static_cast<float>(driven_.y)});
  body_->SetAngularVelocity(static_cast<float>(driven_.w));
}

void Chassis::leave_box2d(bool others_move, double dt) {
  const TPoint2D position = origin_.from_box2d(body_->GetPosition());
  state_.pose = {position.x, position.y, wrap_angle(static_cast<double>(body_->GetAngle()))};
  const b2Vec2 after = body_->GetLinearVelocity();
  state_.velocity = {static_cast<double>(after.x), static_cast<double>(after.y),
                     static_cast<double>(body_->GetAngularVelocity())};
  free_way_ = others_move ? 0.0 : clearance(dt) - most_way(dt);
}

void Chassis::settle(double dt) {
  ground_ = ground_under(terrain_, model_, state_.pose);
  attitude_.step(stance_on(ground_, model_), dt);
  state_.stance = attitude_.stance();
  obstacles_.move(body_handle_, band());
  servos_.step(static_cast<int>(std::lround(dt * 1e3)));
  state_.aim = servos_.angles();
  state_.stamp = state_.stamp + dt;
}

void Chassis::place(const TPose2D& pose) {
  state_.pose = pose;
  state_.velocity = driven_ = {};
  ground_ = ground_under(terrain_, model_, pose);
  attitude_ = Attitude(stance_on(ground_, model_));
  state_.stance = attitude_.stance();
  obstacles_.move(body_handle_, band());
  stops_.clear();
  free_way_ = 0.0;
  moved_freely_ = true;
  enter_box2d();
}

void Chassis::add_shell(std::vector<arenas::Face>& faces) const {
  const HeightBand height = band();
  const double c = std::cos(state_.pose.phi);
  const double s = std::sin(state_.pose.phi);
  arenas::Outline outline;
  for (const b2Vec2& corner : robot::body_outline<b2Vec2, float>(model_)) {
    const double x = static_cast<double>(corner.x);
    const double y = static_cast<double>(corner.y);
    outline.push_back({state_.pose.x + c * x - s * y, state_.pose.y + s * x + c * y});
  }
  arenas::add_prism(outline, height.bottom, height.top, faces);
}

}  // namespace rubble::sim
