#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "app/command.h"
#include "scenarios/config/scenario.h"

namespace rubble::app {

/// What the command line says about mappers that are programs of the user's.
struct MapperChoice {
  std::string command;          ///< --mapper-command: use this program instead of the mapper of the file
  bool allow_commands = false;  ///< --allow-commands: a command that stands in a file may run
};

/// Declares --mapper-command and --allow-commands.
void add_mapper(Options& options, MapperChoice& choice);

/// `overrides` with the command first, so that what is set for it (mapper.timeout_s) comes after it.
std::vector<scenarios::Override> with_mapper(const MapperChoice& choice, std::vector<scenarios::Override> overrides);

/// Permits the scenario's command when the user gave it on the command line (also by --set mapper.command=...) or
/// allowed those of files; prints it, to stderr where stdout is data. Throws InputError for one that may not run:
/// nothing is started then.
void permit_command(const MapperChoice& choice, const std::vector<scenarios::Override>& overrides,
                    scenarios::Scenario& scenario, std::FILE* told_on = stdout);

/// Prints a command that will run, each once.
void tell_command(const std::string& command, std::FILE* told_on);

}  // namespace rubble::app
