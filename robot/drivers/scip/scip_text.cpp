#include "robot/drivers/scip/scip_text.h"

#include <algorithm>

namespace rubble::robot::scip {

char sum_of(std::string_view text) {
  unsigned total = 0;
  for (const char c : text) total += static_cast<unsigned char>(c);
  return static_cast<char>((total & 0x3Fu) + 0x30u);
}

std::optional<std::string_view> checked(std::string_view line) {
  if (line.empty()) return std::nullopt;
  const std::string_view text = line.substr(0, line.size() - 1);
  if (sum_of(text) != line.back()) return std::nullopt;
  return text;
}

std::optional<std::string_view> checked_entry(std::string_view line) {
  if (line.size() < 2 || line[line.size() - 2] != ';') return std::nullopt;
  const std::string_view text = line.substr(0, line.size() - 2);
  if (sum_of(text) != line.back()) return std::nullopt;
  return text;
}

std::string encode(std::uint32_t value, std::size_t characters) {
  std::string text(characters, '0');
  for (std::size_t i = characters; i-- > 0; value >>= 6) text[i] = static_cast<char>((value & 0x3Fu) + 0x30u);
  return text;
}

std::optional<std::uint32_t> decode(std::string_view characters) {
  std::uint32_t value = 0;
  for (const char c : characters) {
    const auto digit = static_cast<std::uint32_t>(static_cast<unsigned char>(c)) - 0x30u;
    if (digit > 0x3Fu) return std::nullopt;
    value = value << 6 | digit;
  }
  return value;
}

std::string cut_into_lines(std::string_view characters, bool sums) {
  std::string lines;
  lines.reserve(characters.size() + characters.size() / 32 + 2);
  for (std::size_t at = 0; at < characters.size(); at += kDataLine) {
    const std::string_view line = characters.substr(at, kDataLine);
    lines += line;
    if (sums) lines += sum_of(line);
    lines += '\n';
  }
  return lines;
}

std::optional<int> number(std::string_view digits) {
  if (digits.empty() || digits.size() > 9) return std::nullopt;
  int value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return value;
}

}  // namespace rubble::robot::scip
