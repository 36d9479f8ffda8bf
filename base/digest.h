#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rubble {

/// SHA-256 as 64 hexadecimal digits.
std::string sha256_of_text(std::string_view text);

/// The same of a file's bytes. Throws InputError when it cannot be read.
std::string sha256_of_file(const std::string& path);

/// CRC-32 as zlib and PNG have it: finds damage, keeps no secret.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace rubble
