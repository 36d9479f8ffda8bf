#include <cstdio>

#include "app/commands.h"
#include "app/terminal.h"
#include "robot/mrpt_bridge.h"

namespace rubble::app {

int replay(const ReplayArguments& arguments) {
  const auto options = terminal_options(arguments.out, false);
  const scenarios::ReplayReport report = scenarios::replay_run(arguments.run, options);
  end_progress();
  if (interrupted()) return kInterrupted;
  for (const auto& artefact : report.artefacts)
    std::printf("%-14s %s\n", artefact.name.c_str(), artefact.same ? "identical" : "DIFFERENT");
  std::printf("%-14s %zu of %zu ticks different\n", "commands", report.different_commands, report.ticks);
  std::printf("%s\n", report.identical ? "bit-identical" : "NOT bit-identical");
  return report.identical ? kOk : kBroken;
}

int export_log(const ExportArguments& arguments) {
  robot::export_rawlog(arguments.log, arguments.out);
  std::printf("%s\n", arguments.out.c_str());
  return kOk;
}

}  // namespace rubble::app
