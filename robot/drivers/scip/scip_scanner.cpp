#include "robot/drivers/scip/scip_scanner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "robot/drivers/clock_map.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/port_word.h"
#include "robot/drivers/scan_queue.h"
#include "robot/drivers/scip/scip_link.h"
#include "robot/drivers/scip/scip_scan.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot {
namespace {

constexpr double kMillisecond = 1e-3;
constexpr double kPause = 0.05;  // the thread asks so often whether it shall end [s]

}  // namespace

struct ScipScanner::Impl {
  ScipScannerConfig config;
  ScanQueue queue;
  std::mutex mutex;
  std::condition_variable ended;
  bool ending = false;
  std::thread thread;

  explicit Impl(const ScipScannerConfig& given) : config(given) {
    check_port_word(config.port);
    thread = std::thread([this] { run(); });
  }
  ~Impl() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ending = true;
    }
    ended.notify_all();
    thread.join();
  }

  bool is_ending() {
    const std::lock_guard<std::mutex> lock(mutex);
    return ending;
  }

  void run() {
    while (!is_ending()) {
      try {
        converse();
      } catch (const std::exception& error) {
        const std::string what = error.what();
        queue.update([&](ScannerStatus& status) {
          status.connected = false;
          status.error = what;
        });
        std::unique_lock<std::mutex> lock(mutex);
        ended.wait_for(lock, std::chrono::duration<double>(config.retry), [this] { return ending; });
      }
    }
  }

  /// One connection, from the opened port until it breaks or the driver ends.
  void converse() {
    scip::Link link(config.open(config.port));
    std::uint64_t counted = 0;  // damaged replies of this connection that the status knows
    const auto count_damaged = [&] {
      const std::uint64_t all = link.damaged();
      queue.update([&](ScannerStatus& status) { status.damaged += all - counted; });
      counted = all;
    };
    link.shake_hands(config.only_scip1);
    ClockMapConfig clock_config;
    clock_config.usual_delay = usual_delay(link.geometry());
    ClockMap map(clock_config);
    WrappingClock clock(scip::kClockWrap, kMillisecond);
    link.ask_time(clock, map);
    link.start();
    queue.set_info(link.info());
    queue.update([](ScannerStatus& status) {
      status.connected = true;
      status.error.clear();
      status.worst_latency = 0.0;
      ++status.connects;
    });
    Stamp last_heard = host_now();
    double last_turn = -1.0;
    while (!is_ending()) {
      const auto sweep = link.next_sweep(kPause);
      if (link.damaged() != counted) count_damaged();
      if (sweep) {
        last_heard = host_now();
        deliver(link, *sweep, clock, map, last_turn);
      } else if (host_now() - last_heard > config.silence) {
        throw DeviceLost(config.port + ": the scanner is silent; it is started anew, check its cable and power");
      }
    }
    link.stop();
  }

  /// From step 0 to the arrival at the soonest: the device sends when the last step is measured.
  static double usual_delay(const scip::Geometry& geometry) {
    const double last_of_turn = 0.75 * geometry.period();  // step 768 of 1024: the rest of the turn is blind
    return std::max(last_of_turn, geometry.after_sweep());
  }

  void deliver(const scip::Link& link, const scip::Sweep& sweep, WrappingClock& clock, ClockMap& map,
               double& last_turn) {
    const double period = link.geometry().period();
    Stamp turn = link.begun() - usual_delay(link.geometry());
    double missed = 0.0;
    if (link.is_scip2()) {
      const WrappingClock::Reading reading = clock.read(sweep.clock_ms, link.begun());
      if (reading.restarted) {
        map.clear();
        last_turn = -1.0;
      }
      // A doubled turn says nothing new; one that goes back would break the order that all readers count on.
      if (last_turn >= 0.0 && reading.time - last_turn < 0.5 * period) return;
      if (last_turn >= 0.0) missed = std::round((reading.time - last_turn) / period) - 1.0;
      last_turn = reading.time;
      map.add(reading.time, link.begun());
      turn = map.host(reading.time);
    }
    LaserScan scan = scip::scan_of(sweep, link.geometry(), {config.range_max, config.no_echo_is_miss}, turn);
    const double latency = link.ended() - (turn + link.geometry().after_sweep());
    queue.update([&](ScannerStatus& status) {
      ++status.scans;
      status.missed += static_cast<std::uint64_t>(std::max(0.0, missed));
      status.latency = latency;
      status.worst_latency = std::max(status.worst_latency, latency);
      status.clock_drift = map.drift();
      status.clock_doubt = map.doubt().value_or(0.0);
    });
    queue.put(std::move(scan));
  }
};

ScipScanner::ScipScanner(const ScipScannerConfig& config) : impl_(std::make_unique<Impl>(config)) {}
ScipScanner::~ScipScanner() = default;

std::vector<LaserScan> ScipScanner::take() { return impl_->queue.take(); }
ScannerStatus ScipScanner::status() const { return impl_->queue.status(); }
ScannerInfo ScipScanner::info() const { return impl_->queue.info(); }
int ScipScanner::descriptor() const { return impl_->queue.descriptor(); }

}  // namespace rubble::robot
