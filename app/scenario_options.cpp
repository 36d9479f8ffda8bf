#include "app/scenario_options.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "scenarios/run/recorded_log.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// The bare name of a file in `folder`, and of no file here.
bool is_shipped(const std::string& name, const fs::path& folder) {
  return !name.empty() && name.find('/') == std::string::npos && !is_there(name) && is_there(folder / (name + ".yaml"));
}

/// The lists of `rubble benchmark` lie beside the scenarios.
bool is_list(const fs::path& file) { return file.stem().string().rfind("benchmark", 0) == 0; }
bool is_no_list(const fs::path& file) { return !is_list(file); }

/// Beside the sweeps lie scenarios that only they use. What cannot be read is none.
bool is_sweep(const fs::path& file) {
  try {
    return ("\n" + read_text_file(file.string())).find("\nseeds:") != std::string::npos;
  } catch (const InputError&) {
    return false;
  }
}

/// `name`, unless it is the bare name of a file in `folder`. A bare name of none is told which there are.
std::string find_shipped(const std::string& name, const fs::path& folder,
                         bool (*is_meant)(const fs::path&) = is_no_list) {
  if (is_shipped(name, folder)) return (folder / (name + ".yaml")).string();
  if (is_there(name) || name.find_first_of("/.") != std::string::npos) return name;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const std::string stem = entry->path().stem().string();
        entry->path().extension() == ".yaml" && is_meant(entry->path()))
      names.push_back(stem);
  std::sort(names.begin(), names.end());
  throw InputError(name + ": there is no such file, and none of that name is shipped" + did_you_mean(name, names) +
                   "; shipped are " + joined(names));
}

}  // namespace

void add_sets(Options& options, std::vector<std::string>& sets) {
  options.texts("--set", sets, "Override one value: --set key.key=value (repeatable)");
}

std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets) {
  std::vector<scenarios::Override> overrides;
  for (const auto& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + set + ": needs the form key.key=value, for example --set robot.levelling=false");
    overrides.emplace_back(set.substr(0, equals), set.substr(equals + 1));
  }
  return overrides;
}

std::vector<scenarios::Override> parse_sweep_sets(const std::vector<std::string>& sets) {
  const std::vector<scenarios::Override> overrides = parse_sets(sets);
  for (const scenarios::Override& o : overrides)
    if (o.key == "seed" || o.key == "name")
      throw UsageError("--set " + o.key + "=" + o.value +
                       ": cannot be the same in every run; seeds and names come from the sweep file");
  return overrides;
}

void RunFolderOptions::declare(Options& options) {
  options.text("--out", out, "Folder for the results (default: runs/NAME-seedN-NUMBER)");
  options.flag("--force", force, "Replace an existing run folder");
  add_mapper(options, mapper);
  add_sets(options, sets);
}

std::vector<scenarios::Override> RunFolderOptions::overrides() const {
  auto all = parse_sets(sets);
  if (seed) all.emplace_back("seed", std::to_string(*seed));
  return with_mapper(mapper, all);
}

std::string recorded_log(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? scenarios::log_in(path) : path;
}

std::string shipped_folder(const std::string& kind) {
  if (const char* home = std::getenv("RUBBLE_HOME")) return std::string(home) + "/" + kind;
  std::error_code error;
  const fs::path installed = fs::read_symlink("/proc/self/exe", error).parent_path() / "../share/rubble" / kind;
  if (fs::is_directory(installed, error)) return installed.lexically_normal().string();
  return std::string(RUBBLE_SOURCE_DIR) + "/" + kind;
}

std::string find_scenario(const std::string& name) {
  if (name.empty()) return shipped_folder() + "/yellow.yaml";
  // Who names an arena is told what is missing.
  const fs::path arenas = fs::path(shipped_folder("arenas")) / "shipped";
  if (is_shipped(name, arenas) && !is_shipped(name, shipped_folder()))
    throw InputError(name + ": is an arena, and what is played is a scenario; write one, of this line: arena: {file: " +
                     (arenas / (name + ".yaml")).string() + "}");
  const std::vector<std::string>& kinds = scenarios::generated_kinds();
  if (std::find(kinds.begin(), kinds.end(), name) != kinds.end() && !is_there(name) &&
      !is_shipped(name, shipped_folder()))
    throw InputError(
        name +
        ": is a kind of arena, and what is played is a scenario; leave it out and say --set arena.generate.kind=" +
        name);
  if (fs::path(name).extension() == ".raf" && is_there(name))
    throw InputError(name + ": is an arena, and what is played is a scenario; write one, of this line: arena: {file: " +
                     fs::absolute(name).lexically_normal().string() + "}");
  return find_shipped(name, shipped_folder());
}

std::string find_robot(const std::string& name) {
  const std::string folder = shipped_folder("robots");
  return name.empty() ? folder + "/pioneer_urg.yaml" : find_shipped(name, folder);
}

std::string find_list(const std::string& name) {
  return name.empty() ? shipped_folder() + "/benchmark.yaml" : find_shipped(name, shipped_folder(), is_list);
}

std::string find_sweep(const std::string& name) { return find_shipped(name, shipped_folder() + "/sweeps", is_sweep); }

}  // namespace rubble::app
