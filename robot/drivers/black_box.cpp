#include "robot/drivers/black_box.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/text/input_file.h"
#include "robot/drivers/host_clock.h"

namespace rubble::robot {
namespace {

// An entry: name length, name, direction (one byte each), stamp (8 bytes), byte count (4 bytes), bytes; little-endian.
constexpr std::size_t kNumbers = 8 + 4;
// A replay walks through the time between the entries step by step: a time that no drive has would keep it for ever.
constexpr Stamp kLatest{9'000'000'000'000'000'000};  ///< the year 2255
constexpr double kLongestDrive = 30.0 * 86400.0;     ///< [s]
constexpr double kMostDisorder = 10.0;               ///< of what several threads wrote [s]

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>((value >> (8 * i)) & 0xFF));
}

std::uint64_t take(const std::string& bytes, std::size_t at, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)])) << (8 * i);
  return value;
}

constexpr std::pair<LineKind, const char*> kKinds[] = {
    {LineKind::Tcp, "tcp"}, {LineKind::Pty, "pty"}, {LineKind::Usb, "usb"}, {LineKind::Uart, "uart"}};

const char* name_of(LineKind kind) {
  for (const auto& [known, name] : kKinds)
    if (known == kind) return name;
  return "";
}

/// Why not all was written; empty: it was.
std::string write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t step = ::write(file, bytes.data(), bytes.size());
    if (step < 0 && errno == EINTR) continue;
    if (step <= 0) {
      const bool full = step == 0 || errno == ENOSPC || errno == EDQUOT || errno == EFBIG;
      return std::string("could not be written to its end (") + std::strerror(step == 0 ? ENOSPC : errno) + "); " +
             (full ? "free some space" : "see to the disk") + " and run again";
    }
    bytes.remove_prefix(static_cast<std::size_t>(step));
  }
  return "";
}

/// Throws InputError where the times are not those of one drive.
void require_times_of_a_drive(const std::vector<BlackBoxEntry>& entries, const std::string& path) {
  Stamp newest = entries.empty() ? Stamp{} : entries.front().stamp;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Stamp stamp = entries[i].stamp;
    const bool possible = stamp >= Stamp{} && stamp <= kLatest;
    if (!possible || stamp - entries.front().stamp > kLongestDrive || newest - stamp > kMostDisorder)
      throw InputError(path + ": is damaged (entry " + std::to_string(i + 1) +
                       " has a time that does not follow those before); copy it again");
    newest = std::max(newest, stamp);
  }
}

class RecordedPort : public Port {
 public:
  RecordedPort(std::unique_ptr<Port> inner, std::string device, BlackBox& box)
      : inner_(std::move(inner)), device_(std::move(device)), box_(box) {
    box_.add(device_, Direction::Opened, inner_->name() + "\n" + name_of(inner_->kind()), inner_->opened());
  }

  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    try {
      const Arrival got = inner_->read(to, size, timeout);
      if (got.size > 0 && !box_.admits(device_, got.size, got.stamp))
        throw DeviceLost(name() + ": sends more than 1 MB/s, which is no '" + device_ + "'; see what is at this port");
      if (got.size > 0)
        box_.add(device_, Direction::FromDevice, {reinterpret_cast<const char*>(to), got.size}, got.stamp);
      return got;
    } catch (const DeviceLost& lost) {
      box_.add(device_, Direction::Lost, lost.what(), host_now());
      throw;
    }
  }
  void write(const std::uint8_t* from, std::size_t size, Stamp now) override {
    box_.add(device_, Direction::ToDevice, {reinterpret_cast<const char*>(from), size}, now);
    inner_->write(from, size, now);
  }
  int descriptor() const override { return inner_->descriptor(); }
  const std::string& name() const override { return inner_->name(); }
  void set_baud(int baud) override {
    inner_->set_baud(baud);
    box_.add(device_, Direction::BitRate, std::to_string(baud), host_now());
  }
  LineKind kind() const override { return inner_->kind(); }
  Stamp opened() const override { return inner_->opened(); }

 private:
  std::unique_ptr<Port> inner_;
  std::string device_;
  BlackBox& box_;
};

}  // namespace

BlackBox::BlackBox(const std::string& path)
    : file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  const std::string magic = kBlackBoxMagic;
  if (!file_ || ::write(file_.get(), magic.data(), magic.size()) != static_cast<ssize_t>(magic.size()))
    throw RunError(path + ": cannot be written (" + std::strerror(errno) +
                   "); give a folder that exists and may be written");
  writer_ = std::thread([this] { write(); });
}

BlackBox::~BlackBox() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

bool BlackBox::admits(const std::string& device, std::size_t bytes, Stamp now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Allowance& allowance = allowances_[device];
  if (allowance.at != Stamp::never())
    allowance.bytes = std::min(kMostBurst, allowance.bytes + kMostRate * std::max(0.0, now - allowance.at));
  allowance.at = now;
  if (allowance.bytes < static_cast<double>(bytes)) {
    allowance.exceeded = true;
    return false;
  }
  allowance.bytes -= static_cast<double>(bytes);
  return true;
}

void BlackBox::add(const std::string& device, Direction direction, std::string_view bytes, Stamp stamp) {
  std::string entry;
  put(entry, device.size(), 1);
  entry += device;
  put(entry, static_cast<std::uint64_t>(direction), 1);
  put(entry, static_cast<std::uint64_t>(stamp.ns), 8);
  put(entry, bytes.size(), 4);
  entry += bytes;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_.empty()) return;
    if (waiting_.size() + entry.size() > kMostWaiting) {
      failure_ = "is not whole: the disk took less than the devices said, until 16 MB waited; record to a faster one";
      return;
    }
    waiting_ += entry;
  }
  changed_.notify_all();
}

/// In the writer's thread: what has come meanwhile in one piece, outside of the lock.
void BlackBox::write() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const std::string piece = std::exchange(waiting_, {});
    writing_ = true;
    lock.unlock();
    const std::string why = write_all(file_.get(), piece);
    lock.lock();
    writing_ = false;
    if (failure_.empty()) failure_ = why;
    changed_.notify_all();
  }
}

std::string BlackBox::failure() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !writing_; });
  return failure_;
}

std::vector<std::string> BlackBox::cut_short() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> names;
  for (const auto& [device, allowance] : allowances_)
    if (allowance.exceeded) names.push_back(device);
  return names;
}

std::vector<BlackBoxEntry> read_black_box(const std::string& path) {
  constexpr std::size_t kLargest = std::size_t{2} << 30;
  const std::string all =
      read_input(path, {"a black box that 'rubble drive' wrote", kLargest, "no drive is that long", Pipes::None});
  const std::string magic = kBlackBoxMagic;
  if (all.compare(0, magic.size(), magic) != 0)
    throw InputError(path +
                     ": is not a black box (it does not begin with 'RUBBLE BYTES 1'); give devices.bytes of a run");
  std::vector<BlackBoxEntry> entries;
  for (std::size_t at = magic.size(); at < all.size();) {
    const std::size_t name = take(all, at, 1);
    if (all.size() - at < 2 + name + kNumbers) break;
    BlackBoxEntry entry;
    entry.device = all.substr(at + 1, name);
    at += 1 + name;
    entry.direction = static_cast<Direction>(take(all, at, 1));
    entry.stamp = {static_cast<std::int64_t>(take(all, at + 1, 8))};
    const std::size_t size = take(all, at + 9, 4);
    at += 1 + kNumbers;
    if (all.size() - at < size) break;
    entry.bytes = all.substr(at, size);
    at += size;
    entries.push_back(std::move(entry));
  }
  require_times_of_a_drive(entries, path);
  return entries;
}

LineKind line_kind(const BlackBoxEntry& opened) {
  const std::size_t end = opened.bytes.find('\n');
  if (end != std::string::npos)
    for (const auto& [kind, name] : kKinds)
      if (opened.bytes.compare(end + 1, std::string::npos, name) == 0) return kind;
  // Boxes of older versions hold the port's name alone.
  return opened.bytes.rfind("tcp:", 0) == 0 ? LineKind::Tcp : LineKind::Uart;
}

std::unique_ptr<Port> open_recorded(const std::string& word, const std::string& device, BlackBox* box) {
  std::unique_ptr<Port> port = open_port(word);
  if (box == nullptr) return port;
  return std::make_unique<RecordedPort>(std::move(port), device, *box);
}

}  // namespace rubble::robot
