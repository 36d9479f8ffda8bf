#include "slam/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/text/number_text.h"
#include "slam/process/guardian.h"

namespace rubble::slam {
namespace {

constexpr std::size_t kMostEarly = 1u << 20;  ///< bytes taken in before all was sent
constexpr int kPipeSize = 1 << 20;            ///< asked for; less is slower, no more

struct Pipe {
  int read = -1;
  int write = -1;
};

void close_if_open(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

Pipe make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw RunError(std::string("the mapper's process cannot be made: ") + std::strerror(errno));
  fcntl(ends[0], F_SETPIPE_SZ, kPipeSize);
  return {ends[0], ends[1]};
}

/// Writing to a process that has ended must not end this one: keeps SIGPIPE off this thread while it lives.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    const timespec now{0, 0};
    if (!was_pending_) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  sigset_t pipe_, before_;
  bool was_pending_ = false;
};

std::string end_text(int status) {
  if (WIFEXITED(status)) return "ended with exit code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  return "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& argv, const std::string& log) {
  GuardedProcess process;
  process.argv = argv;
  if (!log.empty()) {
    process.errors = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    if (process.errors < 0) throw RunError(log + ": cannot be written (" + std::strerror(errno) + ")");
  }
  Pipe input, output;
  const auto close_all = [&] {
    for (int* end : {&input.read, &input.write, &output.read, &output.write, &process.errors}) close_if_open(*end);
  };
  try {
    input = make_pipe();
    output = make_pipe();
    process.input = input.read;
    process.output = output.write;
    guardian_ = start_guarded(process, lifeline_);
  } catch (...) {
    close_all();
    throw;
  }
  std::swap(to_, input.write);
  std::swap(from_, output.read);
  close_all();
  fcntl(to_, F_SETFL, O_NONBLOCK);
  fcntl(from_, F_SETFL, O_NONBLOCK);
  give_time(10.0);
}

ChildProcess::~ChildProcess() {
  close_if_open(to_);
  close_if_open(from_);
  close_if_open(lifeline_);  // tells the guardian
  while (waitpid(guardian_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ChildProcess::give_time(double seconds) {
  seconds_ = seconds;
  deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

int ChildProcess::left_ms() const {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

void ChildProcess::lost_by_time() const {
  throw Lost("gave no whole answer within " + number_text(seconds_) +
             " s (does it flush its output after each answer? mapper.timeout_s allows more)");
}

/// The guardian tells the status once everything is gone.
void ChildProcess::lost_by_end() {
  pollfd line{lifeline_, POLLIN, 0};
  int status = 0;
  if (poll(&line, 1, left_ms()) > 0 && recv(lifeline_, &status, sizeof status, 0) == sizeof status)
    throw Lost(end_text(status));
  throw Lost("closed its output");
}

void ChildProcess::wait_for(bool writable, bool readable) {
  for (;;) {
    pollfd ends[2] = {{writable ? to_ : -1, POLLOUT, 0}, {readable ? from_ : -1, POLLIN, 0}};
    const int ready = poll(ends, 2, left_ms());
    if (ready > 0) return;
    if (ready == 0 || errno != EINTR) lost_by_time();
  }
}

/// Takes in what it says while we are still sending, so that neither waits for the other. False: it is gone.
bool ChildProcess::drain() {
  char buffer[65536];
  const ssize_t got = ::read(from_, buffer, sizeof buffer);
  if (got > 0) early_.append(buffer, static_cast<std::size_t>(got));
  return got != 0;
}

void ChildProcess::send(std::string_view text) {
  const NoPipeSignal quiet;
  while (!text.empty()) {
    wait_for(true, early_.size() < kMostEarly);
    const ssize_t sent = write(to_, text.data(), text.size());
    if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
    if (sent < 0 && errno == EPIPE) lost_by_end();
    if (early_.size() < kMostEarly && !drain()) lost_by_end();
  }
}

std::size_t ChildProcess::read(char* to, std::size_t at_most) {
  if (!early_.empty()) {
    const std::size_t part = std::min(at_most, early_.size());
    std::memcpy(to, early_.data(), part);
    early_.erase(0, part);
    return part;
  }
  for (;;) {
    const ssize_t got = ::read(from_, to, at_most);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0) lost_by_end();
    wait_for(false, true);
  }
}

void ChildProcess::close_input() {
  close_if_open(to_);
  pollfd line{lifeline_, POLLIN, 0};
  while (poll(&line, 1, left_ms()) < 0 && errno == EINTR) {
  }
}

}  // namespace rubble::slam
