#include "scenarios/hardware/emulation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "arenas/files/arena_file.h"
#include "base/error.h"
#include "base/trajectory.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/levelling_emulator.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "sim/sim_robot.h"

namespace rubble::scenarios {
namespace {

constexpr double kDamage = 1.0;               ///< spoilt bytes last so long [s]
constexpr double kSilence = 2.0;              ///< [s]
constexpr double kUnplugged = 3.0;            ///< [s]
constexpr double kUrgClockWrap = 16777216.0;  ///< the scanner's clock counts milliseconds up to here

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
  c.top_speed = std::max(c.top_speed, c.max_speed);
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
    if (fault.name == "urg-wrap") config.clock_start = static_cast<std::uint32_t>(kUrgClockWrap - 1e3 * fault.seconds);
  return config;
}

/// The simulated robot and its devices.
class Emulation {
 public:
  Emulation(const Scenario& scenario, const arenas::Arena& arena, const robot::RobotModel& model,
            const EmulateOptions& options)
      : options_(options), simulated_(arena, model, scenario.sim, scenario.seed), tick_(model.tick) {
    if (!options.urg.empty()) urg_ = std::make_unique<robot::UrgEmulator>(urg_config(scenario, options));
    if (!options.base.empty()) {
      robot::ArcosEmulatorSettings settings = base_settings(model, options);
      settings.true_start = simulated_.truth().front().pose;
      arcos_ = std::make_unique<robot::ArcosEmulator>(settings);
      base_ = std::make_unique<robot::DeviceServer>(options.base, *arcos_, scenario.seed);
    }
    if (!options.levelling.empty()) {
      unit_ = std::make_unique<robot::LevellingEmulator>(robot::LevellingEmulatorSettings{});
      levelling_ = std::make_unique<robot::DeviceServer>(options.levelling, *unit_, scenario.seed + 1);
    }
    if (!options.truth.empty()) {
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
      simulated_.command(commands());
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

  robot::Commands commands() {
    robot::Commands commands;
    if (base_) {
      std::optional<mrpt::math::TPose2D> placed;
      base_->with([&] {
        arcos_->advance(robot::host_now());
        commands.drive = arcos_->motion();
        arcos_->tell_truth(simulated_.truth().back().pose);
        placed = arcos_->take_placed();
      });
      if (placed) simulated_.place(*placed);
    }
    if (levelling_) levelling_->with([&] { commands.aim = unit_->aim(); });
    return commands;
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
      const std::size_t dash = fault.name.find('-');
      begin(fault.name.substr(0, dash), fault.name.substr(dash + 1));
    }
  }

  void begin(const std::string& device, const std::string& fault) {
    if (device == "urg") return begin_urg(fault);
    robot::DeviceServer* server = device == "base" ? base_.get() : levelling_.get();
    robot::EmulatedDevice* emulated =
        device == "base" ? static_cast<robot::EmulatedDevice*>(arcos_.get()) : unit_.get();
    if (server == nullptr) return;
    if (const auto bytes = robot::byte_fault(fault)) return server->spoil(*bytes, kDamage);
    if (fault == "silence") return server->fall_silent(kSilence);
    if (fault == "unplug") return server->unplug(kUnplugged);
    server->with([&] { emulated->fail(fault, robot::host_now()); });
  }

  void begin_urg(const std::string& fault) {
    if (!urg_) return;
    if (const auto bytes = robot::byte_fault(fault)) return urg_->spoil(*bytes, kDamage);
    if (fault == "silence") return urg_->fall_silent(kSilence);
    if (fault == "unplug") return urg_->unplug(kUnplugged);
    if (fault == "reset") urg_->cycle_power();
  }

  void write_truth() {
    if (!truth_.is_open()) return;
    const Trajectory& truth = simulated_.truth();
    for (; truth_written_ < truth.size(); ++truth_written_)
      truth_ << tum_line({on_host(truth[truth_written_].stamp), truth[truth_written_].pose}) << '\n';
    truth_.flush();
  }

  const EmulateOptions& options_;
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

const std::vector<std::string>& fault_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const char* device : {"urg", "base", "levelling"})
      for (const char* fault : {"lost", "split", "doubled", "junk", "sums", "silence", "unplug", "reset"})
        all.push_back(std::string(device) + "-" + fault);
    for (const char* own :
         {"urg-wrap", "base-seto", "base-stall", "base-watchdog", "base-button", "base-motors", "levelling-sensor"})
      all.emplace_back(own);
    return all;
  }();
  return names;
}

FaultAt parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  FaultAt fault;
  fault.name = text.substr(0, at);
  char* end = nullptr;
  if (at != std::string::npos) fault.seconds = std::strtod(text.c_str() + at + 1, &end);
  if (end == nullptr || end == text.c_str() + at + 1 || *end != '\0' || !(fault.seconds >= 0.0 && fault.seconds <= 1e6))
    throw UsageError("--fault " + text + ": needs the form NAME@SECONDS, for example --fault base-unplug@20");
  const auto& names = fault_names();
  if (std::find(names.begin(), names.end(), fault.name) == names.end()) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    throw UsageError("--fault " + text + ": there is no fault '" + fault.name + "'; known are " + known);
  }
  return fault;
}

EmulationReport emulate(const Scenario& scenario, const EmulateOptions& options) {
  const std::string name = scenario.arena_file.empty() ? "generated arena" : scenario.arena_file;
  const arenas::Arena arena = arenas::parse_arena(arena_yaml(scenario), name);
  arenas::check(arena, name);
  robot::RobotModel model = scenario.robot;
  model.tick = scenario.sim.physics_step;  // what a command waits for
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
