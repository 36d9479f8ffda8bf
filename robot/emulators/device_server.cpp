#include "robot/emulators/device_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "robot/drivers/host_clock.h"

namespace rubble::robot {
namespace {

constexpr int kTurnMs = 10;  // the device's own timers are looked at so often at least

}  // namespace

DeviceServer::DeviceServer(const std::string& port, EmulatedDevice& device, std::uint64_t seed)
    : device_(device),
      server_(serve_port(port)),
      port_(server_->name()),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      faults_(seed) {
  thread_ = std::thread([this] { run(); });
}

DeviceServer::~DeviceServer() {
  with([this] { ending_ = true; });
  thread_.join();
}

void DeviceServer::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
}

void DeviceServer::spoil(ByteFault fault, double duration) {
  with([&] { faults_.spoil(fault, host_now() + duration); });
}

void DeviceServer::fall_silent(double duration) {
  with([&] { faults_.fall_silent(host_now() + duration); });
}

void DeviceServer::slow_down(double duration, double way) {
  with([&] {
    slow_until_ = host_now() + duration;
    slow_way_ = way;
  });
}

void DeviceServer::unplug(double duration) {
  with([&] { unplug_until_ = host_now() + duration; });
}

/// Pulls the plug or puts it back, as it is due.
void DeviceServer::replug(Stamp now) {
  if (!unplugged_ && now < unplug_until_) {
    server_->unplug();
    outgoing_.clear();
    incoming_.clear();
    device_.client_left(now);
    unplugged_ = true;
  } else if (unplugged_ && now >= unplug_until_) {
    try {
      server_->plug_in();
      unplugged_ = false;
    } catch (const RunError&) {
      // Somebody has taken the name meanwhile; the next turn tries again.
    }
  }
}

void DeviceServer::turn() {
  std::array<std::uint8_t, 4096> bytes;
  const Served served = server_->read(bytes.data(), bytes.size(), 0.0);
  const std::lock_guard<std::mutex> lock(mutex_);
  const Stamp now = host_now();
  if (served.client_left) device_.client_left(now);
  if (served.client_came) device_.client_came(now);
  if (served.client_left) {
    outgoing_.clear();
    incoming_.clear();
  }
  if (served.size > 0 && !faults_.is_silent(now)) hear({reinterpret_cast<const char*>(bytes.data()), served.size}, now);
  for (; !incoming_.empty() && incoming_.front().due <= now; incoming_.pop_front())
    device_.receive(incoming_.front().bytes, now);
  device_.advance(now);
  queue(faults_.pass(device_.take_output(), now), now);
  send(now);
  replug(now);
}

void DeviceServer::hear(std::string bytes, Stamp now) {
  const Stamp due = now < slow_until_ ? now + slow_way_ : now;
  incoming_.push_back({incoming_.empty() ? due : std::max(due, incoming_.back().due), std::move(bytes)});
}

void DeviceServer::queue(const std::vector<std::string>& pieces, Stamp now) {
  Stamp due = now < slow_until_ ? now + slow_way_ : now;
  if (!outgoing_.empty()) due = std::max(due, outgoing_.back().due);
  for (const std::string& piece : pieces) {
    outgoing_.push_back({due, piece});
    due = due + kSplitPause;
  }
}

void DeviceServer::send(Stamp now) {
  while (!outgoing_.empty() && outgoing_.front().due <= now) {
    const std::string& bytes = outgoing_.front().bytes;
    server_->write(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    outgoing_.pop_front();
  }
}

int DeviceServer::wait_ms() const {
  if (outgoing_.empty()) return kTurnMs;
  return std::clamp(static_cast<int>(std::ceil(1e3 * (outgoing_.front().due - host_now()))), 0, kTurnMs);
}

void DeviceServer::run() {
  for (;;) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (ending_) return;
    }
    turn();
    std::array<pollfd, 2> files{pollfd{wake_.get(), POLLIN, 0}, pollfd{server_->descriptor(), POLLIN, 0}};
    ::poll(files.data(), unplugged_ ? 1 : 2, wait_ms());
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(wake_.get(), &count, sizeof count);
  }
}

}  // namespace rubble::robot
