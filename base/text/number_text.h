#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rubble {

/// The finite decimal number that is all of `text` (12, -0.5, .5, 1e-3), whatever the locale.
/// Nothing for other text, inf, nan, hexadecimal, or beyond the range of a double.
std::optional<double> parse_number(std::string_view text);

/// The whole decimal number that is all of `text`; nothing for 1.0, 1e3, or beyond 64 bits.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// The shortest decimal text that reads back as the same double, whatever the locale.
std::string number_text(double value);

/// The same to 0.1 mm: more does not belong into a file of places.
std::string metres_text(double value);

}  // namespace rubble
