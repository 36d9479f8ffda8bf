#include "scenarios/run/run_folder.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "arenas/truth/render.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/image/png.h"
#include "base/text/csv.h"
#include "base/text/input_file.h"
#include "base/text/words.h"
#include "scoring/maps/ros_map.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = ".partial";
constexpr const char* kReplaced = ".replaced";     // the older run, whole
constexpr const char* kMoving = ".replaced.part";  // parts of it, the others not moved yet

bool is_own_folder(const fs::path& folder) {
  const fs::path name = folder.filename();
  return (name == kPartial || name == kReplaced || name == kMoving) &&
         fs::symlink_status(folder).type() == fs::file_type::directory;
}

[[noreturn]] void cannot_write(const std::string& path, const std::string& why) {
  throw RunError(path + ": cannot be written (" + why + "); check the folder, its permissions and the free space");
}

[[noreturn]] void cannot_create(const std::string& path, const std::error_code& error) {
  throw InputError(path + ": cannot be created (" + error.message() + "); give a writable folder with --out");
}

/// --force would not replace it, so it is not offered.
void refuse_batch_folder(const std::string& path) {
  std::error_code error;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(path, error)) names.insert(entry.path().filename().string());
  for (const std::string& name : names) {
    // A shard has its number in its files' names: results-1of4.jsonl.
    const std::string ending = fs::path(name).extension().string();
    const bool results = name.rfind("results", 0) == 0 && ending == ".jsonl";
    const bool log = name.rfind("workers", 0) == 0 && ending == ".log";
    if (results || log || name == "slurm")
      throw InputError(path + ": is the folder of a batch (it holds " + name +
                       "); give the run a folder of its own with --out");
  }
}

/// The league's list of points of interest: preamble, then one line a detection. Its names have no blanks.
std::string pois_csv(const Scenario& s, const std::vector<explore::VictimReport>& victims) {
  // Date and time would make two runs of one seed differ, so the preamble carries the start of the epoch.
  std::string csv = "\"pois\"\n\"1.3\"\n" + csv_quoted(not_a_formula(s.team)) +
                    "\n\"\"\n\"1970-01-01\"\n\"00:00:00\"\n" + csv_quoted(not_a_formula(s.mission)) +
                    "\ndetection,time,type,name,x,y,z,robot,mode\n";
  for (const auto& victim : victims) {
    const long seconds = static_cast<long>(victim.stamp.seconds());
    char line[200];  // of numbers only: a name may be of any length
    std::snprintf(line, sizeof line, "%d,%02ld:%02ld:%02ld,victim,victim_%d,%.3f,%.3f,0.000,", victim.id,
                  seconds / 3600 % 24, seconds / 60 % 60, seconds % 60, victim.id, victim.p_map.x, victim.p_map.y);
    csv += line + csv_field(not_a_formula(s.robot.name)) + ",A\n";
  }
  return csv;
}

/// What the league's list has no room for: how sure each victim and its place are, and which senses told of it.
std::string victims_csv(const std::vector<explore::VictimReport>& victims) {
  std::string csv = "id,time_s,x_m,y_m,xx_m2,xy_m2,yy_m2,confidence,senses\n";
  for (const auto& victim : victims) {
    const explore::PlaceCovariance& c = victim.covariance;
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "%d,%.2f,%.3f,%.3f,%.5f,%.5f,%.5f,%.3f,", victim.id, victim.stamp.seconds(),
                  victim.p_map.x, victim.p_map.y, c.xx, c.xy, c.yy, victim.confidence);
    csv += line.data() + senses(victim) + "\n";
  }
  return csv;
}

}  // namespace

scoring::LeagueCells league_cells(const slam::CountMap& map) {
  return {map.frame(), [&map](Cell c) { return map.seen(c) > 0 ? std::optional(map.p_occ(c)) : std::nullopt; }};
}

const std::vector<std::string>& deterministic_artefacts() {
  static const std::vector<std::string> names = {
      "arena.yaml",   "arena.png",         "truth.tif",   "truth.png",   "log.rlog",  "truth.tum",
      "estimate.tum", "estimate_live.tum", "map.tif",     "map.tfw",     "map.png",   "map.pgm",
      "map.yaml",     "pois.csv",          "victims.csv", "overlay.png", "error.png", "sight.png",
      "map.rmap",     "scans.csv",         "scans.png",   "loops.csv",   "loops.png"};
  return names;
}

const std::vector<std::string>& run_folder_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = deterministic_artefacts();
    for (const char* name : {"scenario.yaml", "robot.yaml", "versions.json", "hashes.json", "score.json",
                             "decisions.txt", "devices.bytes", "mapper.log", "film.png"})
      all.emplace_back(name);
    return all;
  }();
  return names;
}

/// Without what write_text_file() appends to a file it has not finished: ".4711.part", ".4711-2.part".
std::string without_part(const std::string& name) {
  constexpr std::string_view kPart = ".part";
  if (!ends_with(name, kPart)) return name;
  const std::size_t dot = name.rfind('.', name.size() - kPart.size() - 1);
  const bool numbered =
      dot != std::string::npos && name.find_first_not_of("0123456789-", dot + 1) == name.size() - kPart.size();
  return numbered ? name.substr(0, dot) : name;
}

std::vector<std::string> files_of_run(const std::string& path) {
  const auto& names = run_folder_names();
  const auto is_ours = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), without_part(name)) != names.end();
  };
  // Each run begins with this file; a folder with a map.yaml and a map.png may be anybody's.
  bool begun = false, empty = true;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    empty = empty && is_own_folder(entry.path());
    begun = begun || name == "estimate.tum";
  }
  begun = begun || fs::exists(fs::path(path) / kMoving / "estimate.tum");
  if (!begun && !empty)
    throw InputError(path +
                     ": is not a run folder (no estimate.tum), so --force does not replace it; give another --out");
  const auto own_files = [&](const fs::path& folder) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (folder == path && is_own_folder(entry.path())) continue;
      if (!is_ours(entry.path().filename().string()) || entry.symlink_status().type() == fs::file_type::directory)
        throw InputError(entry.path().string() + ": is not of a run, so --force does not replace its folder; move it " +
                         "away or give another --out");
      if (was_read(entry.path().string()))
        throw InputError(entry.path().string() +
                         ": is what is read, and would be lost with its folder; give another --out");
      files.push_back(entry.path().string());
    }
    return files;
  };
  std::vector<std::string> old = own_files(path);
  const fs::path partial = fs::path(path) / kPartial;
  if (fs::symlink_status(partial).type() == fs::file_type::directory) {
    for (std::string& file : own_files(partial)) old.push_back(std::move(file));
    old.push_back(partial.string());
  }
  // Nothing else may be in what close() removes.
  for (const char* name : {kReplaced, kMoving})
    if (const fs::path aside = fs::path(path) / name; is_own_folder(aside)) own_files(aside);
  return old;
}

std::string next_run_folder(const std::string& parent, const std::string& name, std::uint64_t seed) {
  std::error_code error;
  fs::create_directories(parent, error);
  if (error) cannot_create(parent, error);
  for (int number = 1;; ++number) {
    char suffix[16];
    std::snprintf(suffix, sizeof suffix, "-%03d", number);
    const std::string path = parent + "/" + name + "-seed" + std::to_string(seed) + suffix;
    // To make it is the test: of two runs that start together only one can.
    if (fs::create_directory(path, error)) return path;
    if (error && error != std::errc::file_exists) cannot_create(path, error);
  }
}

RunFolder::RunFolder(const std::string& path, bool replace, const std::string& remedy) : path_(path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw InputError(path + ": is a file; give another folder with --out");
  made_ = fs::create_directories(path, error);
  if (error) cannot_create(path, error);
  lock_.emplace(path);
  if (!fs::is_empty(path, error)) {
    refuse_batch_folder(path);
    if (!replace) throw InputError(path + ": exists and is not empty; " + remedy);
    set_aside(files_of_run(path));
    replaces_ = true;
  }
  fs::create_directories(file(kPartial), error);
  if (error) {
    put_back();
    cannot_create(path, error);
  }
  estimate_.file.open(file("estimate.tum"));
  live_.file.open(file("estimate_live.tum"));
  if (!estimate_.file || !live_.file) {
    put_back();
    throw InputError(path + ": cannot be written to; give a writable folder with --out");
  }
}

RunFolder::~RunFolder() {
  if (keeps_unfinished_) return;
  const bool refused = !begun_ && !closed_ && !replaces_;
  put_back();
  if (refused) clear_away();
}

/// Renames only, so a kill loses nothing: while the older run is moved its parts are in two places, and the next
/// command brings them together. Where an older run waits already, what lies above it was killed and is not worth it.
void RunFolder::set_aside(const std::vector<std::string>& old) const {
  const fs::path moving = file(kMoving), aside = file(kReplaced);
  if (is_own_folder(aside)) {
    for (const std::string& name : old) fs::remove(name);
    return;
  }
  fs::create_directory(moving);
  for (const std::string& name : old) {
    const bool is_partial =
        fs::path(name).filename() == kPartial || fs::path(name).parent_path().filename() == kPartial;
    if (is_partial)
      fs::remove(name);
    else
      fs::rename(name, moving / fs::path(name).filename());
  }
  fs::rename(moving, aside);
}

/// What this wrote.
void RunFolder::clear_away() noexcept {
  std::error_code error;
  try {
    for (const std::string& name : run_folder_names()) fs::remove(file(name), error);
    fs::remove_all(file(kPartial), error);
    if (made_) fs::remove(path_, error);
  } catch (const std::exception&) {
    return;
  }
}

void RunFolder::put_back() noexcept {
  if (!replaces_) return;
  replaces_ = false;
  std::error_code error;
  try {
    const auto& names = run_folder_names();
    for (const std::string& name : names) fs::remove(file(name), error);
    fs::remove_all(file(kPartial), error);
    for (const auto& entry : fs::directory_iterator(file(kReplaced)))
      fs::rename(entry.path(), fs::path(path_) / entry.path().filename(), error);
    fs::remove(file(kReplaced), error);
  } catch (const std::exception&) {
    return;  // it stays where it waits
  }
}

void RunFolder::write(const std::string& name, const std::string& content) const {
  const std::string partial = file(std::string(kPartial) + "/" + name);
  std::ofstream out(partial, std::ios::binary);
  out << content;
  out.close();
  if (!out) cannot_write(partial, std::strerror(errno));
  std::error_code error;
  fs::rename(partial, file(name), error);
  if (error) cannot_write(file(name), error.message());
}

void RunFolder::publish(const std::vector<std::string>& names,
                        const std::function<void(const std::string&)>& write) const {
  const std::string partial = file(kPartial) + "/";
  write(partial);
  for (const std::string& name : names) {
    std::error_code error;
    fs::rename(partial + name, file(name), error);
    if (error) cannot_write(file(name), error.message());
  }
}

void RunFolder::append(Growing& growing, const Trajectory& trajectory) {
  begun_ = begun_ || !trajectory.empty();
  for (; growing.written < trajectory.size(); ++growing.written)
    growing.file << tum_line(trajectory[growing.written]) << '\n';
  growing.file.flush();
  if (!growing.file) cannot_write(path_, std::strerror(errno));
  std::error_code error;
  if (!fs::exists(path_, error)) throw RunError(path_ + ": the folder was deleted under way; run again");
}

void RunFolder::append_truth(const Trajectory& truth) {
  if (!truth_.file.is_open()) truth_.file.open(file("truth.tum"));
  append(truth_, truth);
}

void RunFolder::append_estimate(const slam::Mapper& mapper) {
  append(live_, mapper.live_trajectory());
  if (mapper.revision() == revision_) append(estimate_, mapper.trajectory());
}

void RunFolder::save_estimate(const slam::Mapper& mapper) {
  append(live_, mapper.live_trajectory());
  if (mapper.revision() != revision_) {
    publish({"estimate.tum"}, [&](const std::string& partial) {
      estimate_.file.close();
      estimate_.file.open(partial + "estimate.tum");
      estimate_.written = 0;
      append(estimate_, mapper.trajectory());
    });
    revision_ = mapper.revision();
  }
  append(estimate_, mapper.trajectory());
}

void RunFolder::save_map(const Scenario& scenario, const slam::Mapper& mapper,
                         const std::vector<explore::VictimReport>& victims,
                         const std::function<bool(const mrpt::math::TPoint2D&)>& searched) const {
  scoring::LeagueDrawing drawing;
  drawing.occupied_threshold = scenario.explorer.occupied_threshold();
  drawing.title = "RoboCup-" + scenario.team + "-" + scenario.mission + "-map.tif";
  drawing.path = mapper.trajectory();
  for (const explore::VictimReport& victim : victims) drawing.victims.push_back({victim.id, victim.p_map});
  drawing.searched = searched;
  drawing.geo = scenario.geo;
  const GeoTiff tiff = scoring::draw_league_map(league_cells(mapper.map()), drawing);
  publish({"map.tif", "map.tfw", "map.png", "map.pgm", "map.yaml"}, [&](const std::string& partial) {
    write_geotiff(partial + "map.tif", tiff);
    write_world_file(partial + "map.tfw", *tiff.transform);
    write_png(partial + "map.png", tiff.image);
    scoring::write_ros_map(partial + "map", mapper.map().classify(drawing.occupied_threshold),
                           drawing.occupied_threshold);
  });
  write("pois.csv", pois_csv(scenario, victims));
  write("victims.csv", victims_csv(victims));
}

void RunFolder::save_truth(const arenas::Arena& arena, const OccupancyGrid& truth) const {
  const GeoTiff tiff = scoring::draw_truth(truth);
  publish({"truth.tif", "truth.png", "arena.png"}, [&](const std::string& partial) {
    write_geotiff(partial + "truth.tif", tiff);
    write_png(partial + "truth.png", tiff.image);
    write_png(partial + "arena.png", arenas::render_with_legend(arena, 40.0));
  });
}

void RunFolder::save_hashes(const std::string& score_text) const {
  nlohmann::ordered_json hashes;
  for (const auto& name : deterministic_artefacts())
    if (fs::exists(file(name))) hashes[name] = sha256_of_file(file(name));
  hashes["score"] = sha256_of_text(score_text);
  write("hashes.json", hashes.dump(2) + "\n");
}

void RunFolder::close(bool whole) {
  std::error_code error;
  fs::remove_all(file(kPartial), error);
  if (replaces_ && whole) fs::remove_all(file(kReplaced), error);
  replaces_ = false;
  closed_ = true;
}

void RunFolder::link_latest(const slam::Mapper& mapper) const {
  if (mapper.live_trajectory().empty()) return;
  std::error_code error;
  fs::path folder = fs::absolute(path_, error).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "runs/mine/"
  if (folder.parent_path().filename() != "runs") return;
  const fs::path link = folder.parent_path() / "latest";
  if (fs::exists(fs::symlink_status(link, error)) && !fs::is_symlink(link, error)) return;  // somebody's own file
  const fs::path made = link.parent_path() / (".latest." + std::to_string(getpid()) + ".part");
  fs::remove(made, error);
  fs::create_directory_symlink(folder.filename(), made, error);
  if (error) return;
  fs::rename(made, link, error);
  if (error) fs::remove(made, error);
}

}  // namespace rubble::scenarios
