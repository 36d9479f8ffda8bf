#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "scenarios/run/map_files.h"

namespace rubble::app {
namespace {

struct MapArguments {
  std::string log;
  std::string go_on;
  std::string localise;
  std::string start;
  std::string relations;
  std::string laser;
  bool upside_down = false;
  RunFolderOptions folder;
};

/// The value `x,y,heading_deg` of an option, x and y within `most` [m]; nothing where it was not given.
std::optional<mrpt::math::TPose2D> pose_of(const std::string& option, const std::string& text, int most) {
  if (text.empty()) return std::nullopt;
  double x = 0.0, y = 0.0, heading = 0.0;
  char rest = 0;
  const std::string given = option + " " + text;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &x, &y, &heading, &rest) != 3 || !std::isfinite(x + y + heading))
    throw UsageError(given + ": needs the form x,y,heading_deg, for example " + option + " 1.5,-0.4,90");
  if (!(std::abs(x) <= most && std::abs(y) <= most))
    throw UsageError(given + ": x and y must be within " + std::to_string(most) + " m");
  return mrpt::math::TPose2D(x, y, wrap_angle(deg_to_rad(heading)));
}

/// A log brings its robot along: of what else was set nothing holds.
void tell_vain_settings(const std::vector<scenarios::Override>& overrides) {
  for (const scenarios::Override& set : overrides) {
    const std::string section = set.key.substr(0, set.key.find_first_of(".={"));
    for (const char* vain : {"robot", "levelling", "sim", "arena", "time_limit_s"})
      if (section == vain)
        tell("--set " + set.key + ": has no effect on a log, whose robot and arena are as it was recorded" +
             (set.key.rfind("robot.laser", 0) == 0 ? "; where the laser sits is told by --laser" : ""));
  }
}

int map(const MapArguments& arguments) {
  const auto overrides = arguments.folder.overrides();
  scenarios::Scenario scenario = scenarios::default_scenario(overrides);
  permit_command(arguments.folder.mapper, overrides, scenario);
  auto options = terminal_options(arguments.folder.out, arguments.folder.force);
  const std::string& map = arguments.go_on.empty() ? arguments.localise : arguments.go_on;
  if (map.empty() && !arguments.start.empty())
    throw UsageError("--start: needs a map; give it with --continue or --localise");
  const auto start = pose_of("--start", arguments.start, 10000);
  if (!map.empty()) options.base = scenarios::load_map_base(map, !arguments.go_on.empty(), start);
  options.relations = arguments.relations;
  options.mount = pose_of("--laser", arguments.laser, 10);
  options.upside_down = arguments.upside_down;
  tell_vain_settings(overrides);
  return show(scenarios::map_log(recorded_log(arguments.log), scenario, options));
}

}  // namespace

Command map_command() {
  return {"map", "Map a recorded log (own log, MRPT .rawlog, CARMEN, CoreSLAM .dat)",
          "Examples:\n  rubble map intel.log.gz\n  rubble map lab.rawlog --set mapper.resolution_m=0.1\n"
          "  rubble map intel.clf.bz2 --relations intel.relations\n"
          "  rubble map lab.log --laser 0.145,0,180\n"
          "  rubble map tuesday.rawlog --continue runs/monday\n  rubble map tuesday.rawlog --localise runs/monday",
          [](Options& o) -> Action {
            auto a = std::make_shared<MapArguments>();
            o.argument("log", a->log, "Log file");
            o.seed("--seed", a->folder.seed, "Seed of the mapper's random numbers (the robust mapper has none)");
            o.text("--continue", a->go_on,
                   "Go on with the map of this run (a folder or a map.rmap): where it ended, or wherever in it the "
                   "robot finds itself");
            o.text("--localise", a->localise, "Find the robot in the map of this run, and leave the map as it is");
            o.text("--start", a->start, "Where in that map the robot starts: x,y,heading_deg");
            o.excludes("--continue", "--localise");
            o.text("--laser", a->laser,
                   "Where the laser sits on the robot, where the log does not say it or is wrong: x,y,heading_deg");
            o.flag("--upside-down", a->upside_down, "The laser hangs upside down, which the log does not say");
            o.text("--relations", a->relations,
                   "Judge the trajectory by these relations between moments of the log (Kuemmerle et al. 2009)");
            a->folder.declare(o);
            return [a] { return map(*a); };
          }};
}

}  // namespace rubble::app
