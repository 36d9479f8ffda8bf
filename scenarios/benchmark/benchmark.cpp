#include "scenarios/benchmark/benchmark.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "arenas/files/arena_file.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/input_file.h"
#include "base/trajectory.h"
#include "robot/logs/log.h"
#include "scenarios/benchmark/program_meter.h"
#include "scenarios/run/core.h"
#include "scenarios/run/recorded_log.h"
#include "scenarios/run/run.h"
#include "scoring/trajectory/relative_error.h"
#include "scoring/trajectory/trajectory_error.h"
#include "sim/sim_robot.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// CPU time of this process with all its threads: a mapper may have some [s].
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The list lets no mapper take so long.
struct TookTooLong : std::runtime_error {
  explicit TookTooLong(int limit) : std::runtime_error("stopped after " + std::to_string(limit) + " s of CPU time") {}
};

/// The mapper inside, with the time that each scan takes. Of one that is another program it is that program's time.
class TimedMapper {
 public:
  /// cpu_limit: update() throws TookTooLong once all of them together took longer [s].
  TimedMapper(slam::Mapper& mapper, bool is_program, const std::optional<int>& cpu_limit)
      : mapper_(mapper), cpu_limit_(cpu_limit) {
    if (is_program) program_.emplace();
  }

  void update(const robot::Inputs& inputs) {
    const std::size_t before = mapper_.live_trajectory().size();
    scans_ += inputs.scans.size();
    if (program_) {
      // It may work between its answers: what counts is all since the last one.
      const std::optional<double> start = program_->cpu_seconds();
      mapper_.update(inputs);
      program_->look();
      if (!program_->cpu_seconds()) return;
      all_ = *program_->cpu_seconds();
      if (start) share_out(all_ - *start, before);  // else it is the update that started it, which takes long
    } else {
      const double start = cpu_seconds();
      mapper_.update(inputs);
      const double taken = cpu_seconds() - start;
      all_ += taken;
      share_out(taken, before);
    }
    // Not by RLIMIT_CPU: under one the process's CPU clock goes by the scheduler's ticks, 4 ms.
    if (cpu_limit_ && all_ > *cpu_limit_) throw TookTooLong(*cpu_limit_);
  }
  void finish() {
    const double start = program_ ? all_ : cpu_seconds();
    mapper_.finish();
    if (program_) program_->look_back();
    finish_ = (program_ ? program_->cpu_seconds().value_or(start) : cpu_seconds()) - start;
  }
  json figures() {
    json out = {{"scans", scans_}};
    if (!program_ || program_->cpu_seconds()) add_times(out);
    if (program_) out["is_program"] = true;
    if (program_ && program_->peak_mb()) out["program_peak_mb"] = *program_->peak_mb();
    for (const slam::MapperFigure& figure : mapper_.figures())
      for (const char* key : {slam::MapperFigure::kLoopsClosed, slam::MapperFigure::kLoopsRemoved,
                              slam::MapperFigure::kMapDoubted, slam::MapperFigure::kMostWork})
        if (figure.key == key) out[key] = figure.value;
    return out;
  }

 private:
  void share_out(double taken, std::size_t before) {
    // A scan may wait for the odometry from after it: what counts is the update that placed it, often with others.
    const std::size_t after = mapper_.live_trajectory().size();
    if (after > before) ms_.insert(ms_.end(), after - before, 1e3 * taken / static_cast<double>(after - before));
  }
  void add_times(json& out) {
    std::sort(ms_.begin(), ms_.end());
    const auto share = [&](std::size_t percent) { return ms_[std::min(ms_.size() - 1, ms_.size() * percent / 100)]; };
    out["scans_per_second"] = all_ > 0.0 ? static_cast<double>(scans_) / all_ : 0.0;
    out["finish_ms"] = 1e3 * finish_;
    if (ms_.empty()) return;
    out["usual_ms"] = share(50);
    out["slow_ms"] = share(99);
    out["worst_ms"] = ms_.back();
  }

  slam::Mapper& mapper_;
  const std::optional<int> cpu_limit_;
  std::optional<ProgramMeter> program_;
  std::vector<double> ms_;
  std::size_t scans_ = 0;
  double all_ = 0.0;
  double finish_ = 0.0;
};

/// Where the files of a case lie.
struct CaseFiles {
  std::string log, reference, relations, scenario;
  bool reference_named = false;  ///< by the list: else it was found beside the log, and counts where the log has none
  std::string missing;           ///< the first that is not there
};

/// log: whose own stamps the truth has; null: it has those that the log is delivered with. False: they have no moments
/// in common.
bool add_aligned(json& out, const slam::Mapper& mapper, const Trajectory& truth,
                 const robot::ReplayRobot* log = nullptr) {
  const auto stamped = [&](const Trajectory& poses) { return log != nullptr ? log->in_own_stamps(poses) : poses; };
  const scoring::TrajectoryError error = scoring::trajectory_error(stamped(mapper.trajectory()), truth);
  const scoring::TrajectoryError live = scoring::trajectory_error(stamped(mapper.live_trajectory()), truth);
  if (error.matched < 2) return false;
  out["error_m"] = error.ate_aligned_m;
  out["live_error_m"] = live.ate_aligned_m;
  if (!out.contains(slam::MapperFigure::kLoopsClosed)) return true;
  const auto name = [&](Stamp stamp) { return log != nullptr ? log->own_stamp(stamp) : stamp; };
  std::vector<scoring::Relation> claimed;
  for (const slam::FoundLoop& loop : mapper.found_loops())
    if (loop.closed()) claimed.push_back({name(loop.from), name(loop.to), loop.T_from_to});
  out["loops_false"] = scoring::false_relations(claimed, truth);
  return true;
}

/// Told how much of the log is done, 0..1.
using ShareTeller = std::function<void(double)>;

json run_log(const CaseFiles& files, const Scenario& scenario, const std::optional<int>& cpu_limit,
             const ShareTeller& tell_share) {
  robot::ReplayRobot robot(files.log);
  const auto mapper = slam::make_here(scenario.mapper, robot.model(), {scenario.seed, ""});
  TimedMapper timed(*mapper, !scenario.mapper.command().empty(), cpu_limit);
  while (const auto inputs = robot.read()) {
    timed.update(*inputs);
    tell_share(robot.progress());
  }
  timed.finish();
  json out = timed.figures();
  if (files.relations.empty()) {
    // Other programs know the scans by the log's own stamps.
    const bool is_other = !files.reference.empty() && (files.reference_named || robot.reference().empty());
    const Trajectory other = is_other ? read_tum(files.reference) : Trajectory();
    if (is_other && !add_aligned(out, *mapper, other, &robot))
      throw InputError(files.reference + ": none of its moments lies in " + files.log +
                       "; are both of the same drive?");
    if (!is_other && robot.reference().empty()) out["no_reference"] = true;
    if (!is_other && !robot.reference().empty()) add_aligned(out, *mapper, robot.reference());
    return out;
  }
  const auto known = scoring::read_relations(files.relations);
  const auto error = scoring::relation_error(robot.in_own_stamps(mapper->trajectory()), known);
  const auto live = scoring::relation_error(robot.in_own_stamps(mapper->live_trajectory()), known);
  if (error.relations == 0)
    throw InputError(files.relations + ": none of its moments lies in " + files.log + "; are both of the same drive?");
  const Trajectory scans = robot.in_own_stamps(mapper->trajectory());
  if (const auto doubt = scoring::between_scans(scans, known, files.relations, files.log)) out["doubt"] = *doubt;
  out["error_m"] = error.mean_m;
  out["error_deg"] = rad_to_deg(error.mean_rad);
  out["live_error_m"] = live.mean_m;
  return out;
}

/// The robot explores by its own map: another mapper sees another drive.
json run_arena(const Scenario& scenario, const std::optional<int>& cpu_limit) {
  const std::string yaml = arena_yaml(scenario);
  const arenas::Arena arena = arenas::parse_arena(yaml, scenario.name);
  sim::SimRobot robot(arena, scenario.robot, scenario.sim, scenario.seed);
  const auto mapper = slam::make_here(scenario.mapper, scenario.robot, {scenario.seed, ""});
  const auto explorer = scenario.explorer.make(scenario.robot, mission_of(scenario));
  robot::Levelling levelling(scenario.levelling, scenario.robot);
  TimedMapper timed(*mapper, !scenario.mapper.command().empty(), cpu_limit);
  while (const auto inputs = robot.read()) {
    timed.update(*inputs);
    robot::Commands commands = explorer->next(*mapper, *inputs);
    commands.aim = levelling.update(*inputs);
    robot.command(commands);
    if (explorer->finished()) break;
  }
  timed.finish();
  json out = timed.figures();
  add_aligned(out, *mapper, robot.truth());
  return out;
}

/// What a child says through a pipe, and the most memory it held.
struct ChildAnswer {
  std::string text;
  double peak_mb = 0.0;
  bool interrupted = false;  ///< before it had answered
};

/// True: all of it.
bool write_all(int pipe, const std::string& text) {
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t n = write(pipe, text.data() + sent, text.size() - sent);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// A line for each per cent, ahead of the answer.
ShareTeller through(int pipe) {
  return [pipe, told = 0](double share) mutable {
    const int percent = static_cast<int>(100.0 * share);
    if (percent <= told) return;
    told = percent;
    write_all(pipe, std::to_string(percent) + "\n");
  };
}

/// Takes the lines off the front of what has come so far; the last one counts.
std::optional<double> take_share(std::string& text) {
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) return std::nullopt;
  const std::size_t before = text.rfind('\n', end - 1);
  const double share = std::atof(text.c_str() + (before == std::string::npos ? 0 : before + 1)) / 100.0;
  text.erase(0, end + 1);
  return share;
}

ChildAnswer in_child(const std::function<json(const ShareTeller&)>& work, const ShareTeller& tell_share,
                     const std::function<bool()>& interrupted) {
  int ends[2];
  if (pipe(ends) != 0) throw RunError("a pipe cannot be made; close other programs and try again");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw RunError("a process cannot be made; close other programs and try again");
  if (child == 0) {
    close(ends[0]);
    dup2(STDERR_FILENO, STDOUT_FILENO);  // where libraries of mappers chatter: the parent's is a table, or JSON
    json answer;
    try {
      answer = work(through(ends[1]));
    } catch (const TookTooLong& error) {
      answer = {{"failure", error.what()}, {"stopped", true}};
    } catch (const std::exception& error) {
      answer = {{"failure", error.what()}};
    }
    write_all(ends[1], answer.dump());
    _exit(0);
  }
  close(ends[1]);
  ChildAnswer answer;
  char buffer[4096];
  pollfd end{ends[0], POLLIN, 0};
  while (true) {
    constexpr int kLook = 100;  // [ms]
    if (interrupted && interrupted()) {
      answer.interrupted = true;
      kill(child, SIGKILL);  // its guardian ends a mapper that is a program
      break;
    }
    if (poll(&end, 1, kLook) <= 0) continue;
    const ssize_t n = read(ends[0], buffer, sizeof buffer);
    if (n > 0) answer.text.append(buffer, static_cast<std::size_t>(n));
    if (const auto share = take_share(answer.text)) tell_share(*share);
    if (n == 0 || (n < 0 && errno != EINTR)) break;
  }
  close(ends[0]);
  rusage usage{};
  int status = 0;
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  answer.peak_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return answer;
}

void take(BenchmarkResult& result, const ChildAnswer& answer) {
  result.runs = 1;
  const json said = json::parse(answer.text, nullptr, false);
  if (!said.is_object()) {
    result.failure = "its process ended without an answer";
    return;
  }
  result.failure = said.value("failure", "");
  result.stopped = said.value("stopped", false);
  if (!result.failure.empty()) return;
  const auto number = [&](const char* key) {
    return said.contains(key) ? std::optional<double>(said[key].get<double>()) : std::nullopt;
  };
  result.doubt = said.value("doubt", "");
  if (said.value("no_reference", false)) result.not_judged = "no reference";
  result.error_m = number("error_m");
  result.live_error_m = number("live_error_m");
  result.error_deg = number("error_deg");
  result.most_work_ms = number(slam::MapperFigure::kMostWork);
  result.loops_closed = number(slam::MapperFigure::kLoopsClosed);
  result.loops_removed = number(slam::MapperFigure::kLoopsRemoved);
  result.loops_false = number("loops_false");
  result.doubted = number(slam::MapperFigure::kMapDoubted);
  result.scans = said["scans"].get<std::uint64_t>();
  result.scans_per_second = number("scans_per_second");
  result.usual_ms = number("usual_ms");
  result.slow_ms = number("slow_ms");
  result.worst_ms = number("worst_ms");
  result.finish_ms = number("finish_ms");
  result.peak_mb = said.value("is_program", false) ? number("program_peak_mb") : answer.peak_mb;
}

/// What several runs gave, one at least: medians of errors, the largest of times. A run that failed is told, and spoils
/// the rest.
BenchmarkResult summary(const std::vector<BenchmarkResult>& runs) {
  for (const BenchmarkResult& run : runs)
    if (!run.failure.empty()) return run;
  BenchmarkResult all = runs.front();
  all.runs = runs.size();
  const auto values = [&](std::optional<double> BenchmarkResult::*value) {
    std::vector<double> known;
    for (const BenchmarkResult& run : runs)
      if (run.*value) known.push_back(*(run.*value));
    std::sort(known.begin(), known.end());
    return known;
  };
  const auto median = [](const std::vector<double>& sorted) {
    if (sorted.empty()) return std::optional<double>();
    const std::size_t half = sorted.size() / 2;
    return std::optional<double>(sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]));
  };
  const std::vector<double> errors = values(&BenchmarkResult::error_m);
  all.error_m = median(errors);
  all.live_error_m = median(values(&BenchmarkResult::live_error_m));
  all.error_deg = median(values(&BenchmarkResult::error_deg));
  if (runs.size() > 1 && !errors.empty()) all.worst_m = errors.back();
  for (const auto value : {&BenchmarkResult::usual_ms, &BenchmarkResult::slow_ms, &BenchmarkResult::worst_ms,
                           &BenchmarkResult::most_work_ms, &BenchmarkResult::finish_ms, &BenchmarkResult::peak_mb}) {
    const std::vector<double> known = values(value);
    if (!known.empty()) all.*value = known.back();
  }
  double seconds = 0.0;
  all.scans = 0;
  for (const BenchmarkResult& run : runs) {
    all.scans += run.scans;
    if (run.scans_per_second.value_or(0.0) > 0.0) seconds += static_cast<double>(run.scans) / *run.scans_per_second;
  }
  if (all.scans_per_second) all.scans_per_second = seconds > 0.0 ? static_cast<double>(all.scans) / seconds : 0.0;
  const auto sum = [&](std::optional<double> BenchmarkResult::*value) {
    const std::vector<double> known = values(value);
    return known.empty() ? std::optional<double>() : std::accumulate(known.begin(), known.end(), 0.0);
  };
  all.loops_closed = sum(&BenchmarkResult::loops_closed);
  all.loops_removed = sum(&BenchmarkResult::loops_removed);
  all.loops_false = sum(&BenchmarkResult::loops_false);
  all.doubted = sum(&BenchmarkResult::doubted);
  return all;
}

void judge(const BenchmarkCase& what, BenchmarkResult& result) {
  if (!what.goal && !what.live_goal && !what.false_loops_goal) result.not_judged.clear();
  const auto ask = [&](const std::optional<double>& goal, const std::optional<double>& value, const char* column) {
    if (!goal || !value) return;
    const bool met = *value <= *goal;
    result.goal_met = result.goal_met.value_or(true) && met;
    if (!met) result.goals_missed.emplace_back(column);
  };
  ask(what.goal, result.error_m, "error");
  ask(what.heading_goal, result.error_deg, "deg");
  ask(what.worst_goal, result.worst_m, "worst");
  ask(what.live_goal, result.live_error_m, "known at the scan");
  ask(what.false_loops_goal, result.loops_false, "false loops");
  if (result.scans == 0) return;
  // At least, where all others are at most.
  if (what.speed_goal && result.scans_per_second) ask(-*what.speed_goal, -*result.scans_per_second, "scans/s");
  ask(what.slow_goal, result.slow_ms, "99 % ms");
  ask(what.worst_time_goal, result.worst_ms, "worst ms");
  if (!result.not_judged.empty() && result.goal_met == true) result.goal_met.reset();  // not all of them
}

/// A trajectory beside a log: truth.tum of a run folder, lab.tum of lab.rlog or lab.clf.bz2. Empty: none.
std::string reference_beside(const std::string& log) {
  const fs::path folder = fs::path(log).parent_path();
  fs::path stem = fs::path(log).filename();
  if (stem.extension() == ".gz" || stem.extension() == ".bz2") stem = stem.stem();
  const bool is_of_run = stem == "log.rlog";
  const fs::path beside = folder / (is_of_run ? fs::path("truth.tum") : stem.replace_extension(".tum"));
  std::error_code error;
  return fs::is_regular_file(beside, error) && !read_tum(beside.string()).empty() ? beside.string() : "";
}

CaseFiles files_of(const BenchmarkCase& what, const std::vector<std::string>& folders) {
  CaseFiles files;
  const auto find = [&](const std::string& wanted, std::string& found) {
    if (wanted.empty()) return;
    found = find_in(folders, wanted);
    if (found.empty() && files.missing.empty()) files.missing = wanted;
    if (found.empty() || fs::is_directory(found)) return;
    // A log on the command line may come through a pipe; what a list names would be waited for unasked.
    InputRules rules;
    rules.most = std::size_t{1} << 31;  // the readers have smaller ones of their own
    rules.pipes = Pipes::None;
    require_input(found, rules);
  };
  find(what.log, files.log);
  if (!files.log.empty() && fs::is_directory(files.log)) files.log = log_in(files.log);
  find(what.reference, files.reference);
  if (!files.reference.empty() && read_tum(files.reference).empty())
    throw InputError(files.reference + ": holds no poses; give lines of TUM text, 'time x y z qx qy qz qw'");
  files.reference_named = !what.reference.empty();
  if (!files.log.empty() && !files.reference_named && what.relations.empty())
    files.reference = reference_beside(files.log);
  find(what.relations, files.relations);
  find(what.scenario, files.scenario);
  return files;
}

Scenario scenario_of(const BenchmarkCase& what, const BenchmarkMapper& mapper, const CaseFiles& files,
                     const BenchmarkOptions& options) {
  std::vector<Override> overrides = mapper.overrides;
  overrides.insert(overrides.end(), what.overrides.begin(), what.overrides.end());
  Scenario scenario = files.scenario.empty() ? default_scenario(overrides) : load_scenario(files.scenario, overrides);
  if (options.permit) options.permit(scenario);
  scenario.mapper.require_permission();
  return scenario;
}

/// runs 0, and nothing missing: it was interrupted before the first was done.
BenchmarkResult run_one(const BenchmarkCase& what, const BenchmarkMapper& mapper, const std::optional<int>& cpu_limit,
                        const std::vector<std::string>& folders, const BenchmarkOptions& options,
                        BenchmarkProgress progress) {
  BenchmarkResult result;
  result.mapper = mapper.name;
  const CaseFiles files = files_of(what, folders);
  result.missing = files.missing;
  if (!result.missing.empty()) return result;
  Scenario scenario = scenario_of(what, mapper, files, options);
  std::vector<BenchmarkResult> runs;
  for (const std::uint64_t seed : what.seeds) {
    if (options.interrupted && options.interrupted()) break;
    scenario.seed = seed;
    BenchmarkResult run;
    const auto work = [&](const ShareTeller& tell_share) {
      return files.log.empty() ? run_arena(scenario, cpu_limit) : run_log(files, scenario, cpu_limit, tell_share);
    };
    progress.seed = runs.size() + 1;
    const auto tell = [&](const std::optional<double>& share) {
      progress.share = share;
      if (options.progress) options.progress(progress);
    };
    tell(std::nullopt);
    const ChildAnswer answer = in_child(work, tell, options.interrupted);
    if (answer.interrupted) break;
    take(run, answer);
    if (run.failure.empty() && what.goal && !run.error_m && run.not_judged.empty())
      run.failure = "its trajectory cannot be judged";
    if (!run.failure.empty() && what.seeds.size() > 1) run.failure += " (seed " + std::to_string(seed) + ")";
    runs.push_back(std::move(run));
  }
  if (runs.empty()) return result;
  result = summary(runs);
  result.mapper = mapper.name;
  if (result.failure.empty() && result.runs == what.seeds.size()) judge(what, result);
  return result;
}

}  // namespace

Benchmark run_benchmark(const BenchmarkList& list, const BenchmarkOptions& options) {
  std::vector<std::string> folders{list.folder};
  folders.insert(folders.end(), options.folders.begin(), options.folders.end());
  Benchmark benchmark{list.name, list.about, {}, {}};
  // A key that a mapper does not have shall cost no run.
  for (const BenchmarkCase& what : list.cases) {
    const CaseFiles files = files_of(what, folders);
    for (const BenchmarkMapper& mapper : list.mappers)
      if (files.missing.empty()) scenario_of(what, mapper, files, options);
  }
  std::size_t number = 0;
  for (const BenchmarkCase& what : list.cases) {
    ++number;
    BenchmarkRow row{what, {}};
    for (const BenchmarkMapper& mapper : list.mappers) {
      BenchmarkProgress progress{number, list.cases.size(), what.name, mapper.name, 0, what.seeds.size(), {}, nullptr};
      BenchmarkResult result = run_one(what, mapper, list.cpu_limit, folders, options, progress);
      const bool failed = !result.missing.empty() || !result.failure.empty();
      const bool whole = failed || result.runs == what.seeds.size();
      if (!whole) benchmark.gaps.push_back({what.name, mapper.name, result.runs, what.seeds.size()});
      progress.finished = &result;
      if (whole && options.progress) options.progress(progress);
      if (failed || result.runs > 0) row.results.push_back(std::move(result));
    }
    if (!row.results.empty()) benchmark.rows.push_back(std::move(row));
  }
  return benchmark;
}

}  // namespace rubble::scenarios
