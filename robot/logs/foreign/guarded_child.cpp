#include "robot/logs/foreign/guarded_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "base/error.h"

namespace rubble::robot {
namespace {

using Record = std::function<void(std::string_view)>;

constexpr int kOutOfMemory = 99;
constexpr int kBroken = 98;
constexpr std::size_t kHead = sizeof(std::uint32_t);

void limit(int resource, std::size_t value) {
  rlimit bound{};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &bound);
  bound.rlim_cur = std::min<rlim_t>(bound.rlim_max, value);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &bound);
}

/// Private writable memory of this process [bytes], the kind that RLIMIT_DATA counts.
std::size_t data_held() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%*u %*u %*u %*u %*u %lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void write_all(int to, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t n = write(to, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(kBroken);
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
}

[[noreturn]] void be_child(int to, pid_t parent, const ChildLimits& limits,
                           const std::function<void(const Record&)>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kBroken);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  const int nowhere = open("/dev/null", O_RDWR);
  if (nowhere >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_s);
  limit(RLIMIT_DATA, data_held() + limits.memory);
  int code = 0;
  try {
    work([to](std::string_view record) {
      const auto size = static_cast<std::uint32_t>(record.size());
      char head[kHead];
      std::memcpy(head, &size, kHead);
      write_all(to, head, kHead);
      write_all(to, record.data(), record.size());
    });
  } catch (const std::bad_alloc&) {
    code = kOutOfMemory;
  } catch (...) {
    code = kBroken;
  }
  _exit(code);
}

/// The parent's end of the pipe; the child does not outlive it.
class Child {
 public:
  Child(int from, pid_t pid) : from_(from), pid_(pid) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// False when the child has said all it will say, or nothing for too long.
  bool read(std::string& buffer, int silence_s) {
    pollfd ready{from_, POLLIN, 0};
    int n = 0;
    do n = poll(&ready, 1, silence_s * 1000);
    while (n < 0 && errno == EINTR);
    silent_ = n == 0;
    if (n <= 0) return false;
    const std::size_t old = buffer.size();
    buffer.resize(old + (std::size_t{1} << 16));
    ssize_t got = 0;
    do got = ::read(from_, &buffer[old], buffer.size() - old);
    while (got < 0 && errno == EINTR);
    buffer.resize(old + static_cast<std::size_t>(got > 0 ? got : 0));
    return got > 0;
  }

  /// How it ended; kills it when it has not.
  int end() {
    if (pid_ <= 0) return status_;
    close(from_);
    if (silent_ || !ended_well_) kill(pid_, SIGKILL);
    while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status_;
  }
  void said_all() { ended_well_ = true; }
  bool silent() const { return silent_; }

 private:
  int from_;
  pid_t pid_;
  int status_ = 0;
  bool silent_ = false;
  bool ended_well_ = false;
};

std::string how_it_ended(int status, bool silent, const ChildLimits& limits) {
  if (silent) return "gave nothing for " + std::to_string(limits.silence_s) + " s";
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    return "asks for more than " + std::to_string(limits.memory >> 20) + " MB";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "takes more than " + std::to_string(limits.cpu_s) + " s";
  return "makes its library crash";
}

}  // namespace

std::string run_guarded(const ChildLimits& limits, const std::function<void(const Record&)>& work,
                        const Record& receive) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw RunError(std::string("no pipe can be opened: ") + std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    throw RunError(std::string("no process can be started to read the log: ") + std::strerror(error));
  }
  if (pid == 0) {
    close(ends[0]);
    be_child(ends[1], parent, limits, work);
  }
  close(ends[1]);
  Child child(ends[0], pid);
  std::string buffer;
  while (child.read(buffer, limits.silence_s)) {
    std::size_t at = 0;
    while (buffer.size() - at >= kHead) {
      std::uint32_t size = 0;
      std::memcpy(&size, &buffer[at], kHead);
      if (buffer.size() - at - kHead < size) break;
      receive(std::string_view(buffer).substr(at + kHead, size));
      at += kHead + size;
    }
    buffer.erase(0, at);
  }
  if (!child.silent()) child.said_all();
  return how_it_ended(child.end(), child.silent(), limits);
}

}  // namespace rubble::robot
