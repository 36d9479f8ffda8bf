#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "scenarios/batch/sweep.h"
#include "scenarios/evidence/compare.h"

namespace CLI {
class App;
}

namespace rubble::app {

struct BatchArguments {
  std::string sweep;
  std::string out;
  int workers = 0;  ///< 0: as many as this process may use
  scenarios::Shard shard;
  bool retry = false;
  bool record = false;
  std::string save_baseline;
  std::vector<scenarios::Override> overrides;
  MapperChoice mapper;
  bool slurm = false;
  bool submit = true;
  int shards = 8;
  std::vector<std::string> slurm_options;
};

struct MergeArguments {
  std::vector<std::string> sources;
  std::string out;
};

struct ReportArguments {
  std::vector<std::string> sources;
  std::string out;
  bool markdown = false;
};

struct CompareArguments {
  std::string a;
  std::string b;  ///< empty: A again, with another configuration
  scenarios::CompareOptions options;
  std::string csv, json, html;
};

struct CheckArguments {
  std::string sweep = "regression";
  std::string baseline;  ///< empty: beside the sweep file
  std::string out;
  std::string junit;
  int workers = 0;
  std::vector<scenarios::Override> overrides;
  MapperChoice mapper;
};

int batch(const BatchArguments& arguments);
int batch_merge(const MergeArguments& arguments);
int batch_report(const ReportArguments& arguments);
int compare(const CompareArguments& arguments);
int check(const CheckArguments& arguments);

/// The subcommands about many runs: batch, compare, check. Kept apart from main.cpp's.
class BatchCommands {
 public:
  explicit BatchCommands(CLI::App& app);
  ~BatchCommands();
  /// The exit code when one of them was chosen.
  std::optional<int> run();

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace rubble::app
