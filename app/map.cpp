#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"

namespace rubble::app {
namespace {

struct MapArguments {
  std::string log;
  RunFolderOptions folder;
};

int map(const MapArguments& arguments) {
  const auto overrides = arguments.folder.overrides();
  scenarios::Scenario scenario = scenarios::default_scenario(overrides);
  permit_command(arguments.folder.mapper, overrides, scenario);
  const auto options = terminal_options(arguments.folder.out, arguments.folder.force);
  return show(scenarios::map_log(recorded_log(arguments.log), scenario, options));
}

}  // namespace

Command map_command() {
  return {"map", "Map a recorded log (own log, MRPT .rawlog, CARMEN, CoreSLAM .dat)",
          "Examples:\n  rubble map intel.log.gz\n  rubble map lab.rawlog --set mapper.resolution_m=0.1",
          [](Options& o) -> Action {
            auto a = std::make_shared<MapArguments>();
            o.argument("log", a->log, "Log file");
            o.seed("--seed", a->folder.seed, "Seed of the mapper's random numbers (the robust mapper has none)");
            a->folder.declare(o);
            return [a] { return map(*a); };
          }};
}

}  // namespace rubble::app
