#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstdint>
#include <string>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

constexpr double kBoardThickness = 0.01;   ///< of walls [m]
constexpr double kSheetThickness = 0.015;  ///< of victims' boxes [m]
constexpr double kPlateThickness = 0.02;   ///< of floors and treads that are open below [m]

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

/// A box that stands or hangs, between two corners in the own frame. gives_way: the laser sees it, the robot pushes it
/// aside.
void add_block(const ElementFrame& frame, double x0, double y0, double x1, double y1, double bottom, double top,
               const std::string& element, Arena& arena, bool gives_way = false);
/// A level floor at height z to drive on, closed below.
void add_platform(const ElementFrame& frame, double x0, double y0, double x1, double y1, double z,
                  const std::string& element, Arena& arena);

void add_wall(const ElementFrame& frame, double height, const std::vector<Opening>& openings, Arena& arena);
/// A board of 1.0 m: a gap of 0.1 m stays to either side.
void add_narrow_wall(const ElementFrame& frame, Arena& arena);
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
/// The same as a plate that is open below. No wheel stands on it, and the robot drives under it.
void add_open_floor(const ElementFrame& frame, double height, Arena& arena);
/// A ramp over the whole pallet that rises towards +x: driven along +y, it rolls the robot.
void add_roll_ramp(const ElementFrame& frame, double slope, Arena& arena);
/// A block of 0.10 x 0.30 x 0.10 m to drive over.
void add_wooden_block(const ElementFrame& frame, Arena& arena);
/// Something round that stands in the middle of the pallet.
void add_post(const ElementFrame& frame, double radius, double height, const std::string& element, Arena& arena);
/// A cube of 0.4 m that hangs 0.2 m above the ground, open to +y, with the victim in its middle.
void add_cube_victim(const ElementFrame& frame, Arena& arena);
/// Treads at 0.23, 0.43, ... 1.03 m, rising towards +y; open below they are plates, and no floor.
void add_stairs(const ElementFrame& frame, bool open_below, Arena& arena);
/// Half of a barrel that leans on the wall at +y, 0.89 m tall from `bottom` up.
void add_half_barrel(const ElementFrame& frame, double bottom, const std::string& element, Arena& arena);
/// Stands at the wall at +y.
void add_fire_extinguisher(const ElementFrame& frame, Arena& arena);
void add_shelves(const ElementFrame& frame, Arena& arena);
void add_spectator(const ElementFrame& frame, Arena& arena);
/// A box with a lid behind the wall at +y, open to the wall; the victim looks through the hole. What would be below the
/// ground is left out.
void add_hung_victim(const ElementFrame& frame, const Mount& mount, bool heat, bool sound, bool co2, Arena& arena);

/// 10 x 10 columns of 0.1 m in a frame of 50 mm planks: the diagonal is `tallest` high, the others 0 to 3 quarters of
/// it in the league's counts, as `thrown` (a seed) has them fall, all on a base. Red 0.4 m on 0.05 m, orange 0.2 m on
/// the ground.
void add_step_field(const ElementFrame& frame, double tallest, double base, std::uint64_t thrown, Arena& arena);
/// Four ramps of half a pallet that rise in turn, each to the side the next begins at: their floors agree nowhere.
/// slope: rise per metre.
void add_crossing_ramps(const ElementFrame& frame, double slope, Arena& arena);
/// Four half ramps that rise in turn, two on the ground and two one rise higher.
void add_elevated_ramps(const ElementFrame& frame, double slope, Arena& arena);
/// A ceiling over the pallet from 0.60 to 0.62 m, a wall of 1.2 m above it to either side: the ways in are at +y and
/// -y.
void add_tunnel(const ElementFrame& frame, Arena& arena);

/// Adds a victim in the middle of its box: a back, two sides and a lid of 15 mm board, open to `facing`.
/// The boards reach from the lowest floor below the box to `size` above the highest. position.z of `victim` is taken
/// as height above the floor there and is replaced by the absolute height. size [m] 0: no box.
void add_victim(Arena& arena, Victim victim, double size = 0.4);

}  // namespace rubble::arenas
