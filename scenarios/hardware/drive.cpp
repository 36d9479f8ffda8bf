#include "scenarios/hardware/drive.h"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/words.h"
#include "robot/drivers/black_box.h"
#include "robot/drivers/mrpt_scanner.h"
#include "robot/drivers/scip/scip_scanner.h"
#include "robot/drivers/watch/base_watch.h"
#include "robot/logs/log.h"
#include "scenarios/config/notes.h"
#include "scenarios/hardware/port_mix_up.h"
#include "scenarios/hardware/scanner_check.h"
#include "scenarios/run/core.h"
#include "scenarios/run/loop.h"
#include "scenarios/run/map_files.h"
#include "scenarios/run/replay.h"
#include "scenarios/run/run_folder.h"
#include "scenarios/run/score_json.h"

namespace rubble::scenarios {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLeastRateTime = 0.7;  ///< over less a rate of ten a second says little [s]
constexpr double kTellHow = 2.0;        ///< nothing has come in so long [s]
constexpr double kTellAgain = 5.0;  ///< a reason that changed, or a trouble that comes and goes, is told so often [s]

/// So soon a base that is stopped has told so, on a line that is as slow as may be driven with, and one that does not
/// obey has been found out (BaseWatch::kMotorsOff) [s].
constexpr double kConfirmed = 2.0;

constexpr const char* kNotHeard = "base: has not told that it stopped; see that it stands";

constexpr robot::Drive kMoved{0.02, deg_to_rad(2.0)};  ///< so far is more than a touch [m], [rad]

std::unique_ptr<robot::Scanner> make_scanner(const RobotFile& file, robot::BlackBox& box) {
  const robot::LaserModel& laser = file.settings.robot.laser;
  if (file.lidar.driver == LidarDriver::Mrpt) {
    robot::MrptScannerConfig config;
    config.type = file.lidar.mrpt_class;
    config.port = file.lidar.port;
    config.parameters = file.lidar.parameters;
    config.range_max = laser.range_max;
    config.no_echo_is_miss = file.lidar.no_echo_is_miss;
    config.scan_period = laser.scan_period;
    return robot::mrpt_scanner(config);
  }
  robot::ScipScannerConfig config;
  config.port = file.lidar.port;
  config.range_max = laser.range_max;
  config.no_echo_is_miss = file.lidar.no_echo_is_miss;
  config.open = [&box](const std::string& word) { return robot::open_recorded(word, "urg", &box); };
  return std::make_unique<robot::ScipScanner>(config);
}

/// A scanner that hangs upside down, or whose scans are older than their stamps say (`rubble calibrate`).
class MountedScanner : public robot::Scanner {
 public:
  MountedScanner(std::unique_ptr<robot::Scanner> inner, const LidarSettings& mount)
      : inner_(std::move(inner)), mount_(mount) {}

  std::vector<robot::LaserScan> take() override {
    std::vector<robot::LaserScan> scans = inner_->take();
    for (robot::LaserScan& scan : scans) as_mounted(mount_, scan);
    return scans;
  }
  robot::ScannerStatus status() const override {
    robot::ScannerStatus status = inner_->status();
    for (double* latency : {&status.latency, &status.worst_latency, &status.recent_latency}) *latency += mount_.delay;
    return status;
  }
  robot::ScannerInfo info() const override { return inner_->info(); }
  int descriptor() const override { return inner_->descriptor(); }

 private:
  std::unique_ptr<robot::Scanner> inner_;
  const LidarSettings mount_;
};

std::unique_ptr<robot::Scanner> open_lidar(const RobotFile& file, robot::BlackBox& box) {
  auto scanner = make_scanner(file, box);
  if (file.lidar.delay == 0.0 && !file.lidar.upside_down) return scanner;
  return std::make_unique<MountedScanner>(std::move(scanner), file.lidar);
}

const char* name_of(explore::ExplorerState state) {
  switch (state) {
    case explore::ExplorerState::Starting:
      return "starting";
    case explore::ExplorerState::Driving:
      return "driving";
    case explore::ExplorerState::Searching:
      return "searching";
    case explore::ExplorerState::BackingUp:
      return "backing up";
    case explore::ExplorerState::GoingHome:
      return "going home";
    case explore::ExplorerState::Finished:
      return "finished";
  }
  return "";
}

/// What a real robot and whoever stands beside it add to the loop.
class Driver {
 public:
  Driver(const RobotFile& file, const DriveOptions& options, RunFolder& folder, robot::RealRobot& real, Core& core,
         const robot::Scanner& lidar)
      : options_(options),
        real_(real),
        core_(core),
        lidar_(lidar),
        laser_(file.settings.robot.laser),
        has_base_(!file.robot.base_port.empty()),
        loop_(file.settings, folder, core, hooks()) {
    real_.while_waiting([this](const robot::RobotStatus& status) { return wait(status); });
    real_.listen([this] { return wish(); }, options_.left);
    if (options_.mode == DriveMode::Teleoperate) real_.steer_by_hand(options_.keys);
  }
  ~Driver() {
    real_.steer_by_hand({});
    real_.listen({});
  }

  LoopEnd run(robot::Robot& robot) {
    LoopEnd end = loop_.run(robot);
    if (end.robot_ended && real_.status().emergency) interrupted_ = true;
    if (end.robot_ended && !interrupted_) mind_nothing_done(end);
    if (end.robot_ended && end.failure.empty())
      end.reason = real_.status().emergency ? "emergency stop" : interrupted_ ? "interrupted" : time_is_over();
    end.interrupted = interrupted_;
    return end;
  }

  /// That nothing came of at all: who is held, moves, is late or fell silent has reported, and is where it belongs.
  std::vector<std::string> silent_devices() const {
    const robot::RobotStatus status = real_.status();
    const auto has_reported = [&](const std::string& name) {
      return name == "urg" ? status.scans > 0 : name == "base" ? status.odometry > 0 : status.accelerations > 0;
    };
    std::vector<std::string> names;
    for (const robot::Hindrance& one : status.silent)
      if (one.cause == robot::Hindrance::Cause::Silent && !has_reported(one.name)) names.push_back(one.name);
    return names;
  }

 private:
  /// A robot that stood held or silent to the end has not done what it was sent for.
  std::string time_is_over() const {
    const std::vector<robot::Hindrance> waited_for = real_.status().silent;
    return waited_for.empty() ? "the time is over"
                              : "the time is over; the drive was waiting: " + joined(lines_of(waited_for));
  }

  /// Who waits to the end and has neither moved nor mapped has failed, though nothing was lost.
  void mind_nothing_done(LoopEnd& end) const {
    if (!end.failure.empty() || real_.status().silent.empty()) return;
    const bool moves = options_.mode == DriveMode::Explore || options_.mode == DriveMode::Calibrate;
    const bool mapped = known_area(core_.mapper().map()) > 0.0;
    if (mapped && (moved_ || !moves)) return;
    end.failure = end.reason = time_is_over() + (mapped ? "; the robot never moved" : "; nothing is mapped");
  }

  /// By its wheels.
  void watch_motion(const robot::Inputs& inputs) {
    for (const robot::Odometry& odometry : inputs.odometry) {
      const mrpt::math::TPose2D& pose = odometry.pose;
      if (!start_) start_ = pose;
      moved_ = moved_ || std::hypot(pose.x - start_->x, pose.y - start_->y) > kMoved.v ||
               std::abs(wrap_angle(pose.phi - start_->phi)) > kMoved.w;
    }
  }

  /// Asked in the robot's own thread, whatever the core is at.
  robot::OperatorWish wish() {
    if (options_.emergency && options_.emergency()) return robot::OperatorWish::EmergencyStop;
    if (options_.interrupted && options_.interrupted()) interrupted_ = true;
    if (options_.insisted && options_.insisted()) return robot::OperatorWish::Leave;
    return interrupted_ ? robot::OperatorWish::Stop : robot::OperatorWish::None;
  }

  LoopHooks hooks() {
    LoopHooks hooks;
    hooks.interrupted = [this] { return interrupted_.load(); };
    hooks.over = [this] { return piloted_out_ ? why_piloted_out() : std::string(); };
    hooks.steer = [this](const robot::Inputs& inputs, const robot::Commands& wanted) { return steer(inputs, wanted); };
    hooks.each_second = [this](double seconds) { each_second(seconds); };
    hooks.waits = [this](const explore::Decision& waits) {
      if (options_.tell) options_.tell("the robot " + waits.why);
    };
    hooks.stop = [this] {
      ended_ = true;
      real_.stop();
    };
    return hooks;
  }

  std::string why_piloted_out() const {
    const std::string trouble = options_.pilot_trouble ? options_.pilot_trouble() : "";
    return trouble.empty() ? "the drive is complete" : trouble;
  }

  /// Once, when the scanner has said what it is.
  void tell_of_scanner() {
    if (scanner_told_ || lidar_.info().model.empty()) return;
    scanner_told_ = true;
    const std::string line = scanner_mismatch(lidar_.info(), laser_);
    if (options_.tell && !line.empty()) options_.tell("urg: " + line);
  }

  robot::Commands steer(const robot::Inputs& inputs, robot::Commands commands) {
    tell_of_scanner();
    tell_back({});
    held_ = false;
    begun_ = true;
    watch_motion(inputs);
    if (options_.mode != DriveMode::Explore) commands.brake = false;
    if (options_.mode == DriveMode::Teleoperate) commands.drive = options_.keys ? options_.keys() : robot::Drive{};
    if (options_.mode == DriveMode::MapOnly) commands.drive = {};
    if (options_.mode == DriveMode::Calibrate) {
      const auto wanted = options_.pilot ? options_.pilot(inputs, core_.mapper().pose()) : std::nullopt;
      piloted_out_ = !wanted;
      commands = {wanted.value_or(robot::Drive{}), {}};  // the servos stay at zero, else they would follow its error
    }
    return commands;
  }

  /// Why a device is waited for, as it was told.
  struct Reason {
    std::string name;
    robot::Hindrance::Cause cause = robot::Hindrance::Cause::Silent;
    std::string words;  ///< without its numbers
    Clock::time_point at;
  };

  /// While devices are silent: tells which, and saves the map at once. False ends the run.
  bool wait(const robot::RobotStatus& status) {
    tell_of_scanner();
    if ((status.held || begun_) && seconds_since(shown_at_) >= 1.0) show(status, status.held ? "held" : "waiting");
    for (const robot::Hindrance& one : status.silent)
      if (is_news(one, status.silent) && options_.tell) options_.tell(one.line());
    tell_how_to_go_on(status.silent);
    if (begun_ && names(status.silent) != names(told_)) loop_.save_now();
    tell_back(status.silent);
    if (status.held) mind_hold(status);
    held_ = held_ && status.held;
    if (options_.forget_keys) options_.forget_keys();
    return !interrupted_;
  }

  /// Who has no robot at hand has waited for one by now.
  void tell_how_to_go_on(const std::vector<robot::Hindrance>& silent) {
    if (begun_ || told_how_ || silent.empty() || seconds_since(made_at_) < kTellHow) return;
    told_how_ = true;
    if (options_.tell)
      options_.tell("waits for " + joined(names(silent)) +
                    "; Ctrl-C ends; to try without hardware: rubble emulate (docs/hardware.md)");
  }

  static std::string without_numbers(std::string text) {
    text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
               text.end());
    return text;
  }

  /// Not told of this device while it was waited for; where it takes another reason's place it must have stood for a
  /// while: a port that was not open yet may have been opened since. Takes it for told.
  bool is_news(const robot::Hindrance& one, const std::vector<robot::Hindrance>& all) {
    const std::string words = without_numbers(one.what);
    const auto gives_way = [&](const Reason& reason) {
      return seconds_since(reason.at) < kTellAgain && std::none_of(all.begin(), all.end(), [&](const auto& other) {
               return reason.name == other.name && reason.words == without_numbers(other.what);
             });
    };
    const bool told = std::any_of(reasons_.begin(), reasons_.end(), [&](const Reason& reason) {
      return reason.name == one.name && reason.cause == one.cause && (reason.words == words || gives_way(reason));
    });
    if (!told) reasons_.push_back({one.name, one.cause, words, Clock::now()});
    return !told;
  }

  static std::vector<std::string> names(const std::vector<robot::Hindrance>& all) {
    std::vector<std::string> out;
    for (const robot::Hindrance& one : all) out.push_back(one.name);
    return out;
  }

  /// Somebody stopped the robot at the robot, or had its base while it was away. Only what the operator says after that
  /// was told lets it go.
  void mind_hold(const robot::RobotStatus& status) {
    if (!held_) {
      const std::string first = !status.mend.empty() ? status.mend
                                : status.taken       ? "see that nobody else drives it"
                                                     : "release the button";
      if (options_.tell)
        options_.tell("base: held; " + first + ", then press R (or send SIGUSR2) to let the robot drive again");
      if (options_.rearm) options_.rearm();  // what was pressed or sent before it was held
      held_ = true;
    } else if (options_.rearm && options_.rearm()) {
      if (real_.rearm()) {
        held_ = false;  // should it be stopped again at once, that is another hold
      } else if (const std::string why = real_.status().refusal; options_.tell && !why.empty()) {
        options_.tell("base: " + why);
      }
    }
  }

  /// Names what was told before and is no more.
  void tell_returned(const std::vector<robot::Hindrance>& before, const std::vector<robot::Hindrance>& now) const {
    if (!options_.tell) return;
    const std::vector<std::string> still = names(now);
    std::vector<std::string> lines;
    for (const robot::Hindrance& one : before) {
      if (std::find(still.begin(), still.end(), one.name) != still.end()) continue;
      // That it is let go says all; that it is watched from then on comes with its troubles, and says that it is let
      // go.
      const bool held = std::any_of(before.begin(), before.end(), [&](const robot::Hindrance& other) {
        return other.name == one.name && other.cause == robot::Hindrance::Cause::Held;
      });
      if (held && one.name == "base" && real_.status().doubted) continue;
      const std::string line = one.name + ": " + over(held ? robot::Hindrance::Cause::Held : one.cause);
      if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
    }
    for (const std::string& line : lines) options_.tell(line);
  }

  void tell_back(const std::vector<robot::Hindrance>& silent) {
    tell_returned(told_, silent);
    told_ = silent;
    const std::vector<std::string> still = names(silent);
    const auto is_over = [&](const Reason& one) {
      return std::find(still.begin(), still.end(), one.name) == still.end();
    };
    reasons_.erase(std::remove_if(reasons_.begin(), reasons_.end(), is_over), reasons_.end());
  }

  /// What was told a while ago and comes again for a moment is no news, nor is another number in it.
  void tell_troubles(const std::vector<robot::Hindrance>& now) {
    for (const robot::Hindrance& one : now) {
      const auto [told, is_new] = troubles_told_.try_emplace(without_numbers(one.line()), Clock::now());
      if (is_new || seconds_since(told->second) >= kTellAgain) options_.tell(one.line());
      told->second = Clock::now();  // as long as it goes on it is not told again
    }
    tell_returned(troubles_, now);
  }

  void each_second(double seconds) {
    seconds_ = seconds;
    const robot::RobotStatus status = real_.status();
    if (options_.tell) tell_troubles(status.troubles);
    troubles_ = status.troubles;
    if (!begun_) return;
    show(status, status.held                               ? "held"
                 : options_.mode == DriveMode::Teleoperate ? "by hand"
                 : options_.mode == DriveMode::MapOnly     ? "mapping"
                 : options_.mode == DriveMode::Calibrate   ? "calibrate"
                 : core_.explorer()                        ? name_of(core_.explorer()->state())
                                                           : "mapping");
  }

  /// The line of this second.
  void show(const robot::RobotStatus& robot, const std::string& state) {
    const double since = seconds_since(counted_at_);  // the drive's own time stands still while it waits
    shown_at_ = Clock::now();
    if (!options_.each_second || since <= 0.0) return;
    DriveStatus status;
    status.robot = robot;
    status.has_base = has_base_;
    status.seconds = seconds_;
    status.state = state;
    // While the core waits its mapper does not know that somebody moves the robot; its wheels do.
    status.T_map_base = core_.mapper().pose() + robot.unread;
    status.known_m2 = known_area(core_.mapper().map());
    if (rates_.empty() || (since >= kLeastRateTime && !ended_)) {
      rates_ = {static_cast<double>(robot.scans - last_.scans) / since,
                static_cast<double>(robot.odometry - last_.odometry) / since,
                static_cast<double>(robot.accelerations - last_.accelerations) / since};
      last_ = robot;
      counted_at_ = shown_at_;
    }
    status.scans_per_s = rates_[0];
    status.odometry_per_s = rates_[1];
    status.accelerations_per_s = rates_[2];
    options_.each_second(status);
  }

  const DriveOptions& options_;
  robot::RealRobot& real_;
  Core& core_;
  const robot::Scanner& lidar_;
  const robot::LaserModel laser_;  ///< of the robot file
  bool scanner_told_ = false;
  const bool has_base_;
  Loop loop_;
  bool begun_ = false;  ///< something has come in
  bool told_how_ = false;
  Clock::time_point made_at_ = Clock::now();
  bool moved_ = false;
  std::optional<mrpt::math::TPose2D> start_;  ///< of the wheels
  double seconds_ = 0.0;                      ///< since the first tick
  Clock::time_point shown_at_ = Clock::now();
  Clock::time_point counted_at_ = Clock::now();  ///< what came up to then, last_
  std::vector<double> rates_;                    ///< a second, of scans, odometry and accelerations, as shown last
  bool ended_ = false;                           ///< nothing is read any more, so nothing more is counted
  std::atomic<bool> interrupted_{false};
  bool held_ = false;  ///< stopped at the robot itself, and told
  std::vector<robot::Hindrance> troubles_;
  std::map<std::string, Clock::time_point> troubles_told_;  ///< without their numbers, and when last
  bool piloted_out_ = false;
  std::vector<robot::Hindrance> told_;  ///< what is silent, as it was at the last look
  std::vector<Reason> reasons_;         ///< that were told of devices which are waited for still
  robot::RobotStatus last_;
};

double share(std::vector<double>& sorted, double part) {
  if (sorted.empty()) return 0.0;
  std::sort(sorted.begin(), sorted.end());
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

/// What the drive can say without knowing the truth.
scoring::Evidence evidence_of(const Core& core, const robot::RealRobot& robot, const LoopEnd& end,
                              Clock::time_point start) {
  scoring::Evidence evidence;
  evidence.run = run_figures(core, end.sim_s, end.reason);
  const double wall = seconds_since(start);
  evidence.machine = scoring::MachineFigures{wall, peak_megabytes()};
  scoring::DeviceFigures& devices = evidence.devices.emplace();
  const robot::RobotStatus status = robot.status();
  devices.bad_packets = status.bad_packets;
  devices.odometry_jumps = status.jumps;
  devices.scans_damaged = status.scans_damaged;
  devices.scans_missed = status.scans_missed;
  std::vector<double> delays = robot.answer_delays();
  devices.answer_ms_median = 1e3 * share(delays, 0.5);
  devices.answer_ms_99 = 1e3 * share(delays, 0.99);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto time = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  devices.cpu_share = (time(usage.ru_utime) + time(usage.ru_stime)) / std::max(1e-3, wall);
  return evidence;
}

/// Devices that do not report may be plugged in where others are looked for: asks at their ports who is there.
void tell_who_answers(const RobotFile& file, const std::vector<std::string>& silent, const DriveOptions& options) {
  // Whoever only maps says nothing to a base that others drive; ports mixed up, it may be at any of them.
  if (!options.tell || options.mode == DriveMode::MapOnly) return;
  std::vector<DevicePort> asked;
  using Kind = robot::DeviceKind;
  for (const DevicePort& device :
       {DevicePort{Kind::Scanner, "urg", file.lidar.port}, DevicePort{Kind::Base, "base", file.robot.base_port},
        DevicePort{Kind::Levelling, "levelling", file.robot.levelling_port}})
    if (std::find(silent.begin(), silent.end(), device.name) != silent.end()) asked.push_back(device);
  for (const std::string& line : port_mix_up(asked, options.interrupted)) options.tell(line);
}

/// Says which folder is not complete when an error leaves the drive.
class Completeness {
 public:
  Completeness(const DriveOptions& options, const RunFolder& folder) : options_(options), folder_(folder) {}
  ~Completeness() {
    if (std::uncaught_exceptions() > before_ && options_.incomplete) options_.incomplete(folder_.path());
  }
  Completeness(const Completeness&) = delete;
  Completeness& operator=(const Completeness&) = delete;

 private:
  const DriveOptions& options_;
  const RunFolder& folder_;
  const int before_ = std::uncaught_exceptions();
};

/// A base that is stopped for good and does not obey: whoever stands beside it must know before the program ends.
/// False: it said nothing any more.
bool tell_what_goes_on(const robot::RealRobot& robot, const DriveOptions& options) {
  const auto given_up = Clock::now() + std::chrono::duration<double>(kConfirmed);
  robot::RobotStatus status = robot.status();
  if (!status.begun) {  // nobody here has driven it
    if (options.tell && status.moves)
      options.tell("base: moves though nobody here has driven it, and may go on; see who drives it");
    return true;
  }
  const auto stands = [](const robot::RobotStatus& s) { return s.reported && !s.motors_on && !s.moves; };
  for (; Clock::now() < given_up && !stands(status); status = robot.status())
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (!options.tell || stands(status)) return status.reported;
  if (status.motors_stay || (status.reported && status.motors_on)) {
    options.tell(std::string("base: ") + robot::kMotorsStay);
  } else if (status.reported) {
    options.tell("base: its motors are off, but its wheels turn; see that it comes to stand");
  }
  return status.reported;
}

/// Stops the robot also where an error leaves the drive, and says so when it does not stop.
class StoppedAtLast {
 public:
  /// `unheard` becomes true when the base was silent as the drive ended: that is to be told where it is told how it
  /// did.
  StoppedAtLast(robot::RealRobot& robot, const DriveOptions& options, bool& unheard)
      : robot_(robot), options_(options), unheard_(unheard) {}
  ~StoppedAtLast() {
    if (options_.mode == DriveMode::MapOnly) return;
    robot_.stop();
    const auto wish = [this] {
      return options_.insisted && options_.insisted() ? robot::OperatorWish::Leave : robot::OperatorWish::Stop;
    };
    robot_.listen(wish, options_.left);  // who is in a hurry need not wait for the base
    unheard_ = !tell_what_goes_on(robot_, options_);
    // That its motors stay on, where that is the last that was heard, says more.
    if (unheard_ && options_.tell && std::uncaught_exceptions() > before_ && !robot_.status().motors_stay)
      options_.tell(kNotHeard);
    robot_.listen({});
  }
  StoppedAtLast(const StoppedAtLast&) = delete;
  StoppedAtLast& operator=(const StoppedAtLast&) = delete;

 private:
  robot::RealRobot& robot_;
  const DriveOptions& options_;
  bool& unheard_;
  const int before_ = std::uncaught_exceptions();
};

}  // namespace

RunReport drive(const RobotFile& file, const DriveOptions& options) {
  const auto start = Clock::now();
  if (options.mode == DriveMode::Explore && options.tell) {
    for (const std::string& note : setting_notes(file.settings)) options.tell(note);
    if (const auto note = short_time_note(file.settings)) options.tell(*note);
  }
  if (options.mode != DriveMode::MapOnly && file.robot.base_port.empty())
    throw InputError("devices.base: without a base the robot can only be watched; give its port, or add --map-only");
  file.settings.mapper.require_permission();
  if (file.robot.base_port.empty() && options.tell)
    options.tell("there is no base that a key or a signal here could stop; they end the mapping");
  // A robot that somebody else drives is not waited for: it would be taken over when they stop it.
  // Nor by others while one of its devices is unplugged; MRPT's drivers open their ports themselves.
  std::vector<robot::PortClaim> claims;
  for (const std::string& port : {file.lidar.port, file.robot.base_port, file.robot.levelling_port})
    if (!port.empty()) claims.emplace_back(port);
  RunFolder folder(options.out.empty() ? next_run_folder("runs", file.settings.name, file.settings.seed) : options.out,
                   options.replace);
  if (options.tell && !options.notice.empty()) options.tell(options.notice);
  const Completeness completeness(options, folder);
  folder.write("scenario.yaml", resolved_yaml(file.settings));
  folder.write("robot.yaml", robot_file_yaml(file));
  auto written_by = nlohmann::ordered_json::parse(versions().json(-1));
  if (options.mode != DriveMode::Explore) written_by[kSteeredByHand] = true;
  folder.write("versions.json", written_by.dump(2) + "\n");
  robot::BlackBox box(folder.file("devices.bytes"));
  Core core(file.settings, file.robot.model, options.mode == DriveMode::Explore, folder.path());
  RunReport report;
  std::vector<std::string> silent;  ///< in a drive that never began
  bool unheard = false;             ///< the base, at the very end
  {
    const std::unique_ptr<robot::Scanner> lidar = open_lidar(file, box);
    robot::RealRobotSettings settings = file.robot;
    settings.base.passive = settings.base.listen = options.mode == DriveMode::MapOnly;
    // A laser that is not levelled does not swing, however late its unit is.
    if (!file.settings.levelling.on) settings.safety.levelling_answer = std::numeric_limits<double>::infinity();
    robot::RealRobot real(settings, *lidar, &box);
    folder.keep_unfinished();
    robot::RecordingRobot recorded(real, folder.file("log.rlog"), resolved_yaml(file.settings));
    const StoppedAtLast stopped(real, options, unheard);
    Driver driver(file, options, folder, real, core, *lidar);
    const LoopEnd end = driver.run(recorded);
    report.end = end.reason;
    report.failure = end.failure;
    report.interrupted = end.interrupted;
    if (!end.failure.empty() && end.sim_s == 0.0) silent = driver.silent_devices();
    recorded.flush();
    save_map_files(folder, core.mapper());
    *report.score = score_json(evidence_of(core, real, end, start));
  }
  if (unheard && report.failure.empty()) {
    report.failure = kNotHeard;
  } else if (unheard && options.tell) {
    options.tell(kNotHeard);
  }
  folder.save_hashes("");
  folder.write("score.json", report.score->dump(2) + "\n");
  folder.close();
  folder.link_latest(core.mapper());
  report.folder = folder.path();
  tell_who_answers(file, silent, options);
  for (const std::string& device : box.cut_short())
    if (options.tell)
      options.tell("devices.bytes: not all that '" + device + "' sent is in it: it was more than 1 MB/s");
  if (const std::string why = box.failure(); !why.empty()) throw RunError(folder.file("devices.bytes") + ": " + why);
  return report;
}

}  // namespace rubble::scenarios
