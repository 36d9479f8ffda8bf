#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/batch/batch_tools.h"
#include "app/commands.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "base/text/utf8.h"
#include "scenarios/batch/sweep_note.h"
#include "scenarios/evidence/report.h"

namespace rubble::app {
namespace {

struct ReportArguments {
  std::vector<std::string> sources;
  std::string out;
  bool markdown = false;
};

int batch_report(const ReportArguments& arguments) {
  using namespace scenarios;
  if (arguments.markdown) {
    std::string text;
    for (const auto& source : arguments.sources) {
      const ResultSet set = load_sweep_results(source);
      text += report_markdown(set, note_of(set, source));
    }
    if (arguments.out.empty()) {
      std::printf("%s", printable(text).c_str());
    } else {
      write_text_file(arguments.out, text);
    }
    return kOk;
  }
  if (arguments.sources.size() != 1) throw UsageError("batch report: a page is about one sweep; give one folder");
  const std::string& source = arguments.sources.front();
  const std::string beside = std::filesystem::is_directory(source) ? place_in(source, "report.html") : "report.html";
  write_report(source, arguments.out.empty() ? beside : arguments.out);
  return kOk;
}

}  // namespace

Command batch_report_command() {
  return {"batch report", "Write the page of a sweep: table, plots, best and worst maps",
          "Examples:\n  rubble batch report runs/levelling\n"
          "  rubble batch report --markdown runs/levelling runs/slip --out results.md",
          [](Options& o) -> Action {
            auto a = std::make_shared<ReportArguments>();
            o.arguments("results", a->sources, "Folder of a batch, or file of 'batch merge'");
            o.text("--out", a->out, "The page (default: report.html in the folder)");
            o.flag("--markdown", a->markdown, "A section of a document a folder instead of a page");
            return [a] { return batch_report(*a); };
          }};
}

}  // namespace rubble::app
