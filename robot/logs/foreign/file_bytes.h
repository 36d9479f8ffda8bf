#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "base/text/input_file.h"

namespace rubble::robot {

/// What a log file may hold, packed or not [bytes].
constexpr std::size_t kLargestLog = std::size_t{1} << 31;

/// How many bytes `packed` bytes of a compressed log may become: 64 MB and forty times as many, up to kLargestLog. Text
/// logs shrink to a fifth; what shrinks to a hundredth is no log. Readers check it while they inflate.
std::size_t most_inflated(std::size_t packed);
/// Throws InputError when `inflated` is more than that.
void check_inflated(std::size_t inflated, std::size_t packed, const std::string& path);

/// What is taken as a log; inside of a run folder no pipe waits.
InputRules log_rules(Pipes pipes = Pipes::None);

/// The whole log, which may come through a pipe. Throws InputError: missing, a folder, a device, unreadable, empty,
/// over 2 GB.
std::string read_file(const std::string& path);
/// The same of a file that was opened with log_rules(), from where it stands.
std::string read_file(InputFile& file);

/// What a gzip or bzip2 file holds; other bytes as they are. Throws InputError that says where the compressed data end
/// or break.
std::string unpacked(std::string bytes, const std::string& path);

/// A gzip file that is written piece by piece; same bytes, same file, however they are cut. See NewFile.
class GzipFile {
 public:
  /// Throws RunError, InputError, as do put() and keep().
  explicit GzipFile(const std::string& path);
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
  void put(std::string_view bytes);
  void keep();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes `bytes` gzip-compressed at once.
void write_gzip(const std::string& path, const std::string& bytes);

}  // namespace rubble::robot
