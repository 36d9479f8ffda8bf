#include "scenarios/benchmark/program_meter.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

double seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// What /proc/PID/stat says of a process.
struct ProcessStat {
  pid_t parent = -1;       ///< -1: the process is gone
  double ended_cpu = 0.0;  ///< CPU time of those below it that have ended and were waited for; by the clock tick [s]
};

ProcessStat stat_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text, '\0');
  // "pid (name) state parent ...": the name may hold anything.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(text.substr(name_end + 1));
  ProcessStat stat;
  std::string skipped;
  double user = 0.0, system = 0.0;
  fields >> skipped >> stat.parent;
  for (int k = 5; k <= 15; ++k) fields >> skipped;  // as proc(5) counts
  fields >> user >> system;
  stat.ended_cpu = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return fields ? stat : ProcessStat{};
}

/// CPU time of a process with all its threads [s]; 0: it is gone.
double cpu_of(pid_t pid) {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &now) != 0) return 0.0;
  return seconds(now);
}

/// The most that a process held since it began with its program; 0: it is gone.
double peak_mb_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::strtod(line.c_str() + 6, nullptr) / 1024.0;
  return 0.0;
}

/// The youngest process or thread of the machine; -1: not told.
long newest_process() {
  std::ifstream file("/proc/loadavg");
  std::string load[3], running;
  long newest = -1;
  file >> load[0] >> load[1] >> load[2] >> running >> newest;
  return file ? newest : -1;
}

/// CPU time of children that have ended, and of those below them [s].
double ended_children_cpu() {
  rusage ended{};
  getrusage(RUSAGE_CHILDREN, &ended);
  return seconds(ended.ru_utime) + seconds(ended.ru_stime);
}

}  // namespace

ProgramMeter::ProgramMeter() : earlier_(ended_children_cpu()) {}

/// Fills children_ and processes_.
void ProgramMeter::find() {
  std::multimap<pid_t, pid_t> below;  // by parent
  std::error_code none;
  for (fs::directory_iterator entry("/proc", none), end; !none && entry != end; entry.increment(none)) {
    const std::string name = entry->path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto pid = static_cast<pid_t>(std::strtol(name.c_str(), nullptr, 10));
    if (const pid_t parent = stat_of(pid).parent; parent >= 0) below.emplace(parent, pid);
  }
  const auto add_below = [&](pid_t parent, std::vector<pid_t>& to) {
    const auto [first, last] = below.equal_range(parent);
    std::transform(first, last, std::back_inserter(to), [](const auto& entry) { return entry.second; });
  };
  children_.clear();
  processes_.clear();
  add_below(getpid(), children_);
  for (const pid_t child : children_) add_below(child, processes_);
  for (std::size_t k = 0; k < processes_.size(); ++k) add_below(processes_[k], processes_);
}

void ProgramMeter::look() {
  // A search reads of every process of the machine; there is nothing to find where none has begun since.
  if (const long newest = newest_process(); newest < 0 || newest != newest_) {
    find();
    newest_ = newest;
  }
  if (processes_.empty()) return;
  double cpu = 0.0, peak = 0.0;
  for (const pid_t child : children_) cpu += stat_of(child).ended_cpu;
  for (const pid_t process : processes_) {
    cpu += cpu_of(process) + stat_of(process).ended_cpu;
    peak += peak_mb_of(process);
  }
  note(cpu);
  peak_mb_ = std::max(peak_mb_.value_or(0.0), peak);
}

void ProgramMeter::look_back() {
  if (cpu_seconds_) note(ended_children_cpu() - earlier_);
}

/// One that ends is for a moment in no sum.
void ProgramMeter::note(double cpu_seconds) { cpu_seconds_ = std::max(cpu_seconds_.value_or(0.0), cpu_seconds); }

}  // namespace rubble::scenarios
