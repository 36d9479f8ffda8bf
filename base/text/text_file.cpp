#include "base/text/text_file.h"

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

/// 0 or the error number.
int write_all(const std::string& path, std::string_view text) {
  errno = 0;
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) return errno;
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const int error = errno;
  const bool closed = std::fclose(file.release()) == 0;
  if (!written) return error;
  return closed ? 0 : errno;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path + ": is a folder; give the path of a file");
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
    if (const int failure = write_all(path, text)) fail_write(path, failure);
    return;
  }
  const fs::path linked = fs::weakly_canonical(path, error);  // a symbolic link stays one
  const std::string target = error ? path : linked.string();
  const std::string part = target + "." + std::to_string(getpid()) + ".part";
  int failure = write_all(part, text);
  if (failure == 0) {
    fs::rename(part, target, error);
    failure = error.value();
  }
  if (failure == 0) return;
  std::remove(part.c_str());
  fail_write(path, failure);
}

}  // namespace rubble
