#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <vector>

namespace rubble::arenas {

inline constexpr double kPallet = 1.2;                ///< edge of the league's pallets [m]
inline constexpr double kHalfPallet = 0.5 * kPallet;  ///< [m]
/// What a ramp of 35 deg climbs over a pallet; one of 45 deg climbs kPallet [m].
inline constexpr double kRise35 = kPallet * 0.70020754;

// Parts that are told from others: how they are drawn and written. What else an `element` says is for people.
inline constexpr const char* kFlatElement = "flat";
inline constexpr const char* kWallElement = "wall";
inline constexpr const char* kVictimBoxElement = "victim_box";

using Outline = std::vector<mrpt::math::TPoint2D>;  ///< convex polygon, counter-clockwise [m]

/// A plane piece of floor a wheel can stand on: flat pallet, ramp, top of a step. Overlaps: the higher one carries.
struct FloorPatch {
  Outline outline;
  double z = 0.0;                                 ///< height at outline[0] [m]
  double gx = 0.0;                                ///< dz/dx
  double gy = 0.0;                                ///< dz/dy
  std::string element;                            ///< the league's name of the part, e.g. "pitch_ramp"
  std::optional<double> friction = std::nullopt;  ///< wheel on it; default: the arena's floor_friction

  double height(const mrpt::math::TPoint2D& p) const {
    return z + gx * (p.x - outline[0].x) + gy * (p.y - outline[0].y);
  }
};

/// An upright prism that stops laser beams and, unless it gives way, robots: wall, victim box, post.
struct Solid {
  Outline outline;
  double z_bottom = 0.0;   ///< [m]
  double z_top = 1.2;      ///< [m]
  std::string element;     ///< as runs name what they touched
  bool gives_way = false;  ///< seen by the laser but no obstacle: the strips of a veil
};

/// Loose paper lying flat: wheels on it slip.
struct PaperSheet {
  Outline outline;
  double friction = 0.25;  ///< coefficient between wheel and floor while a wheel is on the sheet
};

/// Crumpled paper: a ball the robot pushes and the laser sees while it reaches the scan plane.
struct PaperBall {
  mrpt::math::TPoint2D position;
  double radius = 0.12;  ///< [m]
  double mass = 0.03;    ///< [kg]
};

enum class ObjectKind { Bottle, Radio };

/// "bottle", "radio": as files call them, in the order of ObjectKind.
const std::vector<std::string>& object_kinds();

/// Something of the blue arena to grasp: an upright cylinder the robot pushes and the laser sees while its plane meets
/// it.
struct LooseObject {
  mrpt::math::TPoint2D position;
  double radius = 0.033;  ///< [m]
  double height = 0.23;   ///< [m]
  double mass = 0.5;      ///< [kg]
  ObjectKind kind = ObjectKind::Bottle;
};

/// A simulated victim; which cues it gives.
struct Victim {
  std::string name;
  mrpt::math::TPoint3D position;  ///< [m]
  double facing = 0.0;            ///< bearing of the open side of its box [rad]
  bool appearance = true;
  bool heat = true;
  bool sound = false;
  bool co2 = false;
};

/// The truth: everything the simulator and the scoring know about one arena. East-north-up, metres.
struct Arena {
  std::string name;
  double cell_size = kPallet;       ///< pallet edge [m]
  double floor_friction = 0.8;      ///< wheel on wood
  mrpt::math::TPoint2D min_corner;  ///< bounding box of all parts
  mrpt::math::TPoint2D max_corner;
  std::vector<FloorPatch> floor;
  std::vector<Solid> solids;
  std::vector<PaperSheet> sheets;
  std::vector<PaperBall> balls;
  std::vector<LooseObject> objects;
  std::vector<Victim> victims;
  mrpt::math::TPose2D start;
};

/// A plane convex polygon in space; what a laser beam can hit. Vertices in order, at least three, one plane.
struct Face {
  std::vector<mrpt::math::TPoint3D> vertices;
};

/// Sets min_corner and max_corner to the box around floor, solids, sheets, balls, objects and victims.
void set_bounds(Arena& arena);

/// All faces of floor and solids, with the risers where a floor patch stands above its neighbour or the ground.
/// Paper balls and loose objects are not in it: they move. Sheets are too thin to see.
std::vector<Face> faces(const Arena& arena);

/// Adds the sides and the top (and, where light gets below, the bottom) of an upright prism.
void add_prism(const Outline& outline, double bottom, double top, std::vector<Face>& faces, bool with_bottom = false);

/// Height of the floor at p [m]; -inf where there is none.
double floor_height(const Arena& arena, const mrpt::math::TPoint2D& p);

/// Throws InputError (place and remedy) when the arena cannot be used: start in a wall or off the floor, no floor, ...
/// `source` names the file or generator in the message; `start_clearance` is the radius the robot needs around the
/// start.
void check(const Arena& arena, const std::string& source, double start_clearance = 0.36);

/// What check() finds wrong with the parts (first trouble, one line without a place), or nothing.
std::optional<std::string> parts_trouble(const Arena& arena);

/// What it finds wrong with one ball or object among the arena's floors and solids, or nothing.
std::optional<std::string> ball_trouble(const Arena& arena, const PaperBall& ball);
std::optional<std::string> object_trouble(const Arena& arena, const LooseObject& object);

/// What check() finds wrong with the start pose alone, or nothing.
std::optional<std::string> start_trouble(const Arena& arena, double start_clearance = 0.36);

}  // namespace rubble::arenas
