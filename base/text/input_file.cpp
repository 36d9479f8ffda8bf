#include "base/text/input_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/text/words.h"

namespace rubble {
namespace {

/// Of a file whatever its names. The time of birth tells a new file from a deleted one whose number it got; systems
/// that do not know it say 0.
using Identity = std::tuple<unsigned, unsigned, std::uint64_t, std::int64_t, unsigned>;

std::optional<Identity> identity_of(int folder, const char* path, int flags) {
  struct statx s {};
  if (statx(folder, path, flags, STATX_TYPE | STATX_INO | STATX_BTIME, &s) != 0 || !S_ISREG(s.stx_mode))
    return std::nullopt;
  const bool birth = (s.stx_mask & STATX_BTIME) != 0;
  return Identity{s.stx_dev_major, s.stx_dev_minor, s.stx_ino, birth ? s.stx_btime.tv_sec : 0,
                  birth ? s.stx_btime.tv_nsec : 0};
}

/// What this process has read, and what it made.
struct Ledger {
  std::mutex mutex;
  std::set<Identity> read;
  std::set<Identity> written;
};

Ledger& ledger() {
  static Ledger instance;
  return instance;
}

void note_read(int file) {
  const auto identity = identity_of(file, "", AT_EMPTY_PATH);
  if (!identity) return;
  Ledger& l = ledger();
  const std::lock_guard<std::mutex> lock(l.mutex);
  if (l.written.count(*identity) == 0) l.read.insert(*identity);
}

/// A name that only the user can have typed: what is in a foreign folder has others.
bool is_given_stream(const std::string& path) {
  return path == "/dev/stdin" || path.rfind("/dev/fd/", 0) == 0 || path.rfind("/proc/self/fd/", 0) == 0;
}

std::string size_text(std::size_t bytes) {
  return bytes >> 30 > 0 ? std::to_string(bytes >> 30) + " GB" : std::to_string(bytes >> 20) + " MB";
}

}  // namespace

InputRules image_rules() {
  return {"an image", std::size_t{1} << 30, "scale the map down to at most 10000 x 10000 pixels", Pipes::None};
}

InputFile::InputFile(const std::string& path, const InputRules& rules) : path_(path), rules_(rules) {
  const std::string give = "; give the path of " + rules.thing;
  if (path.empty()) throw InputError("an empty name is no file" + give);
  if (path.find('\0') != std::string::npos) throw InputError(one_line(path) + ": holds a zero byte" + give);
  // Without O_NONBLOCK a pipe that nobody writes to holds us here.
  file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file_ < 0) {
    if (errno == ENXIO) throw InputError(path + ": is a socket or a device" + give);
    throw InputError(path + ": cannot be opened (" + std::strerror(errno) + "); check the path");
  }
  const bool is_terminal_or_null = path == "/dev/null" || (rules.pipes != Pipes::None && is_given_stream(path));
  struct stat status {};
  std::string trouble;
  if (fstat(file_, &status) != 0) {
    trouble = std::string(": cannot be looked at (") + std::strerror(errno) + "); check the path";
  } else if (S_ISDIR(status.st_mode)) {
    trouble = ": is a folder" + give;
  } else if (S_ISFIFO(status.st_mode)) {
    waits_ = true;
    const bool typed = rules.pipes == Pipes::Typed && is_given_stream(path);
    if (!typed && rules.pipes != Pipes::Named) trouble = ": is a pipe" + give;
  } else if (S_ISSOCK(status.st_mode)) {
    trouble = ": is a socket" + give;
  } else if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && !is_terminal_or_null)) {
    trouble = ": is a device" + give;
  } else if (S_ISCHR(status.st_mode)) {
    waits_ = true;
  } else if (static_cast<std::uintmax_t>(status.st_size) > rules.most) {
    trouble = ": is over " + size_text(rules.most) + ", " + rules.too_large;
  }
  if (!trouble.empty()) {
    ::close(file_);
    throw InputError(path + trouble);
  }
  if (!waits_) size_ = static_cast<std::size_t>(status.st_size);
  note_read(file_);
}

InputFile::~InputFile() { ::close(file_); }

std::size_t InputFile::read(char* to, std::size_t size) {
  for (;;) {
    if (waits_) {
      pollfd ready{file_, POLLIN, 0};
      // A handler that was run means that the user wants to end this.
      if (poll(&ready, 1, -1) < 0 && errno == EINTR)
        throw Interrupted(path_ + ": interrupted while it was read; nothing was written");
    }
    const ssize_t got = ::read(file_, to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno == EINTR || (errno == EAGAIN && waits_)) continue;
    fail_read();
  }
}

std::optional<std::size_t> InputFile::size() const {
  if (waits_) return std::nullopt;
  return size_;
}

std::size_t InputFile::read_at(std::size_t offset, char* to, std::size_t size) const {
  for (;;) {
    const ssize_t got = ::pread(file_, to, size, static_cast<off_t>(offset));
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) fail_read();
  }
}

void InputFile::fail_read() const {
  throw InputError(path_ + ": cannot be read (" + std::strerror(errno) + "); give the path of " + rules_.thing);
}

std::string InputFile::rest() {
  std::string bytes;
  std::vector<char> chunk(std::size_t{1} << 16);
  while (const std::size_t got = read(chunk.data(), chunk.size())) {
    bytes.append(chunk.data(), got);
    if (bytes.size() > rules_.most)
      throw InputError(path_ + ": is over " + size_text(rules_.most) + ", " + rules_.too_large);
  }
  return bytes;
}

std::string read_input(const std::string& path, const InputRules& rules) { return InputFile(path, rules).rest(); }

void require_input(const std::string& path, const InputRules& rules) { const InputFile file(path, rules); }

bool was_read(const std::string& path) {
  const auto identity = identity_of(AT_FDCWD, path.c_str(), 0);
  if (!identity) return false;
  Ledger& l = ledger();
  const std::lock_guard<std::mutex> lock(l.mutex);
  return l.read.count(*identity) > 0;
}

void require_not_read(const std::string& path) {
  if (was_read(path)) throw InputError(path + ": is what is read, and would be lost; give another path to write to");
}

void note_written(int file) {
  const auto identity = identity_of(file, "", AT_EMPTY_PATH);
  if (!identity) return;
  Ledger& l = ledger();
  const std::lock_guard<std::mutex> lock(l.mutex);
  l.read.erase(*identity);
  l.written.insert(*identity);
}

}  // namespace rubble
