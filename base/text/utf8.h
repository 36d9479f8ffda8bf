#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rubble {

/// Bytes of the UTF-8 character at `at`; 0: what stands there is none (RFC 3629: no overlong form, no surrogate).
std::size_t utf8_length(std::string_view text, std::size_t at);

/// For files that must be UTF-8: each byte that is part of no character becomes U+FFFD. File names need not be text.
std::string as_utf8(std::string_view text);

/// For a terminal, several lines: control characters but line breaks, and bytes of no character, become \xNN. What is
/// printed may come from foreign files.
std::string printable(std::string_view text);

}  // namespace rubble
