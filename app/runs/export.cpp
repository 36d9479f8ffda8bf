#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "scenarios/run/map_files.h"

namespace rubble::app {
namespace {

struct ExportArguments {
  std::string log;
  std::string out;
};

/// Relations and references know the scans of a log by its own stamps; an export has those that put it in order.
void tell_other_stamps(const std::string& log, const robot::ExportedScans& exported) {
  if (exported.renamed == 0) return;
  tell(log + ": its clock jitters or runs backwards, so " + std::to_string(exported.renamed) + " of " +
       std::to_string(exported.scans) + " scans have other stamps in the export; relations and references by the " +
       "log's own stamps hold for the log alone, not for the export");
}

int export_log(const ExportArguments& arguments) {
  namespace fs = std::filesystem;
  if (fs::is_directory(arguments.out)) throw InputError(arguments.out + ": is a folder; name the file to write");
  const fs::path folder = fs::path(arguments.out).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InputError(arguments.out + ": the folder " + folder.string() + " does not exist; make it first");
  const bool is_map = scenarios::is_map_export(arguments.out);
  if (!is_map && fs::path(arguments.out).extension() != ".rawlog")
    throw InputError(arguments.out + ": its ending tells no format that can be written; end it in .rawlog (the log), " +
                     ".g2o or .simplemap (the map)");
  robot::ExportedScans exported;
  const std::string log = is_map ? arguments.log : recorded_log(arguments.log);
  if (is_map)
    scenarios::export_map(log, arguments.out);
  else
    exported = robot::export_rawlog(log, arguments.out);
  print_line(arguments.out);
  tell_other_stamps(log, exported);
  return kOk;
}

}  // namespace

Command export_command() {
  return {
      "export", "Write a recorded log as MRPT .rawlog, or a run's map as .g2o or MRPT .simplemap",
      "Of a log whose clock jitters the export has other stamps, which is told: relations of the log do not hold for "
      "it.\nExamples:\n  rubble export runs/latest/log.rlog run.rawlog\n  rubble export runs/latest graph.g2o",
      [](Options& o) -> Action {
        auto a = std::make_shared<ExportArguments>();
        o.argument("log", a->log, "A run folder, a log file of any format that `map` reads, or a map.rmap");
        o.argument("out", a->out, "The .rawlog, .g2o or .simplemap to write");
        return [a] { return export_log(*a); };
      }};
}

}  // namespace rubble::app
