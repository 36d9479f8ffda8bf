#include "scenarios/batch/sweep.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "base/digest.h"
#include "base/error.h"
#include "base/text/file_name.h"
#include "base/yaml/strict_yaml.h"
#include "base/yaml/yaml_node.h"
#include "scenarios/config/needed_key.h"
#include "scenarios/config/seeds.h"
#include "scenarios/run/run.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRuns = 1000000;
constexpr std::size_t kMostBytes = 1000000000;  ///< of all configurations

std::vector<std::string> read_scenarios(const YamlMap& root, const fs::path& folder, const std::string& shipped) {
  std::vector<std::string> paths;
  for (const auto& name : root.texts("scenarios")) {
    const fs::path beside = fs::path(name).is_absolute() ? fs::path(name) : folder / name;
    const fs::path known = fs::path(shipped) / (name + ".yaml");
    if (fs::is_regular_file(beside)) {
      paths.push_back(beside.lexically_normal().string());
    } else if (!shipped.empty() && name.find('/') == std::string::npos && fs::is_regular_file(known)) {
      paths.push_back(known.lexically_normal().string());
    } else {
      root.fail("scenarios",
                "there is no scenario file '" + beside.string() + "'; paths are relative to the sweep file");
    }
  }
  if (paths.empty()) root.fail("scenarios", "a sweep needs scenario files: scenarios: [a.yaml, b.yaml]");
  return paths;
}

/// The sweep gives these itself, once for all configurations.
void refuse_reserved(const YamlMap& map, const std::string& key) {
  if (key == "seed") map.fail(key, "cannot vary by configuration; list the seeds under 'seeds'");
  if (key == "name") map.fail(key, "cannot vary by configuration; results are paired by the scenario's name");
}

/// Each key of a configuration is one value of the scenario, by its whole path.
void refuse_map(const YamlMap& map, const std::string& key) {
  const YamlNode::Entry* entry = map.tree()->find(key);
  if (entry == nullptr || entry->value->kind != YamlNode::Kind::Map) return;
  const auto& inside = entry->value->entries;
  const std::string example = inside.empty() ? "key" : inside.front().key;
  map.fail(key, "is a map; give each of its values by its whole path: " + key + "." + example + ": VALUE");
}

std::vector<Configuration> named_sets(const YamlMap& root) {
  const YamlMap sets = root.map("configs");
  std::vector<Configuration> configurations;
  for (const auto& name : sets.keys()) {
    const YamlMap set = sets.map(name);
    Configuration configuration{name, "", {}};
    for (const auto& key : set.keys()) {
      refuse_reserved(set, key);
      refuse_map(set, key);
      configuration.overrides.emplace_back(key, set.text(key, std::nullopt), set.place(key));
    }
    configurations.push_back(configuration);
  }
  if (configurations.empty()) configurations.push_back({});
  if (configurations.size() > 1)
    for (auto& configuration : configurations) configuration.reference = configurations.front().name;
  return configurations;
}

std::string with(const std::string& name, const std::string& key, const std::string& value) {
  return name + (name.empty() ? "" : ", ") + key + "=" + value;
}

/// Each configuration once for each value of `key`.
std::vector<Configuration> crossed(const std::vector<Configuration>& configurations, const std::string& key,
                                   const std::vector<std::string>& values, const std::string& place) {
  std::vector<Configuration> product;
  for (const auto& configuration : configurations)
    for (const auto& value : values) {
      Configuration next = configuration;
      // A key with one value is the same everywhere and would only lengthen every name.
      if (values.size() > 1) {
        const bool first = configuration.reference.empty();  // this key is what the sweep varies first of all
        next.reference =
            with(first ? configuration.name : configuration.reference, key, first ? values.front() : value);
        next.name = with(configuration.name, key, value);
      }
      next.overrides.emplace_back(key, value, place);
      product.push_back(std::move(next));
    }
  return product;
}

/// What one more override costs each configuration [bytes].
std::size_t cost_of(const std::string& key, const std::string& value, const std::string& place) {
  return sizeof(Override) + place.size() + 3 * (key.size() + value.size());  // its words stand in the two names too
}

std::vector<Configuration> read_configurations(const YamlMap& root) {
  std::vector<Configuration> configurations = named_sets(root);
  std::size_t bytes = 0;  // of the largest configuration
  for (const auto& configuration : configurations) {
    std::size_t own = 0;
    for (const Override& o : configuration.overrides) own += cost_of(o.key, o.value, o.place);
    bytes = std::max(bytes, own);
  }
  const YamlMap grid = root.map("set");
  for (const auto& key : grid.keys()) {
    refuse_reserved(grid, key);
    refuse_map(grid, key);
    const auto values = one_or_more(grid, key);
    if (values.empty()) grid.fail(key, "has no values; give one or a list: " + key + ": [a, b]");
    if (values.size() > kMostRuns / configurations.size())
      root.fail("set", "is a grid of more than a million configurations; split the sweep");
    std::size_t longest = 0;
    for (const auto& value : values) longest = std::max(longest, cost_of(key, value, grid.place(key)));
    bytes += longest;
    if (bytes > kMostBytes / (configurations.size() * values.size()))
      root.fail("set", "is a grid whose configurations take more than 1 GB; split the sweep, or shorten its values");
    configurations = crossed(configurations, key, values, grid.place(key));
  }
  std::set<std::string> names;
  for (auto& configuration : configurations) {
    if (configuration.name.empty()) configuration.name = "default";
    if (!names.insert(configuration.name).second)
      root.fail("set", "gives configuration '" + configuration.name + "' twice; remove the repeated value");
  }
  return configurations;
}

/// What the files hold that a mapper's command names: a changed program is another mapper.
std::string files_of_command(const std::string& command) {
  std::string digests;
  std::istringstream words(command);
  for (std::string word; words >> word;) {
    word.erase(std::remove_if(word.begin(), word.end(), [](char c) { return c == '"' || c == '\''; }), word.end());
    std::error_code error;
    if (fs::is_regular_file(word, error)) digests += sha256_of_file(word) + "\n";
  }
  return digests;
}

std::string run_id(const Scenario& scenario, const std::string& configuration, const std::string& code) {
  Scenario portable = scenario;  // where the arena file lies does not matter, what is in it does
  if (!scenario.arena_file.empty()) portable.arena_file = "arena.yaml";
  std::string text = code + "\n" + configuration + "\n" + resolved_yaml(portable);
  if (!scenario.arena_file.empty()) text += arena_yaml(scenario);
  text += files_of_command(scenario.mapper.command());
  return sha256_of_text(text).substr(0, 16);
}

bool too_large(const Sweep& sweep) {
  return sweep.scenarios.size() * sweep.configurations.size() > kMostRuns / sweep.seeds.size();
}

/// The scenario's name; where that is a kind of arena and the configuration makes another, that kind: a folder must not
/// say yellow of an orange one.
std::string arena_name(const Scenario& scenario) {
  const auto& kinds = generated_kinds();
  const std::string& name = scenario.name;
  const bool says_kind = std::find(kinds.begin(), kinds.end(), name) != kinds.end();
  return says_kind && scenario.arena_file.empty() ? arenas::name_of(scenario.generate.kind) : name;
}

}  // namespace

Scenario Job::scenario() const {
  Scenario own = kind->scenario;
  own.seed = seed;
  return own;
}

std::string Job::folder() const {
  const std::string arena = arena_name(kind->scenario), configuration = kind->configuration.substr(0, 80);
  const bool begins = configuration.rfind(arena, 0) == 0;
  const bool named = begins && (configuration.size() == arena.size() ||
                                !std::isalnum(static_cast<unsigned char>(configuration[arena.size()])));
  std::string name = named ? configuration : arena + "-" + configuration;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.' && c != '=') c = '_';
  return name + "-seed" + std::to_string(seed) + "-" + run_id.substr(0, 8);
}

Sweep load_sweep(const std::string& path, const std::string& shipped) {
  const YamlMap root = YamlMap::load(path);
  Sweep sweep;
  sweep.path = path;
  sweep.name = root.text("name", as_file_name(fs::path(path).stem().string()));
  if (const auto trouble = file_name_trouble(sweep.name)) root.fail("name", *trouble);
  sweep.about = root.text("about", std::string());
  if (root.has("arena") && !root.has("scenarios"))
    root.fail("arena", "'arena' is of a scenario, and a batch makes the runs of a sweep; write one that names it: " +
                           ("scenarios: [" + fs::absolute(path).lexically_normal().string() + "]") +
                           " and 'seeds: 1-24', or give it to 'rubble run'");
  refuse_misspelt(root, "scenarios");
  sweep.scenarios = read_scenarios(root, fs::path(path).parent_path(), shipped);
  sweep.seeds = read_seeds(root);
  sweep.configurations = read_configurations(root);
  sweep.run_limit = root.number("run_limit_s", sweep.run_limit, 1.0, 1e6);
  root.finish();
  if (too_large(sweep)) root.fail("", "asks for more than a million runs; split the sweep");
  return sweep;
}

void choose_seeds(Sweep& sweep, const std::string& text) {
  sweep.seeds = chosen_seeds(sweep.seeds, text);
  if (too_large(sweep)) throw std::invalid_argument("asks for more than a million runs");
}

std::vector<Job> expand(const Sweep& sweep, const std::string& code, const std::vector<Override>& overrides) {
  std::vector<Job> jobs;
  std::set<std::string> names;
  for (const auto& path : sweep.scenarios) {
    std::string name;
    for (const auto& configuration : sweep.configurations) {
      std::vector<Override> all = configuration.overrides;
      all.insert(all.end(), overrides.begin(), overrides.end());
      Scenario scenario;
      try {
        scenario = load_scenario(path, all);
      } catch (const InputError& error) {
        const std::string text = error.what();
        const bool tells_line = text.rfind(sweep.path + ":", 0) == 0;
        throw InputError(tells_line ? text + " (configuration '" + configuration.name + "')"
                                    : sweep.path + ": configuration '" + configuration.name + "': " + text);
      }
      name = scenario.name;
      const auto kind = std::make_shared<JobKind>(JobKind{configuration.name, scenario});
      for (const auto seed : sweep.seeds) {
        scenario.seed = seed;
        jobs.push_back({run_id(scenario, configuration.name, code), seed, kind});
      }
    }
    if (!names.insert(name).second)
      throw InputError(sweep.path + ": two scenarios are named '" + name + "'; results are paired by name, rename one");
  }
  return jobs;
}

std::vector<Job> in_shard(const std::vector<Job>& jobs, const Shard& shard) {
  std::vector<Job> chosen;
  for (const auto& job : jobs) {
    const std::uint64_t hash = std::stoull(job.run_id, nullptr, 16);
    if (hash % static_cast<std::uint64_t>(shard.count) == static_cast<std::uint64_t>(shard.index - 1))
      chosen.push_back(job);
  }
  return chosen;
}

std::string code_version() {
  const Versions built = versions();
  const std::string code = built.rubble + " " + built.commit;
  const bool unnamed = built.commit == "unknown" || built.commit.find("-dirty") != std::string::npos;
  return unnamed ? code + " " + sha256_of_file("/proc/self/exe").substr(0, 16) : code;
}

}  // namespace rubble::scenarios
