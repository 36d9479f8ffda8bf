#include "robot/drivers/device_thread.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "robot/drivers/host_clock.h"

namespace rubble::robot {
namespace {

constexpr double kTurn = 0.02;       ///< the thread looks around so often at least [s]
constexpr double kOpenAgain = 0.25;  ///< [s]
/// Taken in one piece: what was held up on its way or here shall arrive together, since its times are told from that.
constexpr std::size_t kMostBytes = 65536;

void wait_for_either(int port, int wake, double timeout) {
  std::array<pollfd, 2> files{pollfd{wake, POLLIN, 0}, pollfd{port, POLLIN, 0}};
  const double bounded = std::clamp(timeout, 0.0, kTurn);
  const timespec limit{0, static_cast<long>(bounded * 1e9)};
  ::ppoll(files.data(), port < 0 ? 1 : 2, &limit, nullptr);
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t got = ::read(wake, &count, sizeof count);
}

}  // namespace

DeviceThread::DeviceThread(std::string name, std::string port, Device& device, BlackBox* box,
                           std::function<void(Stamp)> each_turn, std::function<void(Stamp)> turned)
    : name_(std::move(name)),
      word_(std::move(port)),
      device_(device),
      box_(box),
      each_turn_(std::move(each_turn)),
      turned_(std::move(turned)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  check_port_word(word_);
  error_ = word_ + ": not opened yet";
  thread_ = std::thread([this] { run(); });
}

DeviceThread::~DeviceThread() { end(); }

void DeviceThread::end() {
  with([this] { ending_ = true; });
  wake();
  const std::lock_guard<std::mutex> lock(ending_mutex_);
  if (thread_.joinable()) thread_.join();
}

void DeviceThread::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
}

std::string DeviceThread::error() const {
  return with([this] { return error_; });
}

bool DeviceThread::busy() const {
  return with([this] { return busy_; });
}

bool DeviceThread::is_ending() const {
  return with([this] { return ending_; });
}

void DeviceThread::send(const std::string& bytes, Stamp now) {
  if (!bytes.empty()) port_->write(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), now);
}

void DeviceThread::set_baud(int baud) {
  if (baud > 0 && baud != baud_ && port_->is_serial()) port_->set_baud(baud);
  baud_ = baud;
}

void DeviceThread::run() {
  while (!is_ending()) {
    try {
      port_ = open_recorded(word_, name_, box_);
      baud_ = 0;
      converse();
    } catch (const std::exception& lost) {
      const Stamp opened = port_ ? port_->opened() : Stamp::never();
      port_.reset();
      with([&] {
        const auto* hung_up = dynamic_cast<const TurnedAway*>(&lost);
        const bool answered = device_.last_report() != Stamp::never() && device_.last_report() >= opened;
        error_ = hung_up != nullptr && answered ? hung_up->otherwise() : lost.what();
        busy_ = dynamic_cast<const PortBusy*>(&lost) != nullptr;
        if (busy_ || (hung_up != nullptr && !answered)) ++turned_away_;
      });
      for (const Stamp again = host_now() + kOpenAgain; host_now() < again && !is_ending();)
        wait_for_either(-1, wake_.get(), kTurn);
    }
  }
}

void DeviceThread::converse() {
  with([this] {
    error_.clear();
    busy_ = false;
    device_.opened(port_->opened(), port_->kind());
  });
  while (!is_ending()) {
    std::array<std::uint8_t, kMostBytes> bytes;
    const Arrival arrival = port_->read(bytes.data(), bytes.size(), 0.0);
    const std::size_t got = arrival.size;
    const Stamp now = arrival.stamp;
    // What was due, and when, cannot be told from the bytes: a thread that is late reads what came meanwhile first.
    if (got == 0 && box_ != nullptr) box_->add(name_, Direction::Turn, {}, now);
    std::string out;
    int baud = 0;
    const Stamp deadline = with([&] {
      if (got > 0) device_.receive({reinterpret_cast<const char*>(bytes.data()), got}, now);
      if (each_turn_) each_turn_(now);
      device_.advance(now);
      out = device_.take_output(now);
      baud = device_.baud();
      return device_.deadline();
    });
    set_baud(baud);  // what is said now is meant for the rate of now
    send(out, now);
    if (turned_) turned_(host_now());
    if (got < bytes.size()) wait_for_either(port_->descriptor(), wake_.get(), deadline - host_now());
  }
  for (const std::string& packet : with([this] { return device_.farewell(); })) {
    send(packet, host_now());
    sleep_until(host_now() + Device::kPause);  // the last one too: closing the line must not cut it short
  }
}

}  // namespace rubble::robot
