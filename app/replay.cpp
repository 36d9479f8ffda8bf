#include <cstdio>
#include <filesystem>

#include "app/commands.h"
#include "app/terminal.h"
#include "base/error.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "scenarios/run/replay.h"

namespace rubble::app {

int replay(const ReplayArguments& arguments) {
  const auto options = terminal_options(arguments.out, false);
  const scenarios::ReplayReport report = scenarios::replay_run(arguments.run, options);
  end_progress();
  if (interrupted()) return kInterrupted;
  for (const auto& artefact : report.artefacts)
    std::printf("%-18s %s\n", artefact.name.c_str(), artefact.same ? "identical" : "DIFFERENT");
  if (!report.ended) std::printf("%-18s %s\n", "map", "not compared: the recorded run did not end");
  std::printf("%-18s %zu of %zu ticks different\n", "commands", report.different_commands, report.ticks);
  std::printf("%s\n", report.identical ? "bit-identical" : "NOT bit-identical");
  return report.identical ? kOk : kBroken;
}

std::string recorded_log(const std::string& path) {
  const std::string inside = path + "/log.rlog";
  return std::filesystem::exists(inside) ? inside : path;
}

int export_log(const ExportArguments& arguments) {
  namespace fs = std::filesystem;
  if (fs::is_directory(arguments.out)) throw InputError(arguments.out + ": is a folder; name the .rawlog to write");
  const fs::path folder = fs::path(arguments.out).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InputError(arguments.out + ": the folder " + folder.string() + " does not exist; make it first");
  robot::export_rawlog(recorded_log(arguments.log), arguments.out);
  std::printf("%s\n", arguments.out.c_str());
  return kOk;
}

}  // namespace rubble::app
