#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"
#include "scenarios/config/notes.h"

namespace rubble::app {
namespace {

struct RunArguments {
  std::string scenario;
  RunFolderOptions folder;
  bool verbose = false;
};

int run(const RunArguments& arguments) {
  const auto overrides = arguments.folder.overrides();
  scenarios::Scenario scenario = scenarios::load_scenario(find_scenario(arguments.scenario), overrides);
  permit_command(arguments.folder.mapper, overrides, scenario);
  auto options = terminal_options(arguments.folder.out, arguments.folder.force);
  if (arguments.verbose)
    options.decided = [](const explore::Decision& decision) {
      end_progress();
      std::fprintf(stderr, "%8.2f s  %s\n", decision.stamp.seconds(), decision.why.c_str());
    };
  for (const std::string& note : scenarios::arena_notes(scenario)) tell(note);
  for (const std::string& note : scenarios::setting_notes(scenario)) tell(note);
  if (const auto note = scenarios::short_time_note(scenario)) tell(*note);
  return show(scenarios::run_scenario(scenario, options));
}

}  // namespace

Command run_command() {
  return {"run", "Explore, map and score an arena in simulation",
          "Examples:\n  rubble run\n  rubble run scenarios/yellow.yaml --seed 7\n"
          "  rubble run --set arena.generate.kind=orange\n"
          "  rubble run --set robot.levelling=false --out runs/no-levelling",
          [](Options& o) -> Action {
            auto a = std::make_shared<RunArguments>();
            o.argument("scenario", a->scenario, "Scenario file, or the name of a shipped one (default: yellow)",
                       Options::Need::Optional);
            o.seed("--seed", a->folder.seed, "Seed of every random choice");
            a->folder.declare(o);
            o.flag("-v,--verbose", a->verbose, "Tell why the robot does what it does, a line a decision");
            return [a, &o] {
              if (o.given("scenario") && a->scenario.empty())
                throw UsageError("run '': is no scenario; give a file or a name, or leave it out for the main job");
              return run(*a);
            };
          }};
}

}  // namespace rubble::app
