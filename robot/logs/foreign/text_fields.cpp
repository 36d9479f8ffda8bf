#include "robot/logs/foreign/text_fields.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "base/text/words.h"

namespace rubble::robot {
namespace {

constexpr double kLatestSecond = 4.6e9;  // 1824 to 2115: also the time from one end to the other has 64 bits

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Digits and a point to nanoseconds without a double between; false where the text has another form.
bool exact_nanoseconds(std::string_view text, std::int64_t& ns) {
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) text.remove_prefix(1);
  std::int64_t value = 0;
  int decimals = -1;  // none yet
  for (const char c : text) {
    if (c == '.' && decimals < 0) {
      decimals = 0;
    } else if (c >= '0' && c <= '9') {
      if (decimals == 9) continue;  // finer than a nanosecond
      if (value > (INT64_MAX - 9) / 10) return false;
      value = value * 10 + (c - '0');
      if (decimals >= 0) ++decimals;
    } else {
      return false;
    }
  }
  for (int d = decimals < 0 ? 0 : decimals; d < 9; ++d) {
    if (value > INT64_MAX / 10) return false;
    value *= 10;
  }
  ns = negative ? -value : value;
  return true;
}

}  // namespace

TextLines::TextLines(std::string_view text) : rest_(text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++number_;
  return true;
}

std::string_view TextFields::peek() {
  std::size_t from = at_;
  while (from < line_.size() && is_blank(line_[from])) ++from;
  std::size_t to = from;
  while (to < line_.size() && !is_blank(line_[to])) ++to;
  return line_.substr(from, to - from);
}

std::string_view TextFields::text(const char* what) {
  const std::string_view field = peek();
  if (field.empty()) {
    start_ = line_.size();
    fail(std::string("the line ends where '") + what + "' should stand; complete the line or delete it");
  }
  start_ = static_cast<std::size_t>(field.data() - line_.data());
  at_ = start_ + field.size();
  return field;
}

double TextFields::number(const char* what) {
  std::string_view field = text(what);
  if (field[0] == '+') field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  // from_chars tells too large from too small (1e-320, harmless) no better than this.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(field).c_str(), nullptr);
  const bool understood = error != std::errc::invalid_argument && end == field.data() + field.size();
  if (!understood || !std::isfinite(value))
    fail(std::string("'") + std::string(field.substr(0, 40)) + "' is not a finite number, but '" + what +
         "' must be one; correct or delete the line");
  return value;
}

std::int64_t TextFields::integer(const char* what, std::int64_t low, std::int64_t high) {
  const double value = number(what);
  if (value != std::floor(value) || value < static_cast<double>(low) || value > static_cast<double>(high))
    fail(std::string("'") + what + "' must be a whole number from " + std::to_string(low) + " to " +
         std::to_string(high));
  return static_cast<std::int64_t>(value);
}

Stamp TextFields::stamp(const char* what) {
  const double seconds = number(what);
  if (std::abs(seconds) > kLatestSecond)
    fail(std::string("'") + what + "' is not a time in seconds; correct or delete the line");
  Stamp stamp;
  if (!exact_nanoseconds(line_.substr(start_, at_ - start_), stamp.ns)) stamp = Stamp::from_seconds(seconds);
  return stamp;
}

void TextFields::skip(int fields, const char* what) {
  for (int i = 0; i < fields; ++i) text(what);
}

void TextFields::fail(const std::string& message) const {
  throw InputError(at(path_, number_, static_cast<int>(start_) + 1, one_line(message)));  // a zero byte would end it
}

}  // namespace rubble::robot
