#include "app/batch/batch_tools.h"

#include <sched.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <functional>

#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/report.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;
using namespace scenarios;

std::string clock_text(double seconds) {
  const long s = static_cast<long>(seconds + 0.5);
  char text[40];
  std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  return text;
}

std::string progress_line(const BatchProgress& p) {
  std::string line = std::to_string(p.finished()) + " of " + std::to_string(p.total) + " runs, " +
                     std::to_string(p.running) + " running";
  if (p.failed) line += ", " + std::to_string(p.failed) + " FAILED";
  if (p.skipped) line += ", " + std::to_string(p.skipped) + " found finished";
  line += ", " + clock_text(p.elapsed_s) + " gone";
  if (p.remaining_s > 0.0) line += ", " + clock_text(p.remaining_s) + " to go";
  return line;
}

/// On a terminal each line replaces the one before; elsewhere it stays, so there are few.
std::function<void(const BatchProgress&)> progress_teller() {
  if (isatty(STDERR_FILENO))
    return [](const BatchProgress& p) {
      std::fprintf(stderr, "\r\033[K%s", progress_line(p).c_str());
      std::fflush(stderr);
    };
  return [pace = ProgressPace()](const BatchProgress& p) mutable {
    if (pace.due(p)) tell(progress_line(p));
  };
}

/// What is left to make, of `all` runs of every shard.
std::string cost_line(const BatchProgress& p, std::size_t all, const BatchOptions& options) {
  const std::size_t left = p.total - p.skipped;
  if (p.total == 0 && all > 0)  // runs are dealt by their ids, not in turn
    return "shard " + std::to_string(options.shard.index) + " of " + std::to_string(options.shard.count) +
           " is empty: none of the " + std::to_string(all) + " runs fell to it, there is nothing to do";
  const std::string in_shard = options.shard.count > 1 ? " in this shard" : "";
  std::string line = std::to_string(left) + (left == 1 ? " run" : " runs");
  if (left < p.total) {
    line += " left of " + std::to_string(p.total) + in_shard;
  } else if (options.shard.count > 1) {
    line += " of " + std::to_string(all) + in_shard;
  }
  if (left == 0) return line + ", all are in " + options.out;
  return line + ", " + std::to_string(options.workers) + " at a time, into " + options.out;
}

}  // namespace

void add_workers(Options& options, int& workers) {
  options.whole("--workers", workers, 1, 4096, "Processes (default: one a core)");
}

bool tell_missing(const std::string& folder, const std::vector<RunRecord>& runs) {
  const MissingRuns missing = missing_runs(folder, runs);
  if (missing.missing == 0) return true;
  tell(folder + ": " + std::to_string(missing.missing) + " of the " + std::to_string(missing.asked) +
       " runs its sweep asked for are missing; give the batch command again to make them");
  return false;
}

void write_report(const std::string& source, const std::string& page) {
  const ResultSet set = load_sweep_results(source);
  if (set.runs.empty()) throw InputError(source + ": holds no finished run to report on");
  tell_missing(source, set.runs);
  write_text_file(page, report_html(set, note_of(set, source), fs::path(page).parent_path().string()));
  print_row("report", page, kBatchLabels);
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

BatchReport run_with_progress(const std::vector<Job>& jobs, BatchOptions options, bool record) {
  catch_interrupts();
  options.stop = interrupted;
  // What it costs is told at the start, also where nobody looks at a terminal.
  options.start = [&](const BatchProgress& p) { tell(cost_line(p, jobs.size(), options)); };
  options.progress = progress_teller();
  BatchReport report = run_batch(jobs, simulating_runner(record), options);
  end_progress();
  return report;
}

}  // namespace rubble::app
