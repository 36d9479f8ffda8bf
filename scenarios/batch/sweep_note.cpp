#include "scenarios/batch/sweep_note.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/text/json_size.h"
#include "base/text/text_file.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kFile = "sweep.json";

std::string name_of_path(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  const std::string name =
      normal.filename().empty() ? normal.parent_path().filename().string() : normal.stem().string();
  return name.empty() || name == "." ? "sweep" : name;
}

/// The ids of the runs that the sweep's last call asked for, if the folder tells.
std::optional<std::set<std::string>> runs_asked(const std::string& folder) {
  const std::string file = folder + "/" + kFile;
  if (!fs::is_directory(folder) || !fs::exists(file)) return std::nullopt;
  const std::string text = read_text_file(file);
  if (!is_modest_json(text)) return std::nullopt;
  const ordered_json json = ordered_json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("runs")) return std::nullopt;
  std::set<std::string> asked;
  for (const auto& id : json["runs"])
    if (id.is_string()) asked.insert(id.get<std::string>());
  return asked;
}

}  // namespace

void save_note(const Sweep& sweep, const std::vector<Job>& jobs, const std::string& folder) {
  ordered_json json{{"name", sweep.name}, {"about", sweep.about}, {"configurations", ordered_json::array()}};
  for (const auto& configuration : sweep.configurations)
    json["configurations"].push_back({{"name", configuration.name}, {"reference", configuration.reference}});
  json["runs"] = ordered_json::array();
  for (const Job& job : jobs) json["runs"].push_back(job.run_id);
  write_text_file(place_in(folder, kFile), json.dump(2) + "\n");
}

ResultSet load_sweep_results(const std::string& path) {
  ResultSet set = load_results(path);
  const auto asked = runs_asked(path);
  if (!asked) return set;
  auto& runs = set.runs;
  runs.erase(std::remove_if(runs.begin(), runs.end(), [&](const auto& run) { return asked->count(run.run_id) == 0; }),
             runs.end());
  return set;
}

MissingRuns missing_runs(const std::string& folder, const std::vector<RunRecord>& runs) {
  const auto asked = runs_asked(folder);
  if (!asked) return {};
  std::set<std::string> left = *asked;
  for (const auto& run : runs) left.erase(run.run_id);
  return {left.size(), asked->size()};
}

SweepNote note_of(const ResultSet& set, const std::string& path) {
  SweepNote note;
  note.name = name_of_path(path);
  const std::string file = set.folder + "/" + kFile;
  if (fs::exists(file)) {
    const std::string text = read_text_file(file);
    const std::string strange = file + ": is not what 'rubble batch' wrote; remove it";
    if (!is_modest_json(text)) throw InputError(strange);
    try {
      const ordered_json json = ordered_json::parse(text);
      note.name = json.at("name");
      note.about = json.at("about");
      for (const auto& configuration : json.at("configurations")) {
        note.configurations.push_back(configuration.at("name"));
        note.references[note.configurations.back()] = configuration.at("reference");
      }
    } catch (const ordered_json::exception&) {
      throw InputError(strange);
    }
  }
  std::set<std::string> present;
  for (const auto& run : set.runs) present.insert(run.configuration);
  auto& names = note.configurations;
  names.erase(std::remove_if(names.begin(), names.end(), [&](const auto& name) { return present.count(name) == 0; }),
              names.end());
  for (const auto& name : present)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (const auto& name : names) {
    std::string& reference = note.references[name];
    if (present.count(reference) == 0) reference = names.front();
  }
  return note;
}

}  // namespace rubble::scenarios
