#include "app/robots/robot_options.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/yaml/binder.h"
#include "robot/drivers/base_driver.h"
#include "robot/drivers/port.h"

namespace rubble::app {
namespace {

constexpr const char* kPort = "/dev/ttyUSB0, pty:PATH or tcp:HOST:PORT";

volatile std::sig_atomic_t emergency_signalled = 0;

volatile std::sig_atomic_t rearm_signalled = 0;

void on_emergency(int /*signal*/) { emergency_signalled = 1; }
void on_rearm(int /*signal*/) { rearm_signalled = 1; }

void print_status(const scenarios::DriveStatus& s) {
  char base[40] = "   - ";  // there is none
  if (s.has_base)
    std::snprintf(base, sizeof base, "%4.1f V  motors %-3s", s.robot.battery, s.robot.motors_on ? "on" : "off");
  std::fprintf(stderr,
               "%6.0f s  %-10s  x %6.2f y %6.2f m %4.0f deg  %5.1f m2  %s  scans %4.1f odometry %4.1f "
               "levelling %4.1f /s\n",
               s.seconds, s.state.c_str(), s.T_map_base.x, s.T_map_base.y, rad_to_deg(s.T_map_base.phi), s.known_m2,
               base, s.scans_per_s, s.odometry_per_s, s.accelerations_per_s);
}

/// The port that an option gives; said by the option's own name what is wrong with it.
void set_port(std::vector<scenarios::Override>& overrides, const std::string& device, const std::string& word) {
  if (word.empty()) throw InputError("--" + device + ": needs a port, and the word is empty; give " + kPort);
  try {
    robot::check_port_word(word);
  } catch (const InputError& error) {
    throw InputError("--" + device + ": " + error.what());
  }
  overrides.emplace_back("devices." + device + ".port", yaml_quoted(word));
}

}  // namespace

void RobotOptions::declare(Options& o) {
  o.argument("robot", robot, "Robot file, or the name of a shipped one (default: pioneer_urg)",
             Options::Need::Optional);
  given = [&o](const std::string& option) { return o.given(option); };
  o.text("--urg", urg, std::string("Port of the laser scanner; ") + kPort);
  o.text("--base", base, std::string("Port of the base, or 'none' (--map-only); ") + kPort);
  o.text("--levelling", levelling, std::string("Port of the levelling unit, or 'none'; ") + kPort);
}

std::vector<scenarios::Override> RobotOptions::with_ports(std::vector<scenarios::Override> overrides) const {
  if (given("--urg")) set_port(overrides, "urg", urg);
  if (base == robot::kNoBase) {
    overrides.emplace_back("devices.base.driver", base);
  } else if (given("--base")) {
    set_port(overrides, "base", base);
  }
  if (levelling == scenarios::kNoLevelling) {
    overrides.emplace_back("devices.levelling.driver", levelling);
  } else if (given("--levelling")) {
    overrides.emplace_back("devices.levelling.driver",
                           scenarios::kLevellingUnit);  // also where the robot file has none
    set_port(overrides, "levelling", levelling);
  }
  return overrides;
}

scenarios::DriveOptions drive_options(Keyboard& keyboard, bool keys_stop) {
  catch_stops();
  std::signal(SIGUSR1, on_emergency);
  std::signal(SIGUSR2, on_rearm);
  scenarios::DriveOptions options;
  options.interrupted = [&keyboard] { return interrupted() || keyboard.quit(); };
  options.emergency = [&keyboard, keys_stop] { return emergency_signalled != 0 || (keys_stop && keyboard.pressed()); };
  options.insisted = insisted;
  options.left = [&keyboard] {
    keyboard.restore();
    std::fprintf(stderr,
                 "rubble: the base was told to stop and left, see that it stands; the folder is not complete\n");
    std::_Exit(kInterrupted);
  };
  options.rearm = [&keyboard] {
    const bool signalled = rearm_signalled != 0;
    rearm_signalled = 0;
    return keyboard.rearmed() || signalled;
  };
  options.forget_keys = [&keyboard] { keyboard.forget(); };
  options.each_second = print_status;
  options.incomplete = [](const std::string& folder) { print_row("folder", folder + " (not complete)"); };
  options.tell = tell;
  return options;
}

std::string missing_keys(const Keyboard& keyboard, const std::string& more) {
  if (keyboard.active()) return "";
  return "no terminal, so no key stops the robot; 'kill -USR1 " + std::to_string(::getpid()) + "' does" + more;
}

}  // namespace rubble::app
