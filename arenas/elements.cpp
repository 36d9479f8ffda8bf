#include "arenas/elements.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "arenas/rough_shapes.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

struct Entry {
  ElementKind kind;
  bool covers = false;
  std::function<void(const ElementFrame&, const Mount&, Arena&)> add;
  std::function<void(const ElementFrame&, double slope, Arena&)> add_sloped;  ///< with another slope [rise a metre]
};

/// Shapes that do not hang on a wall.
template <class Add>
auto standing(Add add) {
  return [add](const ElementFrame& frame, const Mount&, Arena& arena) { add(frame, arena); };
}

auto straight_wall(double height) {
  return standing([height](const ElementFrame& frame, Arena& arena) { add_wall(frame, height, {}, arena); });
}

auto holed_wall(std::vector<Opening> openings) {
  return standing([openings](const ElementFrame& frame, Arena& arena) { add_wall(frame, 1.2, openings, arena); });
}

auto barrel(double bottom) {
  return standing([bottom](const ElementFrame& frame, Arena& arena) { add_half_barrel(frame, bottom, arena); });
}

auto step_field(double tallest) {
  return standing([tallest](const ElementFrame& frame, Arena& arena) { add_step_field(frame, tallest, arena); });
}

auto elevated_floor(double height) {
  return standing([height](const ElementFrame& frame, Arena& arena) { add_elevated_floor(frame, height, arena); });
}

Entry ramp(bool covers, double foot_y, double head_y, double rise) {
  return {ElementKind::Floor, covers,
          standing([=](const ElementFrame& frame, Arena& arena) { add_ramp(frame, foot_y, head_y, rise, arena); }),
          [=](const ElementFrame& frame, double slope, Arena& arena) {
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
  constexpr double kTan35 = 0.70020754;
  constexpr double kHole = 0.133;  // square of the same area as the round hole of 0.15 m
  static const std::vector<Opening> kHoles{
      {-0.28, 0.31, kHole, kHole}, {-0.29, 0.90, kHole, kHole}, {0.29, 0.59, kHole, kHole}};
  static const std::vector<Opening> kSlots{
      {-0.26, 0.27, 0.36, kHole}, {-0.24, 0.90, 0.36, kHole}, {0.31, 0.62, 0.36, kHole}};
  using K = ElementKind;
  static const std::map<std::string, Entry> entries{
      {"small_wall", {K::Wall, false, straight_wall(1.2), nullptr}},
      {"small_wall_no_tex", {K::Wall, false, straight_wall(1.2), nullptr}},
      {"small_wall_qr", {K::Wall, false, straight_wall(1.2), nullptr}},
      {"small_wall_start_check", {K::Wall, false, straight_wall(1.2), nullptr}},
      {"tall_wall", {K::Wall, false, straight_wall(2.4), nullptr}},
      {"wall_holes1", {K::Wall, false, holed_wall(kHoles), nullptr}},
      {"small_wall_triple_holes", {K::Wall, false, holed_wall(kSlots), nullptr}},
      {"half_wall", {K::Wall, false, standing(add_half_wall), nullptr}},
      {"veil_wall", {K::Wall, false, standing(add_veil), nullptr}},
      {"corner_diag_120", {K::Diagonal, false, standing(add_corner_wall), nullptr}},
      {"wall_diag_120", {K::Diagonal, false, standing(add_diagonal_wall), nullptr}},
      {"full_ramp", ramp(true, 0.6, -0.6, 0.339)},
      {"half_ramp", ramp(false, -0.6, 0.0, 0.17)},
      {"half_ramp_shifted", ramp(false, 0.0, -0.6, 0.17)},
      {"simple_elev_ramp", ramp(true, -0.6, 0.6, 1.2)},
      {"steep_ramp_35", ramp(true, -0.6, 0.6, 1.2 * kTan35)},
      {"steep_ramp_45", ramp(true, -0.6, 0.6, 1.2)},
      {"elevated_floor_120", {K::Floor, true, elevated_floor(1.2), nullptr}},
      {"elevated_floor_084", {K::Floor, true, elevated_floor(1.2 * kTan35), nullptr}},
      {"crossing_ramps",
       {K::Floor, true, standing([](const ElementFrame& f, Arena& a) { add_crossing_ramps(f, kTan10, a); }),
        add_crossing_ramps}},
      {"elevated_ramps",
       {K::Floor, true, standing([](const ElementFrame& f, Arena& a) { add_elevated_ramps(f, 0.17 / 0.6, a); }),
        add_elevated_ramps}},
      {"flat", {K::Floor, true, elevated_floor(0.0), nullptr}},
      {"pitch_ramp", ramp(true, -0.6, 0.6, 1.2 * kTan10)},
      {"roll_ramp",
       {K::Floor, true, standing([](const ElementFrame& f, Arena& a) { add_roll_ramp(f, kTan10, a); }), add_roll_ramp}},
      {"tunnel", {K::Floor, false, standing(add_tunnel), nullptr}},
      {"stepfield_orange_diagonal", {K::Floor, false, step_field(0.2), nullptr}},
      {"stairs_120", {K::Floor, false, standing(add_stairs), nullptr}},
      {"stairs_120_solid", {K::Floor, false, standing(add_stairs), nullptr}},
      {"stepfield_red_diagonal", {K::Floor, false, step_field(0.4), nullptr}},
      {"fiducial_barrel", {K::Item, false, barrel(0.30), nullptr}},
      {"fiducial_barrel_high", {K::Item, false, barrel(1.50), nullptr}},
      {"wooden_block", {K::Item, false, standing(add_wooden_block), nullptr}},
      {"red_barrel", {K::Item, false, post(0.29, 0.88, "red_barrel"), nullptr}},
      {"fire_extinguisher", {K::Item, false, post(0.08, 0.55, "fire_extinguisher"), nullptr}},
      {"pvc_pipe", {K::Item, false, post(0.055, 0.6, "pvc_pipe"), nullptr}},
      {"victim_1", {K::Item, false, standing(add_free_victim), nullptr}},
      {"manip_storage", {K::Item, false, standing(add_shelves), nullptr}},
      {"spectator_120", {K::Item, false, standing(add_spectator), nullptr}},
      {"victim_with_box1", {K::Item, false, boxed_victim(true, false, false), nullptr}},
      {"victim_with_box_t", {K::Item, false, boxed_victim(true, false, false), nullptr}},
      {"victim_with_box_s", {K::Item, false, boxed_victim(false, true, false), nullptr}},
      {"victim_with_box_c", {K::Item, false, boxed_victim(false, false, true), nullptr}},
      {"victim_with_box_ts", {K::Item, false, boxed_victim(true, true, false), nullptr}},
      {"victim_with_box_tc", {K::Item, false, boxed_victim(true, false, true), nullptr}},
      {"victim_with_box_sc", {K::Item, false, boxed_victim(false, true, true), nullptr}},
      {"victim_with_box_tsc", {K::Item, false, boxed_victim(true, true, true), nullptr}},
      {"victim_with_box_v", {K::Item, false, boxed_victim(false, false, false), nullptr}},
      {"victim_with_box_q", {K::Item, false, boxed_victim(false, false, false), nullptr}},
      {"victim_doll_heat_with_box", {K::Item, false, boxed_victim(true, false, false), nullptr}},
      {"victim_doll_qr_with_box", {K::Item, false, boxed_victim(false, false, false), nullptr}},
  };
  return entries;
}

/// Where an item hangs: the holes of its wall, as (along, height).
Mount mount_of(const Element& element, const Element* wall) {
  static const Mount kPoints[] = {{-0.3, 0.9}, {0.3, 0.6}, {-0.3, 0.3}};
  const bool has_holes = wall != nullptr && (wall->type == "wall_holes1" || wall->type == "small_wall_triple_holes");
  const int point = std::max(0, element.mount_point.value_or(0));
  if (!has_holes || point > 2) return {0.0, 0.2};  // stands on the ground
  return kPoints[point];
}

}  // namespace

ElementKind kind_of(const std::string& type) {
  const auto found = table().find(type);
  if (found != table().end()) return found->second.kind;
  for (const char* label : {"hazmat", "start_check", "floor_tile"})
    if (type.rfind(label, 0) == 0) return ElementKind::Label;
  return ElementKind::Unknown;
}

std::vector<std::string> element_types() {
  std::vector<std::string> types;
  for (const auto& [type, entry] : table()) {
    if (entry.add) types.push_back(type);
  }
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
  const auto found = table().find(type);
  return found != table().end() && found->second.covers;
}

bool has_slope(const std::string& type) {
  const auto found = table().find(type);
  return found != table().end() && found->second.add_sloped != nullptr;
}

void place(const Element& element, const Element* wall, Arena& arena) {
  const auto found = table().find(element.type);
  if (found == table().end() || !found->second.add) return;
  const ElementFrame frame(element.position + element.offset, element.rotation);
  if (element.slope && found->second.add_sloped) {
    found->second.add_sloped(frame, std::tan(*element.slope), arena);
    return;
  }
  found->second.add(frame, mount_of(element, wall), arena);
}

}  // namespace rubble::arenas
