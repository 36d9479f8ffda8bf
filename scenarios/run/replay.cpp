#include "scenarios/run/replay.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "base/error.h"
#include "base/image/png.h"
#include "base/text/json_size.h"
#include "base/text/text_file.h"
#include "robot/logs/log.h"
#include "scenarios/run/film.h"
#include "scenarios/run/recorded_log.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

/// Where the re-made artefacts go: the folder that was asked for, or one that goes away again.
class Scratch {
 public:
  explicit Scratch(const std::string& wanted) : path_(wanted), kept_(!wanted.empty()) {
    if (kept_) return;
    path_ = (fs::temp_directory_path() / "rubble-replay-XXXXXX").string();
    if (mkdtemp(path_.data()) == nullptr)
      throw RunError(path_ + ": cannot be created; make the temporary folder writable or give --out");
  }
  ~Scratch() {
    std::error_code error;
    if (!kept_) fs::remove_all(path_, error);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool kept_;
};

/// Whether the shorter of two files is the beginning of the other: of what was ended on the spot, log and trajectory
/// reach up to different scans.
bool begin_alike(const std::string& a, const std::string& b) {
  const std::string one = read_text_file(a), other = read_text_file(b);
  const std::size_t size = std::min(one.size(), other.size());
  return one.compare(0, size, other, 0, size) == 0;
}

/// Nothing that the explorer says is compared with what somebody else steered.
bool steered_by_hand(const std::string& run) {
  const std::string file = run + "/versions.json";
  if (!fs::exists(file)) return false;
  const std::string text = read_text_file(file);
  const auto written_by = nlohmann::json::parse(is_modest_json(text) ? text : "", nullptr, false);
  if (!written_by.is_object())
    throw InputError(file + ": is not what rubble wrote (no JSON object); copy it again, or remove it");
  const auto by_hand = written_by.find(kSteeredByHand);
  if (by_hand == written_by.end()) return false;
  if (!by_hand->is_boolean())
    throw InputError(file + ": " + kSteeredByHand + " is neither true nor false; copy the file again");
  return by_hand->get<bool>();
}

/// What the run noted of its files when it ended. Throws InputError when the note is spoilt.
std::map<std::string, std::string> written_hashes(const std::string& run) {
  const std::string file = run + "/hashes.json";
  if (!fs::exists(file)) return {};
  const std::string text = read_text_file(file);
  const auto json = nlohmann::json::parse(is_modest_json(text) ? text : "", nullptr, false);
  const auto is_text = [](const nlohmann::json& value) { return value.is_string(); };
  if (!json.is_object() || json.empty() || !std::all_of(json.begin(), json.end(), is_text))
    throw InputError(file + ": is not what rubble wrote (names and their hashes); copy it again");
  return json.get<std::map<std::string, std::string>>();
}

bool same_commands(const robot::Commands& a, const robot::Commands& b) {
  return a.drive.v == b.drive.v && a.drive.w == b.drive.w && a.aim.pitch == b.aim.pitch && a.aim.roll == b.aim.roll &&
         a.brake == b.brake;
}

/// What must come out again. A run that was killed has no final map and trajectory, but what it knew at each scan.
std::vector<std::string> comparable(bool ended) {
  if (!ended) return {"estimate_live.tum"};
  return {"estimate.tum", "estimate_live.tum", "map.tif", "map.tfw", "map.png", "map.pgm", "map.yaml", "pois.csv"};
}

}  // namespace

Scenario recorded_scenario(const std::string& path, const std::vector<Override>& overrides) {
  log_in(path);
  return load_recorded(path + "/scenario.yaml", overrides);
}

ReplayReport replay_run(const std::string& path, const RunOptions& options) {
  return replay_run(path, recorded_scenario(path), options);
}

ReplayReport replay_run(const std::string& path, const Scenario& scenario, const RunOptions& options, int film) {
  scenario.mapper.require_permission();
  robot::ReplayRobot robot(path + "/log.rlog");
  const Scratch scratch(options.out);
  RunFolder folder(scratch.path(), options.replace, "give another folder with --out");
  const bool by_hand = steered_by_hand(path);
  Core core(scenario, robot.model(), !by_hand, folder.path());
  ReplayReport report;
  report.ended = fs::exists(path + "/hashes.json");
  folder.write("scenario.yaml", resolved_yaml(scenario));
  bool last_differs = false;
  LoopHooks hooks;
  hooks.interrupted = options.interrupted;
  hooks.progress = options.progress;
  hooks.share = [&] { return robot.progress(); };
  const double threshold = scenario.explorer.occupied_threshold();
  Film moments(film);
  hooks.steer = [&](const robot::Inputs& inputs, const robot::Commands& commands) {
    ++report.ticks;
    moments.see(core, inputs, robot.progress(), threshold);
    if (by_hand) return robot.recorded_commands();
    last_differs = !same_commands(commands, robot.recorded_commands());
    if (last_differs) ++report.different_commands;
    return commands;
  };
  const std::map<std::string, std::string> written = written_hashes(path);
  const LoopEnd end = Loop(scenario, folder, core, hooks).run(robot);
  if (!end.failure.empty()) throw RunError(end.failure);
  if (film > 0) {
    moments.end(core, threshold);
    folder.write("film.png", png_bytes(film_picture(moments.frames())));
  }
  // A run that was killed wrote its trajectory up to its last second, an older map, and its last tick perhaps without
  // the command that answered it.
  if (!report.ended && last_differs) --report.different_commands;
  report.identical = report.different_commands == 0;
  for (const std::string& name : comparable(report.ended)) {
    const std::string then = path + "/" + name, now = folder.file(name);
    bool same = fs::exists(then);
    if (same && !report.ended) same = begin_alike(now, then);
    if (same && report.ended) {  // the file of then, and nobody has touched it since
      const std::string hash = sha256_of_file(then);
      const auto at_its_end = written.find(name);
      same = hash == sha256_of_file(now) && (at_its_end == written.end() || at_its_end->second == hash);
    }
    report.artefacts.push_back({name, same});
    report.identical = report.identical && same;
  }
  folder.close();
  return report;
}

}  // namespace rubble::scenarios
