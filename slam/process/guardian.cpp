#include "slam/process/guardian.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

#include "base/error.h"

extern char** environ;  // NOLINT: POSIX names it

namespace rubble::slam {
namespace {

// What runs between fork and exec or exit may be the copy of a process with threads: it allocates nothing, and calls
// only what is safe in a signal handler.

constexpr int kLastTry = 2000;  ///< rounds of ending what does not want to end: some ten seconds

void on_child(int) {}

/// The number a text begins with; -1 when it begins with none.
long number_at(const char* text) {
  if (*text < '0' || *text > '9') return -1;
  long value = 0;
  for (; *text >= '0' && *text <= '9' && value < 100'000'000; ++text) value = 10 * value + (*text - '0');
  return value;
}

/// The parent of process `name` (its folder in /proc); -1: gone.
long parent_of(int proc, const char* name) {
  const int folder = openat(proc, name, O_RDONLY | O_DIRECTORY);
  if (folder < 0) return -1;
  const int file = openat(folder, "stat", O_RDONLY);
  close(folder);
  if (file < 0) return -1;
  char text[512];
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  if (size <= 0) return -1;
  text[size] = '\0';
  // "pid (name) state parent ...": the name may hold anything.
  const char* after = nullptr;
  for (const char* c = text; *c != '\0'; ++c)
    if (*c == ')') after = c;
  return after != nullptr && std::strlen(after) > 4 ? number_at(after + 4) : -1;
}

/// Sends SIGKILL to every process whose parent this one is.
void kill_children() {
  const int proc = open("/proc", O_RDONLY | O_DIRECTORY);
  if (proc < 0) return;
  struct Entry {
    std::uint64_t inode;
    std::int64_t offset;
    unsigned short size;
    unsigned char type;
    char name[1];
  };
  alignas(std::uint64_t) char buffer[8192];
  for (;;) {
    const long got = syscall(SYS_getdents64, proc, buffer, sizeof buffer);
    if (got <= 0) break;
    for (long at = 0; at < got;) {
      const Entry* const entry = reinterpret_cast<const Entry*>(buffer + at);
      const long pid = number_at(entry->name);
      if (pid > 1 && parent_of(proc, entry->name) == getpid()) kill(static_cast<pid_t>(pid), SIGKILL);
      at += entry->size;
    }
  }
  close(proc);
}

/// Ends the process, its group, and everything that descends from it: what loses its parent becomes our child.
void end_all(pid_t group) {
  if (group > 0) kill(-group, SIGKILL);
  for (int round = 0; round < kLastTry; ++round) {
    kill_children();
    for (;;) {
      const pid_t ended = waitpid(-1, nullptr, WNOHANG);
      if (ended < 0 && errno == ECHILD) return;
      if (ended <= 0) break;
    }
    const timespec moment{0, round < 100 ? 1'000'000 : 5'000'000};
    nanosleep(&moment, nullptr);
  }
}

void keep_only(int descriptor) {
  if (descriptor != 0) {
    dup2(descriptor, 0);
    fcntl(0, F_SETFD, FD_CLOEXEC);
  }
  close_range(1, ~0u, 0);
}

/// The life of the guardian.
[[noreturn]] void guard(pid_t charge, int lifeline) {
  keep_only(lifeline);
  sigset_t none;
  sigemptyset(&none);
  for (;;) {
    int status = 0;
    for (pid_t ended = 1; (ended = waitpid(-1, &status, WNOHANG)) > 0;)
      if (ended == charge) {
        end_all(charge);
        (void)!send(0, &status, sizeof status, MSG_NOSIGNAL);
        _exit(0);
      }
    pollfd line{0, POLLIN, 0};
    if (ppoll(&line, 1, nullptr, &none) > 0) {  // nobody writes: the other end is gone
      end_all(charge);
      _exit(0);
    }
  }
}

void reset_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGCHLD}) std::signal(signal, SIG_DFL);
}

/// The life of the process up to exec.
[[noreturn]] void become(const GuardedProcess& process, char* const* argv, char* const* environment, pid_t guardian) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != guardian) _exit(127);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(process.input, STDIN_FILENO);
  dup2(process.output, STDOUT_FILENO);
  if (process.errors >= 0) dup2(process.errors, STDERR_FILENO);
  close_range(3, ~0u, 0);
  execve(argv[0], argv, environment);
  static constexpr char kWhy[] = "rubble: the mapper's program cannot be started\n";
  (void)!write(STDERR_FILENO, kWhy, sizeof kWhy - 1);
  _exit(127);
}

[[noreturn]] void cannot_start(int why) {
  throw RunError(std::string("the mapper's process cannot be made: ") + std::strerror(why));
}

/// Python's sets and dictionaries of text follow a random order unless told otherwise.
std::vector<char*> environment_of_mapper() {
  static char seed[] = "PYTHONHASHSEED=0";
  std::vector<char*> all;
  bool given = false;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    given = given || std::strncmp(*entry, seed, 15) == 0;
    all.push_back(*entry);
  }
  if (!given) all.push_back(seed);
  all.push_back(nullptr);
  return all;
}

}  // namespace

pid_t start_guarded(const GuardedProcess& process, int& lifeline) {
  std::vector<char*> argv;
  for (const std::string& word : process.argv) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const std::vector<char*> environment = environment_of_mapper();
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) cannot_start(errno);
  const pid_t guardian = fork();
  if (guardian < 0) {
    const int why = errno;
    close(ends[0]);
    close(ends[1]);
    cannot_start(why);
  }
  if (guardian == 0) {
    close(ends[0]);
    setsid();  // Ctrl-C on the terminal is for rubble, which then ends the mapper
    prctl(PR_SET_NAME, "rubble-guardian");
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    reset_signals();
    // A child that ends interrupts the guardian's wait, and nothing else.
    sigset_t children;
    sigemptyset(&children);
    sigaddset(&children, SIGCHLD);
    sigprocmask(SIG_SETMASK, &children, nullptr);
    std::signal(SIGCHLD, on_child);
    const pid_t self = getpid();
    const pid_t charge = fork();
    if (charge == 0) become(process, argv.data(), environment.data(), self);
    if (charge < 0) _exit(1);
    guard(charge, ends[1]);
  }
  close(ends[1]);
  lifeline = ends[0];
  return guardian;
}

}  // namespace rubble::slam
