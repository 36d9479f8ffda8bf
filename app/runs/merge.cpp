#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "scenarios/run/map_files.h"

namespace rubble::app {
namespace {

struct MergeArguments {
  std::string first;
  std::string second;
  std::string out;
  bool force = false;
  std::vector<std::string> sets;
};

/// A line on a terminal; elsewhere a line for each kind of work.
slam::MergeProgress merge_progress() {
  if (isatty(STDERR_FILENO)) return show_share;
  return [told = std::string()](const std::string& what, double) mutable {
    if (what == told) return;
    told = what;
    print_line(what);
    std::fflush(stdout);
  };
}

std::string start_text(const mrpt::math::TPose2D& T) {
  const auto rounded = [](double value, double steps) { return std::round(value * steps) / steps + 0.0; };  // no -0.00
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "%.2f, %.2f m, heading %.1f deg", rounded(T.x, 100.0), rounded(T.y, 100.0),
                rounded(rad_to_deg(T.phi), 10.0));
  return text.data();
}

std::string common_text(const scenarios::MergeReport& report) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%.1f m of the second one's %.1f m", report.common_m, report.second_m);
  return text.data();
}

int merge(const MergeArguments& arguments) {
  const scenarios::Scenario scenario = scenarios::default_scenario(parse_sets(arguments.sets));
  const scenarios::MergeReport report = scenarios::merge_maps(arguments.first, arguments.second, scenario,
                                                              arguments.out, arguments.force, merge_progress());
  end_progress();
  if (report.same)
    tell(arguments.second + ": is the same map as " + arguments.first + ", so nothing is added; were two runs meant?");
  print_row("start of the second in the first", start_text(report.T_first_start));
  print_row("way in common", common_text(report));
  print_row("stays with the runs", std::string("victims, logs and scores") +
                                       (report.has_way ? "" : ", and trajectories: both drives cover the same time"));
  print_row("folder", arguments.out);
  return kOk;
}

}  // namespace

Command merge_command() {
  return {"merge", "Make one map of the maps of two robots, or of two runs",
          "Example:\n  rubble merge runs/robbie runs/rosie --out runs/both", [](Options& o) -> Action {
            auto a = std::make_shared<MergeArguments>();
            o.argument("first", a->first, "A run folder with a map.rmap, or such a file; its frame is kept");
            o.argument("second", a->second, "Another");
            o.required_text("--out", a->out, "Folder for the map");
            o.flag("--force", a->force, "Replace an existing run folder");
            add_sets(o, a->sets);
            return [a] { return merge(*a); };
          }};
}

}  // namespace rubble::app
