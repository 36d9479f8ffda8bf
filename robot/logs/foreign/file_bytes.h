#pragma once

#include <string>

namespace rubble::robot {

/// The whole file. Throws InputError: missing, a folder, unreadable, empty.
std::string read_file(const std::string& path);

/// What a gzip or bzip2 file holds; other bytes as they are. Throws InputError that says where the compressed data end
/// or break.
std::string unpacked(std::string bytes, const std::string& path);

/// Writes `bytes` gzip-compressed; same bytes, same file. Throws RunError.
void write_gzip(const std::string& path, const std::string& bytes);

}  // namespace rubble::robot
