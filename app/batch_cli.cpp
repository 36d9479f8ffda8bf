#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/batch.h"
#include "base/error.h"

namespace rubble::app {

struct BatchCommands::Parsed {
  CLI::App* batch = nullptr;
  CLI::App* merge = nullptr;
  BatchArguments batch_arguments;
  MergeArguments merge_arguments;
  std::vector<std::string> sets;
  std::string shard;
};

namespace {

void add_sets(CLI::App& command, std::vector<std::string>& sets) {
  command.add_option("--set", sets, "Override one value in every run: --set key.key=value (repeatable)")
      ->allow_extra_args(false)
      ->take_all();
}

std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets) {
  std::vector<scenarios::Override> overrides;
  for (const auto& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + set + ": needs the form key.key=value, for example --set robot.levelling=false");
    overrides.emplace_back(set.substr(0, equals), set.substr(equals + 1));
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

BatchCommands::BatchCommands(CLI::App& app) : parsed_(std::make_unique<Parsed>()) {
  Parsed& p = *parsed_;
  p.batch = app.add_subcommand("batch", "Make many runs: scenarios x configurations x seeds, on all cores");
  p.batch->add_option("sweep", p.batch_arguments.sweep, "Sweep file, or the name of a shipped one");
  p.batch->add_option("--workers", p.batch_arguments.workers, "Processes (default: one a core)")
      ->check(CLI::Range(1, 4096));
  p.batch->add_option("--out", p.batch_arguments.out, "Folder for the results (default: runs/NAME of the sweep)");
  p.batch->add_option("--shard", p.shard, "Make only part i of N: --shard i/N");
  p.batch->add_flag("--retry", p.batch_arguments.retry, "Make failed and timed-out runs again");
  p.batch->add_flag("--record", p.batch_arguments.record, "Keep the log of each run");
  add_sets(*p.batch, p.sets);
  p.batch->footer(
      "Interrupted or killed, the same command goes on where it was.\n"
      "Examples:\n  rubble batch levelling --workers 4\n  rubble batch my.yaml --out results --shard 2/8\n"
      "  rubble batch merge results --out results.sqlite");
  p.merge = p.batch->add_subcommand("merge", "Merge the results of batches into one SQLite file");
  p.merge->add_option("results", p.merge_arguments.sources, "Folders of batches")->required();
  p.merge->add_option("--out", p.merge_arguments.out, "The SQLite file; what it holds already stays")->required();
  p.merge->footer("Example:\n  rubble batch merge part1 part2 --out results.sqlite");
}

BatchCommands::~BatchCommands() = default;

std::optional<int> BatchCommands::run() {
  Parsed& p = *parsed_;
  if (*p.merge) return batch_merge(p.merge_arguments);
  if (*p.batch) {
    if (p.batch_arguments.sweep.empty()) throw UsageError("batch needs a sweep file; see 'rubble batch --help'");
    p.batch_arguments.shard = parse_shard(p.shard);
    p.batch_arguments.overrides = parse_sets(p.sets);
    return batch(p.batch_arguments);
  }
  return std::nullopt;
}

}  // namespace rubble::app
