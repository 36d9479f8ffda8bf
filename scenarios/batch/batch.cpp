#include "scenarios/batch/batch.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>

#include "base/digest.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/worker_pool.h"
#include "scenarios/run/run.h"
#include "scoring/figures/figures.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// More than a run folder without its log takes.
constexpr std::size_t kProbeBytes = 4u << 20;

std::string pack(const RunOutcome& outcome) {
  return ordered_json{{"score", *outcome.score},
                      {"end", outcome.end},
                      {"failure", outcome.failure},
                      {"broken", outcome.broken},
                      {"hash", outcome.hash}}
      .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

RunOutcome unpack(const std::string& text) {
  const ordered_json json = ordered_json::parse(text);
  return {KeptJson(json["score"]), json["end"], json["failure"], json["broken"].get<std::vector<std::string>>(),
          json["hash"]};
}

bool depends_on_machine(const std::string& key) {
  const scoring::Figure* figure = scoring::find_figure(key);
  return figure != nullptr && figure->is(scoring::kMachine);
}

/// "wall_s is 12, expected at most 10": an expectation about the machine is no part of the result.
bool about_machine(const std::string& broken) { return depends_on_machine(broken.substr(0, broken.find(' '))); }

struct Entry {
  RunRecord record;
  ordered_json timing = ordered_json::object();
};

Entry entry_of(const Job& job, const TaskResult& result, const BatchOptions& options) {
  Entry entry;
  RunRecord& r = entry.record;
  r.run_id = job.run_id;
  r.scenario = job.kind->scenario.name;
  r.configuration = job.kind->configuration;
  r.seed = job.seed;
  r.folder = "runs/" + job.folder();
  r.code = options.code;
  *r.score = ordered_json::object();
  if (result.end == TaskEnd::TimedOut) {
    r.status = RunStatus::TimedOut;
    r.error = "killed after " + std::to_string(static_cast<long>(options.run_limit)) + " s";
    entry.timing["wall_s"] = result.wall_s;
    return entry;
  }
  if (result.end == TaskEnd::Failed) {
    r.status = RunStatus::Failed;
    r.error = result.text;
    entry.timing["wall_s"] = result.wall_s;
    return entry;
  }
  const RunOutcome outcome = unpack(result.text);
  r.status = outcome.failure.empty() ? RunStatus::Ok : RunStatus::Failed;
  r.error = outcome.failure;
  r.end = outcome.end;
  r.hash = outcome.hash;
  for (const auto& [key, value] : outcome.score->items())
    if (key != "end") (depends_on_machine(key) ? entry.timing : *r.score)[key] = value;
  for (const auto& line : outcome.broken) {
    if (about_machine(line)) {
      entry.timing["broken"].push_back(line);
    } else {
      r.broken.push_back(line);
    }
  }
  return entry;
}

/// Throws RunError when the folder takes no more data: then a failed run says nothing about the run.
void check_space(const std::string& folder, const std::string& suffix) {
  const std::string path = folder + "/.space" + suffix;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  std::string why = file < 0 ? std::strerror(errno) : "";
  if (file >= 0) {
    const std::string block(kProbeBytes, '\0');
    const ssize_t written = write(file, block.data(), block.size());
    if (written < 0) {
      why = std::strerror(errno);
    } else if (static_cast<std::size_t>(written) < block.size()) {
      why = "no space left";
    } else if (fsync(file) != 0) {
      why = std::strerror(errno);
    }
    close(file);
  }
  unlink(path.c_str());
  if (!why.empty())
    throw RunError(folder + ": cannot be written (" + why +
                   "); finished runs are kept, free some space and give the same command again");
}

void make_folder(const std::string& path) {
  refuse_run_folder(path);
  std::error_code error;
  for (const std::string& link : {path + "/runs", path + "/results.jsonl", path + "/workers.log"})
    if (fs::is_symlink(link, error))
      throw InputError(link + ": is a symbolic link, results could go anywhere; remove it or give another --out");
  fs::create_directories(path + "/runs", error);
  if (error)
    throw InputError(path + ": cannot be created (" + error.message() + "); give a writable folder with --out");
}

/// What the folder tells of the jobs, this shard's file or any other's.
struct Found {
  std::vector<const Job*> todo;  ///< no result yet
  std::size_t failed = 0;        ///< made, but did not end well
};
Found look_up(const std::vector<Job>& jobs, const ResultsFile& file, const BatchOptions& options) {
  std::vector<RunRecord> known = file.records();
  // The file held open must not be opened again here: closing it would give up its lock.
  for (const auto& entry : fs::directory_iterator(options.out)) {
    const std::string name = entry.path().filename().string();
    const bool own = name == "results" + shard_suffix(options.shard) + ".jsonl";
    if (own || name.rfind("results", 0) != 0 || entry.path().extension() != ".jsonl") continue;
    const auto others = load_lines(entry.path().string());
    known.insert(known.end(), others.begin(), others.end());
  }
  std::set<std::string> well, badly;
  for (const auto& record : known) (record.ok() ? well : badly).insert(record.run_id);
  Found found;
  for (const auto& job : jobs) {
    if (well.count(job.run_id) > 0) continue;
    if (options.retry || badly.count(job.run_id) == 0) {
      found.todo.push_back(&job);
    } else {
      ++found.failed;
    }
  }
  return found;
}

}  // namespace

namespace {

/// Of all artefacts together; the log is there only where it was asked for and must not make a difference.
std::string hash_of_artefacts(const std::string& path) {
  auto hashes = nlohmann::ordered_json::parse(read_text_file(path));
  hashes.erase("log.rlog");
  return sha256_of_text(hashes.dump()).substr(0, 16);
}

}  // namespace

void refuse_run_folder(const std::string& path) {
  std::error_code error;
  for (const char* name : {"score.json", "log.rlog", "estimate.tum"})
    if (fs::exists(path + "/" + name, error))
      throw InputError(path + ": is the folder of a single run (it holds " + name +
                       "); give the batch a folder of its own with --out");
}

std::string shard_suffix(const Shard& shard) {
  return shard.count == 1 ? "" : "-" + std::to_string(shard.index) + "of" + std::to_string(shard.count);
}

ResultSet results_of(const std::vector<Job>& jobs, const std::string& folder) {
  std::set<std::string> wanted;
  for (const auto& job : jobs) wanted.insert(job.run_id);
  ResultSet set = load_results(folder);
  auto& runs = set.runs;
  runs.erase(std::remove_if(runs.begin(), runs.end(), [&](const auto& run) { return wanted.count(run.run_id) == 0; }),
             runs.end());
  return set;
}

Runner simulating_runner(bool record) {
  return [record](const Job& job, const std::string& folder) {
    cv::setNumThreads(1);  // the processes are the parallelism
    RunOptions options;
    options.out = folder;
    options.record = record;
    options.link_latest = false;
    const RunReport report = run_scenario(job.scenario(), options);
    return RunOutcome{report.score, report.end, report.failure, report.broken,
                      hash_of_artefacts(folder + "/hashes.json")};
  };
}

bool ProgressPace::due(const BatchProgress& now) {
  constexpr double kLeast = 10.0, kMost = 30.0;  // [s]
  const std::size_t newly = now.done - told_done_;
  const double since = now.elapsed_s - told_at_;
  const bool is_tenth = 10 * newly >= now.total - now.skipped;
  if (newly == 0 || now.finished() == now.total || since < (is_tenth ? kLeast : kMost)) return false;
  told_done_ = now.done;
  told_at_ = now.elapsed_s;
  return true;
}

BatchReport run_batch(const std::vector<Job>& all, const Runner& runner, const BatchOptions& options) {
  make_folder(options.out);
  ResultsFile file(options.out, shard_suffix(options.shard));
  const std::vector<Job> jobs = in_shard(all, options.shard);
  const Found found = look_up(jobs, file, options);
  const std::vector<const Job*>& todo = found.todo;

  const auto work = [&](std::size_t task) {
    const Job& job = *todo[task];
    const std::string folder = options.out + "/runs/" + job.folder();
    fs::remove_all(folder);  // what a killed call left there
    return pack(runner(job, folder));
  };
  BatchReport report;
  BatchProgress& progress = report.progress;
  progress.total = jobs.size();
  progress.skipped = jobs.size() - todo.size();
  progress.failed = found.failed;
  if (options.start) options.start(progress);
  const auto start = std::chrono::steady_clock::now();
  const auto finished = [&](const TaskResult& result) {
    if (result.end != TaskEnd::Done) check_space(options.out, shard_suffix(options.shard));
    const Entry entry = entry_of(*todo[result.task], result, options);
    file.append(entry.record, entry.timing);
    ++progress.done;
    if (!entry.record.ok()) ++progress.failed;
  };
  PoolOptions pool;
  pool.workers = options.workers;
  pool.time_limit = options.run_limit;
  pool.log = options.out + "/workers" + shard_suffix(options.shard) + ".log";
  pool.stop = options.stop;
  pool.progress = [&](const PoolState& state) {
    progress.running = state.running;
    progress.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (progress.done > 0)
      progress.remaining_s = progress.elapsed_s / static_cast<double>(progress.done) *
                             static_cast<double>(progress.total - progress.finished());
    if (options.progress) options.progress(progress);
  };
  report.interrupted = !run_pool(todo.size(), work, finished, pool);
  return report;
}

}  // namespace rubble::scenarios
