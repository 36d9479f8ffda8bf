#include "app/batch.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/batch_tools.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/merge.h"
#include "scenarios/batch/slurm.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/baseline.h"
#include "scenarios/evidence/report.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;
using namespace scenarios;

/// Says when runs that the sweep in `folder` asked for are not there (a shard that failed or still works); true: all
/// are.
bool tell_missing(const std::string& folder, const std::vector<RunRecord>& runs) {
  const MissingRuns missing = missing_runs(folder, runs);
  if (missing.missing == 0) return true;
  std::fprintf(stderr,
               "rubble: %s: %zu of the %zu runs its sweep asked for are missing; give the batch command again to make "
               "them\n",
               folder.c_str(), missing.missing, missing.asked);
  return false;
}

void write_report(const std::string& source, const std::string& page) {
  const ResultSet set = load_sweep_results(source);
  if (set.runs.empty()) throw InputError(source + ": holds no finished run to report on");
  tell_missing(source, set.runs);
  write_text_file(page, report_html(set, note_of(set, source), fs::path(page).parent_path().string()));
  std::printf("%-12s %s\n", "report", page.c_str());
}

int submit(const BatchArguments& arguments, const Sweep& sweep, const std::vector<Job>& jobs_asked,
           const std::string& out) {
  if (arguments.shard.count > 1 || !arguments.save_baseline.empty())
    throw UsageError("--slurm makes all shards itself and no baseline; leave out --shard and --save-baseline");
  SlurmPlan plan;
  plan.name = sweep.name;
  plan.sweep = fs::absolute(sweep.path).lexically_normal().string();
  plan.out = fs::absolute(out).lexically_normal().string();
  plan.program = fs::read_symlink("/proc/self/exe").string();
  if (std::getenv("RUBBLE_HOME")) plan.home = fs::absolute(std::getenv("RUBBLE_HOME")).string();
  plan.shards = arguments.shards;
  plan.workers = arguments.workers > 0 ? arguments.workers : 1;
  plan.record = arguments.record;
  plan.retry = arguments.retry;
  plan.overrides = with_mapper(arguments.mapper, arguments.overrides);
  plan.allow_commands = arguments.mapper.allow_commands || !arguments.mapper.command.empty();
  plan.options = arguments.slurm_options;
  const SlurmScripts paths = write_slurm(plan);
  save_note(sweep, jobs_asked, plan.out);
  std::printf("%-12s %s\n%-12s %s\n", "array job", paths.array.c_str(), "merge job", paths.merge.c_str());
  if (!arguments.submit) return kOk;
  const SlurmJobs jobs = submit_slurm(paths);
  std::printf("%-12s %s (%d shards), then %s merges to %s/results.sqlite\n", "submitted", jobs.array.c_str(),
              plan.shards, jobs.merge.c_str(), plan.out.c_str());
  return kOk;
}

void print_summary(const BatchReport& report, const BatchOptions& options) {
  const BatchProgress& p = report.progress;
  const std::string suffix = shard_suffix(options.shard);
  std::printf("%-12s %zu of %zu (%zu made now in %.1f s, %zu found finished)\n", "runs", p.finished(), p.total, p.done,
              p.elapsed_s, p.skipped);
  if (p.failed)
    std::printf("%-12s %zu; see \"error\" in the results, and workers%s.log\n", "FAILED", p.failed, suffix.c_str());
  std::printf("%-12s %s/results%s.jsonl\n", "results", options.out.c_str(), suffix.c_str());
  if (report.interrupted) std::printf("%-12s give the same command again to go on\n", "interrupted");
}

}  // namespace

int batch(const BatchArguments& arguments) {
  const Sweep sweep = load_sweep(find_sweep(arguments.sweep), shipped_folder());
  BatchOptions options;
  options.code = code_version();
  const auto overrides = with_mapper(arguments.mapper, arguments.overrides);
  std::vector<Job> jobs = expand(sweep, options.code, overrides);
  for (Job& job : jobs) permit_command(arguments.mapper, overrides, job.scenario);
  options.out = arguments.out.empty() ? "runs/" + sweep.name : arguments.out;
  if (arguments.slurm) return submit(arguments, sweep, jobs, options.out);
  const bool whole = arguments.shard.count == 1;
  if (!whole && !arguments.save_baseline.empty())
    throw UsageError("--save-baseline needs every run of the sweep; leave out --shard");
  options.workers = arguments.workers > 0 ? arguments.workers : usable_cores();
  options.shard = arguments.shard;
  options.retry = arguments.retry;
  options.run_limit = sweep.run_limit;
  const BatchReport report = run_with_progress(jobs, options, arguments.record);
  print_summary(report, options);
  if (report.interrupted) return kInterrupted;
  save_note(sweep, jobs, options.out);
  if (whole) write_report(options.out, options.out + "/report.html");
  if (!arguments.save_baseline.empty()) {
    save_baseline(make_baseline(sweep.name, results_of(jobs, options.out).runs), arguments.save_baseline);
    std::printf("%-12s %s\n", "baseline", arguments.save_baseline.c_str());
  }
  return report.progress.failed ? kFailed : kOk;
}

int batch_merge(const MergeArguments& arguments) {
  const MergeReport report = merge(arguments.sources, arguments.out);
  std::printf("%zu runs in %s, %zu of them new\n", report.runs, arguments.out.c_str(), report.added);
  bool whole = true;
  const std::vector<RunRecord> merged = load_results(arguments.out).runs;
  for (const auto& source : arguments.sources) whole = tell_missing(source, merged) && whole;
  return whole ? kOk : kFailed;
}

int batch_report(const ReportArguments& arguments) {
  if (arguments.markdown) {
    std::string text;
    for (const auto& source : arguments.sources) {
      const ResultSet set = load_sweep_results(source);
      text += report_markdown(set, note_of(set, source));
    }
    if (arguments.out.empty()) {
      std::printf("%s", text.c_str());
    } else {
      write_text_file(arguments.out, text);
    }
    return kOk;
  }
  if (arguments.sources.size() != 1) throw UsageError("batch report: a page is about one sweep; give one folder");
  const std::string& source = arguments.sources.front();
  const std::string beside = fs::is_directory(source) ? source + "/report.html" : "report.html";
  write_report(source, arguments.out.empty() ? beside : arguments.out);
  return kOk;
}

}  // namespace rubble::app
