#include "sim/body/clutter.h"

#include <algorithm>
#include <cmath>

#include "robot/hardware_units.h"

namespace rubble::sim {
namespace {

constexpr double kFloorFriction = 0.3;  ///< crumpled paper on wood
constexpr double kLightest = 0.1;       ///< lighter bodies make the contact with a 14 kg robot ill-conditioned [kg]

}  // namespace

Clutter::Clutter(b2World& world, const PlanOrigin& origin, const Terrain& terrain, Obstacles& obstacles,
                 const std::vector<arenas::PaperBall>& balls, const std::vector<arenas::LooseObject>& objects)
    : origin_(origin),
      terrain_(terrain),
      obstacles_(obstacles),
      initial_(balls),
      objects_(objects),
      spheres_(balls.size()),
      cylinders_(objects.size()) {
  for (const arenas::PaperBall& ball : balls) add(world, ball.position, ball.radius, ball.mass);
  for (const arenas::LooseObject& object : objects) add(world, object.position, object.radius, object.mass);
}

void Clutter::add(b2World& world, const mrpt::math::TPoint2D& position, double radius, double mass) {
  const std::size_t i = bodies_.size();
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  definition.position = origin_.to_box2d(position);
  definition.angularDamping = 5.0f;
  definition.awake = false;
  bodies_.push_back(world.CreateBody(&definition));
  b2CircleShape shape;
  shape.m_radius = static_cast<float>(radius);
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = 0.3f;
  fixture.density = static_cast<float>(std::max(kLightest, mass)) / (b2_pi * shape.m_radius * shape.m_radius);
  handles_.push_back(obstacles_.add_moving({}));
  fixture.userData.pointer = handles_[i];
  bodies_[i]->CreateFixture(&fixture);
  place(i);
}

void Clutter::brake(double dt) {
  const float loss = static_cast<float>(kFloorFriction * robot::kGravity * dt);
  for (b2Body* body : bodies_) {
    if (!body->IsAwake()) continue;
    const b2Vec2 v = body->GetLinearVelocity();
    const float speed = v.Length();
    if (speed == 0.0f) continue;
    const float left = std::max(0.0f, speed - loss) / speed;
    body->SetLinearVelocity({left * v.x, left * v.y});
  }
}

bool Clutter::settle() {
  bool moving = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i]->IsAwake()) continue;
    moving = true;
    place(i);
  }
  return moving;
}

void Clutter::place(std::size_t i) {
  const mrpt::math::TPoint2D p = origin_.from_box2d(bodies_[i]->GetPosition());
  const double floor = terrain_.at(p).height;
  if (i < spheres_.size()) {
    const double radius = initial_[i].radius;
    spheres_[i] = {p.x, p.y, floor + radius, radius};
    obstacles_.move(handles_[i], {floor, floor + 2.0 * radius});
    return;
  }
  const std::size_t k = i - spheres_.size();
  cylinders_[k] = {p.x, p.y, floor, objects_[k].height, objects_[k].radius};
  obstacles_.move(handles_[i], {floor, floor + objects_[k].height});
}

std::vector<arenas::PaperBall> Clutter::balls() const {
  std::vector<arenas::PaperBall> balls = initial_;
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i].position = {spheres_[i].x, spheres_[i].y};
  return balls;
}

std::vector<arenas::LooseObject> Clutter::objects() const {
  std::vector<arenas::LooseObject> objects = objects_;
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].position = {cylinders_[i].x, cylinders_[i].y};
  return objects;
}

}  // namespace rubble::sim
