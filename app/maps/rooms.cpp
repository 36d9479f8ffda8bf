#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scoring/maps/normalise.h"
#include "scoring/marks.h"
#include "scoring/pictures/picture.h"
#include "scoring/room_report.h"

namespace rubble::app {
namespace {

struct RoomsArguments {
  std::string map;
  std::string truth;
  std::optional<double> map_resolution;
  std::optional<double> truth_resolution;
  std::string method = "passages";
  std::string out;
};

/// A map and its rooms.
struct Floor {
  scoring::LoadedMap map;
  scoring::Rooms rooms;
};

Floor floor_of(const std::string& path, const std::optional<double>& resolution, const std::string& method) {
  Floor out;
  out.map = scoring::load_map(map_file(path), {resolution});
  out.rooms = scoring::rooms_of_map(out.map.grid, method == "visibility");
  if (out.rooms.too_many_corners)
    throw InputError(path + ": its walls have more corners than a floor plan; give --method visibility");
  return out;
}

std::string name_of(std::size_t i) { return "room " + std::to_string(i + 1); }

template <class... Values>
std::string text(const char* format, Values... values) {
  char out[200];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

void print_rooms(const Floor& floor) {
  print_row("map", floor.map.recognised);
  print_row("rooms", std::to_string(floor.rooms.rooms.size()));
  for (std::size_t i = 0; i < floor.rooms.rooms.size(); ++i) {
    const scoring::Room& r = floor.rooms.rooms[i];
    print_row(name_of(i),
              text("centre %.2f, %.2f m; box %.2f, %.2f to %.2f, %.2f m; %.1f m^2, perimeter %.1f m", r.centre.x,
                   r.centre.y, r.box_min.x, r.box_min.y, r.box_max.x, r.box_max.y, r.area, r.perimeter));
  }
}

void print_match(const scoring::RoomMatch& match) {
  for (const scoring::RoomPair& p : match.pairs)
    print_row(name_of(p.truth) + " of the truth",
              name_of(p.map) + text(": %.2f m off, %.0f %% of its area, shape differs by %.2f", p.offset,
                                    100.0 * p.area_ratio, p.difference));
  for (const std::size_t i : match.missing) print_row(name_of(i) + " of the truth", "not in the map");
  for (const std::size_t i : match.surplus) print_row(name_of(i) + " of the map", "not in the truth");
  print_row("room error, eq. (7)", text("%.3f m^2 (0 to 2)", match.error));
  print_row("room score", text("%.3f", match.score));
}

std::string as_csv(const scoring::Rooms& rooms) {
  std::string out = "name,centre_x_m,centre_y_m,box_min_x_m,box_min_y_m,box_max_x_m,box_max_y_m,area_m2,perimeter_m\n";
  for (std::size_t i = 0; i < rooms.rooms.size(); ++i) {
    const scoring::Room& r = rooms.rooms[i];
    out += name_of(i) + text(",%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.2f\n", r.centre.x, r.centre.y, r.box_min.x,
                             r.box_min.y, r.box_max.x, r.box_max.y, r.area, r.perimeter);
  }
  return out;
}

void write_floor(const std::string& folder, const std::string& name, const Floor& floor) {
  scoring::draw_rooms(place_in(folder, name + ".png"), floor.map.grid, floor.rooms);
  write_text_file(place_in(folder, name + ".csv"), as_csv(floor.rooms));
}

int rooms(const RoomsArguments& a) {
  const Floor map = floor_of(a.map, a.map_resolution, a.method);
  std::optional<Floor> truth;
  if (!a.truth.empty()) truth = floor_of(a.truth, a.truth_resolution, a.method);
  if (!a.out.empty()) {
    make_folder(a.out);
    write_floor(a.out, "rooms", map);
    if (truth) write_floor(a.out, "truth_rooms", *truth);
  }
  print_rooms(map);
  if (!truth) return kOk;
  const scoring::RoomVerdict found = scoring::judge_rooms(map.map.grid, map.rooms, truth->map.grid, truth->rooms);
  if (!found.aligned) {
    print_not_aligned(found.note);
    return kOk;
  }
  print_match(found.match);
  if (!a.out.empty())
    scoring::write_side_by_side(place_in(a.out, "matched_rooms.png"), map.map.grid, truth->map.grid, found.T_truth_map,
                                scoring::marks_of(map.rooms, truth->rooms, found.match));
  return kOk;
}

}  // namespace

Command rooms_command() {
  return {"rooms", "Find the rooms of a map, and compare them with those of the truth",
          "Examples:\n  rubble rooms plan.png --resolution 0.05 --out rooms\n"
          "  rubble rooms team.tif truth.tif --method visibility",
          [](Options& o) -> Action {
            auto a = std::make_shared<RoomsArguments>();
            o.argument("map", a->map, "GeoTIFF, ROS map.yaml, or image with --resolution");
            o.argument("truth", a->truth, "Ground truth, same formats", Options::Need::Optional);
            o.number("--resolution", a->map_resolution, 0.001, 10.0, "Metres a pixel of the map image");
            o.number("--truth-resolution", a->truth_resolution, 0.001, 10.0, "Metres a pixel of the truth image");
            o.choice("--method", a->method, {"passages", "visibility"},
                     "passages, or the paper's clusters of wall control points by what they see");
            o.text("--out", a->out, "Folder for rooms.png and rooms.csv, the truth's, and matched_rooms.png");
            return [a] { return rooms(*a); };
          }};
}

}  // namespace rubble::app
