#pragma once

#include <cstddef>
#include <string>

#include "base/text/input_file.h"

namespace rubble::robot {

/// What a log file may hold, packed or not [bytes].
constexpr std::size_t kLargestLog = std::size_t{1} << 31;

/// How many bytes `packed` bytes of a compressed log may become: 64 MB and forty times as many, up to kLargestLog. Text
/// logs shrink to a fifth; what shrinks to a hundredth is no log. Readers check it while they inflate.
std::size_t most_inflated(std::size_t packed);
/// Throws InputError when `inflated` is more than that.
void check_inflated(std::size_t inflated, std::size_t packed, const std::string& path);

/// What is taken as a log inside of a run folder: no pipe waits there.
InputRules log_rules();

/// The whole log, which may come through a pipe. Throws InputError: missing, a folder, a device, unreadable, empty,
/// over 2 GB.
std::string read_file(const std::string& path);

/// What a gzip or bzip2 file holds; other bytes as they are. Throws InputError that says where the compressed data end
/// or break.
std::string unpacked(std::string bytes, const std::string& path);

/// Writes `bytes` gzip-compressed; same bytes, same file. Throws RunError.
void write_gzip(const std::string& path, const std::string& bytes);

}  // namespace rubble::robot
