#include "base/text/text_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/text/input_file.h"

namespace rubble {
namespace {

[[noreturn]] void fail_write(const std::string& path, int error) {
  throw RunError(path + ": cannot be written (" + std::strerror(error) + "); check the folder and the free space");
}

/// Writes to a descriptor and closes it; 0 or the error number.
int write_and_close(int file, std::string_view text, bool to_disk) {
  int error = 0;
  while (!text.empty() && error == 0) {
    const ssize_t n = ::write(file, text.data(), text.size());
    if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
    if (n == 0) error = ENOSPC;
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && to_disk && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

/// A file beside `target` that nobody else made: a link or file that was planted under its name is not followed.
int create_beside(const std::string& target, std::string& part) {
  for (int number = 0;; ++number) {
    part = target + "." + std::to_string(getpid()) + (number == 0 ? "" : "-" + std::to_string(number)) + ".part";
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST || number == 1000) return file;
  }
}

}  // namespace

std::string read_text_file(const std::string& path) { return read_input(path); }

void write_text_file(const std::string& path, std::string_view text) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw RunError(path + ": is a folder; give the path of a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {  // a device or pipe is written to, never replaced
    // O_NONBLOCK: a pipe that nobody reads is told, not waited for.
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0 && errno == ENXIO) throw RunError(path + ": is a pipe that nobody reads; start its reader first");
    if (file < 0) fail_write(path, errno);
    ::fcntl(file, F_SETFL, 0);
    if (const int failure = write_and_close(file, text, false)) fail_write(path, failure);
    return;
  }
  require_not_read(path);
  const fs::path linked = fs::weakly_canonical(path, error);  // a symbolic link stays one
  const std::string target = error ? path : linked.string();
  std::string part;
  const int file = create_beside(target, part);
  if (file < 0) fail_write(path, errno);
  note_written(file);
  // Where an older file goes, the new one must be on the disk first.
  int failure = write_and_close(file, text, fs::exists(status));
  if (failure == 0) {
    fs::rename(part, target, error);
    failure = error.value();
  }
  if (failure == 0) return;
  std::remove(part.c_str());
  fail_write(path, failure);
}

std::string place_in(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  std::error_code error;
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(path, error)))
    throw InputError(path +
                     ": is a symbolic link, what is written could go anywhere; remove it or give another folder");
  return path;
}

std::string new_file_beside(const std::string& path) {
  std::string part;
  const int file = create_beside(path, part);
  if (file < 0) fail_write(path, errno);
  ::close(file);
  return part;
}

}  // namespace rubble
