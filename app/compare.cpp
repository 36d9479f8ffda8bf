#include <cstdio>

#include "app/batch.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/compare_output.h"

namespace rubble::app {

int compare(const CompareArguments& arguments) {
  using namespace scenarios;
  const CompareOptions& options = arguments.options;
  if (arguments.b.empty() && (options.configuration_a.empty() || options.configuration_b.empty()))
    throw UsageError("compare: give two folders, or one with --config-a and --config-b");
  const std::string& b = arguments.b.empty() ? arguments.a : arguments.b;
  const Comparison comparison =
      scenarios::compare(load_sweep_results(arguments.a), load_sweep_results(b), arguments.a, b, options);
  std::printf("%s", to_text(comparison).c_str());
  if (!arguments.csv.empty()) write_text_file(arguments.csv, to_csv(comparison));
  if (!arguments.json.empty()) write_text_file(arguments.json, to_json(comparison));
  if (!arguments.html.empty()) write_text_file(arguments.html, to_html(comparison));
  return kOk;
}

}  // namespace rubble::app
