#pragma once

#include <box2d/box2d.h>

#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::sim {

/// From which height to which something stands [m].
struct HeightBand {
  double bottom = 0.0;
  double top = 0.0;
};

/// Metres to Box2D's floats, about an origin in the middle of the arena so that they keep micrometres.
struct PlanOrigin {
  double x = 0.0;
  double y = 0.0;
  b2Vec2 to_box2d(const mrpt::math::TPoint2D& p) const {
    return {static_cast<float>(p.x - x), static_cast<float>(p.y - y)};
  }
  mrpt::math::TPoint2D from_box2d(const b2Vec2& p) const {
    return {static_cast<double>(p.x) + x, static_cast<double>(p.y) + y};
  }
};

/// All that stands still in the plan: solids, and the edges of steps too high to climb. Box2D knows no heights, so a
/// contact counts only where the height bands of both partners overlap: the robot passes under a hanging wall, and the
/// wall below an elevated floor does not stop it up there.
class Obstacles : public b2ContactListener {
 public:
  /// Adds one static body to `world` and becomes its contact listener. `climbable_step` [m].
  Obstacles(b2World& world, const PlanOrigin& origin, const arenas::Arena& arena, double climbable_step);

  /// Registers a moving body's band; the returned handle goes into the user data of its fixtures.
  std::uintptr_t add_moving(const HeightBand& band);
  void move(std::uintptr_t handle, const HeightBand& band) { bands_[handle - 1] = band; }

  /// Takes out contacts whose bands do not overlap.
  void PreSolve(b2Contact* contact, const b2Manifold* old_manifold) override;
  /// Whether the two bands overlap.
  bool meet(b2Contact& contact) const;

 private:
  void add_fixture(const b2Shape& shape, const HeightBand& band);

  std::vector<HeightBand> bands_;
  b2Body* body_ = nullptr;
};

}  // namespace rubble::sim
