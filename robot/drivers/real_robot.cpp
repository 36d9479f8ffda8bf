#include "robot/drivers/real_robot.h"

#include <poll.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "base/lists.h"
#include "base/text/words.h"
#include "robot/battery_watch.h"
#include "robot/drivers/device_thread.h"
#include "robot/drivers/heartbeat.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/watch/answer_watch.h"
#include "robot/drivers/watch/base_watch.h"
#include "robot/drivers/watch/freshness.h"
#include "robot/drivers/watch/levelling_witness.h"
#include "robot/drivers/watch/scan_watch.h"
#include "robot/drivers/watch/standstill.h"

namespace rubble::robot {
namespace {

constexpr double kAsk = 0.05;                 ///< pause of a waiting read() [s]
constexpr double kListen = 0.02;              ///< the operator is asked so often [s]
constexpr double kFarAhead = 0.1;             ///< of stamps [s]
constexpr std::size_t kMostScansKept = 240;   ///< while the robot is held
constexpr std::size_t kNewestScansKept = 40;  ///< of these all remain when the others are thinned

using Cause = Hindrance::Cause;

/// `underway`: all have reported before; a connection that is made anew knows nothing of the last report. `cause`: why
/// nothing comes.
Hindrance silent_for(const std::string& name, bool underway, Stamp last, Stamp now, const std::string& why,
                     Cause cause = Cause::Silent) {
  char text[80];
  if (last == Stamp::never()) {
    std::snprintf(text, sizeof text, underway ? "does not report" : "has not reported yet");
  } else {
    std::snprintf(text, sizeof text, "silent for %.1f s", now - last);
  }
  return {name, cause, text + (why.empty() ? "" : " (" + why + ")")};
}

/// By the worst cause of all: a line that is too slow is not helped by plugging it in again.
std::string remedy(const std::vector<Hindrance>& all, bool starting) {
  const auto any = [&](Cause cause) {
    return std::any_of(all.begin(), all.end(), [cause](const Hindrance& one) { return one.cause == cause; });
  };
  const auto is_device = [](const Hindrance& one) { return one.cause == Cause::Silent && one.name != "heartbeat"; };
  if (any(Cause::Disobeys)) return "; see who moves it";
  if (std::any_of(all.begin(), all.end(), is_device))
    return starting ? "; check cables, power and ports" : "; it did not come back; plug it in and run again";
  if (any(Cause::Held)) return "; nobody has let it go";
  if (any(Cause::Faulty)) return "; see to it and run again";
  return any(Cause::Silent) ? "; nobody has touched it" : "; use a faster one";
}

/// What the clock of a device puts behind the end of the tick.
template <class T>
class Early {
 public:
  /// Takes them out of `list` and puts in what waited and is due. Stamps that are ahead by more than a clock that is
  /// mapped may be are cut off.
  void hold_back(std::vector<T>& list, Stamp now) {
    std::vector<T> all = std::exchange(waiting_, {});
    append(all, std::move(list));
    list.clear();
    for (T& entry : all) {
      if (entry.stamp > now + kFarAhead) entry.stamp = now;
      (entry.stamp > now ? waiting_ : list).push_back(std::move(entry));
    }
  }

 private:
  std::vector<T> waiting_;
};

}  // namespace

struct RealRobot::Impl {
  RealRobotSettings settings;
  Scanner& lidar;
  std::unique_ptr<BaseDriver> base;
  LevellingUnit unit;
  Heartbeat heartbeat;  ///< asked by the operator's thread alone
  std::function<bool(const RobotStatus&)> ask;

  mutable Freshness freshness;  ///< of scans
  ScanWatch scan_watch;         ///< of what they show
  mutable AnswerWatch base_answers;
  mutable AnswerWatch unit_answers;
  std::atomic<bool> emergency{false};
  std::atomic<bool> stopped{false};
  std::atomic<std::int64_t> stopped_ns{std::numeric_limits<std::int64_t>::max()};  ///< for good
  std::atomic<bool> ending{false};
  std::atomic<std::int64_t> operator_ns{Stamp::never().ns};
  Standstill standstill{host_now(), time_asleep()};  ///< minded by the operator's thread
  std::atomic<std::uint64_t> scans{0}, odometry{0}, accelerations{0};

  std::atomic<int> pardoned{0};  ///< of the base's refusals, by the operator

  mutable std::mutex mutex;  ///< of what core and base thread share; taken after the base
  Commands commands;
  bool brake_asked = false;
  Stamp commanded = Stamp::never();
  bool armed = false;  ///< all devices have reported: the motors may go on
  BaseWatch base_watch;
  BatteryWatch battery_watch;
  Stamp battery_told = Stamp::never();
  std::optional<BatteryState> waiting_battery;
  LevellingWitness levelling_witness;
  bool unlevelled = false;  ///< the operator drives on without what levels the scanner the wrong way
  std::vector<Odometry> waiting_odometry;
  std::optional<mrpt::math::TPose2D> read_pose;  ///< of the wheels, by the last report that read() returned
  Stamp scan_answered = Stamp::never();          ///< arrival of the scan whose answer is on its way
  Stamp scan_leaving = Stamp::never();           ///< the same, once the base's thread has the answer
  std::vector<double> delays;

  std::vector<LaserScan> waiting_scans;
  Stamp scan_arrived = Stamp::never();  ///< of the scan that read() returned last
  Stamp created = host_now();
  Stamp first = Stamp::never();
  Stamp tick_end = Stamp::never();
  Stamp last_now = Stamp::never();
  Early<Odometry> early_odometry;
  Early<Acceleration> early_accelerations;
  Early<AimState> early_aims;
  Stamp held_since = Stamp::never();

  std::unique_ptr<DeviceThread> unit_thread;
  std::unique_ptr<DeviceThread> base_thread;  // it asks all the others
  std::mutex listen_mutex;                    ///< of what is called for the operator
  std::function<OperatorWish()> wish;
  std::function<Drive()> hand;
  std::function<void()> left;
  std::thread operator_thread;

  Impl(const RealRobotSettings& given, Scanner& scanner, BlackBox* box)
      : settings(given),
        lidar(scanner),
        base(given.own_base ? given.own_base(given.base) : make_base(given.base_driver, given.base)),
        unit(given.levelling),
        heartbeat(given.heartbeat),
        scan_watch(given.safety.scans),
        base_answers(given.safety.base_answer),
        unit_answers(given.safety.levelling_answer),
        base_watch(given.base, {given.model.T_base_laser.x, given.model.T_base_laser.y, given.model.T_base_laser.yaw},
                   given.safety.mount_check),
        battery_watch(given.safety.battery_low, given.safety.battery_empty) {
    if (!settings.levelling_port.empty())
      unit_thread = std::make_unique<DeviceThread>("levelling", settings.levelling_port, unit, box);
    if (!settings.base_port.empty())
      base_thread = std::make_unique<DeviceThread>(
          "base", settings.base_port, *base, box, [this](Stamp now) { watch(now); },
          [this](Stamp now) { left_for_base(now); });
    operator_thread = std::thread([this] {
      while (!ending) {
        if (standstill.look(host_now(), time_asleep())) forget_drive();
        listen();
        sleep_until(host_now() + kListen);
      }
    });
  }
  ~Impl() {
    ending = true;
    operator_thread.join();
  }

  /// Calls `use()` while the base's thread, if there is one, leaves the base alone.
  template <class Use>
  auto with_base(const Use& use) const {
    return base_thread ? base_thread->with(use) : use();
  }
  /// `ask(base_watch)` while the base's thread leaves it alone.
  template <class Ask>
  auto watched(const Ask& ask) const {
    const std::lock_guard<std::mutex> lock(mutex);
    return ask(base_watch);
  }
  bool is_blind() const {
    return watched([this](const BaseWatch& watch) { return watch.blind() || is_levelled_wrong(); });
  }
  bool is_held_by_us() const {
    return watched([this](const BaseWatch&) { return holds_itself(); });
  }
  /// With the mutex taken, as the next one: what was seen here holds it until the operator lets it go.
  bool holds_itself() const { return !base_watch.held().empty() || is_levelled_wrong() || is_empty(); }
  std::string refusal() const {
    if (base_watch.motors_stay() || base_watch.moves())
      return "still moves, or its motors are on though switched off; it stays held";
    return base_watch.refusal();
  }
  bool is_levelled_wrong() const { return !levelling_witness.finding().empty() && !unlevelled && !is_only_mapping(); }
  bool is_empty() const { return battery_watch.empty() && !is_only_mapping(); }
  void wake_base() const {
    if (base_thread) base_thread->wake();
  }

  /// In the operator's thread: it waits neither for the core nor for a device.
  void listen() {
    operator_ns = heartbeat.last(host_now()).ns;
    const std::lock_guard<std::mutex> lock(listen_mutex);
    if (hand) drive_by_hand(hand());
    if (!wish) return;
    const OperatorWish wanted = wish();
    if (wanted == OperatorWish::EmergencyStop && !emergency) emergency_stop();
    if (wanted == OperatorWish::Stop) stop();
    if (wanted != OperatorWish::Leave) return;
    if (base_thread) base_thread->end();
    wish = {};
    if (left) left();
  }

  void drive_by_hand(const Drive& wanted) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (wanted.v == commands.drive.v && wanted.w == commands.drive.w) return;
      commands.drive = wanted;
    }
    wake_base();
  }

  void stop() {
    if (stopped.exchange(true)) return;
    stopped_ns = host_now().ns;
    with_base([this] { base->stop(); });
    wake_base();
  }

  void emergency_stop() {
    if (!emergency.exchange(true)) stopped_ns = host_now().ns;
    with_base([this] { base->emergency_stop(); });
    wake_base();
  }

  /// In the base's thread, every 20 ms at the latest: what the motors may do now.
  void watch(Stamp now) {
    const std::lock_guard<std::mutex> lock(mutex);
    const bool fresh = commanded != Stamp::never() && now - commanded <= settings.safety.core_silence;
    const bool ours = armed && !is_taken() && !holds_itself();
    const bool allowed = ours && !emergency && !stopped;
    const BaseDriver::Answers answers = base->answers(now);
    const bool heard = is_base_answering(answers, now);
    const bool free = allowed && heard && fresh && standstill.is_over(now, time_asleep()) &&
                      is_base_reporting(base->ready(), base->last_report(), now) && is_lidar_well(now) &&
                      is_unit_well(now) && is_operator_well(now);
    if (allowed) base->enable(true);
    if (armed && !ours) base->enable(false);  // somebody else may have stopped it meanwhile
    if (std::exchange(brake_asked, false) && allowed) base->brake();
    const Drive wanted = free ? commands.drive : Drive{};
    base->drive(wanted);
    // Reports that come without a pause are hardly later than the base may be silent.
    const double late = answers.missing ? settings.safety.base_silence : answers.late;
    mind_base({wanted, allowed && heard, armed && !allowed, allowed && !heard, late, base->watchdog()}, now);
    if (scan_answered != Stamp::never()) scan_leaving = std::exchange(scan_answered, Stamp::never());
  }

  /// In the base's thread.
  void mind_base(BaseTurn turn, Stamp now) {
    turn.ready = base->ready();
    turn.motors_on = base->motors_on();
    turn.held = base->hold() != BaseDriver::Hold::None;
    turn.own_ramp = base->own_ramp();
    std::vector<Odometry> reports = base->take_odometry();
    turn.jumps = base->jumps();
    turn.identity = base->who();
    if (turn.ready) look_at_battery(now);
    if (base_watch.look(turn, reports, now)) base->emergency_stop();
    scan_watch.look(reports);
    append(waiting_odometry, std::move(reports));
  }

  /// In the base's thread, with the mutex taken.
  void look_at_battery(Stamp now) {
    constexpr double kPeriod = 1.0;  // at which it is told [s]
    const double volts = base->battery();
    battery_watch.look(volts, now);
    if (volts <= 0.0 || (battery_told != Stamp::never() && now - battery_told < kPeriod)) return;
    battery_told = now;
    // With an empty one the robot is held, and drives on when the operator says so: then he has the say, not its alarm.
    waiting_battery = {volts, volts < settings.safety.battery_empty ? 0.0 : settings.safety.battery_low};
  }

  std::optional<BatteryState> take_battery() {
    const std::lock_guard<std::mutex> lock(mutex);
    return std::exchange(waiting_battery, std::nullopt);
  }

  /// In the base's thread, after each turn of it: what watch() let pass has been sent.
  void left_for_base(Stamp now) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (scan_leaving != Stamp::never()) delays.push_back(now - std::exchange(scan_leaving, Stamp::never()));
  }

  /// Since the operator said so last, another program seemed to have the base: it may have stopped the robot.
  bool is_taken() const { return base_thread && base_thread->turned_away() > pardoned; }

  bool is_lidar_silent(const ScannerStatus& scanner, Stamp now) const {
    return scanner.last_scan == Stamp::never() || now - scanner.last_scan > settings.safety.lidar_silence;
  }
  /// Of the newest scan's last beam: a line or a computer that hands scans over late shows the world as it was.
  static double age(const ScannerStatus& scanner, Stamp now) { return now - scanner.last_scan + scanner.latency; }
  bool is_lidar_well(Stamp now) const { return is_lidar_well(lidar.status(), now); }
  bool is_lidar_well(const ScannerStatus& scanner, Stamp now) const {
    if (is_lidar_silent(scanner, now)) return false;  // its own trouble, and over with the next scan
    freshness.look(age(scanner, now), settings.safety.lidar_age, now);
    return !freshness.stale() && (is_only_mapping() || !scan_watch.holds());
  }
  /// Somebody else drives, by other means: what the scanner does not see holds nobody.
  bool is_only_mapping() const { return settings.base.passive; }
  bool is_base_reporting(bool ready, Stamp last, Stamp now) const {
    return ready && last != Stamp::never() && now - last <= settings.safety.base_silence;
  }
  bool is_base_answering(const BaseDriver::Answers& given, Stamp now) const { return base_answers.look(given, now); }
  bool is_unit_silent(Stamp last, Stamp now) const {
    return last == Stamp::never() || now - last > settings.safety.levelling_silence;
  }
  bool is_unit_well(Stamp now) const {
    if (!unit_thread) return true;
    const auto [ready, last, given] =
        unit_thread->with([&] { return std::make_tuple(unit.ready(), unit.last_report(), unit.answers(now)); });
    if (!ready || is_unit_silent(last, now)) return false;
    return unit_answers.look(given, now);
  }
  bool is_operator_well(Stamp now) const {
    if (settings.heartbeat.empty()) return true;
    const Stamp last{operator_ns.load()};
    return last != Stamp::never() && now - last <= settings.safety.operator_silence;
  }

  /// A line that hands scans over in bundles makes the scanner look silent though it turns.
  Hindrance silent_lidar(const ScannerStatus& scanner, bool underway, Stamp now) const {
    const bool held_up = scanner.error.empty() && scanner.recent_latency > settings.safety.lidar_silence;
    if (!held_up)
      return silent_for("urg", underway, scanner.last_scan, now, scanner.error,
                        scanner.slow ? Cause::Late : Cause::Silent);
    char text[120];
    std::snprintf(text, sizeof text, "the line or this computer holds scans up, by %.1f s of late",
                  scanner.recent_latency);
    return silent_for("urg", underway, scanner.last_scan, now, text, Cause::Late);
  }

  /// What keeps the robot from being driven at `now`.
  std::vector<Hindrance> silent(Stamp now) const {
    std::vector<Hindrance> all;
    const bool underway = first != Stamp::never();
    const ScannerStatus scanner = lidar.status();
    if (!is_lidar_well(scanner, now)) {
      if (is_lidar_silent(scanner, now)) {
        all.push_back(silent_lidar(scanner, underway, now));
      } else if (!freshness.stale()) {
        all.push_back({"urg", Cause::Faulty, scan_watch.trouble()});
      } else {
        char text[80];
        std::snprintf(text, sizeof text, "its scans are %.1f s old; the line or this computer is too slow",
                      freshness.stale().value_or(age(scanner, now)));
        all.push_back({"urg", Cause::Late, text});
      }
    }
    if (underway && !standstill.is_over(now, time_asleep())) {
      char text[80];
      std::snprintf(text, sizeof text, "stood still for %.1f s", standstill.seconds(now, time_asleep()));
      all.push_back({"this computer", Cause::Late, text});
    }
    if (base_thread) add_silent_base(all, underway, now);
    add_silent_helpers(all, underway, now);
    return all;
  }

  void add_silent_base(std::vector<Hindrance>& all, bool underway, Stamp now) const {
    const auto [last, ready, state, hold, answered, slow] = with_base([this, now] {
      return std::make_tuple(base->last_report(), base->ready(), base->state(), base->hold(), base->answers(now),
                             base->slow());
    });
    const auto hold_it = [&](const std::string& why) { all.push_back({"base", Cause::Held, why}); };
    const auto [name_held, why_held, motors_stay, moves, goes_on] = watched([](const BaseWatch& watch) {
      return std::make_tuple(watch.held_name(), watch.held(), watch.motors_stay(), watch.moves(),
                             watch.moves_though_held());
    });
    if (!why_held.empty()) all.push_back({name_held, Cause::Held, why_held});
    if (goes_on && underway && !motors_stay)
      all.push_back({"base", Cause::Disobeys, "moves though it is held; see who drives or pushes it"});
    const double volts = watched([this](const BaseWatch&) { return is_empty() ? battery_watch.volts() : 0.0; });
    if (volts > 0.0) {
      char text[120];
      std::snprintf(text, sizeof text, "its battery is empty: %.1f V of at least %g V (safety.battery_empty_v)", volts,
                    settings.safety.battery_empty);
      hold_it(text);
    }
    const std::string error = base_thread->error();
    if (motors_stay && error.empty()) hold_it(kMotorsStay);  // not connected, nobody knows
    if (!underway && moves && !settings.base.passive)
      all.push_back({"base", Cause::Disobeys, "moves though nobody here drives it; it is taken when it stands"});
    if (underway && is_taken()) hold_it("another program may have had it; see who drives the robot");
    if (hold == BaseDriver::Hold::EmergencyButton) hold_it("emergency button pressed");
    if (hold == BaseDriver::Hold::MotorsOff) hold_it("motors were switched off");
    if (!is_base_reporting(ready, last, now)) {
      const std::string how = ready ? "" : state;  // the state of one that fell silent just now is that it reports
      all.push_back(silent_for("base", underway, last, now, error.empty() ? how : error,
                               error.empty() && slow ? Cause::Late : Cause::Silent));
    } else if (!is_base_answering(answered, now)) {
      all.push_back({"base", Cause::Late, base_answers.trouble(answered)});
    }
  }

  /// The levelling unit and the operator.
  void add_silent_helpers(std::vector<Hindrance>& all, bool underway, Stamp now) const {
    const std::string wrong =
        watched([this](const BaseWatch&) { return is_levelled_wrong() ? levelling_witness.finding() : std::string(); });
    if (!wrong.empty()) all.push_back({"levelling", Cause::Held, wrong});
    if (!is_unit_well(now)) {
      const auto [reported, how, given] = unit_thread->with([&] {
        const Stamp last = unit.ready() ? unit.last_report() : Stamp::never();
        return std::make_tuple(last, unit.ready() ? std::string() : unit.state(), unit.answers(now));
      });
      const std::string error = unit_thread->error();
      if (is_unit_silent(reported, now)) {
        all.push_back(silent_for("levelling", underway, reported, now, error.empty() ? how : error));
      } else {
        all.push_back({"levelling", Cause::Late, unit_answers.trouble(given)});
      }
    }
    if (!is_operator_well(now))
      all.push_back(
          silent_for("heartbeat", underway, {operator_ns.load()}, now, settings.heartbeat + " must be touched"));
  }

  RobotStatus status(Stamp now) const {
    RobotStatus s;
    s.silent = silent(now);
    const bool named_only = is_only_mapping() || !scan_watch.holds();
    if (named_only && !scan_watch.is_well()) s.troubles.push_back({"urg", Cause::Faulty, scan_watch.trouble()});
    s.emergency = emergency;
    s.held = is_held();
    s.blind = is_blind();
    s.taken = first != Stamp::never() && (is_taken() || is_held_by_us());
    s.begun = first != Stamp::never();
    s.scans = scans;
    s.odometry = odometry;
    s.accelerations = accelerations;
    with_base([&] {
      s.motors_on = base->motors_on();
      s.reported = base->last_report() != Stamp::never() && base->last_report() > Stamp{stopped_ns.load()};
      s.battery = base->battery();
      s.bad_packets = base->bad_sums();
      s.jumps = base->jumps();
      const std::lock_guard<std::mutex> lock(mutex);
      s.odometry += waiting_odometry.size();
      s.moves = base_watch.moves();
      if (read_pose && !waiting_odometry.empty()) s.unread = waiting_odometry.back().pose - *read_pose;
      s.mend = is_levelled_wrong() ? "see to its servos and the robot file; after R it is not levelled any more"
               : is_empty()        ? "charge or change its battery"
                                   : base_watch.mend();
      add_battery(s.troubles);
      if (unlevelled) s.troubles.push_back({"levelling", Cause::Faulty, "off since it did not take the tilt away"});
      if (is_only_mapping() && !levelling_witness.finding().empty())
        s.troubles.push_back({"levelling", Cause::Faulty, levelling_witness.finding()});
      s.motors_stay = base_watch.motors_stay();
      s.doubted = base_watch.doubted();
      s.refusal = refusal();
      append(s.troubles, base_watch.troubles());
    });
    if (unit_thread) {
      unit_thread->with([&] {
        s.bad_packets += unit.bad_lines();
        s.accelerations += unit.waiting_accelerations();
        if (unit.sensor_fault())
          s.troubles.push_back({"levelling", Cause::Faulty, "its accelerometer gives no signal; the servos hold"});
      });
    }
    const ScannerStatus scanner = lidar.status();
    s.scans_damaged = scanner.damaged;
    s.scans_missed = scanner.missed;
    return s;
  }

  /// With the mutex taken.
  void add_battery(std::vector<Hindrance>& troubles) const {
    if (!battery_watch.low() || is_empty()) return;
    char text[120];
    std::snprintf(text, sizeof text,
                  "its battery is low: %.1f V of at least %g V (safety.battery_low_v); charge it soon",
                  battery_watch.volts(), settings.safety.battery_low);
    troubles.push_back({"base", Cause::Faulty, text});
  }

  bool is_held() const {
    if (first != Stamp::never() && is_taken()) return true;
    if (is_held_by_us()) return true;
    return with_base([this] { return base->hold() != BaseDriver::Hold::None; });
  }

  void take_scans(Stamp now) {
    const Stamp arrived = lidar.status().last_scan;  // asked first: at most older than what is taken
    std::vector<LaserScan> fresh = lidar.take();
    if (fresh.empty()) return;
    {
      const std::lock_guard<std::mutex> lock(mutex);  // commands may come from another thread
      scan_arrived = arrived == Stamp::never() ? now : arrived;
    }
    scans += fresh.size();
    show_to_watch(fresh, now);
    if (scan_watch.holds()) return;  // a map of what a covered scanner takes for free is none
    append(waiting_scans, std::move(fresh));
    if (waiting_scans.size() > kMostScansKept) thin_waiting_scans();
  }

  void show_to_watch(const std::vector<LaserScan>& fresh, Stamp now) {
    const std::lock_guard<std::mutex> lock(mutex);
    for (const LaserScan& scan : fresh) {
      scan_watch.see(scan, now);
      base_watch.see(scan, now);
    }
  }

  /// The robot is held for long: every second of the older scans goes. How it was moved while it came to rest, when
  /// nothing but scans can tell, stays known.
  void thin_waiting_scans() {
    const std::size_t older = waiting_scans.size() - kNewestScansKept;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < waiting_scans.size(); ++i)
      if (i >= older || i % 2 == 0) waiting_scans[kept++] = std::move(waiting_scans[i]);
    waiting_scans.resize(kept);
  }

  Commands commands_in_force() {
    const std::lock_guard<std::mutex> lock(mutex);
    return commands;
  }

  /// What was asked for before a wait is not what is wanted after it.
  void forget_drive() {
    const std::lock_guard<std::mutex> lock(mutex);
    commands.drive = {};
  }

  std::vector<Odometry> take_odometry() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!waiting_odometry.empty()) read_pose = waiting_odometry.back().pose;
    return std::exchange(waiting_odometry, {});
  }

  /// What levels the scanner the wrong way stands level from then on.
  void mind_levelling(const Inputs& inputs) {
    if (settings.model.accelerometer_mount != AccelerometerMount::Platform) return;
    bool wrong = false;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const std::size_t n = std::min(inputs.accelerations.size(), inputs.aims.size());
      for (std::size_t i = 0; i < n; ++i) levelling_witness.look(inputs.accelerations[i], inputs.aims[i]);
      wrong = is_levelled_wrong();
    }
    if (wrong && unit_thread) unit_thread->with([&] { unit.aim({}); });
  }

  Inputs collect() {
    Inputs inputs;
    inputs.scans = std::exchange(waiting_scans, {});
    inputs.odometry = take_odometry();
    inputs.battery = take_battery();
    if (unit_thread) {
      unit_thread->with([&] {
        inputs.accelerations = unit.take_accelerations();
        inputs.aims = unit.take_aims();
      });
    }
    mind_levelling(inputs);
    odometry += inputs.odometry.size();
    accelerations += inputs.accelerations.size();
    inputs.command = commands_in_force();
    // A clock that is mapped may run ahead by microseconds; nothing lies behind the end of the tick.
    inputs.now = std::max(host_now(), last_now);
    // What does waits for the next tick, so that the log has the stamps that the drivers gave.
    early_odometry.hold_back(inputs.odometry, inputs.now);
    early_accelerations.hold_back(inputs.accelerations, inputs.now);
    early_aims.hold_back(inputs.aims, inputs.now);
    sort_by_stamp(inputs.scans);
    sort_by_stamp(inputs.accelerations);
    sort_by_stamp(inputs.aims);
    last_now = inputs.now;
    return inputs;
  }

  /// A robot that was held all the time, such as by its emergency button, is waited for as long as it takes; but not
  /// beyond the time that the drive was given.
  bool is_over_before_it_began(Stamp now) const {
    return settings.time_limit > 0.0 && now - created >= settings.safety.start + settings.time_limit;
  }

  bool is_over(Stamp now) const { return settings.time_limit > 0.0 && now - first >= settings.time_limit; }

  /// Another program has this robot. It is not waited for: it would be taken over when that one stops it.
  void refuse_busy_devices() const {
    std::vector<std::string> lines;
    if (const ScannerStatus scanner = lidar.status(); scanner.busy) lines.push_back("urg: " + scanner.error);
    for (const DeviceThread* thread : {base_thread.get(), unit_thread.get()})
      if (thread != nullptr && thread->busy()) lines.push_back(thread->name() + ": " + thread->error());
    if (!lines.empty()) throw DeviceLost(joined(lines));
  }

  /// Somebody seemed to have this robot and has let it go, perhaps by an emergency stop: a person must say "go".
  void refuse_released_devices() const {
    std::vector<std::string> names;
    if (lidar.status().turned_away > 0) names.emplace_back("urg");
    for (const DeviceThread* thread : {base_thread.get(), unit_thread.get()})
      if (thread != nullptr && thread->turned_away() > 0) names.push_back(thread->name());
    if (names.empty()) return;
    throw DeviceLost(joined(names) +
                     ": hung up at first, so another program may have had the robot, and stopped it; "
                     "see that the robot is free and start again");
  }

  /// Waits while something is silent. False: the run was ended meanwhile.
  bool wait_for_all() {
    for (;;) {
      const Stamp now = host_now();
      const std::vector<Hindrance> hindrances = silent(now);
      if (hindrances.empty()) {
        held_since = Stamp::never();
        if (first == Stamp::never()) refuse_released_devices();
        return true;
      }
      if (emergency) return false;
      if (first != Stamp::never() && !standstill.is_over(now, time_asleep()) &&
          standstill.seconds(now, time_asleep()) > settings.safety.give_up)
        throw DeviceLost(joined(lines_of(hindrances)) + "; see that the robot stands, and start again");
      if (held_since == Stamp::never()) {
        held_since = now;
        forget_drive();
      }
      const bool blind = is_blind();
      if (is_held() && !blind) held_since = now;  // somebody is at the robot: it is not lost
      const bool starting = first == Stamp::never();
      if (blind && is_over(now)) throw DeviceLost(joined(lines_of(hindrances)) + "; the time is over");
      if (!starting && is_over(now)) return false;
      if (starting && is_held() && is_over_before_it_began(now)) return false;
      if (starting) refuse_busy_devices();
      if (now - held_since > (starting ? settings.safety.start : settings.safety.give_up))
        throw DeviceLost(joined(lines_of(hindrances)) + remedy(hindrances, starting));
      if (ask && !ask(status(now))) return false;
      take_scans(now);
      sleep_until(now + kAsk);
    }
  }

  std::optional<Inputs> read() {
    if (emergency) return std::nullopt;
    if (!wait_for_all()) return std::nullopt;
    Stamp now = host_now();
    if (first == Stamp::never()) {
      first = now;
      waiting_scans.clear();
      lidar.take();
      collect();  // what came before the run belongs to nobody
      const std::lock_guard<std::mutex> lock(mutex);
      armed = true;
      tick_end = now;
    }
    if (is_over(now)) return std::nullopt;
    tick_end = tick_end + settings.model.tick;
    if (tick_end < now) tick_end = now;  // the core took longer than a tick, or devices were waited for
    for (;;) {
      pollfd file{lidar.descriptor(), POLLIN, 0};
      const double left = std::max(0.0, tick_end - host_now());
      const timespec limit{static_cast<time_t>(left), static_cast<long>((left - static_cast<int>(left)) * 1e9)};
      const int ready = ::ppoll(&file, 1, &limit, nullptr);
      now = host_now();
      if (ready > 0) take_scans(now);
      if (!waiting_scans.empty()) tick_end = now;
      if (emergency) return std::nullopt;
      if (now >= tick_end) return collect();
    }
  }
};

RealRobot::RealRobot(const RealRobotSettings& settings, Scanner& lidar, BlackBox* box)
    : impl_(std::make_unique<Impl>(settings, lidar, box)) {}

RealRobot::~RealRobot() = default;

const RobotModel& RealRobot::model() const { return impl_->settings.model; }

std::optional<Inputs> RealRobot::read() { return impl_->read(); }

void RealRobot::command(const Commands& commands) {
  Impl& robot = *impl_;
  const Stamp now = host_now();
  {
    const std::lock_guard<std::mutex> lock(robot.mutex);
    robot.commands = commands;
    robot.brake_asked = robot.brake_asked || commands.brake;
    robot.commanded = now;
    robot.scan_answered = std::exchange(robot.scan_arrived, Stamp::never());
  }
  robot.wake_base();
  if (robot.unit_thread && robot.settings.model.has_levelling_unit) {
    const bool level = robot.watched([&](const BaseWatch&) { return !robot.unlevelled && !robot.is_levelled_wrong(); });
    robot.unit_thread->with([&] { robot.unit.aim(level ? commands.aim : LaserAim{}); });
    robot.unit_thread->wake();
  }
}

void RealRobot::emergency_stop() { impl_->emergency_stop(); }

void RealRobot::stop() { impl_->stop(); }

bool RealRobot::rearm() {
  if (!impl_->watched([this](const BaseWatch&) { return impl_->refusal(); }).empty()) return false;
  if (impl_->base_thread) impl_->pardoned = impl_->base_thread->turned_away();
  impl_->with_base([this] {
    impl_->base->rearm();
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->base_watch.rearm();
    impl_->battery_watch.pardon();
    impl_->unlevelled = impl_->unlevelled || impl_->is_levelled_wrong();
  });
  impl_->wake_base();
  return true;
}

void RealRobot::listen(std::function<OperatorWish()> ask, std::function<void()> left) {
  const std::lock_guard<std::mutex> lock(impl_->listen_mutex);
  impl_->wish = std::move(ask);
  impl_->left = std::move(left);
}

void RealRobot::steer_by_hand(std::function<Drive()> hand) {
  const std::lock_guard<std::mutex> lock(impl_->listen_mutex);
  impl_->hand = std::move(hand);
}

void RealRobot::while_waiting(std::function<bool(const RobotStatus&)> ask) { impl_->ask = std::move(ask); }

RobotStatus RealRobot::status() const { return impl_->status(host_now()); }

std::vector<double> RealRobot::answer_delays() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->delays;
}

}  // namespace rubble::robot
