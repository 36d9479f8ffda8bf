#include "sim/body/obstacles.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/rims.h"
#include "arenas/model/risers.h"
#include "robot/body.h"

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;

constexpr float kWallFriction = 0.3f;  ///< body against wall

}  // namespace

Obstacles::Obstacles(b2World& world, const PlanOrigin& origin, const arenas::Arena& arena, double climbable_step) {
  b2BodyDef definition;
  body_ = world.CreateBody(&definition);
  for (const arenas::Solid& solid : arena.solids) {
    if (solid.gives_way) continue;  // veil strips: the laser sees them, the robot passes
    // Box2D polygons take at most eight corners: a fan of pieces serves outlines with more.
    const std::size_t n = solid.outline.size();
    for (std::size_t first = 1; first + 1 < n; first += b2_maxPolygonVertices - 2) {
      std::vector<b2Vec2> corners{origin.to_box2d(solid.outline[0])};
      const std::size_t last = std::min(first + b2_maxPolygonVertices - 2, n - 1);
      for (std::size_t i = first; i <= last; ++i) corners.push_back(origin.to_box2d(solid.outline[i]));
      b2PolygonShape shape;
      shape.Set(corners.data(), static_cast<int32>(corners.size()));
      add_fixture(shape, {solid.z_bottom, solid.z_top});
    }
  }
  for (const arenas::Riser& riser : arenas::risers(arena, climbable_step)) {
    const arenas::Stretch stretch = arenas::too_high(riser, climbable_step);
    if (stretch.to - stretch.from < 1e-6) continue;
    const TPoint2D along = riser.b - riser.a;
    b2EdgeShape shape;
    shape.SetTwoSided(origin.to_box2d(riser.a + along * stretch.from), origin.to_box2d(riser.a + along * stretch.to));
    // From above the edge stops the robot too: driving off a cliff is not simulated.
    add_fixture(shape,
                {std::min(riser.low_a, riser.low_b), std::max(riser.high_a, riser.high_b) + 2.0 * robot::kGraze});
  }
  // So does the rim, where there is nothing to drive on: a kerb.
  for (const arenas::Rim& rim : arenas::open_rims(arena, climbable_step)) {
    b2EdgeShape shape;
    shape.SetTwoSided(origin.to_box2d(rim.a), origin.to_box2d(rim.b));
    add_fixture(shape, {std::min(rim.z_a, rim.z_b), std::max(rim.z_a, rim.z_b) + 2.0 * robot::kGraze});
  }
  world.SetContactListener(this);
}

void Obstacles::add_fixture(const b2Shape& shape, const HeightBand& band) {
  b2FixtureDef definition;
  definition.shape = &shape;
  definition.friction = kWallFriction;
  definition.userData.pointer = add_moving(band);
  body_->CreateFixture(&definition);
}

std::uintptr_t Obstacles::add_moving(const HeightBand& band) {
  bands_.push_back(band);
  return bands_.size();
}

bool Obstacles::meet(b2Contact& contact) const {
  const HeightBand& a = bands_[contact.GetFixtureA()->GetUserData().pointer - 1];
  const HeightBand& b = bands_[contact.GetFixtureB()->GetUserData().pointer - 1];
  return std::min(a.top, b.top) - std::max(a.bottom, b.bottom) > robot::kGraze;
}

void Obstacles::PreSolve(b2Contact* contact, const b2Manifold* /*old_manifold*/) {
  if (!meet(*contact)) contact->SetEnabled(false);
}

}  // namespace rubble::sim
