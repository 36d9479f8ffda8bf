#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// An element's own frame: origin in the middle of its pallet, walls on the edge y = +0.6 m.
class ElementFrame {
 public:
  /// rotation: clockwise [rad].
  ElementFrame(const mrpt::math::TPoint2D& origin, double rotation);

  mrpt::math::TPoint2D point(double x, double y) const;
  Outline outline(const Outline& own) const;
  /// The rectangle between two corners in the own frame.
  Outline box(double x0, double y0, double x1, double y1) const;
  /// Bearing of the own +y axis in the arena [rad].
  double forward() const;

 private:
  mrpt::math::TPoint2D origin_;
  double cos_;
  double sin_;
};

/// A rectangular hole in a wall: its middle along the wall and above the ground, its size [m].
struct Opening {
  double along, height, width, tall;
};

/// Where a box hangs at its wall: along the wall and above the ground [m].
struct Mount {
  double along, height;
};

void add_wall(const ElementFrame& frame, double height, const std::vector<Opening>& openings, Arena& arena);
/// The half of a wall to the right of the middle, seen from the pallet.
void add_half_wall(const ElementFrame& frame, Arena& arena);
/// From corner to corner of the pallet.
void add_diagonal_wall(const ElementFrame& frame, Arena& arena);
/// From the two corners at +y to the middle.
void add_corner_wall(const ElementFrame& frame, Arena& arena);
/// A lath with strips that hang down to the floor and give way.
void add_veil(const ElementFrame& frame, Arena& arena);
/// A ramp as wide as the pallet that rises by `rise` from foot_y to head_y.
void add_ramp(const ElementFrame& frame, double foot_y, double head_y, double rise, Arena& arena);
/// Flat, closed below. height: above the ground [m].
void add_elevated_floor(const ElementFrame& frame, double height, Arena& arena);
/// A ramp over the whole pallet that rises towards +x: driven along +y, it rolls the robot.
void add_roll_ramp(const ElementFrame& frame, double slope, Arena& arena);
/// A block of 0.10 x 0.30 x 0.10 m to drive over.
void add_wooden_block(const ElementFrame& frame, Arena& arena);
/// Something round that stands in the middle of the pallet.
void add_post(const ElementFrame& frame, double radius, double height, const std::string& element, Arena& arena);
/// A doll without a box.
void add_free_victim(const ElementFrame& frame, Arena& arena);
void add_stairs(const ElementFrame& frame, Arena& arena);
/// Half of a barrel that leans on the wall at +y, 0.89 m tall from `bottom` up.
void add_half_barrel(const ElementFrame& frame, double bottom, Arena& arena);
void add_shelves(const ElementFrame& frame, Arena& arena);
void add_spectator(const ElementFrame& frame, Arena& arena);
/// A box behind the wall at +y, open to the wall; the victim looks through the hole.
void add_hung_victim(const ElementFrame& frame, const Mount& mount, bool heat, bool sound, bool co2, Arena& arena);

}  // namespace rubble::arenas
