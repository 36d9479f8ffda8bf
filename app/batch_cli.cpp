#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/batch.h"
#include "base/error.h"

namespace rubble::app {

struct BatchCommands::Parsed {
  CLI::App* batch = nullptr;
  CLI::App* merge = nullptr;
  CLI::App* report = nullptr;
  CLI::App* compare = nullptr;
  CLI::App* check = nullptr;
  BatchArguments batch_arguments;
  MergeArguments merge_arguments;
  ReportArguments report_arguments;
  CompareArguments compare_arguments;
  CheckArguments check_arguments;
  std::vector<std::string> sets;
  std::string shard;

  void add_batch(CLI::App& app);
  void add_merge_and_report();
  void add_compare(CLI::App& app);
  void add_check(CLI::App& app);
};

namespace {

void add_sets(CLI::App& command, std::vector<std::string>& sets) {
  command.add_option("--set", sets, "Override one value in every run: --set key.key=value (repeatable)")
      ->allow_extra_args(false)
      ->take_all();
}

void add_mapper(CLI::App& command, MapperChoice& choice) {
  command.add_option("--mapper-command", choice.command, "Map every run with this program (docs/mapper_protocol.md)");
  command.add_flag("--allow-commands", choice.allow_commands, "Let commands that stand in the files run");
}

void add_workers(CLI::App& command, int& workers) {
  command.add_option("--workers", workers, "Processes (default: one a core)")->check(CLI::Range(1, 4096));
}

std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets) {
  std::vector<scenarios::Override> overrides;
  for (const auto& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + set + ": needs the form key.key=value, for example --set robot.levelling=false");
    const std::string key = set.substr(0, equals);
    if (key == "seed" || key == "name")
      throw UsageError("--set " + set + ": cannot be the same in every run; seeds and names come from the sweep file");
    overrides.emplace_back(key, set.substr(equals + 1));
  }
  return overrides;
}

scenarios::Shard parse_shard(const std::string& text) {
  scenarios::Shard shard;
  char rest = 0;
  if (!text.empty() && (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2 ||
                        shard.count < 1 || shard.index < 1 || shard.index > shard.count))
    throw UsageError("--shard " + text + ": needs the form i/N with i from 1 to N, for example --shard 2/8");
  return shard;
}

}  // namespace

void BatchCommands::Parsed::add_batch(CLI::App& app) {
  BatchArguments& a = batch_arguments;
  batch = app.add_subcommand("batch", "Make many runs: scenarios x configurations x seeds, on all cores");
  batch->add_option("sweep", a.sweep, "Sweep file, or the name of a shipped one");
  add_workers(*batch, a.workers);
  batch->add_option("--out", a.out, "Folder for the results (default: runs/NAME of the sweep)");
  batch->add_option("--shard", shard, "Make only part i of N: --shard i/N");
  batch->add_flag("--retry", a.retry, "Make failed and timed-out runs again");
  batch->add_flag("--record", a.record, "Keep the log of each run");
  batch->add_option("--save-baseline", a.save_baseline, "Write medians and tolerances for 'rubble check'");
  add_sets(*batch, sets);
  add_mapper(*batch, a.mapper);
  CLI::Option* slurm = batch->add_flag("--slurm", a.slurm, "Submit to Slurm: an array job and a job that merges");
  batch->add_option("--shards", a.shards, "Tasks of the array job (default: 8)")
      ->check(CLI::Range(1, 100000))
      ->needs(slurm);
  batch->add_option("--slurm-option", a.slurm_options, "One more option for sbatch: --slurm-option=--time=2:00:00")
      ->allow_extra_args(false)
      ->take_all()
      ->needs(slurm);
  batch->add_flag("!--no-submit", a.submit, "Only write the scripts for Slurm")->needs(slurm);
  batch->footer(
      "Interrupted or killed, the same command goes on where it was.\n"
      "Examples:\n  rubble batch levelling --workers 4\n  rubble batch my.yaml --out results --shard 2/8\n"
      "  rubble batch my.yaml --out /shared/results --slurm --shards 40\n"
      "  rubble batch merge results --out results.sqlite");
}

void BatchCommands::Parsed::add_merge_and_report() {
  merge = batch->add_subcommand("merge", "Merge the results of batches into one SQLite file");
  merge->add_option("results", merge_arguments.sources, "Folders of batches")->required();
  merge->add_option("--out", merge_arguments.out, "The SQLite file; what it holds already stays")->required();
  merge->footer("Example:\n  rubble batch merge part1 part2 --out results.sqlite");
  report = batch->add_subcommand("report", "Write the page of a sweep: table, plots, best and worst maps");
  report->add_option("results", report_arguments.sources, "Folder of a batch, or file of 'batch merge'")->required();
  report->add_option("--out", report_arguments.out, "The page (default: report.html in the folder)");
  report->add_flag("--markdown", report_arguments.markdown, "A section of a document a folder instead of a page");
  report->footer(
      "Examples:\n  rubble batch report runs/levelling\n"
      "  rubble batch report --markdown runs/levelling runs/slip --out results.md");
}

void BatchCommands::Parsed::add_compare(CLI::App& app) {
  CompareArguments& a = compare_arguments;
  compare = app.add_subcommand("compare", "Does B map better than A? Paired runs, intervals, sign test");
  compare->add_option("a", a.a, "Results: folder of a batch, or file of 'batch merge'")->required();
  compare->add_option("b", a.b, "Other results; leave out to compare two configurations of A");
  compare->add_option("--config-a", a.options.configuration_a, "Only this configuration of A");
  compare->add_option("--config-b", a.options.configuration_b, "Only this configuration of B");
  compare->add_flag("--by-config", a.options.by_configuration, "Also a table for each configuration");
  compare->add_flag("--all", a.options.all_metrics, "Also numbers of which neither direction is better");
  compare->add_option("--seed", a.options.seed, "Seed of the bootstrap");
  compare->add_option("--csv", a.csv, "Write a CSV file");
  compare->add_option("--json", a.json, "Write a JSON file");
  compare->add_option("--html", a.html, "Write a page");
  compare->footer(
      "Examples:\n  rubble compare runs/before runs/after\n"
      "  rubble compare runs/icp --config-a mapper.icp=false --config-b mapper.icp=true --html icp.html");
}

void BatchCommands::Parsed::add_check(CLI::App& app) {
  CheckArguments& a = check_arguments;
  check = app.add_subcommand("check", "Run the regression suite; exit code 1 when mapping got worse");
  check->add_option("sweep", a.sweep, "Sweep file, or the name of a shipped one (default: regression)");
  check->add_option("--baseline", a.baseline, "Baseline file (default: NAME.baseline.json beside the sweep file)");
  check->add_option("--out", a.out, "Folder for the results (default: runs/check-NAME)");
  check->add_option("--junit", a.junit, "Write JUnit XML");
  add_workers(*check, a.workers);
  add_sets(*check, sets);
  add_mapper(*check, a.mapper);
  check->footer(
      "Prints GitHub annotations when GITHUB_ACTIONS is true, appends to GITHUB_STEP_SUMMARY when that is set.\n"
      "Examples:\n  rubble batch my.yaml --save-baseline my.baseline.json\n  rubble check my.yaml --junit check.xml");
}

BatchCommands::BatchCommands(CLI::App& app) : parsed_(std::make_unique<Parsed>()) {
  parsed_->add_batch(app);
  parsed_->add_merge_and_report();
  parsed_->add_compare(app);
  parsed_->add_check(app);
}

BatchCommands::~BatchCommands() = default;

std::optional<int> BatchCommands::run() {
  Parsed& p = *parsed_;
  if (*p.merge) return batch_merge(p.merge_arguments);
  if (*p.report) return batch_report(p.report_arguments);
  if (*p.compare) return compare(p.compare_arguments);
  if (*p.check) {
    p.check_arguments.overrides = parse_sets(p.sets);
    return check(p.check_arguments);
  }
  if (!*p.batch) return std::nullopt;
  if (p.batch_arguments.sweep.empty()) throw UsageError("batch needs a sweep file; see 'rubble batch --help'");
  p.batch_arguments.shard = parse_shard(p.shard);
  p.batch_arguments.overrides = parse_sets(p.sets);
  return batch(p.batch_arguments);
}

}  // namespace rubble::app
