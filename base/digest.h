#pragma once

#include <string>
#include <string_view>

namespace rubble {

/// SHA-256 as 64 hexadecimal digits.
std::string sha256_of_text(std::string_view text);

/// The same of a file's bytes. Throws InputError when it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace rubble
