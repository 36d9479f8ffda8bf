#include "app/batch.h"

#include <sched.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/terminal.h"
#include "scenarios/batch.h"
#include "scenarios/merge.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;
using namespace scenarios;

std::string shipped_folder() {
  const char* home = std::getenv("RUBBLE_HOME");
  return std::string(home ? home : ".") + "/scenarios";
}

/// A path, or the bare name of a sweep that ships with rubble.
std::string find_sweep(const std::string& name) {
  const std::string shipped = shipped_folder() + "/sweeps/" + name + ".yaml";
  if (!fs::exists(name) && name.find('/') == std::string::npos && fs::exists(shipped)) return shipped;
  return name;
}

/// Cores this process may run on: less than the machine's in a container or under a scheduler.
int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

std::string clock_text(double seconds) {
  const long s = static_cast<long>(seconds + 0.5);
  char text[40];
  std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  return text;
}

void show(const BatchProgress& p) {
  std::fprintf(stderr, "\r\033[K%zu of %zu runs, %zu running%s%s, %s gone", p.finished(), p.total, p.running,
               p.failed ? (", " + std::to_string(p.failed) + " FAILED").c_str() : "",
               p.skipped ? (", " + std::to_string(p.skipped) + " found finished").c_str() : "",
               clock_text(p.elapsed_s).c_str());
  if (p.remaining_s > 0.0) std::fprintf(stderr, ", %s to go", clock_text(p.remaining_s).c_str());
  std::fflush(stderr);
}

}  // namespace

int batch(const BatchArguments& arguments) {
  const Sweep sweep = load_sweep(find_sweep(arguments.sweep), shipped_folder());
  BatchOptions options;
  options.code = code_version();
  const std::vector<Job> jobs = expand(sweep, options.code, arguments.overrides);
  options.out = arguments.out.empty() ? "runs/" + sweep.name : arguments.out;
  options.workers = arguments.workers > 0 ? arguments.workers : usable_cores();
  options.shard = arguments.shard;
  options.retry = arguments.retry;
  options.run_limit = sweep.run_limit;
  catch_interrupts();
  options.stop = interrupted;
  if (isatty(STDERR_FILENO)) options.progress = show;
  const BatchReport report = run_batch(jobs, simulating_runner(arguments.record), options);
  end_progress();

  const BatchProgress& p = report.progress;
  std::printf("%-12s %zu of %zu (%zu made now in %.1f s, %zu found finished)\n", "runs", p.finished(), p.total, p.done,
              p.elapsed_s, p.skipped);
  if (p.failed) std::printf("%-12s %zu; see \"error\" in the results and workers.log\n", "FAILED", p.failed);
  std::printf("%-12s %s/results%s.jsonl\n", "results", options.out.c_str(), shard_suffix(options.shard).c_str());
  if (report.interrupted) {
    std::printf("%-12s give the same command again to go on\n", "interrupted");
    return kInterrupted;
  }
  return p.failed ? kFailed : kOk;
}

int batch_merge(const MergeArguments& arguments) {
  const MergeReport report = merge(arguments.sources, arguments.out);
  std::printf("%zu runs in %s, %zu of them new\n", report.runs, arguments.out.c_str(), report.added);
  return kOk;
}

}  // namespace rubble::app
