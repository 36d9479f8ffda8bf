#include "arenas/files/arena_file.h"

#include <algorithm>
#include <cmath>

#include "arenas/elements/element_shapes.h"
#include "arenas/elements/elements.h"
#include "arenas/files/include.h"
#include "arenas/files/piece.h"
#include "arenas/files/plan.h"
#include "arenas/model/geometry.h"
#include "arenas/raf/raf.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/yaml/strict_yaml.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// Between wheel and floor, where an entry gives it.
std::optional<double> friction(const YamlMap& entry) {
  if (!entry.has("friction")) return std::nullopt;
  return entry.number("friction", std::nullopt, 0.01, 2.0);
}

double angle(const YamlMap& entry, const std::string& key, std::optional<double> fallback) {
  return deg_to_rad(entry.number(key, fallback, -360.0, 360.0));
}

TPoint2D point(const YamlMap& entry, const std::string& key) {
  const std::vector<double> xy = entry.numbers(key, 2);
  if (xy.size() != 2) entry.fail(key, "give '" + key + ": [x, y]' in metres");
  return {xy[0], xy[1]};
}

void read_floors(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("floors")) {
    const double length = entry.number("length_m", plan.cell_size(), 0.01, kFar);
    const double width = entry.number("width_m", plan.cell_size(), 0.01, kFar);
    const double heading = angle(entry, "angle_deg", 0.0);
    const double slope = std::tan(deg_to_rad(entry.number("slope_deg", 0.0, 0.0, 60.0)));
    FloorPatch patch;
    patch.z = entry.number("z_m", 0.0, -10.0, 10.0);
    patch.gx = slope * std::cos(heading);
    patch.gy = slope * std::sin(heading);
    patch.element = entry.text("element", slope > 0.0 ? "ramp" : "platform");
    patch.friction = friction(entry);
    for (const TPoint2D& p : plan.places(entry)) {
      patch.outline = rectangle(p, length, width, heading);  // outline[0] lies at the foot
      arena.floor.push_back(patch);
    }
  }
}

void read_walls(const YamlMap& root, const Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("walls")) {
    const TPoint2D from = point(entry, "from_m");
    const TPoint2D to = point(entry, "to_m");
    if (!(std::hypot(to.x - from.x, to.y - from.y) > 1e-3))
      entry.fail("to_m", "the wall has no length: give two different points");
    const double bottom = entry.number("bottom_m", 0.0, -10.0, 10.0);
    const double height = entry.number("height_m", plan.wall_height(), 0.01, 10.0);
    const double thickness = entry.number("thickness_m", plan.wall_thickness(), 0.005, 1.0);
    arena.solids.push_back({strip(from, to, thickness), bottom, bottom + height, entry.text("element", kWallElement)});
  }
}

void read_boxes(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("boxes")) {
    const double length = entry.number("length_m", 0.4, 0.01, kFar);
    const double width = entry.number("width_m", length, 0.01, kFar);
    const double heading = angle(entry, "angle_deg", 0.0);
    const double bottom = entry.number("bottom_m", 0.0, -10.0, 10.0);
    const double height = entry.number("height_m", plan.wall_height(), 0.01, 10.0);
    const std::string element = entry.text("element", "box");
    for (const TPoint2D& p : plan.places(entry)) {
      arena.solids.push_back({rectangle(p, length, width, heading), bottom, bottom + height, element});
    }
  }
}

/// `outline_m: [x, y, x, y, ...]`, in either sense of rotation, as convex pieces.
std::vector<Outline> read_outline(const YamlMap& entry) {
  const std::vector<double> numbers = entry.numbers("outline_m");
  if (numbers.size() < 6 || numbers.size() % 2 != 0) {
    entry.fail("outline_m", "give three or more corners as x, y, x, y, ... in metres");
  }
  Outline outline;
  for (std::size_t i = 0; i < numbers.size(); i += 2) outline.push_back({numbers[i], numbers[i + 1]});
  const std::vector<Outline> pieces = convex_pieces(outline);
  if (pieces.empty()) entry.fail("outline_m", "the outline crosses itself or has no area: go round it once");
  return pieces;
}

void read_paper(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("paper")) {
    const double friction = entry.number("friction", 0.25, 0.0, 2.0);
    if (entry.has("outline_m")) {
      for (const Outline& piece : read_outline(entry)) arena.sheets.push_back({piece, friction});
      continue;
    }
    const double length = entry.number("length_m", 0.42, 0.01, kFar);  // DIN A3, landscape
    const double width = entry.number("width_m", 0.297, 0.01, kFar);
    const double heading = angle(entry, "angle_deg", 0.0);
    for (const TPoint2D& p : plan.places(entry))
      arena.sheets.push_back({rectangle(p, length, width, heading), friction});
  }
}

void read_balls(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("balls")) {
    const double radius = entry.number("radius_m", 0.12, 0.01, 1.0);
    // Crumpled paper fills space with dimension 2.5 (Gomes 1987), so mass grows with radius^2.5; 30 g at 0.12 m.
    const double relative = radius / 0.12;
    const double mass = entry.number("mass_kg", 0.03 * relative * relative * std::sqrt(relative), 0.001, 10.0);
    for (const TPoint2D& p : plan.places(entry)) {
      arena.balls.push_back({p, radius, mass});
      if (const auto trouble = ball_trouble(arena, arena.balls.back())) entry.fail("", *trouble);
    }
  }
}

/// What the blue arena's robots grasp and put down. Sizes of an 0.5 l bottle, full, and of a handheld radio.
void read_objects(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("objects")) {
    LooseObject object;
    const std::string type = entry.choice("type", std::nullopt, object_kinds());
    object.kind = type == object_kinds().front() ? ObjectKind::Bottle : ObjectKind::Radio;
    const bool is_bottle = object.kind == ObjectKind::Bottle;
    object.radius = entry.number("radius_m", is_bottle ? 0.033 : 0.03, 0.01, 0.5);
    object.height = entry.number("height_m", is_bottle ? 0.23 : 0.26, 0.02, 2.0);
    object.mass = entry.number("mass_kg", is_bottle ? 0.52 : 0.30, 0.01, 20.0);
    for (const TPoint2D& p : plan.places(entry)) {
      object.position = p;
      arena.objects.push_back(object);
      if (const auto trouble = object_trouble(arena, object)) entry.fail("", *trouble);
    }
  }
}

void read_cues(const YamlMap& entry, Victim& victim) {
  if (!entry.has("cues")) return;
  victim.appearance = victim.heat = false;
  for (const std::string& cue : entry.texts("cues")) {
    if (cue == "appearance") {
      victim.appearance = true;
    } else if (cue == "heat") {
      victim.heat = true;
    } else if (cue == "sound") {
      victim.sound = true;
    } else if (cue == "co2") {
      victim.co2 = true;
    } else {
      entry.fail("cues", "unknown cue '" + cue + "': use appearance, heat, sound, co2");
    }
  }
}

/// With `wall`, the box stands with its back against that wall of the pallet; otherwise its middle is at the place.
void read_victims(const YamlMap& root, Plan& plan, Arena& arena) {
  for (const YamlMap& entry : root.maps("victims")) {
    const double size = entry.number("box_m", 0.4, 0.0, 1.2);
    TPoint2D p = plan.place(entry);
    Victim victim;
    victim.name = entry.text("name", std::nullopt);
    if (std::any_of(arena.victims.begin(), arena.victims.end(),
                    [&](const Victim& v) { return v.name == victim.name; })) {
      entry.fail("name", "two victims are named '" + victim.name + "': rename one");
    }
    if (entry.has("wall")) {
      const std::string side = entry.choice("wall", std::nullopt, {"north", "east", "south", "west"});
      const double back = 0.5 * (plan.cell_size() - plan.wall_thickness() - size);
      const double outward = side == "east" ? 0.0 : side == "north" ? 0.5 * kPi : side == "west" ? kPi : -0.5 * kPi;
      p = p + TPoint2D{back * std::cos(outward), back * std::sin(outward)};
      victim.facing = wrap_angle(outward + kPi);
    } else {
      victim.facing = wrap_angle(angle(entry, "facing_deg", std::nullopt));
    }
    victim.position = {p.x, p.y, entry.number("height_m", 0.2, 0.0, 2.0)};
    read_cues(entry, victim);
    add_victim(arena, victim, size);
  }
}

/// The league's building blocks by name, each on the ground in the middle of a pallet.
void read_elements(const YamlMap& root, Plan& plan, Arena& arena) {
  std::vector<Element> elements;
  for (const YamlMap& entry : root.maps("elements")) {
    Element element;
    element.type = entry.choice("type", std::nullopt, element_types());
    element.rotation = angle(entry, "rotation_deg", 0.0);
    if (entry.has("mount_point")) {
      element.mount_point = static_cast<int>(entry.integer("mount_point", std::nullopt, -1, 2));
    }
    if (entry.has("slope_deg")) {
      if (!has_slope(element.type)) entry.fail("slope_deg", "a '" + element.type + "' has no slope: take the key out");
      element.slope = deg_to_rad(entry.number("slope_deg", std::nullopt, 1.0, 60.0));
    }
    if (entry.has("throw")) {
      if (!is_thrown(element.type)) entry.fail("throw", "a '" + element.type + "' has no columns: take the key out");
      element.thrown = static_cast<std::uint64_t>(entry.integer("throw", std::nullopt, 1, 1000000000));
    }
    if (entry.has("friction") && !has_floor(element.type))
      entry.fail("friction", "no wheel stands on a '" + element.type + "': take the key out");
    element.friction = friction(entry);
    for (const TPoint2D& p : plan.places(entry)) {
      element.position = p;
      elements.push_back(element);
    }
  }
  for (const Element& element : elements) place(element, wall_behind(element, elements), arena);
}

void read_start(const YamlMap& root, const Plan& plan, Arena& arena) {
  const YamlMap start = root.map("start");
  arena.start.phi = wrap_angle(angle(start, "heading_deg", 0.0));
  if (start.has("x_m") || start.has("y_m")) {
    if (plan.start_cell())
      start.fail("x_m", "the drawing marks the start with S already: remove x_m and y_m, or the S");
    arena.start.x = start.number("x_m", std::nullopt, -kFar, kFar);
    arena.start.y = start.number("y_m", std::nullopt, -kFar, kFar);
  } else if (plan.start_cell()) {
    arena.start.x = plan.start().x;
    arena.start.y = plan.start().y;
  } else {
    root.fail("start", "where does the robot start? write S into a pallet of the drawing, or 'start: {x_m: , y_m: }'");
  }
}

void check_start(const YamlMap& root, const Plan& plan, const Arena& arena) {
  const auto trouble = start_trouble(arena);
  if (!trouble) return;
  if (plan.start_cell()) root.fail_at("maze", plan.start_cell()->row, plan.start_cell()->column, *trouble);
  root.fail("start", *trouble);
}

Arena build(const YamlMap& document, const std::string& source) {
  const YamlMap root = compose(document, source);
  root.maps("include");  // all done, or empty: a key that is known
  Arena arena;
  const std::string file = source.substr(source.find_last_of('/') + 1);
  arena.name = root.text("name", file.substr(0, file.find_last_of('.')));
  arena.floor_friction = root.number("floor_friction", 0.8, 0.01, 2.0);
  Plan plan(root, arena);
  read_floors(root, plan, arena);
  read_walls(root, plan, arena);
  read_boxes(root, plan, arena);
  read_elements(root, plan, arena);
  read_paper(root, plan, arena);
  read_balls(root, plan, arena);
  read_objects(root, plan, arena);
  read_victims(root, plan, arena);
  read_start(root, plan, arena);
  root.finish();
  plan.finish(root);
  if (const auto trouble = parts_trouble(arena)) root.fail("", *trouble);
  check_start(root, plan, arena);
  set_bounds(arena);
  return arena;
}

}  // namespace

Arena load_arena(const std::string& path) {
  if (!is_raf(path)) return build(YamlMap::load(path), path);
  const RafImport import = import_raf(path);
  if (!import.unknown.empty()) throw InputError(path + ": " + import.summary() + ": remove these parts from the file");
  return import.arena;
}

Arena parse_arena(const std::string& yaml, const std::string& name) { return build(YamlMap::parse(yaml, name), name); }

}  // namespace rubble::arenas
