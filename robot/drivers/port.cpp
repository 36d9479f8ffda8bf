#include "robot/drivers/port.h"

#include <fcntl.h>
#include <linux/serial.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

#include "base/error.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/port_word.h"

namespace rubble::robot {

namespace fs = std::filesystem;
namespace {

constexpr double kConnectTimeout = 2.0;  // [s]
constexpr double kWriteTimeout = 0.5;    // a device that takes nothing for so long is gone [s]
constexpr double kTurnedAway = 3.0;      // who is hung up on so early was turned away, or so it seems [s]
constexpr int kFirstBaud = 115200;

/// Waits for `events`; false: the time is over. Signals do not shorten the wait.
bool wait_for(int descriptor, short events, double timeout) {
  const Stamp until = host_now() + timeout;
  for (;;) {
    pollfd entry{descriptor, events, 0};
    const double left = std::max(0.0, until - host_now());
    timespec wait{};
    wait.tv_sec = static_cast<time_t>(left);
    wait.tv_nsec = static_cast<long>((left - std::floor(left)) * 1e9);
    const int ready = ppoll(&entry, 1, &wait, nullptr);
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) return true;  // the read or write that follows tells what is wrong
  }
}

/// Reads and writes of every kind of descriptor that does not block.
class DescriptorPort : public Port {
 public:
  DescriptorPort(std::string word, Descriptor descriptor) : name_(std::move(word)), file_(std::move(descriptor)) {}

  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    const Stamp until = host_now() + timeout;
    for (;;) {
      const ssize_t got = ::read(file_.get(), to, size);
      if (got > 0) return {static_cast<std::size_t>(got), host_now()};
      if (got == 0) throw_lost("the device closed the line");
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) throw_lost(gone(errno));
      if (!wait_for(file_.get(), POLLIN, until - host_now())) return {0, host_now()};
    }
  }

  void write(const std::uint8_t* from, std::size_t size, Stamp) override {
    for (std::size_t sent = 0; sent < size;) {
      // MSG_NOSIGNAL has no counterpart for a tty, but a tty raises no SIGPIPE either.
      const ssize_t step = is_serial() ? ::write(file_.get(), from + sent, size - sent)
                                       : ::send(file_.get(), from + sent, size - sent, MSG_NOSIGNAL);
      if (step > 0) {
        sent += static_cast<std::size_t>(step);
        continue;
      }
      if (step < 0 && errno == EINTR) continue;
      if (step < 0 && errno != EAGAIN && errno != EWOULDBLOCK) throw_lost(gone(errno));
      if (!wait_for(file_.get(), POLLOUT, kWriteTimeout))
        throw DeviceLost(name_ + ": the device takes no bytes; " + remedy());
    }
  }

  int descriptor() const override { return file_.get(); }
  const std::string& name() const override { return name_; }
  Stamp opened() const override { return opened_; }

 protected:
  virtual std::string remedy() const = 0;
  std::string name_;
  Descriptor file_;

 private:
  static std::string gone(int error) { return std::string("the device is gone (") + std::strerror(error) + ")"; }

  [[noreturn]] void throw_lost(const std::string& how) const {
    const std::string what = name_ + ": " + how + "; " + remedy();
    if (!is_serial() && host_now() - opened_ < kTurnedAway)
      throw TurnedAway(
          name_ + ": the other side hangs up at once; another program uses the device, or none is connected there",
          what);
    throw DeviceLost(what);
  }

  const Stamp opened_ = host_now();
};

class TcpPort : public DescriptorPort {
 public:
  TcpPort(std::string word, Descriptor socket, std::vector<Descriptor> locks)
      : DescriptorPort(std::move(word), std::move(socket)), locks_(std::move(locks)) {}
  void set_baud(int) override {}
  LineKind kind() const override { return LineKind::Tcp; }

 private:
  std::string remedy() const override { return "see that the other side still runs"; }
  std::vector<Descriptor> locks_;
};

speed_t speed_of(int baud, const std::string& name) {
  static const std::vector<std::pair<int, speed_t>> table = {{9600, B9600},     {19200, B19200},    {38400, B38400},
                                                             {57600, B57600},   {115200, B115200},  {230400, B230400},
                                                             {500000, B500000}, {1000000, B1000000}};
  for (const auto& [rate, speed] : table)
    if (rate == baud) return speed;
  throw InputError(name + ": no serial line runs at " + std::to_string(baud) +
                   " baud; give 9600, 19200, 38400, 57600, 115200, 230400, 500000 or 1000000");
}

/// By the numbers of Linux' list of devices (Documentation/admin-guide/devices.txt).
LineKind kind_of(int line) {
  constexpr unsigned kFirstPty = 136, kLastPty = 143, kUsbModem = 166;
  struct stat status {};
  if (fstat(line, &status) != 0) return LineKind::Uart;
  const unsigned number = major(status.st_rdev);
  if (number >= kFirstPty && number <= kLastPty) return LineKind::Pty;
  return number == kUsbModem ? LineKind::Usb : LineKind::Uart;
}

class SerialPort : public DescriptorPort {
 public:
  SerialPort(std::string word, Descriptor descriptor, std::vector<Descriptor> locks)
      : DescriptorPort(std::move(word), std::move(descriptor)), locks_(std::move(locks)) {
    kind_ = kind_of(file_.get());
    if (kind_ == LineKind::Uart) ask_for_low_latency();
    set_baud(kFirstBaud);
    tcflush(file_.get(), TCIOFLUSH);
  }

  void set_baud(int baud) override {
    const speed_t speed = speed_of(baud, name_);
    tcdrain(file_.get());  // what was sent at the old rate must leave first
    termios settings{};
    if (tcgetattr(file_.get(), &settings) != 0)
      throw DeviceLost(name_ + ": is no serial line (" + std::strerror(errno) + "); " + remedy());
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
    settings.c_cc[VMIN] = 1;  // without O_NONBLOCK's EAGAIN a silent line could not be told from a lost one
    settings.c_cc[VTIME] = 0;
    cfsetspeed(&settings, speed);
    if (tcsetattr(file_.get(), TCSANOW, &settings) != 0)
      throw DeviceLost(name_ + ": takes no settings (" + std::strerror(errno) + "); " + remedy());
  }

  LineKind kind() const override { return kind_; }

 private:
  /// A USB adapter of FTDI hands over what it has once a millisecond then, not every sixteen. Others do not care.
  void ask_for_low_latency() const {
    serial_struct line{};
    if (ioctl(file_.get(), TIOCGSERIAL, &line) != 0) return;
    line.flags |= ASYNC_LOW_LATENCY;
    ioctl(file_.get(), TIOCSSERIAL, &line);
  }

  LineKind kind_ = LineKind::Uart;
  std::vector<Descriptor> locks_;
  std::string remedy() const override { return "check its plug and power, `rubble devices` lists what is there"; }
};

std::string why_not_opened(int error) {
  if (error == ENOENT || error == ENXIO || error == ENODEV)
    return "there is no such device; plug it in, `rubble devices` lists what is there";
  if (error == EACCES || error == EPERM) return "no permission; add yourself to the group dialout and log in again";
  if (error == EBUSY) return "another program uses it; end that first";
  return std::string("cannot be opened (") + std::strerror(error) + "); `rubble devices` lists what is there";
}

/// For as long as it is open.
void lock_line(const Descriptor& line, const std::string& word) {
  if (isatty(line.get()) && flock(line.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw PortBusy(word + ": " + why_not_opened(EBUSY));
}

/// What this program has claimed.
class Claims {
 public:
  static Claims& ours() {
    static Claims claims;
    return claims;
  }
  bool has(const std::string& name) {
    const std::lock_guard<std::mutex> guard(mutex_);
    return names_.count(name) > 0;
  }
  void add(const std::vector<std::string>& names) {
    const std::lock_guard<std::mutex> guard(mutex_);
    names_.insert(names.begin(), names.end());
  }
  void remove(const std::vector<std::string>& names) {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (const std::string& name : names) names_.erase(name);
  }

 private:
  std::mutex mutex_;
  std::set<std::string> names_;
};

/// On this computer: the name of a socket that nobody connects to, which goes with the program whatever ends it, and
/// stays when the device goes. Without a descriptor, as where no such names are, nothing is locked.
Descriptor lock_name(const std::string& thing, const std::string& word) {
  const std::string name = "rubble client of " + thing;
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  // A path may be longer than such a name; its end tells more than its beginning.
  const std::size_t size = std::min(name.size(), sizeof place.sun_path - 1);
  std::memcpy(place.sun_path + 1, name.data() + (name.size() - size), size);  // a first byte of 0: no file
  Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket) return {};
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&place), length) == 0) return socket;
  if (errno == EADDRINUSE) throw PortBusy(word + ": " + why_not_opened(EBUSY));
  return {};
}

std::vector<Descriptor> lock_names(const std::vector<std::string>& names, const std::string& word) {
  std::vector<Descriptor> locks;
  for (const std::string& name : names)
    if (!Claims::ours().has(name)) locks.push_back(lock_name(name, word));
  return locks;
}

/// A path by which the line is asked for, and what it leads to now.
std::vector<std::string> names_of(const std::string& path) {
  std::error_code error;
  std::vector<std::string> names{fs::absolute(path, error).lexically_normal().string()};
  const std::string device = fs::canonical(path, error).string();
  if (!error && device != names[0]) names.push_back(device);
  return names;
}

std::vector<std::string> names_of(const addrinfo* addresses) {
  std::vector<std::string> names;
  for (const addrinfo* address = addresses; address != nullptr; address = address->ai_next) {
    char host[NI_MAXHOST] = "", number[NI_MAXSERV] = "";
    if (getnameinfo(address->ai_addr, address->ai_addrlen, host, sizeof host, number, sizeof number,
                    NI_NUMERICHOST | NI_NUMERICSERV) == 0)
      names.push_back(std::string(host) + ":" + number);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::unique_ptr<Port> open_serial(const std::string& word, const std::string& path) {
  std::vector<Descriptor> locks = lock_names(names_of(path), word);
  Descriptor line(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!line) throw DeviceLost(word + ": " + why_not_opened(errno));
  lock_line(line, word);
  if (!isatty(line.get())) throw InputError(word + ": is no serial line; give the path of one, as /dev/ttyUSB0");
  return std::make_unique<SerialPort>(word, std::move(line), std::move(locks));
}

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

/// 0, or the error that kept the socket from being connected in time.
int connect_in_time(int socket, const addrinfo& address) {
  if (::connect(socket, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!wait_for(socket, POLLOUT, kConnectTimeout)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// Null when the host is not known; `failure` then tells why.
Addresses find(const PortWord& parts, int* failure = nullptr) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int result = getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found);
  if (failure != nullptr) *failure = result;
  return Addresses(result == 0 ? found : nullptr);
}

std::unique_ptr<Port> open_tcp(const std::string& word, const PortWord& parts) {
  int failure = 0;
  const Addresses addresses = find(parts, &failure);
  if (failure != 0)
    throw DeviceLost(word + ": the host '" + parts.host + "' is not known (" + gai_strerror(failure) +
                     "); check its name, or give its address");
  std::vector<Descriptor> locks = lock_names(names_of(addresses.get()), word);
  int error = ECONNREFUSED;
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    Descriptor socket(::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket) continue;
    error = connect_in_time(socket.get(), *address);
    if (error != 0) continue;
    const int on = 1;
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(socket.get(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    return std::make_unique<TcpPort>(word, std::move(socket), std::move(locks));
  }
  throw DeviceLost(word + ": nobody answers (" + std::strerror(error) +
                   "); switch the device on or start `rubble emulate` there, or end the program that talks to it");
}

}  // namespace

PortClaim::PortClaim(const std::string& word) {
  const PortWord parts = parse_port_word(word);
  std::vector<std::string> names = parts.kind == PortKind::Tcp ? names_of(find(parts).get()) : names_of(parts.path);
  for (const std::string& name : names) {
    if (Claims::ours().has(name))
      throw PortBusy(word +
                     ": leads to a device that another port of this robot names as well; each device needs its "
                     "own");
    locks_.push_back(lock_name(name, word));
  }
  if (parts.kind != PortKind::Tcp) {
    const Descriptor line(::open(parts.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (line) lock_line(line, word);
  }
  names_ = std::move(names);
  Claims::ours().add(names_);
}

PortClaim::~PortClaim() { Claims::ours().remove(names_); }

std::unique_ptr<Port> open_port(const std::string& word) {
  const PortWord parts = parse_port_word(word);
  if (parts.kind == PortKind::Tcp) return open_tcp(word, parts);
  return open_serial(word, parts.path);
}

}  // namespace rubble::robot
