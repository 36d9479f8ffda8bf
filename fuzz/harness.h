#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"

namespace rubble::fuzz {

/// Reads a hostile input: refusing it is well, anything else thrown ends the target.
template <class Read>
void refuses_or_reads(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The input as a file in memory, for readers that take a path; one at a time. All inputs are the same file: a process
/// remembers each one it has read (base/text/input_file.h), and millions of them took hundreds of megabytes.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) {
    if (ftruncate(file(), 0) != 0) std::abort();
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = pwrite(file(), data + done, size - done, static_cast<off_t>(done));
      if (n <= 0) std::abort();
      done += static_cast<std::size_t>(n);
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file()); }

 private:
  static int file() {
    static const int file = memfd_create("input", MFD_CLOEXEC);
    return file;
  }
};

}  // namespace rubble::fuzz

/// The body of a target, with `data` and `size`.
#define RUBBLE_FUZZ_TARGET extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
