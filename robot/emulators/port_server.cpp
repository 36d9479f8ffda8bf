#include "robot/emulators/port_server.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pty.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/port_word.h"

namespace rubble::robot {

namespace fs = std::filesystem;
namespace {

// A TCP client that acknowledges nothing for so long is gone [s]: questions of the system's own when nothing is under
// way, else what is sent again.
constexpr int kIdle = 2, kAskAgain = 1, kTries = 3;
constexpr unsigned kUnheard = 1000u * (kIdle + kTries * kAskAgain);  // [ms]

/// One descriptor at a time behind an epoll descriptor that stays the same; what the client has not taken waits here.
class Line {
 public:
  Line() : poll_(epoll_create1(EPOLL_CLOEXEC)) {
    if (!poll_)
      throw RunError(std::string("no descriptor is left (") + std::strerror(errno) + "); close some programs");
  }

  int descriptor() const { return poll_.get(); }

  void watch(int file) {
    forget();
    watched_ = file;
    update(EPOLL_CTL_ADD);
  }

  /// A second one that is never written to; closing it ends that.
  void watch_too(int file) const {
    epoll_event event{};
    event.events = EPOLLIN;
    epoll_ctl(poll_.get(), EPOLL_CTL_ADD, file, &event);
  }

  void forget() {
    if (watched_ >= 0) epoll_ctl(poll_.get(), EPOLL_CTL_DEL, watched_, nullptr);
    watched_ = -1;
    waiting_.clear();
  }

  void wait(double timeout) {
    epoll_event event{};
    const Stamp until = host_now() + timeout;
    for (;;) {
      const double left = std::max(0.0, until - host_now());
      timespec limit{};
      limit.tv_sec = static_cast<time_t>(left);
      limit.tv_nsec = static_cast<long>((left - std::floor(left)) * 1e9);
      if (epoll_pwait2(poll_.get(), &event, 1, &limit, nullptr) >= 0 || errno != EINTR) return;
    }
  }

  /// Whether nothing waits to be sent any more; an error counts so too, the next read finds it.
  bool flush() {
    while (!waiting_.empty()) {
      const ssize_t sent = put(waiting_.data(), waiting_.size());
      if (sent <= 0) return false;
      waiting_.erase(waiting_.begin(), waiting_.begin() + sent);
      if (waiting_.empty()) update(EPOLL_CTL_MOD);
    }
    return true;
  }

  bool write(const std::uint8_t* from, std::size_t size) {
    if (watched_ < 0 || !flush()) return false;
    const ssize_t sent = put(from, size);
    if (sent < 0) return false;
    waiting_.assign(from + sent, from + size);
    if (!waiting_.empty()) update(EPOLL_CTL_MOD);
    return true;
  }

 private:
  ssize_t put(const std::uint8_t* from, std::size_t size) const {
    for (;;) {
      const ssize_t sent = is_socket_ ? ::send(watched_, from, size, MSG_NOSIGNAL) : ::write(watched_, from, size);
      if (sent < 0 && errno == ENOTSOCK) {
        is_socket_ = false;
        continue;
      }
      if (sent >= 0 || errno != EINTR) return sent;
    }
  }

  void update(int operation) const {
    epoll_event event{};
    event.events = EPOLLIN | (waiting_.empty() ? 0u : static_cast<unsigned>(EPOLLOUT));
    epoll_ctl(poll_.get(), operation, watched_, &event);
  }

  Descriptor poll_;
  int watched_ = -1;
  mutable bool is_socket_ = true;
  std::vector<std::uint8_t> waiting_;
};

/// What both kinds of lines have in common.
class LineServer : public PortServer {
 public:
  const std::string& name() const override { return name_; }
  int descriptor() const override { return line_.descriptor(); }

  Served read(std::uint8_t* to, std::size_t size, double timeout) override {
    Served result;
    line_.flush();
    if (take(to, size, result)) return result;
    line_.wait(timeout);
    line_.flush();
    take(to, size, result);
    return result;
  }

 protected:
  explicit LineServer(std::string name) : name_(std::move(name)) {}
  /// Takes what is there, if anything is.
  virtual bool take(std::uint8_t* to, std::size_t size, Served& result) = 0;

  std::string name_;
  Line line_;
};

class TcpServer : public LineServer {
 public:
  explicit TcpServer(const PortWord& parts)
      : LineServer("tcp:" + parts.host + ":" + parts.port), host_(parts.host), port_(parts.port) {
    plug_in();
  }

  bool write(const std::uint8_t* from, std::size_t size) override { return client_ && line_.write(from, size); }

  void unplug() override {
    line_.forget();
    if (client_) left_ = true;
    client_.close();
    listener_.close();
  }

  void plug_in() override {
    if (listener_) return;
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    addrinfo* found = nullptr;
    const int failure = getaddrinfo(host_.c_str(), port_.c_str(), &hints, &found);
    if (failure != 0)
      throw InputError(name_ + ": the host '" + host_ + "' is not known (" + gai_strerror(failure) +
                       "); give an address of this machine, as 127.0.0.1");
    Descriptor socket(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int on = 1;
    setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const bool bound = ::bind(socket.get(), found->ai_addr, found->ai_addrlen) == 0 && ::listen(socket.get(), 4) == 0;
    const int error = errno;
    freeaddrinfo(found);
    if (!bound)
      throw RunError(name_ + ": cannot be served (" + std::strerror(error) +
                     "); give another port, or 0 for any free one");
    listener_ = std::move(socket);
    tell_port();
    line_.watch_too(listener_.get());
  }

 private:
  void tell_port() {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    char number[16] = "";
    if (getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
        getnameinfo(reinterpret_cast<sockaddr*>(&address), size, nullptr, 0, number, sizeof number, NI_NUMERICSERV) ==
            0)
      port_ = number;
    const bool is_v6 = host_.find(':') != std::string::npos;
    name_ = "tcp:" + (is_v6 ? "[" + host_ + "]" : host_) + ":" + port_;
  }

  /// Accepts a client or takes bytes; whether there is something to tell.
  bool take(std::uint8_t* to, std::size_t size, Served& result) override {
    if (left_) result.client_left = true;
    left_ = false;
    if (client_ && is_cut_off()) drop_client(result);
    if (client_ && !is_leaving()) turn_away();
    if (!client_ && listener_) accept_client(result);
    if (client_ && size > 0) {
      const ssize_t got = ::read(client_.get(), to, size);
      if (got > 0) result.size = static_cast<std::size_t>(got);
      if (got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) drop_client(result);
    }
    return result.size > 0 || result.client_came || result.client_left;
  }

  Descriptor next_client() const {
    return Descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  }

  /// The client has closed its end, though what it said last may not have been read: it makes room for the next one.
  bool is_leaving() const {
    pollfd file{client_.get(), POLLRDHUP, 0};
    return ::poll(&file, 1, 0) > 0;
  }

  /// What was sent to the client is sent again and again, and nobody acknowledges it. (TCP_USER_TIMEOUT would also end
  /// a client that lives but does not read: it acknowledges that it has no room.)
  bool is_cut_off() const {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (getsockopt(client_.get(), IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return false;
    const bool again = info.tcpi_retransmits > 0 || info.tcpi_probes >= kTries;
    return again && info.tcpi_last_ack_recv > kUnheard;
  }

  void drop_client(Served& result) {
    line_.forget();
    client_.close();
    result.client_left = true;
  }

  void turn_away() const {
    while (next_client()) {
    }
  }

  void accept_client(Served& result) {
    Descriptor client = next_client();
    if (!client) return;
    const int on = 1;
    setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    // A client whose cable was cut says no good-bye; it must not keep others out for good.
    const int idle = kIdle, again = kAskAgain, tries = kTries;
    setsockopt(client.get(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    setsockopt(client.get(), IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
    setsockopt(client.get(), IPPROTO_TCP, TCP_KEEPINTVL, &again, sizeof again);
    setsockopt(client.get(), IPPROTO_TCP, TCP_KEEPCNT, &tries, sizeof tries);
    client_ = std::move(client);
    line_.watch(client_.get());
    result.client_came = true;
  }

  std::string host_, port_;
  Descriptor listener_, client_;
  bool left_ = false;
};

class PtyServer : public LineServer {
 public:
  explicit PtyServer(const PortWord& parts) : LineServer("pty:" + parts.path), path_(parts.path) { plug_in(); }
  ~PtyServer() override { unplug(); }

  bool write(const std::uint8_t* from, std::size_t size) override { return ours_ && line_.write(from, size); }

  void unplug() override {
    if (!ours_) return;
    line_.forget();
    if (link_target() == device_) ::unlink(path_.c_str());
    ours_.close();
    theirs_.close();
  }

  void plug_in() override {
    if (ours_) return;
    struct stat status {};
    if (lstat(path_.c_str(), &status) == 0 && !S_ISLNK(status.st_mode))
      throw RunError(name_ + ": a file of this name exists; give a path where a link may be made");
    // What a program that was killed left behind points nowhere, as long as its number was not given to another pty.
    const std::string other = link_target();
    if (!other.empty() && fs::exists(other))
      throw RunError(name_ + ": somebody serves there already (" + other +
                     "); end that program, remove the link or give another path");
    int ours = -1, theirs = -1;
    char device[128] = "";
    termios raw{};
    cfmakeraw(&raw);
    raw.c_cflag |= CLOCAL | CREAD;
    cfsetspeed(&raw, B115200);
    // Raw before anyone can see the name: no echo, no change of line ends. Our own copy of the client's end stays open,
    // else reading fails whenever no client is there.
    if (openpty(&ours, &theirs, device, &raw, nullptr) != 0)
      throw RunError(name_ + ": no pty is left (" + std::strerror(errno) + "); close some terminals");
    ours_ = Descriptor(ours);
    theirs_ = Descriptor(theirs);
    fcntl(ours, F_SETFL, O_NONBLOCK);
    fcntl(ours, F_SETFD, FD_CLOEXEC);
    fcntl(theirs, F_SETFD, FD_CLOEXEC);
    device_ = device;
    publish();
    line_.watch(ours_.get());
  }

 private:
  void publish() const {
    // Beside it under a name that nobody has: what has it may be anybody's.
    std::string fresh;
    int made = -1;
    for (int number = 0; made != 0 && (number == 0 || errno == EEXIST); ++number) {
      fresh = path_ + "." + std::to_string(getpid()) + "-" + std::to_string(number);
      made = ::symlink(device_.c_str(), fresh.c_str());
    }
    if (made != 0 || ::rename(fresh.c_str(), path_.c_str()) != 0)
      throw RunError(name_ + ": the link cannot be made (" + std::strerror(errno) +
                     "); give a path in a folder that exists and may be written");
  }

  std::string link_target() const {
    char target[128];
    const ssize_t size = ::readlink(path_.c_str(), target, sizeof target);
    return size < 0 ? std::string() : std::string(target, static_cast<std::size_t>(size));
  }

  bool take(std::uint8_t* to, std::size_t size, Served& result) override {
    if (!ours_ || size == 0) return false;
    const ssize_t got = ::read(ours_.get(), to, size);
    if (got > 0) result.size = static_cast<std::size_t>(got);
    return result.size > 0;
  }

  std::string path_, device_;
  Descriptor ours_, theirs_;
};

}  // namespace

std::unique_ptr<PortServer> serve_port(const std::string& word) {
  const PortWord parts = parse_port_word(word);
  if (parts.kind == PortKind::Tcp) return std::make_unique<TcpServer>(parts);
  if (parts.kind == PortKind::Pty) return std::make_unique<PtyServer>(parts);
  throw InputError("port '" + word + "': a device cannot be emulated there; give pty:PATH or tcp:127.0.0.1:PORT");
}

}  // namespace rubble::robot
