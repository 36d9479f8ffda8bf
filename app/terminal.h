#pragma once

#include <string>

#include "scenarios/run/run.h"

namespace rubble::app {

/// Ctrl-C (and a polite kill) asks the work to end with its folder complete; a second one ends it at once.
void catch_interrupts();
bool interrupted();

/// Run options whose progress is one line on a terminal and nothing elsewhere.
scenarios::RunOptions terminal_options(const std::string& out, bool force);
/// Wipes the progress line.
void end_progress();

/// Prints the table that ends a run: one line a figure that is known.
void print_summary(const scenarios::RunReport& report);

/// The exit code of a finished run.
int exit_code(const scenarios::RunReport& report);

}  // namespace rubble::app
