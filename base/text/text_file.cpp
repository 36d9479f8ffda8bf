#include "base/text/text_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/error.h"

namespace rubble {
namespace {

constexpr std::size_t kLargest = 256u << 20;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

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

std::string read_text_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path + ": is a folder; give the path of a file");
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_character_file(status) && path != "/dev/stdin" && path != "/dev/null")
    throw InputError(path + ": is a device; give the path of a file");
  errno = 0;
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path + ": cannot be opened (" + std::strerror(errno) + "); check the path");
  std::string text;
  char buffer[65536];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file.get())) {
    text.append(buffer, n);
    if (text.size() > kLargest) throw InputError(path + ": is over 256 MB; this is not the file you mean");
  }
  if (std::ferror(file.get())) throw InputError(path + ": cannot be read (" + std::strerror(errno) + ")");
  return text;
}

void write_text_file(const std::string& path, std::string_view text) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw RunError(path + ": is a folder; give the path of a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {  // a device or pipe is written to, never replaced
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) fail_write(path, errno);
    if (const int failure = write_and_close(file, text, false)) fail_write(path, failure);
    return;
  }
  const fs::path linked = fs::weakly_canonical(path, error);  // a symbolic link stays one
  const std::string target = error ? path : linked.string();
  std::string part;
  const int file = create_beside(target, part);
  if (file < 0) fail_write(path, errno);
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

}  // namespace rubble
