#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/utf8.h"
#include "base/text/words.h"
#include "scenarios/benchmark/benchmark_output.h"

namespace rubble::app {
namespace {

using namespace scenarios;

struct BenchmarkArguments {
  std::string list;
  std::vector<std::string> data;
  std::vector<std::string> only;
  std::string html;
  std::string markdown;
  bool json = false;
  MapperChoice mapper;
};

/// Keeps the mappers asked for by name.
void keep_only(BenchmarkList& list, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::vector<BenchmarkMapper> kept;
  for (const std::string& name : names) {
    bool known = false;
    for (const BenchmarkMapper& mapper : list.mappers) {
      if (mapper.name != name) continue;
      kept.push_back(mapper);
      known = true;
    }
    if (known) continue;
    std::vector<std::string> names_there;
    for (const BenchmarkMapper& mapper : list.mappers) names_there.push_back(mapper.name);
    throw UsageError("--mapper " + name + ": " + list.path + " has no mapper of that name" +
                     did_you_mean(name, names_there) + "; it has " + joined(names_there));
  }
  list.mappers = kept;
}

std::string progress_text(const BenchmarkProgress& p) {
  std::string text =
      "case " + std::to_string(p.number) + " of " + std::to_string(p.cases) + ": " + p.name + ", " + p.mapper;
  if (p.seeds > 1 && p.seed > 0) text += ", seed " + std::to_string(p.seed) + " of " + std::to_string(p.seeds);
  return text;
}

/// On a terminal, where each line takes the place of the one before.
void show_progress(const BenchmarkProgress& p) {
  const std::string share = p.share ? "  " + std::to_string(static_cast<int>(std::round(100.0 * *p.share))) + " %" : "";
  std::fprintf(stderr, "\r\033[K%s", one_line(progress_text(p) + share).c_str());
  std::fflush(stderr);
}

/// Elsewhere lines stay: one for each mapper that is through with a case.
void tell_finished(const BenchmarkProgress& p) {
  if (p.finished == nullptr) return;
  const BenchmarkResult& result = *p.finished;
  std::string end = "done";
  if (result.error_m) end = number_text(std::round(1e4 * *result.error_m) / 1e4) + " m off";
  if (!result.failure.empty()) end = (result.stopped ? "" : "failed: ") + result.failure;
  if (!result.missing.empty()) end = "not there: " + result.missing;
  tell(progress_text(p) + ": " + end);
}

int benchmark(const BenchmarkArguments& arguments) {
  BenchmarkList list = load_benchmark(find_list(arguments.list));
  keep_only(list, arguments.only);
  if (!arguments.mapper.command.empty()) list.mappers.push_back({"process", with_mapper(arguments.mapper, {})});
  BenchmarkOptions options;
  for (const std::string& folder : arguments.data) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
      throw InputError("--data " + folder + ": there is no such folder; name the one that the logs of the list lie in");
  }
  options.folders = arguments.data;
  if (const char* data = std::getenv("RUBBLE_DATA")) options.folders.push_back(std::string(data) + "/logs");
  catch_interrupts();
  options.interrupted = interrupted;
  options.progress = isatty(STDERR_FILENO) ? show_progress : tell_finished;
  options.permit = [&](Scenario& scenario) {
    permit_command(arguments.mapper, with_mapper(arguments.mapper, {}), scenario, arguments.json ? stderr : stdout);
  };
  const Benchmark result = run_benchmark(list, options);
  end_progress();
  if (!arguments.html.empty()) write_text_file(arguments.html, to_html(result));
  if (!arguments.markdown.empty()) write_text_file(arguments.markdown, to_markdown(result));
  std::fputs(printable(arguments.json ? to_json(result) : to_text(result)).c_str(), stdout);
  if (!result.gaps.empty()) return kInterrupted;
  bool any = false, failed = false;
  std::vector<std::string> not_judged, doubts;
  int gone = 0;
  for (const BenchmarkRow& row : result.rows) {
    gone += !row.results.empty() && !row.results.front().missing.empty() ? 1 : 0;
    for (const BenchmarkResult& r : row.results) {
      if (!r.not_judged.empty() && (not_judged.empty() || not_judged.back() != row.what.name))
        not_judged.push_back(row.what.name);
      if (!r.doubt.empty() && std::find(doubts.begin(), doubts.end(), r.doubt) == doubts.end())
        doubts.push_back(r.doubt);
      any = any || r.missing.empty();
      failed = failed || (!r.failure.empty() && !r.stopped);
    }
  }
  if (!any)
    throw InputError(list.path +
                     ": none of its logs and scenarios is there; lay them beside the list, or give their "
                     "folder with --data (the list's first lines may say where they come from)");
  if (gone > 0)
    tell(std::to_string(gone) + " of " + std::to_string(result.rows.size()) +
         " cases were left out, as what they name is not there; give the folder of the logs with --data "
         "(the list's first lines may say where they come from)");
  for (const std::string& doubt : doubts) tell(doubt);
  if (!not_judged.empty())
    tell("no reference to judge by: " + joined(not_judged) +
         "; give the case a trajectory, 'reference: FILE.tum', or lay NAME.tum beside the log NAME");
  return failed ? kFailed : kOk;
}

}  // namespace

Command benchmark_command() {
  return {"benchmark", "Run mappers over logs and arenas and lay them beside published figures",
          "Logs that are not there are told and left out. RUBBLE_DATA/logs is searched too, where that is set.\n"
          "Examples:\n  rubble benchmark --data ~/logs --html benchmark.html\n"
          "  rubble benchmark my.yaml --mapper robust --json\n"
          "  rubble benchmark my.yaml --mapper-command './my_mapper --fast'",
          [](Options& o) -> Action {
            auto a = std::make_shared<BenchmarkArguments>();
            o.argument("list", a->list, "List of mappers, logs and arenas (default: the one that ships with rubble)",
                       Options::Need::Optional);
            o.texts("--data", a->data, "A folder with logs of the list");
            o.texts("--mapper", a->only, "Only this mapper of the list; may be given again");
            o.flag("--json", a->json, "Print JSON");
            o.text("--html", a->html, "Write a page");
            o.text("--markdown", a->markdown, "Write a table for documents");
            add_mapper(o, a->mapper);
            return [a] { return benchmark(*a); };
          }};
}

}  // namespace rubble::app
