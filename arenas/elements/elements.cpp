#include "arenas/elements/elements.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "arenas/elements/element_shapes.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

struct Entry {
  ElementKind kind;
  const char* what;  ///< it does, one line
  std::function<void(const ElementFrame&, const Mount&, Arena&)> add;
  bool covers = false;
  std::function<void(const ElementFrame&, double slope, Arena&)> add_sloped =
      nullptr;                                    ///< another slope [rise a metre]
  std::optional<double> friction = std::nullopt;  ///< of its floors; default: the arena's, for all are of wood
  bool has_holes = false;                         ///< a wall at whose mount points items hang
  std::function<void(const ElementFrame&, std::uint64_t thrown, Arena&)> add_thrown = nullptr;  ///< instead of add
};

/// Shapes that do not hang on a wall.
template <class Add>
auto standing(Add add) {
  return [add](const ElementFrame& frame, const Mount&, Arena& arena) { add(frame, arena); };
}

auto straight_wall(double height) {
  return standing([height](const ElementFrame& frame, Arena& arena) { add_wall(frame, height, {}, arena); });
}

Entry holed_wall(const char* what, std::vector<Opening> openings) {
  Entry entry{ElementKind::Wall, what,
              standing([openings](const ElementFrame& frame, Arena& arena) { add_wall(frame, 1.2, openings, arena); })};
  entry.has_holes = true;
  return entry;
}

auto barrel(double bottom, const char* element) {
  return standing([=](const ElementFrame& frame, Arena& arena) { add_half_barrel(frame, bottom, element, arena); });
}

Entry step_field(const char* what, double tallest, double base) {
  Entry entry{ElementKind::Floor, what, nullptr};
  entry.add_thrown = [=](const ElementFrame& frame, std::uint64_t thrown, Arena& arena) {
    add_step_field(frame, tallest, base, thrown, arena);
  };
  return entry;
}

auto stairs(bool open_below) {
  return standing([=](const ElementFrame& frame, Arena& arena) { add_stairs(frame, open_below, arena); });
}

auto open_floor(double height) {
  return standing([=](const ElementFrame& frame, Arena& arena) { add_open_floor(frame, height, arena); });
}

auto elevated_floor(double height) {
  return standing([height](const ElementFrame& frame, Arena& arena) { add_elevated_floor(frame, height, arena); });
}

Entry ramp(const char* what, bool covers, double foot_y, double head_y, double rise) {
  return {ElementKind::Floor, what,
          standing([=](const ElementFrame& frame, Arena& arena) { add_ramp(frame, foot_y, head_y, rise, arena); }),
          covers, [=](const ElementFrame& frame, double slope, Arena& arena) {
            add_ramp(frame, foot_y, head_y, slope * std::abs(head_y - foot_y), arena);
          }};
}

auto post(double radius, double height, const char* element) {
  return standing([=](const ElementFrame& frame, Arena& arena) { add_post(frame, radius, height, element, arena); });
}

auto boxed_victim(bool heat, bool sound, bool co2) {
  return [=](const ElementFrame& frame, const Mount& mount, Arena& arena) {
    add_hung_victim(frame, mount, heat, sound, co2, arena);
  };
}

const std::map<std::string, Entry>& table() {
  constexpr double kTan10 = 0.17632698;
  constexpr double kHole = 0.133;  // square of the same area as the round hole of 0.15 m
  static const std::vector<Opening> kHoles{
      {-0.28, 0.31, kHole, kHole}, {-0.29, 0.90, kHole, kHole}, {0.29, 0.59, kHole, kHole}};
  static const std::vector<Opening> kSlots{
      {-0.26, 0.27, 0.36, kHole}, {-0.24, 0.90, 0.36, kHole}, {0.31, 0.62, 0.36, kHole}};
  using K = ElementKind;
  static const std::map<std::string, Entry> entries{
      {"small_wall", {K::Wall, "a board of 1.2 m on the edge at +y", straight_wall(1.2)}},
      {"small_wall_no_tex", {K::Wall, "a board of 1.0 m in the middle of the edge at +y", standing(add_narrow_wall)}},
      {"small_wall_qr", {K::Wall, "a board of 1.2 m with a QR code", straight_wall(1.2)}},
      {"small_wall_start_check", {K::Wall, "a board of 1.2 m with the start check", straight_wall(1.2)}},
      {"tall_wall", {K::Wall, "a board of 2.4 m on the edge at +y", straight_wall(2.4)}},
      {"wall_holes1", holed_wall("a board with three square openings: the laser and victims look through", kHoles)},
      {"small_wall_triple_holes", holed_wall("a board with three slots: the laser and victims look through", kSlots)},
      {"half_wall", {K::Wall, "the right half of a board: a gap of 0.6 m stays", standing(add_half_wall)}},
      {"veil_wall", {K::Wall, "strips that the laser sees and the robot pushes aside", standing(add_veil)}},
      {"corner_diag_120", {K::Diagonal, "two boards from the corners at +y to the middle", standing(add_corner_wall)}},
      {"wall_diag_120", {K::Diagonal, "a board from corner to corner", standing(add_diagonal_wall)}},
      {"full_ramp", ramp("rises 0.339 m over the pallet towards -y", true, kHalfPallet, -kHalfPallet, 0.339)},
      {"half_ramp", ramp("rises 0.17 m over the southern half, towards +y", false, -kHalfPallet, 0.0, 0.17)},
      {"half_ramp_shifted", ramp("rises 0.17 m over the southern half, towards -y", false, 0.0, -kHalfPallet, 0.17)},
      {"simple_elev_ramp", ramp("45 deg up to the floor at 1.2 m", true, -kHalfPallet, kHalfPallet, kPallet)},
      {"steep_ramp_35", ramp("35 deg up to the floor at 0.84 m", true, -kHalfPallet, kHalfPallet, kRise35)},
      {"steep_ramp_45", ramp("45 deg up to the floor at 1.2 m", true, -kHalfPallet, kHalfPallet, kPallet)},
      {"elevated_floor_120", {K::Floor, "a floor at 1.2 m, open below: to drive under", open_floor(kPallet)}},
      {"elevated_floor_120_solid", {K::Floor, "a floor at 1.2 m, closed below", elevated_floor(kPallet), true}},
      {"elevated_floor_084", {K::Floor, "a floor at 0.84 m, closed below", elevated_floor(kRise35), true}},
      {"crossing_ramps",
       {K::Floor, "four ramps of 10 deg that agree nowhere: pitches and rolls the robot at once",
        standing([](const ElementFrame& f, Arena& a) { add_crossing_ramps(f, kTan10, a); }), true, add_crossing_ramps}},
      {"elevated_ramps",
       {K::Floor, "four half ramps in turn, two of them 0.17 m up",
        standing([](const ElementFrame& f, Arena& a) { add_elevated_ramps(f, 0.17 / kHalfPallet, a); }), true,
        add_elevated_ramps}},
      {"flat", {K::Floor, "a flat pallet on the ground", elevated_floor(0.0), true}},
      {"pitch_ramp", ramp("10 deg towards +y: pitches a robot that drives along +y", true, -kHalfPallet, kHalfPallet,
                          kPallet * kTan10)},
      {"roll_ramp",
       {K::Floor, "10 deg towards +x: rolls a robot that drives along +y",
        standing([](const ElementFrame& f, Arena& a) { add_roll_ramp(f, kTan10, a); }), true, add_roll_ramp}},
      {"tunnel", {K::Floor, "a ceiling at 0.60 m on two boards, to drive through along y", standing(add_tunnel)}},
      {"stepfield_orange_diagonal", step_field("10 x 10 columns of 0 to 0.2 m", 0.2, 0.0)},
      {"stairs_120", {K::Floor, "five treads at 0.23 to 1.03 m towards +y, open below", stairs(true)}},
      {"stairs_120_solid", {K::Floor, "five treads at 0.23 to 1.03 m towards +y, closed below", stairs(false)}},
      {"stepfield_red_diagonal", step_field("10 x 10 columns of 0.05 to 0.45 m", 0.4, 0.05)},
      {"fiducial_barrel",
       {K::Item, "half a barrel on the wall at +y, from 0.30 m up", barrel(0.30, "fiducial_barrel")}},
      {"fiducial_barrel_high",
       {K::Item, "half a barrel on the wall at +y, from 1.50 m up", barrel(1.50, "fiducial_barrel")}},
      {"wooden_block", {K::Item, "0.10 m high, to drive over", standing(add_wooden_block)}},
      {"red_barrel", {K::Item, "half a barrel on the wall at +y, from 0.30 m up", barrel(0.30, "red_barrel")}},
      {"fire_extinguisher",
       {K::Item, "a block of 0.47 x 0.20 x 0.89 m at the wall at +y", standing(add_fire_extinguisher)}},
      {"pvc_pipe", {K::Item, "a post 0.05 m wide and 0.6 m high", post(0.025, 0.6, "pvc_pipe")}},
      {"victim_1",
       {K::Item, "a victim in a cube of 0.4 m, 0.2 m above the ground, open to +y: appearance and heat",
        standing(add_cube_victim)}},
      {"manip_storage", {K::Item, "shelves at 0.5 and 1.0 m", standing(add_shelves)}},
      {"spectator_120", {K::Item, "a box at 1.07 to 1.70 m, above a level laser", standing(add_spectator)}},
      {"victim_with_box1",
       {K::Item, "a victim in a box behind the wall at +y: appearance and heat", boxed_victim(true, false, false)}},
      {"victim_with_box_t",
       {K::Item, "a victim in a box behind the wall at +y: appearance and heat", boxed_victim(true, false, false)}},
      {"victim_with_box_s",
       {K::Item, "a victim in a box behind the wall at +y: appearance and sound", boxed_victim(false, true, false)}},
      {"victim_with_box_c",
       {K::Item, "a victim in a box behind the wall at +y: appearance and co2", boxed_victim(false, false, true)}},
      {"victim_with_box_ts",
       {K::Item, "a victim in a box behind the wall at +y: appearance, heat and sound",
        boxed_victim(true, true, false)}},
      {"victim_with_box_tc",
       {K::Item, "a victim in a box behind the wall at +y: appearance, heat and co2", boxed_victim(true, false, true)}},
      {"victim_with_box_sc",
       {K::Item, "a victim in a box behind the wall at +y: appearance, sound and co2",
        boxed_victim(false, true, true)}},
      {"victim_with_box_tsc",
       {K::Item, "a victim in a box behind the wall at +y: appearance, heat, sound and co2",
        boxed_victim(true, true, true)}},
      {"victim_with_box_v",
       {K::Item, "a victim in a box behind the wall at +y: appearance", boxed_victim(false, false, false)}},
      {"victim_with_box_q",
       {K::Item, "a victim in a box behind the wall at +y: appearance", boxed_victim(false, false, false)}},
      {"victim_doll_heat_with_box",
       {K::Item, "a victim in a box behind the wall at +y: appearance and heat", boxed_victim(true, false, false)}},
      {"victim_doll_qr_with_box",
       {K::Item, "a victim in a box behind the wall at +y: appearance", boxed_victim(false, false, false)}},
  };
  return entries;
}

const Entry* find(const std::string& type) {
  const auto found = table().find(type);
  return found != table().end() ? &found->second : nullptr;
}

/// Where an item hangs: the holes of its wall, as (along, height); at a wall without holes its middle is on the ground.
Mount mount_of(const Element& element, const Element* wall) {
  static const Mount kPoints[] = {{-0.3, 0.9}, {0.3, 0.6}, {-0.3, 0.3}};
  const Entry* behind = wall != nullptr ? find(wall->type) : nullptr;
  const int point = std::max(0, element.mount_point.value_or(0));
  if (behind == nullptr) return {0.0, 0.2};  // stands on the ground
  if (!behind->has_holes || point > 2) return {0.0, 0.0};
  return kPoints[point];
}

}  // namespace

ElementKind kind_of(const std::string& type) {
  if (const Entry* entry = find(type)) return entry->kind;
  for (const char* label : {"hazmat", "start_check", "floor_tile"})
    if (type.rfind(label, 0) == 0) return ElementKind::Label;
  return ElementKind::Unknown;
}

std::vector<std::string> element_types() {
  std::vector<std::string> types;
  for (const auto& [type, entry] : table()) types.push_back(type);
  return types;
}

const Element* wall_behind(const Element& item, const std::vector<Element>& elements) {
  for (const Element& e : elements) {
    const double turn = wrap_angle(e.rotation - item.rotation);
    const mrpt::math::TPoint2D shift = e.position - item.position;
    if (kind_of(e.type) != ElementKind::Wall || std::abs(turn) > 1e-6) continue;
    if (std::hypot(shift.x, shift.y) < 1e-6) return &e;
  }
  return nullptr;
}

bool covers_pallet(const std::string& type) {
  const Entry* entry = find(type);
  return entry != nullptr && entry->covers;
}

bool has_slope(const std::string& type) {
  const Entry* entry = find(type);
  return entry != nullptr && entry->add_sloped != nullptr;
}

bool is_thrown(const std::string& type) {
  const Entry* entry = find(type);
  return entry != nullptr && entry->add_thrown != nullptr;
}

bool has_floor(const std::string& type) {
  Element element;
  element.type = type;
  Arena alone;
  place(element, nullptr, alone);
  return !alone.floor.empty();
}

std::string description_of(const std::string& type) {
  const Entry* entry = find(type);
  return entry != nullptr ? entry->what : "";
}

std::string name_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::Floor:
      return "floor";
    case ElementKind::Wall:
      return "wall";
    case ElementKind::Diagonal:
      return "diagonal";
    case ElementKind::Item:
      return "item";
    case ElementKind::Label:
      return "label";
    case ElementKind::Unknown:
      break;
  }
  return "unknown";
}

void place(const Element& element, const Element* wall, Arena& arena) {
  const Entry* entry = find(element.type);
  if (entry == nullptr) return;
  const ElementFrame frame(element.position + element.offset, element.rotation);
  const std::size_t first = arena.floor.size();
  if (element.slope && entry->add_sloped) {
    entry->add_sloped(frame, std::tan(*element.slope), arena);
  } else if (entry->add_thrown) {
    entry->add_thrown(frame, element.thrown, arena);
  } else {
    entry->add(frame, mount_of(element, wall), arena);
  }
  for (std::size_t i = first; i < arena.floor.size(); ++i)
    arena.floor[i].friction = element.friction ? element.friction : entry->friction;
}

}  // namespace rubble::arenas
