#include "app/batch_tools.h"

#include <sched.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/terminal.h"

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

void show(const BatchProgress& p) {
  std::string line = std::to_string(p.finished()) + " of " + std::to_string(p.total) + " runs, " +
                     std::to_string(p.running) + " running";
  if (p.failed) line += ", " + std::to_string(p.failed) + " FAILED";
  if (p.skipped) line += ", " + std::to_string(p.skipped) + " found finished";
  line += ", " + clock_text(p.elapsed_s) + " gone";
  if (p.remaining_s > 0.0) line += ", " + clock_text(p.remaining_s) + " to go";
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

}  // namespace

std::string shipped_folder() {
  if (const char* home = std::getenv("RUBBLE_HOME")) return std::string(home) + "/scenarios";
  std::error_code error;
  const fs::path installed = fs::read_symlink("/proc/self/exe", error).parent_path() / "../share/rubble/scenarios";
  if (fs::is_directory(installed, error)) return installed.lexically_normal().string();
  return std::string(RUBBLE_SOURCE_DIR) + "/scenarios";
}

std::string find_sweep(const std::string& name) {
  const std::string shipped = shipped_folder() + "/sweeps/" + name + ".yaml";
  if (!fs::exists(name) && name.find('/') == std::string::npos && fs::exists(shipped)) return shipped;
  return name;
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

BatchReport run_with_progress(const std::vector<Job>& jobs, BatchOptions options, bool record) {
  catch_interrupts();
  options.stop = interrupted;
  if (isatty(STDERR_FILENO)) options.progress = show;
  BatchReport report = run_batch(jobs, simulating_runner(record), options);
  end_progress();
  return report;
}

}  // namespace rubble::app
