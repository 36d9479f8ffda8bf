#include "robot/emulators/scip/urg_emulator.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/scip/scip_text.h"
#include "robot/emulators/port_server.h"
#include "robot/emulators/scip/scip_device.h"

namespace rubble::robot {
namespace {

constexpr std::size_t kSlowPiece = 16;     // bytes that leave together on a line with a bit rate
constexpr double kLongestWait = 0.1;       // [s]
constexpr std::size_t kMostPublished = 8;  // turns that wait for the thread

std::uint32_t value_of(const LaserScan& scan, std::size_t beam, const scip::Geometry& geometry) {
  const float range = scan.ranges[beam];
  if (std::isinf(range)) return scip::kNoEcho;
  const long mm = std::isnan(range) ? 0 : std::lround(1000.0 * static_cast<double>(range));
  if (mm >= static_cast<long>(scip::kFirstRange))
    return static_cast<std::uint32_t>(std::min<long>(mm, geometry.most_mm));
  const bool has_code = beam < scan.codes.size() && scan.codes[beam] > 0 && scan.codes[beam] < scip::kFirstRange;
  return has_code ? scan.codes[beam] : scip::kOtherError;
}

/// The scan as numbers of all steps; beams are those nearest to a step's bearing.
std::vector<std::uint32_t> values_of(const LaserScan& scan, const scip::DeviceIdentity& identity) {
  const scip::Geometry& g = identity.geometry;
  std::vector<std::uint32_t> values(static_cast<std::size_t>(identity.last_of_all) + 1, scip::kNotMeasurable);
  for (int step = g.first_step; step <= g.last_step; ++step) {
    const double bearing = (step - g.front_step) * g.step_angle();
    const long beam = std::lround((bearing - scan.angle_min) / scan.angle_step);
    if (beam < 0 || beam >= static_cast<long>(scan.ranges.size())) continue;
    values[static_cast<std::size_t>(step)] = value_of(scan, static_cast<std::size_t>(beam), g);
  }
  return values;
}

}  // namespace

std::uint32_t clock_before_wrap(double seconds) {
  return static_cast<std::uint32_t>(scip::kClockWrap - std::clamp(1e3 * seconds, 1.0, 1.0 * scip::kClockWrap));
}

struct UrgEmulator::Impl {
  struct Outgoing {
    Stamp due;
    std::string bytes;
    bool is_scan = false;
  };

  UrgEmulatorConfig config;
  scip::Device device;
  std::unique_ptr<PortServer> server;
  const std::string word = server->name();
  Descriptor wake{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  Stamp power_on = host_now();
  Rng jitter;
  BadLine bad_line;
  std::deque<Outgoing> outgoing;  // the thread's own

  mutable std::mutex mutex;  // guards what follows
  std::vector<LaserScan> published;
  UrgEmulatorStatus status;
  ByteFault fault = ByteFault::None;
  Stamp fault_until = Stamp::never(), silent_until = Stamp::never(), unplugged_until = Stamp::never();
  bool cycle_power = false;
  bool ending = false;

  std::thread thread;

  explicit Impl(const UrgEmulatorConfig& given)
      : config(given),
        device(scip::identity_of(given.laser)),
        server(serve_port(given.port)),
        jitter(given.seed, "jitter"),
        bad_line(given.seed) {
    device.set_clock(0.0, config.clock_start);
    thread = std::thread([this] { run(); });
  }
  ~Impl() {
    change([this] { ending = true; });
    thread.join();
  }

  /// Changes what the thread looks at, and wakes it.
  template <typename Change>
  void change(const Change& what) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      what();
    }
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(wake.get(), &one, sizeof one);
  }

  /// Seconds by the device's own crystal since the emulator was made.
  double device_time(Stamp host) const { return (host - power_on) / (1.0 + config.clock_drift); }

  void run() {
    bool plugged = true;
    for (;;) {
      wait();
      std::vector<LaserScan> scans;
      bool restart = false, silent = false, pulled = false;
      const Stamp now = host_now();
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (ending) return;
        scans = std::exchange(published, {});
        restart = std::exchange(cycle_power, false);
        silent = now < silent_until;
        pulled = now < unplugged_until;
      }
      if (pulled != !plugged) plugged = move_plug(pulled, now);
      if (restart) {
        device.cycle_power(device_time(now));
        outgoing.clear();
      }
      hear(now, silent || pulled);
      for (const LaserScan& scan : scans) {
        if (!silent && !pulled) turn(scan);
      }
      send();
    }
  }

  bool move_plug(bool pulled, Stamp now) {
    outgoing.clear();
    if (pulled) {
      server->unplug();
    } else {
      device.cycle_power(device_time(now));
      try {
        server->plug_in();
      } catch (const std::exception&) {
        // Another program has taken the name meanwhile; it may let go of it again.
        const std::lock_guard<std::mutex> lock(mutex);
        unplugged_until = now + 0.5;
        return false;
      }
    }
    return !pulled;
  }

  void wait() {
    double left = kLongestWait;
    if (!outgoing.empty()) left = std::clamp(outgoing.front().due - host_now(), 0.0, kLongestWait);
    pollfd entries[2] = {{wake.get(), POLLIN, 0}, {server->descriptor(), POLLIN, 0}};
    const timespec limit{0, static_cast<long>(left * 1e9)};
    ppoll(entries, 2, &limit, nullptr);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(wake.get(), &count, sizeof count);
  }

  void hear(Stamp now, bool deaf) {
    std::array<std::uint8_t, 1024> bytes;
    const Served served = server->read(bytes.data(), bytes.size(), 0.0);
    if (served.client_left) {
      device.client_left();
      outgoing.clear();
    }
    if (served.client_came) {
      const std::lock_guard<std::mutex> lock(mutex);
      ++status.clients;
    }
    if (deaf) return;
    const auto replies = device.receive(bytes.data(), served.size, device_time(now));
    // When the stream was stopped, turns that wait to be sent are sent no more.
    if (!replies.empty() && !device.laser_is_on() && config.baud == 0) drop_scans();
    for (const std::string& reply : replies) queue(reply, now, false);
  }

  void drop_scans() {
    outgoing.erase(std::remove_if(outgoing.begin(), outgoing.end(), [](const Outgoing& o) { return o.is_scan; }),
                   outgoing.end());
  }

  void turn(const LaserScan& scan) {
    const scip::Geometry& g = device.identity().geometry;
    const Stamp step0 = scan.stamp - (scan.angle_min / g.step_angle() + g.front_step) * g.step_time();
    const double late = jitter.uniform(0.0, config.jitter);
    const Stamp due = step0 + (device.identity().last_of_all * g.step_time() + late);
    for (const std::string& block : device.turn(device_time(step0), values_of(scan, device.identity())))
      queue(block, due, true);
  }

  void queue(const std::string& bytes, Stamp due, bool is_scan) {
    ByteFault spoilt;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (is_scan && config.baud > 0 && !outgoing.empty()) {
        ++status.dropped;
        return;
      }
      spoilt = host_now() < fault_until ? fault : ByteFault::None;
    }
    // One after the other: nothing overtakes what waits.
    if (!outgoing.empty()) due = std::max(due, outgoing.back().due, [](Stamp a, Stamp b) { return a < b; });
    if (config.baud > 0) return queue_slowly(bytes, due, is_scan);
    for (const std::string& piece : bad_line.spoil(bytes, spoilt)) {
      outgoing.push_back({due, piece, is_scan});
      if (spoilt == ByteFault::Split) due = due + kSplitPause;
    }
  }

  void queue_slowly(const std::string& bytes, Stamp due, bool is_scan) {
    for (std::size_t at = 0; at < bytes.size(); at += kSlowPiece) {
      const std::string piece = bytes.substr(at, kSlowPiece);
      due = due + 10.0 * static_cast<double>(piece.size()) / config.baud;
      outgoing.push_back({due, piece, is_scan && at + kSlowPiece >= bytes.size()});
    }
  }

  void send() {
    while (!outgoing.empty() && outgoing.front().due <= host_now()) {
      const Outgoing next = std::move(outgoing.front());
      outgoing.pop_front();
      const Stamp now = host_now();
      const bool taken = server->write(reinterpret_cast<const std::uint8_t*>(next.bytes.data()), next.bytes.size());
      if (next.is_scan && taken && config.scan_sent) config.scan_sent(host_now());
      const std::lock_guard<std::mutex> lock(mutex);
      status.dropped += taken ? 0 : 1;
      if (!next.is_scan || !taken) continue;
      ++status.sent;
      status.worst_lateness = std::max(status.worst_lateness, now - next.due);
    }
  }
};

UrgEmulator::UrgEmulator(const UrgEmulatorConfig& config) : impl_(std::make_unique<Impl>(config)) {}
UrgEmulator::~UrgEmulator() = default;

const std::string& UrgEmulator::port() const { return impl_->word; }

void UrgEmulator::publish(const LaserScan& scan) {
  impl_->change([&] {
    if (impl_->published.size() == kMostPublished) impl_->published.erase(impl_->published.begin());
    impl_->published.push_back(scan);
  });
}

void UrgEmulator::spoil(ByteFault fault, double duration) {
  impl_->change([&] {
    impl_->fault = fault;
    impl_->fault_until = host_now() + duration;
  });
}

void UrgEmulator::fall_silent(double duration) {
  impl_->change([&] { impl_->silent_until = host_now() + duration; });
}

void UrgEmulator::cycle_power() {
  impl_->change([&] { impl_->cycle_power = true; });
}

void UrgEmulator::unplug(double duration) {
  impl_->change([&] { impl_->unplugged_until = host_now() + duration; });
}

UrgEmulatorStatus UrgEmulator::status() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->status;
}

}  // namespace rubble::robot
