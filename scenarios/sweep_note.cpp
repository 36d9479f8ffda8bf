#include "scenarios/sweep_note.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/text_file.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kFile = "/sweep.json";

std::string name_of_path(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  const std::string name =
      normal.filename().empty() ? normal.parent_path().filename().string() : normal.stem().string();
  return name.empty() || name == "." ? "sweep" : name;
}

}  // namespace

void save_note(const Sweep& sweep, const std::vector<Job>& jobs, const std::string& folder) {
  ordered_json json{{"name", sweep.name}, {"about", sweep.about}, {"configurations", ordered_json::array()}};
  for (const auto& configuration : sweep.configurations)
    json["configurations"].push_back({{"name", configuration.name}, {"reference", configuration.reference}});
  json["runs"] = ordered_json::array();
  for (const Job& job : jobs) json["runs"].push_back(job.run_id);
  write_text_file(folder + kFile, json.dump(2) + "\n");
}

ResultSet load_sweep_results(const std::string& path) {
  ResultSet set = load_results(path);
  const std::string file = path + kFile;
  if (!fs::is_directory(path) || !fs::exists(file)) return set;
  const ordered_json json = ordered_json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object() || !json.contains("runs")) return set;
  std::set<std::string> wanted;
  for (const auto& id : json["runs"])
    if (id.is_string()) wanted.insert(id.get<std::string>());
  auto& runs = set.runs;
  runs.erase(std::remove_if(runs.begin(), runs.end(), [&](const auto& run) { return wanted.count(run.run_id) == 0; }),
             runs.end());
  return set;
}

SweepNote note_of(const ResultSet& set, const std::string& path) {
  SweepNote note;
  note.name = name_of_path(path);
  const std::string file = set.folder + kFile;
  if (fs::exists(file)) {
    try {
      const ordered_json json = ordered_json::parse(read_text_file(file));
      note.name = json.at("name");
      note.about = json.at("about");
      for (const auto& configuration : json.at("configurations")) {
        note.configurations.push_back(configuration.at("name"));
        note.references[note.configurations.back()] = configuration.at("reference");
      }
    } catch (const ordered_json::exception&) {
      throw InputError(file + ": is not what 'rubble batch' wrote; remove it");
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
