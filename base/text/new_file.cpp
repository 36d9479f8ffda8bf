#include "base/text/new_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/text/input_file.h"

namespace rubble {

namespace {

/// A name that a signal handler may read at any moment: it is whole while `owner` is set.
struct Unfinished {
  std::atomic<bool> taken{false};
  std::atomic<pid_t> owner{0};  ///< of a child that was forked meanwhile it is not
  std::array<char, PATH_MAX> name{};
};

std::array<Unfinished, 16> unfinished;

/// More at once than there are slots, or with longer names, are only not removed.
void note_unfinished(const std::string& part) {
  if (part.size() >= PATH_MAX) return;
  for (Unfinished& slot : unfinished) {
    if (slot.taken.exchange(true)) continue;
    std::copy_n(part.c_str(), part.size() + 1, slot.name.begin());
    slot.owner = getpid();
    return;
  }
}

/// No signal comes to this thread between a file's making and its being noted. One that another thread takes just then
/// may leave the file: noted before it is made, a file of someone else could be removed.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

NewFile::NewFile(const std::string& path) : path_(path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw RunError(path + ": is a folder; give the path of a file");
  replaces_ = fs::exists(status);
  if (replaces_ && !fs::is_regular_file(status)) {  // a device or pipe is written to, never replaced
    // O_NONBLOCK: a pipe that nobody reads is told, not waited for.
    file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file_ < 0 && errno == ENXIO) throw RunError(path + ": is a pipe that nobody reads; start its reader first");
    if (file_ < 0) fail(errno);
    ::fcntl(file_, F_SETFL, 0);
    return;
  }
  require_not_read(path);
  const fs::path linked = fs::weakly_canonical(path, error);
  target_ = error ? path : linked.string();
  std::string part;
  file_ = create_beside(target_, part);
  if (file_ < 0) fail(errno);
  part_ = part;
  note_written(file_);
}

NewFile::~NewFile() {
  if (file_ >= 0) ::close(file_);
  if (part_.empty()) return;
  std::remove(part_.c_str());
  let_be(part_);
}

void NewFile::put(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file_, bytes.data(), bytes.size());
    if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
    if (n == 0) fail(ENOSPC);
    if (n < 0 && errno != EINTR) fail(errno);
  }
}

void NewFile::keep() {
  if (!part_.empty() && replaces_ && ::fsync(file_) != 0 && errno != EINVAL) fail(errno);
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) fail(errno);
  if (part_.empty()) return;
  std::error_code error;
  std::filesystem::rename(part_, target_, error);
  if (error) fail(error.value());
  let_be(part_);
  part_.clear();
}

void NewFile::fail(int error) const {
  throw RunError(path_ + ": cannot be written (" + std::strerror(error) + "); check the folder and the free space");
}

int create_beside(const std::string& target, std::string& part) {
  const SignalsWait wait;
  for (int number = 0;; ++number) {
    part = target + "." + std::to_string(getpid()) + (number == 0 ? "" : "-" + std::to_string(number)) + ".part";
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) note_unfinished(part);
    if (file >= 0 || errno != EEXIST || number == 1000) return file;
  }
}

void let_be(const std::string& part) {
  for (Unfinished& slot : unfinished) {
    if (slot.owner != getpid() || part != slot.name.data()) continue;
    slot.owner = 0;
    slot.taken = false;
  }
}

void remove_unfinished_files() noexcept {
  for (const Unfinished& slot : unfinished)
    if (slot.owner == getpid()) unlink(slot.name.data());
}

}  // namespace rubble
