#include "scenarios/batch/worker_pool.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "base/error.h"

namespace rubble::scenarios {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollMs = 200;

/// Precedes every answer on the socket.
struct Header {
  std::uint64_t done = 0;  ///< 1: the text is the result, 0: the reason of the failure
  std::uint64_t length = 0;
};

bool send_all(int socket, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = recv(socket, at, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void redirect_output(const std::string& log) {
  const int file = open(log.empty() ? "/dev/null" : log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW, 0644);
  if (file < 0) return;
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  close(file);
}

/// The life of a worker process: answers task numbers until the other end closes.
[[noreturn]] void serve(int socket, pid_t parent, const std::function<std::string(std::size_t)>& work,
                        const std::string& log) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  // Ctrl-C, a closed terminal and the polite kill of a service or a scheduler reach the whole group; the parent
  // decides.
  for (const int signal : {SIGINT, SIGHUP, SIGTERM}) std::signal(signal, SIG_IGN);
  redirect_output(log);
  std::uint64_t task = 0;
  while (receive_all(socket, &task, sizeof task)) {
    Header header;
    std::string text;
    try {
      text = work(static_cast<std::size_t>(task));
      header.done = 1;
    } catch (const std::exception& error) {
      text = error.what();
    } catch (...) {
      text = "an unknown exception";
    }
    header.length = text.size();
    std::fflush(nullptr);
    if (!send_all(socket, &header, sizeof header) || !send_all(socket, text.data(), text.size())) break;
  }
  _exit(0);
}

std::string cause_of_death(int status) {
  if (WIFEXITED(status)) return "its process ended with exit code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  return "its process was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")" +
         (signal == SIGKILL ? ", perhaps for want of memory" : "");
}

/// A worker process as its parent sees it.
struct Worker {
  pid_t pid = -1;
  int socket = -1;
  std::optional<std::size_t> task;
  Clock::time_point started;
  std::string received;

  double busy_s() const { return std::chrono::duration<double>(Clock::now() - started).count(); }

  /// A whole answer, when one has arrived.
  std::optional<TaskResult> answer() {
    Header header;
    if (!task || received.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, received.data(), sizeof header);
    if (received.size() < sizeof header + header.length) return std::nullopt;
    TaskResult result{*task, header.done != 0 ? TaskEnd::Done : TaskEnd::Failed, received.substr(sizeof header),
                      busy_s()};
    received.clear();
    task.reset();
    return result;
  }

  /// False when the other end is gone.
  bool receive() {
    char buffer[65536];
    for (;;) {
      const ssize_t got = recv(socket, buffer, sizeof buffer, MSG_DONTWAIT);
      if (got > 0) {
        received.append(buffer, static_cast<std::size_t>(got));
      } else if (got < 0 && errno == EINTR) {
        continue;
      } else {
        return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
      }
    }
  }

  /// Ends the process and returns its status as waitpid gives it.
  int bury() {
    int status = 0;
    kill(pid, SIGKILL);
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    close(socket);
    *this = {};
    return status;
  }
};

class Pool {
 public:
  Pool(const std::function<std::string(std::size_t)>& work, const PoolOptions& options)
      : work_(work), options_(options) {}
  ~Pool() {
    for (Worker& worker : workers_)
      if (worker.pid > 0) worker.bury();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  bool run(std::size_t tasks, const std::function<void(const TaskResult&)>& finished) {
    state_.tasks = tasks;
    workers_.resize(std::min(tasks, static_cast<std::size_t>(std::max(options_.workers, 1))));
    while (state_.finished < tasks) {
      if (options_.stop && options_.stop()) return false;
      hand_out();
      if (options_.progress) options_.progress(state_);
      for (const TaskResult& result : wait()) {
        ++state_.finished;
        --state_.running;
        finished(result);
      }
    }
    if (options_.progress) options_.progress(state_);
    return true;
  }

 private:
  void spawn(Worker& worker) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw RunError(std::string("cannot make a worker process: ") + std::strerror(errno) + "; use fewer --workers");
    std::fflush(nullptr);  // else the child would write our buffers a second time
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid < 0) {
      const int why = errno;
      close(ends[0]);
      close(ends[1]);
      throw RunError(std::string("cannot make a worker process: ") + std::strerror(why) + "; use fewer --workers");
    }
    if (pid == 0) {
      close(ends[0]);
      for (const Worker& other : workers_)
        if (other.socket >= 0) close(other.socket);
      serve(ends[1], parent, work_, options_.log);
    }
    close(ends[1]);
    worker.pid = pid;
    worker.socket = ends[0];
  }

  void hand_out() {
    for (Worker& worker : workers_) {
      if (next_ == state_.tasks) return;
      if (worker.task) continue;
      if (worker.pid < 0) spawn(worker);
      const std::uint64_t number = next_;
      if (!send_all(worker.socket, &number, sizeof number)) {  // it died while idle
        worker.bury();
        spawn(worker);
        if (!send_all(worker.socket, &number, sizeof number)) throw RunError("worker processes die at once");
      }
      worker.task = next_++;
      worker.started = Clock::now();
      ++state_.running;
    }
  }

  /// Waits a moment for answers, deaths and time limits.
  std::vector<TaskResult> wait() {
    std::vector<pollfd> sockets;
    for (const Worker& worker : workers_) sockets.push_back({worker.task ? worker.socket : -1, POLLIN, 0});
    poll(sockets.data(), sockets.size(), kPollMs);
    std::vector<TaskResult> results;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      Worker& worker = workers_[i];
      if (!worker.task) continue;
      const bool alive = sockets[i].revents == 0 || worker.receive();
      if (auto result = worker.answer()) {
        results.push_back(*result);
      } else if (!alive) {
        const std::size_t task = *worker.task;
        const double busy = worker.busy_s();
        results.push_back({task, TaskEnd::Failed, cause_of_death(worker.bury()), busy});
      } else if (worker.busy_s() > options_.time_limit) {
        const std::size_t task = *worker.task;
        const double busy = worker.busy_s();
        worker.bury();
        results.push_back({task, TaskEnd::TimedOut, "", busy});
      }
    }
    return results;
  }

  const std::function<std::string(std::size_t)>& work_;
  const PoolOptions& options_;
  std::vector<Worker> workers_;
  PoolState state_;
  std::size_t next_ = 0;
};

}  // namespace

bool run_pool(std::size_t tasks, const std::function<std::string(std::size_t)>& work,
              const std::function<void(const TaskResult&)>& finished, const PoolOptions& options) {
  return Pool(work, options).run(tasks, finished);
}

}  // namespace rubble::scenarios
