#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/run/run.h"

namespace rubble::scoring {
struct Figure;
}

namespace rubble::app {

/// Ctrl-C, a polite kill or a terminal that is closed end the program on the spot with one line and kInterrupted: for
/// short work that leaves nothing to be completed. Every file is written beside its place, so none is cut, and what was
/// not finished is removed.
void end_by_interrupts();

/// Ctrl-C (and a polite kill) asks the work to end with its folder complete; a second one ends it at once.
void catch_interrupts();
bool interrupted();

/// For whoever has a robot in hand: all signals that a terminal can send (also Ctrl-\\, Ctrl-Z and the end of a pipe
/// that reads us) end the work as above or are ignored. The second asks for an end at once, see insisted(); only the
/// third ends the program on the spot.
void catch_stops();
bool insisted();

/// Run options whose progress is one line on a terminal and nothing elsewhere.
scenarios::RunOptions terminal_options(const std::string& out, bool force);
/// "`what`  43 %" as a line on a terminal that the next one replaces, and nothing elsewhere.
void show_share(const std::string& what, double share);
/// Wipes the progress line.
void end_progress();

/// All that is printed may hold names and values of foreign files: what a terminal would obey, or would not show, is
/// shown as escapes (base/text/words.h). Nothing else prints text that is not our own.
/// A line on stdout.
void print_line(const std::string& line);
/// On stdout: whatever is no plain letter is written as \uXXXX, which every reader of JSON takes.
void print_json(const nlohmann::ordered_json& json);
/// A line on stderr, as a message of the program.
void tell(const std::string& line);
/// Tables of batches have short labels.
constexpr int kBatchLabels = 12;
/// One row of a table on stdout.
void print_row(const std::string& label, const std::string& value, int width = 34, std::FILE* out = stdout);

/// The row of a map that was not laid on the truth; its label says the note's first words.
void print_not_aligned(const std::string& note);

/// A row of the table of figures. `explained`: with what it means behind it.
void print_figure(const scoring::Figure& figure, const std::string& text, bool explained);

/// Every row of the table of figures that is meant for people and known. `score`: the content of score.json;
/// `explained`: with what each means behind it.
void print_figures(const nlohmann::ordered_json& score, bool explained = false);

/// What names of victims stand behind that nobody can find.
inline constexpr const char* kOutOfSight = "cannot be seen from floor the robot reaches: ";
/// How many victims were found, where that is known.
void print_victims(const nlohmann::ordered_json& score);

/// Prints the table that ends a run: one line a figure that is known. Returns the exit code.
int show(const scenarios::RunReport& report);

}  // namespace rubble::app
