#include "scenarios/benchmark/benchmark_list.h"

#include <filesystem>
#include <set>

#include "scenarios/config/needed_key.h"
#include "scenarios/config/seeds.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestError = 1e4;   // [m]
constexpr double kLargestTurn = 180.0;  // [deg]
constexpr double kMostSpeed = 1e9;      // [1/s]
constexpr double kLongest = 1e6;        // [ms]
constexpr int kLongestRun = 1000000;    // [s]

BenchmarkMapper read_mapper(const YamlMap& map) {
  BenchmarkMapper mapper;
  refuse_misspelt(map, "kind");
  const std::string kind = map.text("kind", std::nullopt);
  mapper.name = map.text("name", kind);
  mapper.overrides.emplace_back("mapper.kind", kind, map.place("kind"));
  const YamlMap set = map.map("set");
  for (const std::string& key : set.keys())
    mapper.overrides.emplace_back("mapper." + key, set.text(key, std::nullopt), set.place(key));
  return mapper;
}

BenchmarkCase read_case(const YamlMap& map) {
  BenchmarkCase c;
  refuse_misspelt(map, "name");
  c.name = map.text("name", std::nullopt);
  c.about = map.text("about", "");
  c.log = map.text("log", "");
  c.reference = map.text("reference", "");
  c.relations = map.text("relations", "");
  c.scenario = map.text("scenario", "");
  if (map.has("seeds"))
    c.seeds = read_seeds(map);
  else
    c.seeds = {static_cast<std::uint64_t>(map.integer("seed", 1, 0, INT64_MAX))};
  if (c.seeds.size() > 1 && c.scenario.empty()) map.fail("seeds", "are of arenas; a log is the same with every seed");
  const YamlMap set = map.map("set");
  for (const std::string& key : set.keys()) {
    if (key == "seed") set.fail(key, "stands beside the case's name");
    c.overrides.emplace_back(key, set.text(key, std::nullopt), set.place(key));
  }
  if (c.log.empty() && c.scenario.empty())
    for (const char* key : {"log", "scenario"}) refuse_misspelt(map, key);
  if (c.log.empty() == c.scenario.empty()) map.fail("name", "a case needs either 'log' or 'scenario'");
  if (!c.relations.empty() && c.log.empty()) map.fail("relations", "belong to a log; give 'log' beside them");
  if (!c.reference.empty() && c.log.empty()) map.fail("reference", "belongs to a log; give 'log' beside it");
  if (!c.reference.empty() && !c.relations.empty()) map.fail("reference", "beside 'relations'; keep one of them");
  c.measure = c.relations.empty() ? BenchmarkMeasure::Aligned : BenchmarkMeasure::Relations;
  const auto goal = [&](const char* key, double most = kLargestError) {
    return map.has(key) ? std::optional<double>(map.number(key, std::nullopt, 0.0, most)) : std::nullopt;
  };
  c.goal = goal("goal_m");
  c.heading_goal = goal("goal_deg", kLargestTurn);
  c.live_goal = goal("live_goal_m");
  c.worst_goal = goal("worst_goal_m");
  c.false_loops_goal = goal("false_loops_goal");
  c.speed_goal = goal("scans_per_s_goal", kMostSpeed);
  c.slow_goal = goal("ms_99_goal", kLongest);
  c.worst_time_goal = goal("worst_ms_goal", kLongest);
  if (c.worst_goal && c.seeds.size() < 2) map.fail("worst_goal_m", "is of several seeds; give 'seeds' beside it");
  if (c.heading_goal && c.relations.empty()) map.fail("goal_deg", "is of relations; give 'relations' beside it");
  for (const YamlMap& row : map.maps("published"))
    c.published.push_back({row.text("by", std::nullopt), row.text("source", std::nullopt),
                           row.number("error_m", std::nullopt, 0.0, kLargestError)});
  return c;
}

}  // namespace

BenchmarkList load_benchmark(const std::string& path) {
  const YamlMap root = YamlMap::load(path);
  BenchmarkList list;
  list.path = path;
  list.folder = fs::path(path).parent_path().string();
  list.name = root.text("name", fs::path(path).stem().string());
  list.about = root.text("about", "");
  if (root.has("cpu_limit_s")) list.cpu_limit = static_cast<int>(root.integer("cpu_limit_s", 0, 1, kLongestRun));
  std::set<std::string> names;
  for (const YamlMap& row : root.maps("mappers")) {
    list.mappers.push_back(read_mapper(row));
    if (!names.insert(list.mappers.back().name).second)
      row.fail("name", "mapper '" + list.mappers.back().name + "' is there twice; give them names");
  }
  names.clear();
  for (const YamlMap& row : root.maps("cases")) {
    list.cases.push_back(read_case(row));
    if (!names.insert(list.cases.back().name).second)
      row.fail("name", "case '" + list.cases.back().name + "' is there twice");
  }
  for (const char* key : {"mappers", "cases"}) refuse_misspelt(root, key);
  if (list.mappers.empty()) root.fail("mappers", "a benchmark needs one mapper at least: mappers: [{kind: robust}]");
  if (list.cases.empty())
    root.fail("cases", "a benchmark needs one case at least: cases: [{name: lab, log: lab.rawlog}]");
  root.finish();
  return list;
}

std::string find_in(const std::vector<std::string>& folders, const std::string& path) {
  if (fs::path(path).is_absolute()) return fs::exists(path) ? path : "";
  for (const std::string& folder : folders) {
    const fs::path candidate = folder.empty() ? fs::path(path) : fs::path(folder) / path;
    if (fs::exists(candidate)) return candidate.string();
  }
  return "";
}

}  // namespace rubble::scenarios
