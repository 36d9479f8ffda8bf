#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/batch/batch_tools.h"
#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "base/text/utf8.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/baseline.h"

namespace rubble::app {
namespace {

using namespace scenarios;

struct CheckArguments {
  std::string sweep = "regression";
  std::string baseline;  ///< empty: beside the sweep file
  std::string out;
  std::string junit;
  int workers = 0;  ///< 0: as many as this process may use
  std::vector<std::string> sets;
  MapperChoice mapper;
};

/// What GitHub Actions reads, where its variables exist.
void tell_github(const std::vector<CheckCase>& cases, const std::string& title) {
  const char* actions = std::getenv("GITHUB_ACTIONS");
  if (actions && std::string(actions) == "true") std::printf("%s", printable(to_github_annotations(cases)).c_str());
  if (const char* summary = std::getenv("GITHUB_STEP_SUMMARY")) {
    std::ofstream file(summary, std::ios::app);
    file << to_markdown(cases, title);
    file.flush();
    if (!file) tell(std::string(summary) + ": the job summary cannot be written");
  }
}

/// Records of runs still to be made: a baseline that does not fit is told before, not after them.
std::vector<RunRecord> planned(const std::vector<Job>& jobs) {
  std::vector<RunRecord> runs;
  for (const Job& job : jobs) {
    RunRecord run;
    run.scenario = job.kind->scenario.name;
    run.configuration = job.kind->configuration;
    run.seed = job.seed;
    runs.push_back(run);
  }
  return runs;
}

int check(const CheckArguments& arguments) {
  const Sweep sweep = load_sweep(find_sweep(arguments.sweep), shipped_folder());
  const std::string beside = std::filesystem::path(sweep.path).replace_extension(".baseline.json").string();
  const std::string baseline_path = arguments.baseline.empty() ? beside : arguments.baseline;
  if (!std::filesystem::exists(baseline_path))
    throw InputError(baseline_path + ": there is no baseline; make one with 'rubble batch " + arguments.sweep +
                     " --save-baseline " + baseline_path + "'");
  const Baseline baseline = load_baseline(baseline_path);
  BatchOptions options;
  options.code = code_version();
  const auto overrides = with_mapper(arguments.mapper, parse_sweep_sets(arguments.sets));
  std::vector<Job> jobs = expand(sweep, options.code, overrides);
  for (const Job& job : jobs) permit_command(arguments.mapper, overrides, job.kind->scenario);
  require_fit(baseline, planned(jobs));
  options.out = arguments.out.empty() ? "runs/check-" + sweep.name : arguments.out;
  options.workers = arguments.workers > 0 ? arguments.workers : usable_cores();
  options.run_limit = sweep.run_limit;
  options.retry = true;  // a run that was killed on a busy machine is no verdict
  const bool stopped = run_with_progress(jobs, options, false).interrupted;
  save_note(sweep, jobs, options.out);
  if (stopped) {
    print_row("interrupted", "give the same command again to go on", kBatchLabels);
    return kInterrupted;
  }
  ResultSet set = results_of(jobs, options.out);
  for (RunRecord& run : set.runs) {  // expectations on times are kept apart from what depends on the seed alone
    const auto timing = set.timing.find(run.run_id);
    if (timing == set.timing.end() || !timing->second->contains("broken")) continue;
    for (const auto& line : timing->second["broken"])
      if (line.is_string()) run.broken.push_back(line.get<std::string>());
  }
  const std::vector<CheckCase> cases = check_runs(baseline, set.runs);
  for (const auto& c : cases)
    if (!c.passed) print_row("REGRESSION", c.group + ": " + c.name + ": " + c.detail, kBatchLabels);
  print_row("checks",
            std::to_string(cases.size() - failures(cases)) + " of " + std::to_string(cases.size()) + " passed (" +
                std::to_string(jobs.size()) + " runs in " + options.out + ")",
            kBatchLabels);
  if (!arguments.junit.empty()) write_text_file(arguments.junit, to_junit(cases, "rubble." + sweep.name));
  tell_github(cases, "rubble check " + sweep.name);
  return failures(cases) == 0 ? kOk : kBroken;
}

}  // namespace

Command check_command() {
  return {"check", "Run the regression suite; exit code 1 when mapping got worse",
          "Prints GitHub annotations when GITHUB_ACTIONS is true, appends to GITHUB_STEP_SUMMARY when that is set.\n"
          "Examples:\n  rubble batch my.yaml --save-baseline my.baseline.json\n"
          "  rubble check my.yaml --junit check.xml",
          [](Options& o) -> Action {
            auto a = std::make_shared<CheckArguments>();
            o.argument("sweep", a->sweep, "Sweep file, or the name of a shipped one (default: regression)",
                       Options::Need::Optional);
            o.text("--baseline", a->baseline, "Baseline file (default: NAME.baseline.json beside the sweep file)");
            o.text("--out", a->out, "Folder for the results (default: runs/check-NAME)");
            o.text("--junit", a->junit, "Write JUnit XML");
            add_workers(o, a->workers);
            add_mapper(o, a->mapper);
            add_sets(o, a->sets);
            return [a] { return check(*a); };
          }};
}

}  // namespace rubble::app
