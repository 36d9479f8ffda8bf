#include "app/terminal.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "app/commands.h"

namespace rubble::app {
namespace {

volatile std::sig_atomic_t signalled = 0;

void on_signal(int signal) {
  signalled = 1;
  std::signal(signal, SIG_DFL);  // the second one is not asked twice
}

struct Row {
  const char* key;
  const char* label;
  const char* format;
  double factor;
};

constexpr Row kRows[] = {
    {"area_known_m2", "area mapped", "%.1f m2", 1.0},
    {"known", "of the arena known", "%.1f %%", 100.0},
    {"ate_first_m", "trajectory error, first pose", "%.3f m", 1.0},
    {"ate_aligned_m", "trajectory error, aligned", "%.3f m", 1.0},
    {"psi_m", "psi", "%.3f m", 1.0},
    {"precision", "precision", "%.3f", 1.0},
    {"recall", "recall", "%.3f", 1.0},
    {"score", "score", "%.3f", 1.0},
    {"sim_s", "time covered", "%.1f s", 1.0},
    {"wall_s", "time taken", "%.1f s", 1.0},
    {"real_time_factor", "times real time", "%.0f", 1.0},
    {"peak_mb", "memory", "%.0f MB", 1.0},
};

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGHUP, on_signal);  // the terminal was closed
}

bool interrupted() { return signalled != 0; }

scenarios::RunOptions terminal_options(const std::string& out, bool force) {
  catch_interrupts();
  scenarios::RunOptions options;
  options.out = out;
  options.replace = force;
  options.interrupted = interrupted;
  if (isatty(STDERR_FILENO))
    options.progress = [](const scenarios::Progress& p) {
      std::fprintf(stderr, "\r\033[K%6.1f s  %3.0f %%  %.1f m2 known  %.0f x real time", p.sim_s, 100.0 * p.share,
                   p.known_m2, p.real_time_factor);
      std::fflush(stderr);
    };
  return options;
}

void end_progress() {
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r\033[K");
}

void print_summary(const scenarios::RunReport& report) {
  const auto& score = report.score;
  std::printf("%-30s %s\n", "ended", report.end.c_str());
  for (const Row& row : kRows) {
    if (!score.contains(row.key) || !score[row.key].is_number()) continue;
    char value[64];
    std::snprintf(value, sizeof value, row.format, score[row.key].get<double>() * row.factor);
    std::printf("%-30s %s\n", row.label, value);
  }
  if (score["aligned"].is_boolean() && !score["aligned"].get<bool>())
    std::printf("%-30s %s\n", "not aligned", score["align_note"].get<std::string>().c_str());
  if (score["victims_total"].is_number())
    std::printf("%-30s %d of %d\n", "victims found", score["victims_found"].get<int>(),
                score["victims_total"].get<int>());
  if (const auto lost = score.value("hits_outside", std::uint64_t{0}); lost > 0)
    std::printf("%-30s %llu laser hits lay beyond the largest map (mapper.max_map_cells)\n", "NOT MAPPED",
                static_cast<unsigned long long>(lost));
  if (const auto dropped = score.value("scans_out_of_order", std::uint64_t{0}); dropped > 0)
    std::printf("%-30s %llu scans were empty or not younger than the one before\n", "NOT MAPPED",
                static_cast<unsigned long long>(dropped));
  for (const auto& broken : report.broken) std::printf("%-30s %s\n", "NOT AS EXPECTED", broken.c_str());
  std::printf("%-30s %s\n", "folder", report.folder.c_str());
}

int exit_code(const scenarios::RunReport& report) {
  if (!report.failure.empty()) std::fprintf(stderr, "rubble: %s\n", report.failure.c_str());
  if (report.interrupted) return kInterrupted;
  if (!report.failure.empty()) return kFailed;
  return report.broken.empty() ? kOk : kBroken;
}

}  // namespace rubble::app
