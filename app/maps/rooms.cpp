#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scoring/maps/normalise.h"
#include "scoring/marks.h"
#include "scoring/pictures/picture.h"
#include "scoring/pose_score.h"
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
  std::string pose;  ///< X,Y,DEG[,SCALE]: compare there instead of aligning
  bool json = false;
};

/// A map and its rooms.
struct Floor {
  scoring::LoadedMap map;
  scoring::Rooms rooms;
};

scoring::Rooms checked(scoring::Rooms rooms, const std::string& path) {
  if (rooms.too_many_corners)
    throw InputError(path + ": its walls have more corners than a floor plan; give --method visibility");
  return rooms;
}

/// Without its rooms yet.
Floor plan_of(const std::string& path, const std::optional<double>& resolution, double scale = 1.0) {
  Floor out;
  out.map = scoring::load_map(map_file(path), {resolution});
  if (scale != 1.0) out.map.grid = scoring::scaled_frame(out.map.grid, scale);
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
  print_row("room agreement", text("%.3f", match.score));
}

nlohmann::ordered_json point(const mrpt::math::TPoint2D& p) { return {p.x, p.y}; }

nlohmann::ordered_json as_json(const scoring::Rooms& rooms) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < rooms.rooms.size(); ++i) {
    const scoring::Room& r = rooms.rooms[i];
    out.push_back({{"name", name_of(i)},
                   {"centre_m", point(r.centre)},
                   {"box_min_m", point(r.box_min)},
                   {"box_max_m", point(r.box_max)},
                   {"area_m2", r.area},
                   {"perimeter_m", r.perimeter}});
  }
  return out;
}

nlohmann::ordered_json as_json(const std::vector<std::size_t>& rooms) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const std::size_t i : rooms) out.push_back(name_of(i));
  return out;
}

/// What the comparison adds.
void add_match(nlohmann::ordered_json& out, const scoring::RoomVerdict& found) {
  const mrpt::math::TPose2D& T = found.T_truth_map;
  out["aligned"] = found.aligned;
  if (!found.note.empty()) out["align_note"] = found.note;
  if (!found.aligned) return;
  out["T_truth_map"] = {{"x_m", T.x}, {"y_m", T.y}, {"yaw_deg", rad_to_deg(T.phi)}};
  out["pairs"] = nlohmann::ordered_json::array();
  for (const scoring::RoomPair& p : found.match.pairs)
    out["pairs"].push_back({{"truth", name_of(p.truth)},
                            {"map", name_of(p.map)},
                            {"offset_m", p.offset},
                            {"area_ratio", p.area_ratio},
                            {"difference", p.difference}});
  out["missing"] = as_json(found.match.missing);
  out["surplus"] = as_json(found.match.surplus);
  out["room_error_m2"] = found.match.error;
  out["room_agreement"] = found.match.score;
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
  const std::optional<GivenPose> pose = parse_pose(a.pose);
  if (pose && a.truth.empty()) throw UsageError("--pose goes with a truth; see rubble rooms --help");
  const bool by_sight = a.method == "visibility";
  Floor map = plan_of(a.map, a.map_resolution, pose ? pose->scale : 1.0);
  std::optional<Floor> truth;
  scoring::RoomVerdict found;
  if (!a.truth.empty()) {
    truth = plan_of(a.truth, a.truth_resolution);
    truth->rooms = checked(scoring::rooms_of_map(truth->map.grid, by_sight), a.truth);
    found = scoring::judge_rooms(
        map.map.grid, truth->map.grid, truth->rooms, by_sight,
        pose ? std::optional<mrpt::math::TPose2D>(pose->T_truth_map) : std::optional<mrpt::math::TPose2D>());
  }
  map.rooms = checked(truth ? found.of_map : scoring::rooms_of_map(map.map.grid, by_sight), a.map);
  if (!a.out.empty()) {
    make_folder(a.out);
    write_floor(a.out, "rooms", map);
    if (truth) write_floor(a.out, "truth_rooms", *truth);
  }
  nlohmann::ordered_json json = {{"rooms", as_json(map.rooms)}};
  if (!a.json) print_rooms(map);
  if (truth) {
    json["truth_rooms"] = as_json(truth->rooms);
    add_match(json, found);
    if (!a.json && found.aligned) print_match(found.match);
    if (!a.json && !found.aligned) print_not_aligned(found.note);
    if (found.aligned && !a.out.empty())
      scoring::write_side_by_side(place_in(a.out, "matched_rooms.png"), map.map.grid, truth->map.grid,
                                  found.T_truth_map, scoring::marks_of(map.rooms, truth->rooms, found.match));
  }
  if (a.json) print_json(json);
  return kOk;
}

}  // namespace

Command rooms_command() {
  return {"rooms", "Find the rooms of a map, and compare them with those of the truth",
          "Examples:\n  rubble rooms plan.png --resolution 0.05 --out rooms\n"
          "  rubble rooms team.tif truth.tif --method visibility\n"
          "  rubble rooms team.tif truth.tif --pose=1.5,-2,90 --json",
          [](Options& o) -> Action {
            auto a = std::make_shared<RoomsArguments>();
            o.argument("map", a->map, "GeoTIFF, ROS map.yaml, or image with --resolution");
            o.argument("truth", a->truth, "Ground truth, same formats", Options::Need::Optional);
            o.number("--resolution", a->map_resolution, 0.001, 10.0, "Metres a pixel of the map image");
            o.number("--truth-resolution", a->truth_resolution, 0.001, 10.0, "Metres a pixel of the truth image");
            o.choice("--method", a->method, {"passages", "visibility"},
                     "passages, or the paper's clusters of wall control points by what they see");
            o.text("--out", a->out, "Folder for rooms.png and rooms.csv, the truth's, and matched_rooms.png");
            o.text("--pose", a->pose,
                   "Compare at this pose, X,Y,DEG[,SCALE], instead of aligning (write --pose=-1,2,90)");
            o.flag("--json", a->json, "Print JSON");
            return [a] { return rooms(*a); };
          }};
}

}  // namespace rubble::app
