#include "scenarios/run/replay.h"

#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/mapper_choice.h"
#include "app/terminal.h"
#include "scenarios/hardware/raw_replay.h"

namespace rubble::app {
namespace {

struct ReplayArguments {
  std::string run;
  std::string out;
  bool raw = false;
  int film = 0;
  MapperChoice mapper;
};

/// The drivers again on the bytes of the devices.
int replay_bytes(const std::string& run) {
  const scenarios::RawReplay replay = scenarios::replay_raw(run);
  for (const auto& kind : replay.kinds)
    std::printf("%-18s %zu of %zu the same (%zu in the bytes)\n", kind.name.c_str(), kind.same, kind.recorded,
                kind.replayed);
  std::printf(
      "%-18s %zu scans, %zu packets of the base, %zu lines of the levelling unit; the odometry jumped %zu times\n",
      "damaged", replay.damaged_scans, replay.bad_sums, replay.bad_lines, replay.jumps);
  std::printf("%s\n", replay.identical ? "the drivers say the same again" : "NOT the same");
  return replay.identical ? kOk : kBroken;
}

int replay(const ReplayArguments& arguments) {
  if (arguments.raw) return replay_bytes(arguments.run);
  const auto options = terminal_options(arguments.out, false);
  const auto overrides = with_mapper(arguments.mapper, {});
  scenarios::Scenario scenario = scenarios::recorded_scenario(arguments.run, overrides);
  permit_command(arguments.mapper, overrides, scenario);
  const scenarios::ReplayReport report = scenarios::replay_run(arguments.run, scenario, options, arguments.film);
  end_progress();
  if (interrupted()) {
    tell("interrupted, so nothing is compared" +
         (arguments.out.empty() ? "" : "; " + arguments.out + " holds the run up to then"));
    return kInterrupted;
  }
  for (const auto& artefact : report.artefacts)
    std::printf("%-18s %s\n", artefact.name.c_str(), artefact.same ? "identical" : "DIFFERENT");
  if (!report.ended) std::printf("%-18s %s\n", "map", "not compared: the recorded run did not end");
  std::printf("%-18s %zu of %zu ticks different\n", "commands", report.different_commands, report.ticks);
  std::printf("%s\n", report.identical ? "bit-identical" : "NOT bit-identical");
  return report.identical ? kOk : kBroken;
}

}  // namespace

Command replay_command() {
  return {"replay", "Run the mapper again on a recorded run and compare bit by bit",
          "Examples:\n  rubble replay runs/latest\n  rubble replay runs/latest --out again --film 9",
          [](Options& o) -> Action {
            auto a = std::make_shared<ReplayArguments>();
            o.argument("run", a->run, "Run folder");
            o.text("--out", a->out, "Keep the re-made artefacts in this folder");
            o.flag("--raw", a->raw, "Run the drivers again on the raw bytes of a real drive instead");
            o.excludes("--raw", "--out");
            o.whole("--film", a->film, 1, 100, "Draw so many moments of the run side by side into film.png of --out");
            o.needs("--film", "--out");
            add_mapper(o, a->mapper);
            return [a] { return replay(*a); };
          }};
}

}  // namespace rubble::app
