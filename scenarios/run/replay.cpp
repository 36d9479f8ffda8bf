#include "scenarios/run/replay.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/digest.h"
#include "base/error.h"
#include "robot/logs/log.h"

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

/// Whether the bytes of `beginning` are the first ones of `whole`.
bool starts_with_file(const std::string& whole, const std::string& beginning) {
  std::ifstream a(whole, std::ios::binary);
  std::ifstream b(beginning, std::ios::binary);
  const std::string first{std::istreambuf_iterator<char>(b), {}};
  std::string same(first.size(), '\0');
  a.read(same.data(), static_cast<std::streamsize>(same.size()));
  return a.gcount() == static_cast<std::streamsize>(first.size()) && same == first;
}

bool same_commands(const robot::Commands& a, const robot::Commands& b) {
  return a.drive.v == b.drive.v && a.drive.w == b.drive.w && a.aim.pitch == b.aim.pitch && a.aim.roll == b.aim.roll;
}

/// What must come out again. A run that was killed has no final map and trajectory, but what it knew at each scan.
std::vector<std::string> comparable(bool ended) {
  if (!ended) return {"estimate_live.tum"};
  return {"estimate.tum", "estimate_live.tum", "map.tif", "map.tfw", "map.png", "map.pgm", "map.yaml", "pois.csv"};
}

}  // namespace

Scenario recorded_scenario(const std::string& path, const std::vector<Override>& overrides) {
  if (!fs::exists(path + "/log.rlog"))
    throw InputError(path + ": is not a recorded run (no log.rlog in it); give a folder that 'rubble run' wrote");
  return load_recorded(path + "/scenario.yaml", overrides);
}

ReplayReport replay_run(const std::string& path, const RunOptions& options) {
  return replay_run(path, recorded_scenario(path), options);
}

ReplayReport replay_run(const std::string& path, const Scenario& scenario, const RunOptions& options) {
  scenario.mapper.require_permission();
  robot::ReplayRobot robot(path + "/log.rlog");
  const Scratch scratch(options.out);
  RunFolder folder(scratch.path(), options.replace);
  Core core(scenario, robot.model(), true, folder.path());
  ReplayReport report;
  report.ended = fs::exists(path + "/hashes.json");
  folder.write("scenario.yaml", resolved_yaml(scenario));
  bool last_differs = false;
  LoopHooks hooks;
  hooks.interrupted = options.interrupted;
  hooks.progress = options.progress;
  hooks.share = [&] { return robot.progress(); };
  hooks.steer = [&](const robot::Inputs&, const robot::Commands& commands) {
    ++report.ticks;
    last_differs = !same_commands(commands, robot.recorded_commands());
    if (last_differs) ++report.different_commands;
    return commands;
  };
  const LoopEnd end = Loop(scenario, folder, core, hooks).run(robot);
  if (!end.failure.empty()) throw RunError(end.failure);
  // A run that was killed wrote its trajectory up to its last second, an older map, and its last tick perhaps without
  // the command that answered it.
  if (!report.ended && last_differs) --report.different_commands;
  report.identical = report.different_commands == 0;
  for (const std::string& name : comparable(report.ended)) {
    const std::string then = path + "/" + name, now = folder.file(name);
    const bool same =
        fs::exists(then) && (report.ended ? sha256_of_file(then) == sha256_of_file(now) : starts_with_file(now, then));
    report.artefacts.push_back({name, same});
    report.identical = report.identical && same;
  }
  folder.close();
  return report;
}

}  // namespace rubble::scenarios
