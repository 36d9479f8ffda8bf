#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/commands.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/words.h"

namespace rubble::app {
namespace {

/// A path, or the bare name of a scenario that ships with rubble; no name: the main job.
std::string find_scenario(const std::string& name) {
  namespace fs = std::filesystem;
  const char* home = std::getenv("RUBBLE_HOME");
  const std::string shipped = std::string(home ? home : RUBBLE_SOURCE_DIR) + "/scenarios/";
  if (name.empty()) return shipped + "yellow.yaml";
  if (!fs::exists(name) && name.find('/') == std::string::npos && fs::exists(shipped + name + ".yaml"))
    return shipped + name + ".yaml";
  return name;
}

}  // namespace

int run(const RunArguments& arguments) {
  auto overrides = arguments.common.overrides;
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  const scenarios::Scenario scenario = scenarios::load_scenario(find_scenario(arguments.scenario), overrides);
  const auto options = terminal_options(arguments.common.out, arguments.common.force);
  for (const std::string& note : scenarios::arena_notes(scenario))
    std::fprintf(stderr, "rubble: %s\n", one_line(note).c_str());
  const scenarios::RunReport report = scenarios::run_scenario(scenario, options);
  end_progress();
  print_summary(report);
  return exit_code(report);
}

int map(const MapArguments& arguments) {
  auto overrides = arguments.common.overrides;
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  const scenarios::Scenario scenario = scenarios::default_scenario(overrides);
  const auto options = terminal_options(arguments.common.out, arguments.common.force);
  const scenarios::RunReport report = scenarios::map_log(recorded_log(arguments.log), scenario, options);
  end_progress();
  print_summary(report);
  return exit_code(report);
}

}  // namespace rubble::app
