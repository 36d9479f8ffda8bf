#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// The text of SCIP 2.0 (Hokuyo, C-42-03320B): what both ends of the line must agree on.
namespace rubble::robot::scip {

constexpr std::size_t kDataLine = 64;           ///< characters of a full data line, its sum apart
constexpr std::uint32_t kClockWrap = 1u << 24;  ///< the device's clock counts milliseconds up to here
constexpr std::uint32_t kFirstRange = 20;       ///< smaller numbers in the place of a range are codes
constexpr std::uint8_t kNoEcho = 0;             ///< code: no or a weak echo, or an object at 22 m
constexpr std::uint8_t kOtherError = 6;         ///< code: other
constexpr std::uint8_t kNotMeasurable = 19;     ///< code of the steps outside the field of view

/// Check character of a line: its bytes added, the low six bits, plus 0x30.
char sum_of(std::string_view text);

/// The line without the check character that ends it; nothing when that is wrong or missing.
std::optional<std::string_view> checked(std::string_view line);

/// The `KEY:value` of a line `KEY:value;` + sum, in which the ';' does not count; nothing when the sum is wrong.
std::optional<std::string_view> checked_entry(std::string_view line);

/// Six bits a character, the highest first, each plus 0x30. The value must fit.
std::string encode(std::uint32_t value, std::size_t characters);

/// The value of up to five such characters; nothing when one is outside 0x30..0x6F.
std::optional<std::uint32_t> decode(std::string_view characters);

/// Cuts characters into lines of 64, each ended by its sum (if `sums`) and LF.
std::string cut_into_lines(std::string_view characters, bool sums);

/// Digits as a number; nothing when one is no digit.
std::optional<int> number(std::string_view digits);

}  // namespace rubble::robot::scip
