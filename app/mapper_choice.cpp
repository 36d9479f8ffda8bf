#include "app/mapper_choice.h"

#include <cstdio>
#include <set>

#include "app/terminal.h"
#include "slam/process/process_mapper.h"

namespace rubble::app {

void add_mapper(Options& options, MapperChoice& choice) {
  options.text("--mapper-command", choice.command,
               "Map with this program (docs/mapper_protocol.md): --mapper-command \"python3 my_slam.py\"");
  options.flag("--allow-commands", choice.allow_commands, "Let a command that stands in a file run");
}

std::vector<scenarios::Override> with_mapper(const MapperChoice& choice, std::vector<scenarios::Override> overrides) {
  if (!choice.command.empty())
    overrides.insert(overrides.begin(), {"mapper", slam::process_mapper_yaml(choice.command)});
  return overrides;
}

void permit_command(const MapperChoice& choice, const std::vector<scenarios::Override>& overrides,
                    scenarios::Scenario& scenario, std::FILE* told_on) {
  const std::string command = scenario.mapper.command();
  if (command.empty()) return;
  std::string typed = choice.command;
  for (const scenarios::Override& o : overrides)
    if (o.key == "mapper.command") typed = o.value;
  if (choice.allow_commands || command == typed) scenario.mapper.permit_command();
  scenario.mapper.require_permission();
  tell_command(command, told_on);
}

void tell_command(const std::string& command, std::FILE* told_on) {
  static std::set<std::string> told;
  if (!told.insert(command).second) return;
  print_row("mapper command", command, 30, told_on);
  std::fflush(told_on);
}

}  // namespace rubble::app
