#include <memory>

#include "app/batch/batch_tools.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "scenarios/batch/merge.h"

namespace rubble::app {
namespace {

struct BatchMergeArguments {
  std::vector<std::string> sources;
  std::string out;
};

int batch_merge(const BatchMergeArguments& arguments) {
  const scenarios::MergeReport report = scenarios::merge(arguments.sources, arguments.out);
  print_line(std::to_string(report.runs) + " runs in " + arguments.out + ", " + std::to_string(report.added) +
             " of them new");
  bool whole = true;
  const std::vector<scenarios::RunRecord> merged = scenarios::load_results(arguments.out).runs;
  for (const auto& source : arguments.sources) whole = tell_missing(source, merged) && whole;
  return whole ? kOk : kFailed;
}

}  // namespace

Command batch_merge_command() {
  return {"batch merge", "Merge the results of batches into one SQLite file",
          "Example:\n  rubble batch merge part1 part2 --out results.sqlite", [](Options& o) -> Action {
            auto a = std::make_shared<BatchMergeArguments>();
            o.arguments("results", a->sources, "Folders of batches");
            o.required_text("--out", a->out, "The SQLite file; what it holds already stays");
            return [a] { return batch_merge(*a); };
          }};
}

}  // namespace rubble::app
