#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "scenarios/run/map_files.h"

namespace rubble::app {
namespace {

struct MergeArguments {
  std::string first;
  std::string second;
  std::string out;
  bool force = false;
  std::vector<std::string> sets;
};

int merge(const MergeArguments& arguments) {
  const scenarios::Scenario scenario = scenarios::default_scenario(parse_sets(arguments.sets));
  scenarios::merge_maps(arguments.first, arguments.second, scenario, arguments.out, arguments.force, show_share);
  end_progress();
  print_line(arguments.out);
  return kOk;
}

}  // namespace

Command merge_command() {
  return {"merge", "Make one map of the maps of two robots, or of two runs",
          "Example:\n  rubble merge runs/robbie runs/rosie --out runs/both", [](Options& o) -> Action {
            auto a = std::make_shared<MergeArguments>();
            o.argument("first", a->first, "A run folder with a map.rmap, or such a file; its frame is kept");
            o.argument("second", a->second, "Another");
            o.required_text("--out", a->out, "Folder for the map");
            o.flag("--force", a->force, "Replace an existing run folder");
            add_sets(o, a->sets);
            return [a] { return merge(*a); };
          }};
}

}  // namespace rubble::app
