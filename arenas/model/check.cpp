#include <algorithm>
#include <cmath>
#include <set>

#include "arenas/model/arena.h"
#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "base/angle.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using Trouble = std::optional<std::string>;

constexpr double kRobotHeight = 0.5;     ///< body with lidar: what a solid must not reach into at the start [m]
constexpr double kClimbableStep = 0.10;  ///< Pioneer 3-AT data sheet [m]
constexpr double kLargest = 500.0;       ///< an arena beyond this was drawn in another unit [m]
constexpr double kBesideFloor = 10.0;    ///< farther away nothing can be seen from the arena [m]
constexpr double kSteepest = deg_to_rad(60.0);

/// Two decimals, a point in any locale.
std::string metres(double value) {
  const long long centi = std::llround(std::abs(value) * 100.0);
  const std::string digits = std::to_string(centi % 100);
  return (value < 0.0 && centi > 0 ? "-" : "") + std::to_string(centi / 100) + "." +
         (digits.size() < 2 ? "0" + digits : digits);
}

std::string place(const TPoint2D& p) { return "(" + metres(p.x) + ", " + metres(p.y) + ")"; }

Trouble outline_trouble(const Outline& outline, const std::string& what) {
  for (const TPoint2D& p : outline) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return what + " has a corner that is not a number";
    if (std::max(std::abs(p.x), std::abs(p.y)) > kLargest) {
      return what + " lies more than 500 m from the origin: coordinates are in metres";
    }
  }
  if (outline.size() < 3) return what + " has fewer than three corners";
  if (!is_convex(outline)) {
    return what + " at " + place(outline[0]) + " is not convex and counter-clockwise: order or split its corners";
  }
  return std::nullopt;
}

Trouble floor_trouble(const Arena& arena) {
  if (arena.floor.empty()) return "there is no floor: draw at least one pallet";
  for (const FloorPatch& patch : arena.floor) {
    if (const Trouble t = outline_trouble(patch.outline, "floor '" + patch.element + "'")) return t;
    if (!std::isfinite(patch.z) || !(std::hypot(patch.gx, patch.gy) <= std::tan(kSteepest))) {
      return "floor '" + patch.element + "' at " + place(patch.outline[0]) + " is steeper than 60 deg";
    }
    if (patch.friction && !(*patch.friction > 0.0 && *patch.friction <= 2.0)) {
      return "floor '" + patch.element + "' at " + place(patch.outline[0]) + ": friction must be above 0, up to 2";
    }
  }
  return std::nullopt;
}

Trouble solids_trouble(const Arena& arena) {
  for (const Solid& solid : arena.solids) {
    if (const Trouble t = outline_trouble(solid.outline, "solid '" + solid.element + "'")) return t;
    if (!(solid.z_top > solid.z_bottom)) {
      return "solid '" + solid.element + "' at " + place(solid.outline[0]) + " has no height: top must be above bottom";
    }
  }
  return std::nullopt;
}

Trouble paper_trouble(const Arena& arena) {
  for (const PaperSheet& sheet : arena.sheets) {
    if (const Trouble t = outline_trouble(sheet.outline, "paper sheet")) return t;
    if (!(sheet.friction >= 0.0 && sheet.friction <= 2.0)) return "friction of a paper sheet must be 0 to 2";
  }
  for (const PaperBall& ball : arena.balls) {
    if (const Trouble t = ball_trouble(arena, ball)) return t;
  }
  return std::nullopt;
}

Trouble objects_trouble(const Arena& arena) {
  for (const LooseObject& object : arena.objects) {
    if (const Trouble t = object_trouble(arena, object)) return t;
  }
  return std::nullopt;
}

Trouble victims_trouble(const Arena& arena) {
  std::set<std::string> names;
  for (const Victim& victim : arena.victims) {
    if (victim.name.empty()) return "a victim has no name";
    if (!names.insert(victim.name).second) return "two victims are named '" + victim.name + "': rename one";
    if (!std::isfinite(victim.position.x) || !std::isfinite(victim.position.y) || !std::isfinite(victim.position.z) ||
        !std::isfinite(victim.facing)) {
      return "victim '" + victim.name + "' has a position that is not a number";
    }
    const TPoint2D p{victim.position.x, victim.position.y};
    const bool is_near = std::any_of(arena.floor.begin(), arena.floor.end(), [&](const FloorPatch& patch) {
      return distance(patch.outline, p) <= kBesideFloor;
    });
    if (!is_near) {
      return "victim '" + victim.name + "' at " + place(p) +
             " is more than 10 m from any floor: move it into the arena";
    }
    if (!(victim.appearance || victim.heat || victim.sound || victim.co2)) {
      return "victim '" + victim.name + "' gives no cue: nobody could find it";
    }
  }
  return std::nullopt;
}

Trouble start_floor_trouble(const Arena& arena, const TPoint2D& start, double clearance) {
  const PatchIndex floor(arena);
  const double centre = floor.floor_height(start);
  if (!std::isfinite(centre)) return "start " + place(start) + " is off the floor: move it onto a pallet";
  constexpr int kSpokes = 32;
  constexpr int kSteps = 16;
  for (int i = 0; i < kSpokes; ++i) {
    const double bearing = 2.0 * kPi * i / kSpokes;
    double inner = centre;
    for (int k = 1; k <= kSteps; ++k) {
      const double r = clearance * k / kSteps;
      const double z = floor.floor_height({start.x + r * std::cos(bearing), start.y + r * std::sin(bearing)});
      if (!std::isfinite(z)) {
        return "start " + place(start) + " is " + metres(r) + " m from where the floor ends; the robot needs " +
               metres(clearance) + " m: move the start";
      }
      if (std::abs(z - inner) > kClimbableStep) {
        return "start " + place(start) + " is " + metres(r) + " m from a step; the robot needs " + metres(clearance) +
               " m of even floor: move the start";
      }
      inner = z;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> ball_trouble(const Arena& arena, const PaperBall& ball) {
  if (!(ball.radius > 0.0 && ball.radius <= 1.0)) return "radius of a paper ball must be above 0, up to 1 m";
  if (!(ball.mass > 0.0 && ball.mass <= 10.0)) return "mass of a paper ball must be above 0, up to 10 kg";
  if (!std::isfinite(floor_height(arena, ball.position))) {
    return "paper ball at " + place(ball.position) + " lies off the floor: move it onto a pallet";
  }
  for (const Solid& solid : arena.solids) {
    if (distance(solid.outline, ball.position) > 0.0) continue;
    if (solid.z_bottom < floor_height(arena, ball.position) + 2.0 * ball.radius) {
      return "paper ball at " + place(ball.position) + " lies in a solid '" + solid.element + "': move it";
    }
  }
  return std::nullopt;
}

std::optional<std::string> object_trouble(const Arena& arena, const LooseObject& object) {
  const std::string what =
      "object '" + object_kinds().at(static_cast<std::size_t>(object.kind)) + "' at " + place(object.position);
  if (!(object.radius > 0.0 && object.height > 0.0 && object.mass > 0.0)) {
    return what + " needs a radius, a height and a mass above 0";
  }
  if (!std::isfinite(floor_height(arena, object.position))) return what + " is off the floor: move it onto a pallet";
  for (const Solid& solid : arena.solids) {
    if (distance(solid.outline, object.position) == 0.0 && solid.z_bottom < object.height) {
      return what + " is in a solid '" + solid.element + "': move it";
    }
  }
  return std::nullopt;
}

std::optional<std::string> parts_trouble(const Arena& arena) {
  if (!(arena.cell_size >= 0.1 && arena.cell_size <= 10.0)) return "cell_m must be 0.1 to 10";
  if (!(arena.floor_friction > 0.0 && arena.floor_friction <= 2.0)) return "floor friction must be above 0, up to 2";
  for (const auto& part_trouble : {floor_trouble, solids_trouble, paper_trouble, objects_trouble, victims_trouble}) {
    if (const Trouble t = part_trouble(arena)) return t;
  }
  return std::nullopt;
}

std::optional<std::string> start_trouble(const Arena& arena, double start_clearance) {
  const TPoint2D start{arena.start.x, arena.start.y};
  if (!std::isfinite(start.x) || !std::isfinite(start.y) || !std::isfinite(arena.start.phi)) {
    return "the start pose is not a number";
  }
  if (const Trouble t = start_floor_trouble(arena, start, start_clearance)) return t;
  const double z = floor_height(arena, start);
  for (const Solid& solid : arena.solids) {
    if (solid.gives_way || solid.z_top <= z || solid.z_bottom >= z + kRobotHeight) continue;
    const double gap = distance(solid.outline, start);
    if (gap == 0.0) return "start " + place(start) + " is in a solid '" + solid.element + "': move the start";
    if (gap < start_clearance) {
      return "start " + place(start) + " is " + metres(gap) + " m from a '" + solid.element + "'; the robot needs " +
             metres(start_clearance) + " m: move the start";
    }
  }
  for (const PaperBall& ball : arena.balls) {
    if (std::hypot(ball.position.x - start.x, ball.position.y - start.y) < ball.radius + start_clearance) {
      return "start " + place(start) + " is on the paper ball at " + place(ball.position) + ": move one of them";
    }
  }
  for (const LooseObject& object : arena.objects) {
    if (std::hypot(object.position.x - start.x, object.position.y - start.y) < object.radius + start_clearance) {
      return "start " + place(start) + " is on the object '" +
             object_kinds().at(static_cast<std::size_t>(object.kind)) + "': move one of them";
    }
  }
  return std::nullopt;
}

void check(const Arena& arena, const std::string& source, double start_clearance) {
  if (const Trouble t = parts_trouble(arena)) throw InputError(source + ": " + *t);
  if (const Trouble t = start_trouble(arena, start_clearance)) throw InputError(source + ": " + *t);
}

}  // namespace rubble::arenas
