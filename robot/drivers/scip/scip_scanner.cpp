#include "robot/drivers/scip/scip_scanner.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/scan_queue.h"
#include "robot/drivers/scip/scan_maker.h"
#include "robot/drivers/scip/scip_link.h"

namespace rubble::robot {
namespace {

constexpr double kLateEnd = 10.0;  // by then a connection that was closed is closed at the other end of a slow line [s]
constexpr double kPause = 0.05;    // the thread asks so often whether it shall end [s]

}  // namespace

struct ScipScanner::Impl {
  ScipScannerConfig config;
  ScanQueue queue;
  std::mutex mutex;
  std::condition_variable ended;
  bool ending = false;
  bool answered = false;           ///< the scanner, in this connection
  Stamp late_at = Stamp::never();  ///< when it answered too late last, and since nothing else happened
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
        const auto* hung_up = dynamic_cast<const TurnedAway*>(&error);
        const std::string what = hung_up != nullptr && answered ? hung_up->otherwise() : error.what();
        const bool busy = dynamic_cast<const PortBusy*>(&error) != nullptr;
        queue.update([&](ScannerStatus& status) {
          // Behind a line that is so slow it is our own connection of before that is still open.
          if (hung_up != nullptr && late_at != Stamp::never() && host_now() - late_at < kLateEnd) return;
          status.connected = false;
          status.busy = busy;
          status.slow = dynamic_cast<const scip::TooLate*>(&error) != nullptr;
          late_at = status.slow ? host_now() : Stamp::never();
          if (busy || (hung_up != nullptr && !answered)) ++status.turned_away;
          status.error = what;
        });
        std::unique_lock<std::mutex> lock(mutex);
        ended.wait_for(lock, std::chrono::duration<double>(config.retry), [this] { return ending; });
      }
    }
  }

  /// One connection, from the opened port until it breaks or the driver ends.
  void converse() {
    answered = false;
    scip::Link link(config.open(config.port));
    std::uint64_t counted = 0;  // damaged replies of this connection that the status knows
    const auto count_damaged = [&] {
      const std::uint64_t all = link.damaged();
      queue.update([&](ScannerStatus& status) { status.damaged += all - counted; });
      counted = all;
    };
    try {
      link.shake_hands(config.only_scip1);
    } catch (const DeviceLost&) {
      answered = link.answered();
      throw;
    }
    answered = true;
    scip::ScanMaker maker(link.geometry(), link.is_scip2(), {config.range_max, config.no_echo_is_miss});
    link.ask_time(maker.clock(), maker.map());
    link.start();
    queue.set_info(link.info());
    queue.update([](ScannerStatus& status) {
      status.connected = true;
      status.error.clear();
      status.busy = status.slow = false;
      status.worst_latency = 0.0;
      ++status.connects;
    });
    Stamp last_heard = host_now();
    while (!is_ending()) {
      const auto sweep = link.next_sweep(kPause);
      if (link.damaged() != counted) count_damaged();
      if (sweep) {
        last_heard = host_now();
        deliver(link, *sweep, maker);
      } else if (host_now() - last_heard > config.silence) {
        throw DeviceLost(config.port + ": the scanner is silent; it is started anew, check its cable and power");
      }
    }
    link.stop();
  }

  void deliver(const scip::Link& link, const scip::Sweep& sweep, scip::ScanMaker& maker) {
    auto made = maker.make(sweep, link.begun(), link.ended());
    if (!made) return;
    queue.update([&](ScannerStatus& status) {
      ++status.scans;
      status.missed += static_cast<std::uint64_t>(made->missed);
      status.latency = made->latency;
      status.worst_latency = std::max(status.worst_latency, made->latency);
      status.clock_drift = maker.map().drift();
      status.clock_doubt = maker.map().doubt().value_or(0.0);
    });
    queue.put(std::move(made->scan), host_now());
  }
};

ScipScanner::ScipScanner(const ScipScannerConfig& config) : impl_(std::make_unique<Impl>(config)) {}
ScipScanner::~ScipScanner() = default;

std::vector<LaserScan> ScipScanner::take() { return impl_->queue.take(); }
ScannerStatus ScipScanner::status() const { return impl_->queue.status(); }
ScannerInfo ScipScanner::info() const { return impl_->queue.info(); }
int ScipScanner::descriptor() const { return impl_->queue.descriptor(); }

}  // namespace rubble::robot
