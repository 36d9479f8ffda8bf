#include <cstdio>

#include "app/hardware.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "scenarios/hardware/emulation.h"

namespace rubble::app {
namespace {

mrpt::math::TPose2D parse_pose(const std::string& text) {
  mrpt::math::TPose2D pose;
  double degrees = 0.0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &pose.x, &pose.y, &degrees, &rest) != 3)
    throw UsageError("--odometry-start " + text + ": needs the form X,Y,DEG, for example --odometry-start 65,0,90");
  pose.phi = deg_to_rad(degrees);
  return pose;
}

}  // namespace

int emulate(const EmulateArguments& arguments) {
  if (arguments.urg.empty() && arguments.base.empty() && arguments.levelling.empty())
    throw UsageError("emulate: no device is asked for; give --urg, --base or --levelling, see rubble emulate --help");
  auto overrides = arguments.overrides;
  if (arguments.seed) overrides.emplace_back("seed", std::to_string(*arguments.seed));
  const scenarios::Scenario scenario =
      scenarios::load_scenario(find_shipped(arguments.scenario, "scenarios", "yellow"), overrides);
  scenarios::EmulateOptions options;
  options.urg = arguments.urg;
  options.base = arguments.base;
  options.levelling = arguments.levelling;
  for (const std::string& fault : arguments.faults) options.faults.push_back(scenarios::parse_fault(fault));
  if (!arguments.odometry_start.empty()) options.odometry_start = parse_pose(arguments.odometry_start);
  options.time_limit = arguments.time_limit;
  options.truth = arguments.truth;
  options.ready = [](const std::vector<std::string>& ports) {
    for (const std::string& port : ports) std::printf("%s\n", port.c_str());
    std::printf("ready\n");
    std::fflush(stdout);
  };
  options.tell = [](const std::string& fault) {
    std::printf("fault %s\n", fault.c_str());
    std::fflush(stdout);
  };
  catch_interrupts();
  options.interrupted = interrupted;
  const scenarios::EmulationReport report = scenarios::emulate(scenario, options);
  std::printf("%.1f s, %llu scans; ticks began late by at most %.2f ms (95 %%), %.2f ms (worst)\n", report.seconds,
              static_cast<unsigned long long>(report.scans), 1e3 * report.late_95, 1e3 * report.late_worst);
  return kOk;
}

}  // namespace rubble::app
