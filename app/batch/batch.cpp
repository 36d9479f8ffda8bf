#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "app/batch/batch_tools.h"
#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/slurm.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/baseline.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;
using namespace scenarios;

struct BatchArguments {
  std::string sweep;
  std::string out;
  int workers = 0;    ///< 0: as many as this process may use
  std::string seeds;  ///< so many of the sweep, or others; empty: all
  std::string shard;
  bool retry = false;
  bool record = false;
  std::string save_baseline;
  std::vector<std::string> sets;
  MapperChoice mapper;
  bool slurm = false;
  bool no_submit = false;
  int shards = 8;
  std::vector<std::string> slurm_options;
};

Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  if (!text.empty() && (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2 ||
                        shard.count < 1 || shard.index < 1 || shard.index > shard.count))
    throw UsageError("--shard " + text + ": needs the form i/N with i from 1 to N, for example --shard 2/8");
  return shard;
}

void take_seeds(Sweep& sweep, const std::string& text) {
  if (text.empty()) return;
  try {
    choose_seeds(sweep, text);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--seeds " + text + ": " + error.what());
  }
}

int submit(const BatchArguments& arguments, const Sweep& sweep, const std::vector<Job>& jobs_asked,
           const std::string& out) {
  if (!arguments.shard.empty() || !arguments.save_baseline.empty() || !arguments.seeds.empty())
    throw UsageError(
        "--slurm makes all shards and seeds itself and no baseline; leave out --shard, --seeds and --save-baseline");
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
  plan.overrides = with_mapper(arguments.mapper, parse_sweep_sets(arguments.sets));
  plan.allow_commands = arguments.mapper.allow_commands || !arguments.mapper.command.empty();
  plan.options = arguments.slurm_options;
  const SlurmScripts paths = write_slurm(plan);
  save_note(sweep, jobs_asked, plan.out);
  print_row("array job", paths.array, kBatchLabels);
  print_row("merge job", paths.merge, kBatchLabels);
  if (arguments.no_submit) return kOk;
  const SlurmJobs jobs = submit_slurm(paths);
  print_row("submitted",
            jobs.array + " (" + std::to_string(plan.shards) + " shards), then " + jobs.merge + " merges to " +
                plan.out + "/results.sqlite",
            kBatchLabels);
  return kOk;
}

void print_summary(const BatchReport& report, const BatchOptions& options) {
  const BatchProgress& p = report.progress;
  const std::string suffix = shard_suffix(options.shard);
  std::printf("%-12s %zu of %zu (%zu made now in %.1f s, %zu found finished)\n", "runs", p.finished(), p.total, p.done,
              p.elapsed_s, p.skipped);
  if (p.failed)
    print_row("FAILED", std::to_string(p.failed) + "; see \"error\" in the results, and workers" + suffix + ".log",
              kBatchLabels);
  print_row("results", options.out + "/results" + suffix + ".jsonl", kBatchLabels);
  if (report.interrupted) print_row("interrupted", "give the same command again to go on", kBatchLabels);
}

int batch(const BatchArguments& arguments) {
  if (arguments.sweep.empty()) throw UsageError("batch needs a sweep file; see 'rubble batch --help'");
  BatchOptions options;
  options.shard = parse_shard(arguments.shard);
  const std::vector<Override> overrides = with_mapper(arguments.mapper, parse_sweep_sets(arguments.sets));
  Sweep sweep = load_sweep(find_sweep(arguments.sweep), shipped_folder());
  take_seeds(sweep, arguments.seeds);
  options.code = code_version();
  std::vector<Job> jobs = expand(sweep, options.code, overrides);
  for (const Job& job : jobs) permit_command(arguments.mapper, overrides, job.kind->scenario);
  options.out = arguments.out.empty() ? "runs/" + sweep.name : arguments.out;
  if (arguments.slurm) return submit(arguments, sweep, jobs, options.out);
  const bool whole = options.shard.count == 1;
  if (!whole && !arguments.save_baseline.empty())
    throw UsageError("--save-baseline needs every run of the sweep; leave out --shard");
  options.workers = arguments.workers > 0 ? arguments.workers : usable_cores();
  options.retry = arguments.retry;
  options.run_limit = sweep.run_limit;
  const BatchReport report = run_with_progress(jobs, options, arguments.record);
  print_summary(report, options);
  if (report.interrupted) return kInterrupted;
  save_note(sweep, jobs, options.out);
  if (whole) write_report(options.out, place_in(options.out, "report.html"));
  if (!arguments.save_baseline.empty()) {
    save_baseline(make_baseline(sweep.name, results_of(jobs, options.out).runs), arguments.save_baseline);
    print_row("baseline", arguments.save_baseline, kBatchLabels);
  }
  return report.progress.failed ? kFailed : kOk;
}

}  // namespace

Command batch_command() {
  return {"batch", "Make many runs: scenarios x configurations x seeds, on all cores",
          "Interrupted or killed, the same command goes on where it was.\n"
          "Examples:\n  rubble batch levelling --workers 4\n  rubble batch my.yaml --out results --shard 2/8\n"
          "  rubble batch my.yaml --out /shared/results --slurm --shards 40\n"
          "  rubble batch merge results --out results.sqlite",
          [](Options& o) -> Action {
            auto a = std::make_shared<BatchArguments>();
            o.argument("sweep", a->sweep, "Sweep file, or the name of a shipped one", Options::Need::Optional);
            add_workers(o, a->workers);
            o.text("--out", a->out, "Folder for the results (default: runs/NAME of the sweep)");
            o.text("--seeds", a->seeds,
                   "Only the first so many seeds of the sweep (6), or others instead (101-108; one: 101-101)");
            o.text("--shard", a->shard, "Make only part i of N: --shard i/N");
            o.flag("--retry", a->retry, "Make failed and timed-out runs again");
            o.flag("--record", a->record, "Keep the log of each run");
            o.text("--save-baseline", a->save_baseline, "Write medians and tolerances for 'rubble check'");
            add_mapper(o, a->mapper);
            add_sets(o, a->sets);
            o.flag("--slurm", a->slurm, "Submit to Slurm: an array job and a job that merges");
            o.whole("--shards", a->shards, 1, 100000, "Tasks of the array job (default: 8)");
            o.texts("--slurm-option", a->slurm_options, "One more option for sbatch: --slurm-option=--time=2:00:00");
            o.flag("--no-submit", a->no_submit, "Only write the scripts for Slurm");
            for (const char* option : {"--shards", "--slurm-option", "--no-submit"}) o.needs(option, "--slurm");
            return [a] { return batch(*a); };
          }};
}

}  // namespace rubble::app
