#include "app/terminal.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "base/text/new_file.h"
#include "base/text/words.h"
#include "scenarios/run/score_json.h"

namespace rubble::app {
namespace {

volatile std::sig_atomic_t signalled = 0;
volatile std::sig_atomic_t on_terminal = 0;  ///< where a progress line may stand, that the last one wipes

[[noreturn]] void end_now() {
  remove_unfinished_files();
  _exit(kInterrupted);
}

constexpr char kEnded[] = "\r\033[Krubble: interrupted\n";
constexpr std::size_t kWipe = 4;  ///< of its letters wipe the line

void on_signal_without_rest(int /*signal*/) {
  // A terminal that is held by Ctrl-S, or a full pipe, takes no line: who wants the end does not wait for it.
  pollfd errors{STDERR_FILENO, POLLOUT, 0};
  const bool taken = poll(&errors, 1, 0) == 1 && (errors.revents & POLLOUT) != 0;
  const std::size_t from = on_terminal != 0 ? 0 : kWipe;
  if (taken && write(STDERR_FILENO, kEnded + from, sizeof kEnded - 1 - from) < 0) end_now();  // as it does anyway
  end_now();
}

void on_signal(int signal) {
  signalled = 1;
  std::signal(signal, on_signal_without_rest);  // the second one is not asked twice
}

/// SIGHUP stays ignored where it is: who starts a long batch by nohup means to close the terminal.
void catch_polite(void (*handler)(int)) {
  on_terminal = isatty(STDERR_FILENO);
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  if (std::signal(SIGHUP, handler) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void on_stop(int /*signal*/) {
  if (signalled >= 2) end_now();
  signalled = signalled + 1;
}

/// One that may come again by itself, from a timer or a limit, or twice from a terminal that is closed (by its shell
/// and by the system): however often, nobody is in a hurry.
void on_end(int /*signal*/) {
  if (signalled == 0) signalled = 1;
}

std::string padded(std::string text) {
  constexpr std::size_t kWidth = 10;
  text.resize(std::max(kWidth, text.size() + 2), ' ');
  return text;
}

}  // namespace

void catch_stops() {
  for (const int signal : {SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGPWR, SIGSTKFLT, SIGIO, SIGHUP})
    std::signal(signal, on_end);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) std::signal(signal, on_end);
  std::signal(SIGXFSZ, SIG_IGN);  // writing fails instead, as on a full disk
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGTSTP}) std::signal(signal, on_stop);
  for (const int signal : {SIGPIPE, SIGTTIN, SIGTTOU}) std::signal(signal, SIG_IGN);
}

bool insisted() { return signalled >= 2; }

void end_by_interrupts() { catch_polite(on_signal_without_rest); }

void catch_interrupts() { catch_polite(on_signal); }

bool interrupted() { return signalled != 0; }

scenarios::RunOptions terminal_options(const std::string& out, bool force) {
  catch_interrupts();
  scenarios::RunOptions options;
  options.out = out;
  options.replace = force;
  options.interrupted = interrupted;
  options.waits = [](const explore::Decision& waits) {
    end_progress();
    tell("at " + std::to_string(static_cast<int>(waits.stamp.seconds())) + " s the robot " + waits.why);
  };
  options.note = tell;
  if (isatty(STDERR_FILENO))
    options.progress = [](const scenarios::Progress& p) {
      std::fprintf(stderr, "\r\033[K%6.1f s  %3.0f %%  %.1f m2 known  %.0f x real time", p.sim_s, 100.0 * p.share,
                   p.known_m2, p.real_time_factor);
      std::fflush(stderr);
    };
  return options;
}

void show_share(const std::string& what, double share) {
  static std::string shown;  // a terminal is slower than what reports
  const std::string line = one_line(what) + "  " + std::to_string(static_cast<int>(100.0 * share)) + " %";
  if (line == shown || !isatty(STDERR_FILENO)) return;
  shown = line;
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

void end_progress() {
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r\033[K");
}

void print_line(const std::string& line) { std::printf("%s\n", one_line(line).c_str()); }

void print_json(const nlohmann::ordered_json& json) {
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  std::printf("%s\n", json.dump(2, ' ', true, replace).c_str());
}

void tell(const std::string& line) { std::fprintf(stderr, "rubble: %s\n", one_line(line).c_str()); }

void print_row(const std::string& label, const std::string& value, int width, std::FILE* out) {
  std::fprintf(out, "%-*s %s\n", width, one_line(label).c_str(), one_line(value).c_str());
}

void print_not_aligned(const std::string& note) { print_row("not aligned", scoring::reason_of(note)); }

void print_figure(const scoring::Figure& figure, const std::string& text, bool explained) {
  print_row(figure.label, explained && !figure.meaning.empty() ? padded(text) + figure.meaning : text);
}

void print_figures(const nlohmann::ordered_json& score, bool explained) {
  const auto aligned = score.find("aligned");
  const bool refused = aligned != score.end() && aligned->is_boolean() && !aligned->get<bool>();
  for (const scoring::Figure* figure : scoring::figures_with(scoring::kShown)) {
    if (refused && figure->is(scoring::kPlaced)) continue;
    const auto found = score.find(figure->key);  // special figures may not be there
    const std::string text = found == score.end() ? "" : scoring::text_of(*figure, scenarios::value_of(found.value()));
    if (text.empty()) continue;
    print_figure(*figure, text, explained);
  }
}

void print_victims(const nlohmann::ordered_json& score) {
  if (!score.at("victims_found").is_number()) return;
  std::string text = score["victims_found"].dump() + " of " + score["victims_total"].dump();
  // Nobody can find what no pose on the floor it can reach shows.
  if (const auto seen = score.find("victims_visible");
      seen != score.end() && seen->is_number() && *seen != score["victims_total"])
    text += " (" + seen->dump() + " can be seen)";
  text += ", " + score["victims_false"].dump() + " false";
  if (const auto& error = score["victims_error_m"]; error.is_number())
    text += ", " + scoring::text_of(*scoring::find_figure("victims_error_m"), scenarios::value_of(error)) + " off";
  print_row("victims found", text);
}

int show(const scenarios::RunReport& report) {
  end_progress();
  const nlohmann::ordered_json& score = *report.score;
  if (!report.failure.empty() && score["scans"] == 0) {  // figures of nothing are none
    print_row("folder", report.folder);
    tell(report.failure);
    return report.interrupted ? kInterrupted : kFailed;
  }
  // A sentence that comes last, on stderr, is not said twice.
  print_row("ended", report.end == report.failure ? "by a failure; the last line tells it" : report.end);
  if (!report.place.empty()) print_row("place in the map", report.place);
  print_figures(score);
  if (score["aligned"].is_boolean() && !score["aligned"].get<bool>())
    print_not_aligned(score["align_note"].get<std::string>());
  print_victims(score);
  if (!report.unseen_victims.empty()) print_row("victims out of sight", kOutOfSight + joined(report.unseen_victims));
  if (const auto lost = score["hits_outside"].get<std::uint64_t>(); lost > 0)
    print_row("NOT MAPPED", std::to_string(lost) + " laser hits lay beyond the largest map (mapper.max_map_cells)");
  if (const auto dropped = score["scans_out_of_order"].get<std::uint64_t>(); dropped > 0)
    print_row("NOT MAPPED", std::to_string(dropped) +
                                " scans were empty, not younger than the one before, or of angles that no scanner has");
  const bool turns_against = score.value("turns_against", 0.0) > 0.0;
  if (score.value("map_doubted", 0.0) > 0.0 && !turns_against)
    print_row("DOUBTFUL MAP", score["frames_doubled"].dump() + " of " + score["key_frames"].dump() +
                                  " key frames lie on top of another place, " + score["scans_unfit"].dump() +
                                  " scans fit nothing mapped: the robot may have lost its place");
  if (turns_against)
    print_row("DOUBTFUL MAP",
              "the scans turn the other way than the wheels: the laser hangs upside down (map has "
              "--upside-down), its beams come in reverse, or the encoders are exchanged");
  for (const auto& broken : report.broken) print_row("NOT AS EXPECTED", broken);
  print_row("folder", report.folder);
  if (!report.failure.empty()) tell(report.failure);
  if (report.interrupted) return kInterrupted;
  if (!report.failure.empty()) return kFailed;
  return report.broken.empty() ? kOk : kBroken;
}

}  // namespace rubble::app
