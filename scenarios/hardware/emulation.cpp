#include "scenarios/hardware/emulation.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <type_traits>

#include "arenas/files/arena_file.h"
#include "arenas/model/arena.h"
#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"
#include "base/trajectory.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/levelling_emulator.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "sim/sim_robot.h"

namespace rubble::scenarios {
namespace {

constexpr double kDamage = 1.0;     ///< spoilt bytes last so long [s]
constexpr double kSilence = 2.0;    ///< [s]
constexpr double kUnplugged = 3.0;  ///< [s]
constexpr double kSlow = 6.0;       ///< [s]

robot::ArcosEmulatorSettings base_settings(const robot::RobotModel& model, const EmulateOptions& options) {
  robot::ArcosEmulatorSettings settings;
  settings.odometry_start = options.odometry_start;
  settings.half_track = 0.5 * model.effective_track;
  robot::arcos::Configuration& c = settings.configuration;
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  c.max_speed = whole(1e3 * model.max_v);
  c.max_turn_rate = whole(rad_to_deg(model.max_w));
  c.accel = whole(1e3 * model.max_accel);
  c.turn_accel = whole(rad_to_deg(model.max_turn_accel));
  // Nothing that a client may set takes the simulated robot beyond what it can do.
  c.top_speed = c.max_speed;
  c.top_turn_rate = c.max_turn_rate;
  c.top_accel = c.accel;
  c.top_turn_accel = c.turn_accel;
  c.watchdog_ms = whole(1e3 * model.command_timeout);
  if (options.as_hardware) play_hardware(settings);
  return settings;
}

robot::UrgEmulatorConfig urg_config(const Scenario& scenario, const EmulateOptions& options) {
  robot::UrgEmulatorConfig config;
  config.port = options.urg;
  config.laser = scenario.robot.laser;
  config.seed = scenario.seed;
  for (const FaultAt& fault : options.faults)
    if (fault.fault == Fault(robot::DeviceFault::ClockWrap))
      config.clock_start = robot::clock_before_wrap(fault.seconds);
  return config;
}

/// Every fault there is, as --fault knows it.
const std::vector<FaultAt>& known_faults() {
  using robot::ByteFault;
  using robot::DeviceFault;
  static const std::vector<FaultAt> faults = [] {
    std::vector<FaultAt> all;
    const auto add = [&](EmulatedKind device, const char* name, Fault fault) {
      all.push_back({std::string(name_of(device)) + "-" + name, device, fault, 0.0});
    };
    for (const EmulatedKind device : {EmulatedKind::Scanner, EmulatedKind::Base, EmulatedKind::Levelling}) {
      add(device, "lost", ByteFault::Lost);
      add(device, "split", ByteFault::Split);
      add(device, "doubled", ByteFault::Doubled);
      add(device, "junk", ByteFault::Junk);
      add(device, "sums", ByteFault::WrongSum);
      add(device, "silence", PortFault::Silence);
      add(device, "unplug", PortFault::Unplug);
      add(device, "reset", DeviceFault::Reset);
    }
    add(EmulatedKind::Scanner, "wrap", DeviceFault::ClockWrap);
    add(EmulatedKind::Base, "seto", DeviceFault::SetOrigin);
    add(EmulatedKind::Base, "stall", DeviceFault::Stall);
    add(EmulatedKind::Base, "watchdog", DeviceFault::Watchdog);
    add(EmulatedKind::Base, "button", DeviceFault::Button);
    add(EmulatedKind::Base, "motors", DeviceFault::Motors);
    add(EmulatedKind::Base, "stuck", DeviceFault::Stuck);
    add(EmulatedKind::Base, "runaway", DeviceFault::Runaway);
    add(EmulatedKind::Base, "encoders", DeviceFault::Encoders);
    add(EmulatedKind::Base, "battery", DeviceFault::Battery);
    add(EmulatedKind::Base, "slow", PortFault::Slow);
    add(EmulatedKind::Levelling, "sensor", DeviceFault::Sensor);
    add(EmulatedKind::Levelling, "slow", PortFault::Slow);
    return all;
  }();
  return faults;
}

/// The simulated robot and its devices.
class Emulation {
 public:
  Emulation(const Scenario& scenario, const arenas::Arena& arena, const robot::RobotModel& model,
            const EmulateOptions& options)
      : options_(options), arena_(arena), simulated_(arena, model, scenario.sim, scenario.seed), tick_(model.tick) {
    if (!options.urg.empty()) urg_ = std::make_unique<robot::UrgEmulator>(urg_config(scenario, options));
    if (!options.base.empty()) {
      robot::ArcosEmulatorSettings settings = base_settings(model, options);
      settings.true_start = simulated_.truth().front().pose;
      arcos_ = std::make_unique<robot::ArcosEmulator>(settings);
      base_ = std::make_unique<robot::DeviceServer>(options.base, *arcos_, scenario.seed);
    }
    if (!options.levelling.empty()) {
      robot::LevellingEmulatorSettings settings;
      settings.most_rate = static_cast<int>(std::lround(1.0 / model.acceleration_period));
      settings.identity.rate = std::min(settings.identity.rate, settings.most_rate);
      unit_ = std::make_unique<robot::LevellingEmulator>(settings);
      levelling_ = std::make_unique<robot::DeviceServer>(options.levelling, *unit_, scenario.seed + 1);
    }
    if (!options.truth.empty()) {
      require_not_read(options.truth);
      if (std::error_code error; std::filesystem::is_fifo(options.truth, error))
        throw InputError(options.truth + ": is a pipe, and would be waited at for a reader; give a file");
      truth_.open(options.truth);
      if (!truth_) throw InputError(options.truth + ": cannot be written; give a path in a folder that exists");
    }
  }

  std::vector<std::string> ports() const {
    std::vector<std::string> words;
    if (urg_) words.push_back("urg " + urg_->port());
    if (base_) words.push_back("base " + base_->port());
    if (levelling_) words.push_back("levelling " + levelling_->port());
    return words;
  }

  EmulationReport run() {
    start_ = host_start();
    EmulationReport report;
    std::vector<double> late;
    robot::Inputs arrived;  // of the tick that ends now
    for (std::int64_t tick = 0;; ++tick) {
      const double time = static_cast<double>(tick) * tick_;
      robot::sleep_until(start_ + time);
      late.push_back(robot::host_now() - (start_ + time));
      deliver(arrived);
      begin_faults(time);
      report.seconds = time;
      if (options_.interrupted && options_.interrupted()) break;
      if (options_.time_limit > 0.0 && time >= options_.time_limit) break;
      // The tick to come is computed at its start, under what the devices were told up to now: so a scan is there when
      // its last beam is due. What it measures is held back until the tick is over.
      obey();
      auto next = simulated_.read();
      if (!next) break;
      arrived = std::move(*next);
      for (robot::LaserScan& scan : arrived.scans) publish(scan, report);
      if (tick % static_cast<std::int64_t>(std::lround(1.0 / tick_)) == 0) write_truth();
    }
    write_truth();
    std::sort(late.begin(), late.end());
    report.late_95 = late[static_cast<std::size_t>(0.95 * static_cast<double>(late.size() - 1))];
    report.late_worst = late.back();
    return report;
  }

 private:
  static Stamp host_start() { return robot::host_now() + 0.01; }
  Stamp on_host(Stamp simulated) const { return {start_.ns + simulated.ns}; }

  void publish(robot::LaserScan& scan, EmulationReport& report) {
    scan.stamp = on_host(scan.stamp);
    ++report.scans;
    if (urg_) urg_->publish(scan);
    if (base_) base_->with([&] { arcos_->measure(scan); });
  }

  void obey() {
    robot::Commands commands;
    if (base_) {
      std::optional<mrpt::math::TPose2D> placed;
      base_->with([&] {
        arcos_->advance(robot::host_now());
        commands.drive = arcos_->motion();
        commands.brake = arcos_->brakes_hard();
        arcos_->tell_truth(simulated_.truth().back().pose);
        placed = arcos_->take_placed();
      });
      if (placed) place(*placed);
    }
    if (levelling_) levelling_->with([&] { commands.aim = unit_->aim(); });
    simulated_.command(commands);
  }

  /// Beside the floor there is nothing to stand on.
  void place(const mrpt::math::TPose2D& pose) {
    if (std::isfinite(arenas::floor_height(arena_, {pose.x, pose.y}))) return simulated_.place(pose);
    char text[160];
    std::snprintf(text, sizeof text,
                  "base: SIM_SET_POSE to x %.2f, y %.2f m, where the arena has no floor; the robot stays where it is",
                  pose.x, pose.y);
    if (options_.warn) options_.warn(text);
  }

  void deliver(const robot::Inputs& inputs) {
    if (base_) {
      for (robot::Odometry odometry : inputs.odometry) {
        odometry.stamp = on_host(odometry.stamp);
        base_->with([&] { arcos_->measure(odometry, odometry.stamp); });
      }
    }
    if (!levelling_) return;
    for (std::size_t i = 0; i < inputs.accelerations.size() && i < inputs.aims.size(); ++i) {
      robot::Acceleration acceleration = inputs.accelerations[i];
      acceleration.stamp = on_host(acceleration.stamp);
      levelling_->with([&] { unit_->measure(acceleration, inputs.aims[i], acceleration.stamp); });
    }
  }

  void begin_faults(double time) {
    for (; begun_ < options_.faults.size() && options_.faults[begun_].seconds <= time; ++begun_) {
      const FaultAt& fault = options_.faults[begun_];
      if (options_.tell) options_.tell(fault.name);
      switch (fault.device) {
        case EmulatedKind::Scanner:
          if (urg_) begin(fault.fault, *urg_, [&](robot::DeviceFault own) { fail_scanner(own); });
          break;
        case EmulatedKind::Base:
          if (base_) begin(fault.fault, *base_, [&](robot::DeviceFault own) { fail(*base_, *arcos_, own); });
          break;
        case EmulatedKind::Levelling:
          if (levelling_)
            begin(fault.fault, *levelling_, [&](robot::DeviceFault own) { fail(*levelling_, *unit_, own); });
          break;
      }
    }
  }

  template <class Port, class Own>
  static void begin(const Fault& fault, Port& port, const Own& own) {
    if (const auto* bytes = std::get_if<robot::ByteFault>(&fault)) return port.spoil(*bytes, kDamage);
    if (const auto* device = std::get_if<robot::DeviceFault>(&fault)) return own(*device);
    switch (std::get<PortFault>(fault)) {
      case PortFault::Silence:
        return port.fall_silent(kSilence);
      case PortFault::Unplug:
        return port.unplug(kUnplugged);
      case PortFault::Slow:
        if constexpr (std::is_same_v<Port, robot::DeviceServer>) port.slow_down(kSlow);
    }
  }

  static void fail(robot::DeviceServer& server, robot::EmulatedDevice& device, robot::DeviceFault fault) {
    server.with([&] { device.fail(fault, robot::host_now()); });
  }

  /// That its clock wraps was arranged before the start.
  void fail_scanner(robot::DeviceFault fault) {
    if (fault == robot::DeviceFault::Reset) urg_->cycle_power();
  }

  void write_truth() {
    if (!truth_.is_open()) return;
    const Trajectory& truth = simulated_.truth();
    for (; truth_written_ < truth.size(); ++truth_written_)
      truth_ << tum_line({on_host(truth[truth_written_].stamp), truth[truth_written_].pose}) << '\n';
    truth_.flush();
    if (!truth_)
      throw RunError(options_.truth + ": cannot be written (" + std::strerror(errno) +
                     "); check the folder and the free space");
  }

  const EmulateOptions& options_;
  const arenas::Arena& arena_;
  sim::SimRobot simulated_;
  double tick_;
  Stamp start_;
  std::unique_ptr<robot::UrgEmulator> urg_;
  std::unique_ptr<robot::ArcosEmulator> arcos_;
  std::unique_ptr<robot::LevellingEmulator> unit_;
  std::unique_ptr<robot::DeviceServer> base_;
  std::unique_ptr<robot::DeviceServer> levelling_;
  std::size_t begun_ = 0;
  std::ofstream truth_;
  std::size_t truth_written_ = 0;
};

}  // namespace

const char* name_of(EmulatedKind device) {
  switch (device) {
    case EmulatedKind::Scanner:
      return "urg";
    case EmulatedKind::Base:
      return "base";
    case EmulatedKind::Levelling:
      return "levelling";
  }
  return "";
}

const std::string& EmulateOptions::port(EmulatedKind device) const {
  return device == EmulatedKind::Scanner ? urg : device == EmulatedKind::Base ? base : levelling;
}

FaultAt parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  FaultAt fault;
  fault.name = text.substr(0, at);
  char* end = nullptr;
  if (at != std::string::npos) fault.seconds = std::strtod(text.c_str() + at + 1, &end);
  if (end == nullptr || end == text.c_str() + at + 1 || *end != '\0' || !(fault.seconds >= 0.0 && fault.seconds <= 1e6))
    throw UsageError("--fault " + text + ": needs the form NAME@SECONDS, for example --fault base-unplug@20");
  std::vector<std::string> names;
  for (const FaultAt& known : known_faults()) {
    names.push_back(known.name);
    if (known.name != fault.name) continue;
    fault.device = known.device;
    fault.fault = known.fault;
    return fault;
  }
  throw UsageError("--fault " + text + ": there is no fault '" + fault.name + "'; known are " + joined(names));
}

EmulationReport emulate(const Scenario& scenario, const EmulateOptions& options) {
  const std::string name = scenario.arena_file.empty() ? "generated arena" : scenario.arena_file;
  const arenas::Arena arena = arenas::parse_arena(arena_yaml(scenario), name);
  arenas::check(arena, name);
  robot::RobotModel model = scenario.robot;
  model.tick = scenario.sim.physics_step;  // what a command waits for
  model.T_base_laser.yaw = options.urg_yaw;
  if (options.urg_upside_down) model.T_base_laser.roll = kPi;
  Scenario endless = scenario;
  endless.sim.time_limit = 1e9;
  EmulateOptions sorted = options;
  std::stable_sort(sorted.faults.begin(), sorted.faults.end(),
                   [](const FaultAt& a, const FaultAt& b) { return a.seconds < b.seconds; });
  Emulation emulation(endless, arena, model, sorted);
  if (options.ready) options.ready(emulation.ports());
  return emulation.run();
}

}  // namespace rubble::scenarios
