#include <cstdio>
#include <filesystem>

#include "app/batch_tools.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "base/error.h"

namespace rubble::app {
namespace {

/// A path, or the bare name of a scenario that ships with rubble; no name: the main job.
std::string find_scenario(const std::string& name) {
  namespace fs = std::filesystem;
  const std::string shipped = shipped_folder() + "/";
  if (name.empty()) return shipped + "yellow.yaml";
  if (!fs::exists(name) && name.find('/') == std::string::npos && fs::exists(shipped + name + ".yaml"))
    return shipped + name + ".yaml";
  return name;
}

}  // namespace

int run(const RunArguments& arguments) {
  auto overrides = arguments.common.overrides;
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  overrides = with_mapper(arguments.common.mapper, overrides);
  scenarios::Scenario scenario = scenarios::load_scenario(find_scenario(arguments.scenario), overrides);
  permit_command(arguments.common.mapper, overrides, scenario);
  const auto options = terminal_options(arguments.common.out, arguments.common.force);
  for (const std::string& note : scenarios::arena_notes(scenario)) std::fprintf(stderr, "rubble: %s\n", note.c_str());
  const scenarios::RunReport report = scenarios::run_scenario(scenario, options);
  end_progress();
  print_summary(report);
  return exit_code(report);
}

int map(const MapArguments& arguments) {
  auto overrides = arguments.common.overrides;
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  overrides = with_mapper(arguments.common.mapper, overrides);
  scenarios::Scenario scenario = scenarios::default_scenario(overrides);
  permit_command(arguments.common.mapper, overrides, scenario);
  const auto options = terminal_options(arguments.common.out, arguments.common.force);
  const scenarios::RunReport report = scenarios::map_log(recorded_log(arguments.log), scenario, options);
  end_progress();
  print_summary(report);
  return exit_code(report);
}

}  // namespace rubble::app
