#include "scoring/league/league_victims.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/text/words.h"

namespace rubble::scoring {
namespace {

namespace fs = std::filesystem;

/// The list of victims that belongs to a truth map, when none is given.
std::string victims_beside(const std::string& truth, MapOrigin origin) {
  const fs::path folder = fs::path(truth).parent_path();
  std::string stem = fs::path(truth).stem().string();
  std::vector<fs::path> candidates = {folder / (stem + ".csv")};
  for (const std::string suffix : {"-truth", "-visible"})
    if (origin == MapOrigin::Local && ends_with(stem, suffix))
      candidates.push_back(folder / (stem.substr(0, stem.size() - suffix.size()) + ".yaml"));
  if (origin == MapOrigin::Local && stem == "truth") candidates.push_back(folder / "arena.yaml");
  for (const fs::path& path : candidates)
    if (fs::is_regular_file(path)) return path.string();
  return "";
}

double mean_error(const LeaguePoints& points) {
  double sum = 0.0;
  for (const VictimPoints& v : points.victims) sum += v.found ? v.error_m : 0.0;
  return sum / static_cast<double>(std::max<std::size_t>(1, found_victims(points)));
}

}  // namespace

ReportedVictims reported_victims(const LoadedMap& map, const std::string& csv) {
  ReportedVictims out;
  out.symbols = map.symbols.size();
  const PoiList list = csv.empty() ? PoiList{} : read_poi_list(csv);
  const bool from_start = list.form == PoiForm::League;
  const bool start_known = map.origin == MapOrigin::Local || map.origin == MapOrigin::Ros;
  if (!csv.empty() && (!from_start || start_known)) {
    out.victims = list.pois;
    out.from = VictimSource::List;
    if (from_start && map.origin == MapOrigin::Ros)  // x to the right instead of up
      for (Poi& poi : out.victims) poi.p_picture = {poi.p_picture.y, -poi.p_picture.x};
    return out;
  }
  if (!csv.empty())
    out.note = csv + ": counts from where the robot started, which the map (" +
               (map.origin == MapOrigin::Earth ? "turned or anchored on Earth" : "an image without a world file") +
               ") does not say; " + (map.symbols.empty() ? "it is left out" : "the symbols on the map are taken") +
               ", or give a list with the header name,x,y in the map's own metres";
  if (!map.symbols.empty()) {
    out.victims = map.symbols;
    out.from = VictimSource::Symbols;
  }
  return out;
}

TrueVictims true_victims(const std::string& truth, MapOrigin origin, const std::string& given) {
  TrueVictims out;
  out.path = given.empty() ? victims_beside(truth, origin) : given;
  if (out.path.empty()) return out;
  const PoiList list = read_poi_list(out.path);
  const bool own_metres = list.form == PoiForm::Plain;
  if (!own_metres && origin != MapOrigin::Local && origin != MapOrigin::Ros)
    throw InputError(out.path + ": has coordinates of its own, which " + truth +
                     " does not say where to lay; give the truth as GeoTIFF or with a world file");
  out.victims = list.pois;
  return out;
}

std::optional<LeaguePoints> victim_points(const OccupancyGrid& map, const OccupancyGrid& truth, const MapScore& score,
                                          const ReportedVictims& reported, const TrueVictims& victims) {
  if (reported.from == VictimSource::None || victims.path.empty()) return std::nullopt;
  if (score.aligned) return league_points(map, truth, score.T_truth_map, reported.victims, victims.victims);
  LeaguePoints points = league_points({}, {}, {}, {}, victims.victims);
  points.false_alarms = reported.victims.size();
  return points;
}

std::size_t found_victims(const LeaguePoints& points) {
  return static_cast<std::size_t>(
      std::count_if(points.victims.begin(), points.victims.end(), [](const VictimPoints& v) { return v.found; }));
}

VictimFigures victim_figures(const ReportedVictims& reported, const std::optional<LeaguePoints>& points) {
  VictimFigures out;
  out.from = reported.from;
  out.symbols = reported.symbols;
  out.reported = reported.victims.size();
  if (!points) return out;
  out.judged = true;
  out.total = points->victims.size();
  out.found = found_victims(*points);
  out.false_alarms = points->false_alarms;
  out.error_m = mean_error(*points);
  out.quality = points->quality;
  out.location = points->location;
  out.fine = points->fine;
  return out;
}

}  // namespace rubble::scoring
