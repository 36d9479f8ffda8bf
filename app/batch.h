#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "scenarios/sweep.h"

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
  std::vector<scenarios::Override> overrides;
};

struct MergeArguments {
  std::vector<std::string> sources;
  std::string out;
};

int batch(const BatchArguments& arguments);
int batch_merge(const MergeArguments& arguments);

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
