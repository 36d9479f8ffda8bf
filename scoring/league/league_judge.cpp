#include "scoring/league/league_judge.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "scoring/maps/normalise.h"
#include "scoring/marks.h"
#include "scoring/pictures/evaluation_page.h"
#include "scoring/pictures/picture.h"
#include "scoring/pictures/sight_picture.h"
#include "scoring/room_report.h"

namespace rubble::scoring {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOverlay = "-overlay.png";
constexpr const char* kErrorMap = "-error.png";
constexpr const char* kSightMap = "-sight.png";
constexpr const char* kPage = ".html";
constexpr const char* kNumber = "-map";  ///< before the number of a team's map

constexpr std::size_t kMostOfName = 80;  ///< [bytes] of a team's name in names of files, which end at 255

/// A file name of its own for each team, whatever the team calls itself. The number is none of its rank: it stands
/// behind the name.
std::string safe_name(const std::string& team, std::size_t index) {
  std::string name;
  for (const char c : team.substr(0, kMostOfName))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.' ? c : '_';
  return name + kNumber + std::to_string(index + 1);
}

bool all_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// A name by safe_name() with one of our endings; earlier programs put the number first (`001-NAME`).
bool is_named_by_us(const std::string& name) {
  for (const char* ending : {kOverlay, kErrorMap, kSightMap, kPage}) {
    if (!ends_with(name, ending)) continue;
    const std::string stem = name.substr(0, name.size() - std::string(ending).size());
    const std::size_t at = stem.rfind(kNumber);
    if (at != std::string::npos && all_digits(stem.substr(at + std::string(kNumber).size()))) return true;
    if (stem.size() > 4 && stem[3] == '-' && all_digits(stem.substr(0, 3))) return true;
  }
  return false;
}

/// Pages and pictures of teams from an earlier call: those its league.html leads to or shows, named by safe_name().
void remove_old_pages(const std::string& folder) {
  if (!fs::exists(folder + "/league.csv") || !fs::is_regular_file(folder + "/league.html")) return;
  std::ifstream page(folder + "/league.html");  // no input: it is written anew
  const std::string table(std::istreambuf_iterator<char>(page), {});
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = is_named_by_us(name) && entry.is_regular_file() && table.find(name) != std::string::npos;
    if (is_ours && !was_read(entry.path().string())) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

/// `pois`: the team's list of victims.
LeaguePictures draw(const LeagueEntry& entry, const OccupancyGrid& map, const LeagueTruth& truth,
                    const LeagueConfig& config, const std::string& name, const std::string& pois) {
  LeaguePictures pictures;
  pictures.overlay = name + kOverlay;
  const Marks marks =
      marks_on_overlay(entry.score, entry.reported.victims, truth.victims.victims, !truth.victims.path.empty());
  if (entry.score.aligned || entry.score.by != AlignBy::Auto)
    write_overlay(place_in(config.out, pictures.overlay), map, truth.grid, entry.score.T_truth_map,
                  entry.score.aligned ? "" : "NOT TRUSTED: " + reason_of(entry.score.note), marks);
  else
    write_side_by_side(place_in(config.out, pictures.overlay), map, truth.grid, std::nullopt, {}, entry.score.note);
  if (entry.score.aligned) {
    pictures.error = name + kErrorMap;
    write_error_map(place_in(config.out, pictures.error), map, truth.grid, entry.score.T_truth_map, config.score.tau);
    pictures.sight = name + kSightMap;
    write_sight_map(place_in(config.out, pictures.sight), map, truth.grid, entry.score.T_truth_map);
  }
  pictures.tool = name + kPage;
  Marks rooms;
  if (entry.score.warped && config.truth_rooms)
    rooms = room_marks(map, truth.grid, *config.truth_rooms, entry.score.T_truth_map);
  write_text_file(
      place_in(config.out, pictures.tool),
      evaluation_page(
          map, truth.grid,
          {entry.file, truth.path,
           words_of({entry.file, truth.path, config.map_resolution, config.truth_resolution, config.score.tau,
                     entry.reported.from == VictimSource::List ? pois : "", truth.victims.path}),
           entry.score.T_truth_map, 1.0, config.score, entry.score.aligned ? "" : reason_of(entry.score.note),
           marks_on_page(entry.score, marks, rooms), entry.score.score_at_best_pose, entry.score.by, marks.seam}));
  return pictures;
}

/// A spoilt list of victims is no reason not to judge the map: what the map shows counts, and the note names the list.
ReportedVictims victims_of(const LoadedMap& map, const std::string& list) {
  try {
    return reported_victims(map, list);
  } catch (const InputError& error) {
    ReportedVictims out = reported_victims(map, "");
    out.note = error.what() +
               std::string(map.symbols.empty() ? "; no victims are counted" : "; the symbols on the map are taken");
    return out;
  }
}

void judge_map(const LeagueFiles& files, const LeagueTruth& truth, const LeagueConfig& config, const std::string& name,
               LeagueEntry& entry, LeaguePictures& pictures) {
  const LoadedMap loaded = load_map(files.map, {config.map_resolution, false});
  entry.reported = victims_of(loaded, files.pois);
  if (!entry.reported.note.empty() && config.tell) config.tell(entry.reported.note);
  entry.score = score_map(loaded.grid, truth.grid, config.score);
  if (same_content(files.map, truth.path)) add_note(entry.score.note, "a copy of the truth, byte for byte");
  add_note(entry.score.note, entry.reported.note);
  entry.points = victim_points(loaded.grid, truth.grid, entry.score, entry.reported, truth.victims);
  if (!config.out.empty()) pictures = draw(entry, loaded.grid, truth, config, name, files.pois);
}

/// Two teams that handed in one file: said of both.
void note_copies(std::vector<LeagueEntry>& entries) {
  for (LeagueEntry& entry : entries) {
    if (!entry.error.empty()) continue;
    std::vector<std::string> others;
    for (const LeagueEntry& other : entries)
      if (other.team != entry.team && other.error.empty() && same_content(other.file, entry.file))
        others.push_back(other.team);
    if (!others.empty()) add_note(entry.score.note, "the same file as the map of " + joined(others));
  }
}

}  // namespace

bool League::with_points() const {
  return std::any_of(entries.begin(), entries.end(), [](const LeagueEntry& e) { return e.points || e.judge > 0.0; });
}

LeagueTruth load_league_truth(const std::string& path, const std::optional<double>& resolution,
                              const std::string& victims) {
  LoadedMap loaded = load_map(path, {resolution});
  LeagueTruth truth;
  truth.path = path;
  truth.victims = true_victims(path, loaded.origin, victims);
  truth.grid = std::move(loaded.grid);
  return truth;
}

std::map<std::string, double> judges_points(const std::string& file, const std::string& folder,
                                            const LeagueTruth& truth, const std::vector<LeagueFiles>& teams) {
  if (file.empty()) return {};
  const std::map<std::string, double> judge = read_judge(file);
  const double most = kJudgesMostPerVictim * static_cast<double>(truth.victims.victims.size());
  for (const auto& [team, points] : judge) {
    const auto is_team = [name = &team](const LeagueFiles& files) { return files.team == *name; };
    if (std::none_of(teams.begin(), teams.end(), is_team))
      throw InputError(file + ": names team '" + team + "', but " + folder + " holds no map of that name");
    if (!truth.victims.path.empty() && points > most)
      throw InputError(file + ": gives '" + team + "' " + number_text(points) + " points, but " +
                       std::to_string(truth.victims.victims.size()) + " victims are worth " + number_text(most) +
                       " at the most");
  }
  return judge;
}

League judge_league(const LeagueFolder& folder, const LeagueTruth& truth, const std::map<std::string, double>& judge,
                    const LeagueConfig& given) {
  LeagueConfig config = given;
  config.score = prepared_for(truth.grid, config.score);
  if (config.score.warp && !config.out.empty())
    config.truth_rooms = std::make_shared<const Rooms>(rooms_of_map(truth.grid, false));
  if (!config.out.empty()) remove_old_pages(config.out);
  League league;
  std::map<std::pair<std::string, std::string>, LeaguePictures> pictures;  // of team and file
  for (const LeagueFiles& files : folder.teams) {
    LeagueEntry entry;
    entry.team = files.team;
    entry.file = files.map;
    if (const auto points = judge.find(files.team); points != judge.end()) entry.judge = points->second;
    entry.error = files.error;
    LeaguePictures& drawn = pictures[{entry.team, entry.file}];
    if (entry.error.empty()) try {
        judge_map(files, truth, config, safe_name(entry.team, league.entries.size()), entry, drawn);
      } catch (const InputError& error) {
        entry.error = error.what();
      }
    league.entries.push_back(std::move(entry));
  }
  note_copies(league.entries);
  rank_league(league.entries);
  for (const LeagueEntry& entry : league.entries) league.pictures.push_back(pictures.at({entry.team, entry.file}));
  for (const std::string& path : folder.skipped) league.left_out += (league.left_out.empty() ? "" : ", ") + path;
  return league;
}

void write_league(const League& league, const LeagueTruth& truth, const std::string& out) {
  write_text_file(place_in(out, "league.csv"), league_csv(league.entries));
  write_text_file(place_in(out, "league.html"),
                  league_page(truth.path, league.with_points(), league.entries, league.pictures, league.left_out));
}

}  // namespace rubble::scoring
