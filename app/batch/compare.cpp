#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "base/text/utf8.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/compare_output.h"

namespace rubble::app {
namespace {

struct CompareArguments {
  std::string a;
  std::string b;  ///< empty: A again, with another configuration
  scenarios::CompareOptions options;
  std::string csv, json, html;
};

int compare(const CompareArguments& arguments) {
  using namespace scenarios;
  const CompareOptions& options = arguments.options;
  if (arguments.b.empty() && (options.configuration_a.empty() || options.configuration_b.empty()))
    throw UsageError("compare: give two folders, or one with --config-a and --config-b");
  const std::string& b = arguments.b.empty() ? arguments.a : arguments.b;
  // One that is missing is told where it is read; of two the second would be found only after the first was mended.
  std::error_code error;
  if (b != arguments.a && !std::filesystem::exists(arguments.a, error) && !std::filesystem::exists(b, error))
    throw InputError(arguments.a + ", " + b +
                     ": do not exist; give the folders of a 'rubble batch' or files of 'rubble batch merge'");
  const Comparison comparison =
      scenarios::compare(load_sweep_results(arguments.a), load_sweep_results(b), arguments.a, b, options);
  std::printf("%s", printable(to_text(comparison)).c_str());
  if (!arguments.csv.empty()) write_text_file(arguments.csv, to_csv(comparison));
  if (!arguments.json.empty()) write_text_file(arguments.json, to_json(comparison));
  if (!arguments.html.empty()) write_text_file(arguments.html, to_html(comparison));
  return kOk;
}

}  // namespace

Command compare_command() {
  return {"compare", "Does B map better than A? Paired runs, intervals, sign test",
          "Examples:\n  rubble compare runs/before runs/after\n"
          "  rubble compare runs/icp --config-a mapper.icp=false --config-b mapper.icp=true --html icp.html",
          [](Options& o) -> Action {
            auto a = std::make_shared<CompareArguments>();
            o.argument("a", a->a, "Results: folder of a batch, or file of 'batch merge'");
            o.argument("b", a->b, "Other results; leave out to compare two configurations of A",
                       Options::Need::Optional);
            o.text("--config-a", a->options.configuration_a, "Only this configuration of A");
            o.text("--config-b", a->options.configuration_b, "Only this configuration of B");
            o.flag("--by-config", a->options.by_configuration, "Also a table for each configuration");
            o.flag("--all", a->options.all_metrics, "Also numbers of which neither direction is better");
            o.seed("--seed", a->options.seed, "Seed of the bootstrap");
            o.text("--csv", a->csv, "Write a CSV file");
            o.text("--json", a->json, "Write a JSON file");
            o.text("--html", a->html, "Write a page");
            return [a] { return compare(*a); };
          }};
}

}  // namespace rubble::app
