#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "scenarios/hardware/emulation.h"

namespace rubble::app {
namespace {

struct EmulateArguments {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string urg, base, levelling;
  std::vector<std::string> faults;  ///< NAME@SECONDS
  std::string odometry_start;       ///< X,Y,DEG
  double urg_yaw_deg = 0.0;
  bool urg_upside_down = false;
  bool as_hardware = false;
  double time_limit = 0.0;
  std::string truth;
  std::vector<std::string> sets;
};

mrpt::math::TPose2D parse_pose(const std::string& text) {
  mrpt::math::TPose2D pose;
  double degrees = 0.0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &pose.x, &pose.y, &degrees, &rest) != 3)
    throw UsageError("--odometry-start " + text + ": needs the form X,Y,DEG, for example --odometry-start 65,0,90");
  constexpr double kFarthest = 1000.0, kMostDegrees = 3600.0;
  if (!(std::abs(pose.x) <= kFarthest && std::abs(pose.y) <= kFarthest && std::abs(degrees) <= kMostDegrees))
    throw UsageError("--odometry-start " + text + ": X and Y are at most 1000 m, DEG at most 3600, either way");
  pose.phi = deg_to_rad(degrees);
  return pose;
}

int emulate(const EmulateArguments& arguments) {
  if (arguments.urg.empty() && arguments.base.empty() && arguments.levelling.empty())
    throw UsageError("emulate: no device is asked for; give --urg, --base or --levelling, see rubble emulate --help");
  auto overrides = parse_sets(arguments.sets);
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  const scenarios::Scenario scenario = scenarios::load_scenario(find_scenario(arguments.scenario), overrides);
  scenarios::EmulateOptions options;
  options.urg = arguments.urg;
  options.base = arguments.base;
  options.levelling = arguments.levelling;
  for (const std::string& text : arguments.faults) {
    const scenarios::FaultAt fault = scenarios::parse_fault(text);
    if (options.port(fault.device).empty())
      throw UsageError("--fault " + text + ": that device is not played; give --" + name_of(fault.device) + " too");
    options.faults.push_back(fault);
  }
  if (!arguments.odometry_start.empty()) options.odometry_start = parse_pose(arguments.odometry_start);
  if ((arguments.urg_yaw_deg != 0.0 || arguments.urg_upside_down) && options.urg.empty())
    throw UsageError("--urg-yaw, --urg-upside-down: the scanner is not played; give --urg too");
  options.urg_yaw = deg_to_rad(arguments.urg_yaw_deg);
  options.urg_upside_down = arguments.urg_upside_down;
  if (arguments.as_hardware && options.base.empty())
    throw UsageError("--as-hardware: the base is not played; give --base too");
  options.as_hardware = arguments.as_hardware;
  options.time_limit = arguments.time_limit;
  options.truth = arguments.truth;
  options.ready = [](const std::vector<std::string>& ports) {
    for (const std::string& port : ports) print_line(port);
    print_line("ready");
    std::fflush(stdout);
  };
  options.tell = [](const std::string& fault) {
    print_line("fault " + fault);
    std::fflush(stdout);
  };
  options.warn = tell;
  catch_interrupts();
  options.interrupted = interrupted;
  const scenarios::EmulationReport report = scenarios::emulate(scenario, options);
  std::printf("%.1f s, %llu scans; ticks began late by at most %.2f ms (95 %%), %.2f ms (worst)\n", report.seconds,
              static_cast<unsigned long long>(report.scans), 1e3 * report.late_95, 1e3 * report.late_worst);
  return kOk;
}

}  // namespace

Command emulate_command() {
  return {"emulate", "Play the devices of a simulated robot in real time",
          "Example:\n  rubble emulate yellow --urg tcp:127.0.0.1:10940 --base tcp:127.0.0.1:8101 "
          "--levelling tcp:127.0.0.1:8102",
          [](Options& o) -> Action {
            auto a = std::make_shared<EmulateArguments>();
            o.argument("scenario", a->scenario, "Scenario file, or the name of a shipped one (default: yellow)",
                       Options::Need::Optional);
            o.seed("--seed", a->seed, "Seed of every random choice");
            o.text("--urg", a->urg, "Offer the laser scanner there: tcp:HOST:PORT or pty:PATH");
            o.text("--base", a->base, "Offer the base there");
            o.text("--levelling", a->levelling, "Offer the levelling unit there");
            o.texts("--fault", a->faults, "NAME@SECONDS: let something go wrong (repeatable); docs/hardware.md");
            o.text("--odometry-start", a->odometry_start, "X,Y,DEG: where the base's dead reckoning begins [m, deg]");
            o.number("--urg-yaw", a->urg_yaw_deg, -180.0, 180.0,
                     "The scanner is mounted so, counter-clockwise seen from above [deg]");
            o.flag("--urg-upside-down", a->urg_upside_down, "The scanner hangs upside down from its mount");
            o.flag("--as-hardware", a->as_hardware, "The base does not say that it is a simulator, nor obey as one");
            o.number("--time-limit", a->time_limit, 0.0, 1e6, "Ends after so long (default: Ctrl-C ends it) [s]");
            o.text("--truth", a->truth, "Write the true trajectory to this .tum file");
            add_sets(o, a->sets);
            return [a] { return emulate(*a); };
          }};
}

}  // namespace rubble::app
