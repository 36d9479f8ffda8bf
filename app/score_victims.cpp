#include "app/score_victims.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/error.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;

/// The list of victims that belongs to a truth map, when none is given.
std::string victims_beside(const std::string& truth, scoring::MapOrigin origin) {
  const fs::path folder = fs::path(truth).parent_path();
  std::string stem = fs::path(truth).stem().string();
  std::vector<fs::path> candidates = {folder / (stem + ".csv")};
  for (const std::string suffix : {"-truth", "-visible"})
    if (origin == scoring::MapOrigin::Local && stem.size() > suffix.size() &&
        stem.compare(stem.size() - suffix.size(), suffix.size(), suffix) == 0)
      candidates.push_back(folder / (stem.substr(0, stem.size() - suffix.size()) + ".yaml"));
  if (origin == scoring::MapOrigin::Local && stem == "truth") candidates.push_back(folder / "arena.yaml");
  for (const fs::path& path : candidates)
    if (fs::is_regular_file(path)) return path.string();
  return "";
}

double mean_error(const scoring::LeaguePoints& points) {
  double sum = 0.0;
  for (const scoring::VictimPoints& v : points.victims) sum += v.found ? v.error_m : 0.0;
  return sum / static_cast<double>(std::max<std::size_t>(1, found_victims(points)));
}

}  // namespace

ReportedVictims reported_victims(const scoring::LoadedMap& map, const std::string& csv) {
  ReportedVictims out;
  out.symbols = map.symbols.size();
  const scoring::PoiList list = csv.empty() ? scoring::PoiList{} : scoring::read_poi_list(csv);
  const bool from_start = list.form == scoring::PoiForm::League;
  const bool start_known = map.origin == scoring::MapOrigin::Local || map.origin == scoring::MapOrigin::Ros;
  if (!csv.empty() && (!from_start || start_known)) {
    out.victims = list.pois;
    out.from = "csv";
    if (from_start && map.origin == scoring::MapOrigin::Ros)  // x to the right instead of up
      for (scoring::Poi& poi : out.victims) poi.p_picture = {poi.p_picture.y, -poi.p_picture.x};
    return out;
  }
  if (!csv.empty())
    std::fprintf(
        stderr,
        "rubble: %s: counts from where the robot started, which the map (%s) does not say; %s, or give a list with the "
        "header "
        "name,x,y in the map's own metres\n",
        csv.c_str(),
        map.origin == scoring::MapOrigin::Earth ? "turned or anchored on Earth" : "an image without a world file",
        map.symbols.empty() ? "it is left out" : "the symbols on the map are taken");
  if (!map.symbols.empty()) {
    out.victims = map.symbols;
    out.from = "symbols";
  }
  return out;
}

TrueVictims true_victims(const std::string& truth, scoring::MapOrigin origin, const std::string& given) {
  TrueVictims out;
  out.path = given.empty() ? victims_beside(truth, origin) : given;
  if (out.path.empty()) return out;
  const scoring::PoiList list = scoring::read_poi_list(out.path);
  const bool own_metres = list.form == scoring::PoiForm::Plain;
  if (!own_metres && origin != scoring::MapOrigin::Local && origin != scoring::MapOrigin::Ros)
    throw InputError(out.path + ": has coordinates of its own, which " + truth +
                     " does not say where to lay; give the truth as GeoTIFF or with a world file");
  out.victims = list.pois;
  return out;
}

std::optional<scoring::LeaguePoints> victim_points(const OccupancyGrid& map, const OccupancyGrid& truth,
                                                   const scoring::MapScore& score, const ReportedVictims& reported,
                                                   const TrueVictims& victims) {
  if (reported.from == "none" || victims.path.empty()) return std::nullopt;
  if (score.aligned) return scoring::league_points(map, truth, score.T_truth_map, reported.victims, victims.victims);
  scoring::LeaguePoints points = scoring::league_points({}, {}, {}, {}, victims.victims);
  points.false_alarms = reported.victims.size();
  return points;
}

std::size_t found_victims(const scoring::LeaguePoints& points) {
  return static_cast<std::size_t>(std::count_if(points.victims.begin(), points.victims.end(),
                                                [](const scoring::VictimPoints& v) { return v.found; }));
}

void print_victims(const ReportedVictims& reported, const std::optional<scoring::LeaguePoints>& points) {
  if (reported.from == "none") return;
  std::printf("%-26s %zu from %s, %zu symbols on the map\n", "victims reported", reported.victims.size(),
              reported.from.c_str(), reported.symbols);
  if (!points) return;
  std::printf("%-26s %zu of %zu, %zu false, %.2f m off\n", "victims found", found_victims(*points),
              points->victims.size(), points->false_alarms, mean_error(*points));
  std::printf("%-26s %.1f map quality, %.1f location\n", "points for victims", points->quality, points->location);
}

void add_victims(nlohmann::ordered_json& json, const ReportedVictims& reported,
                 const std::optional<scoring::LeaguePoints>& points) {
  json["victims_from"] = reported.from;
  json["victim_symbols"] = reported.symbols;
  json["victims_reported"] = reported.victims.size();
  if (!points) return;
  json["victims_found"] = found_victims(*points);
  json["victims_total"] = points->victims.size();
  json["victims_false"] = points->false_alarms;
  json["victims_error_m"] = mean_error(*points);
  json["points_quality"] = points->quality;
  json["points_location"] = points->location;
}

}  // namespace rubble::app
