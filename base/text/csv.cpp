#include "base/text/csv.h"

#include <string_view>

#include "base/text/utf8.h"

namespace rubble {
namespace {

bool is_one_of(char c, std::string_view letters) { return letters.find(c) != std::string_view::npos; }

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Digits with a decimal point at most and an exponent, behind one sign.
bool is_signed_number(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos) {
    std::string_view power = text.substr(exponent + 1);
    if (!power.empty() && is_one_of(power.front(), "+-")) power.remove_prefix(1);
    if (!is_digits(power)) return false;
  }
  const std::string_view digits = text.substr(1, exponent == std::string_view::npos ? exponent : exponent - 1);
  const std::size_t point = digits.find('.');
  return digits.find_first_not_of("0123456789.") == std::string_view::npos &&
         digits.find_first_not_of('.') != std::string_view::npos &&
         (point == std::string_view::npos || digits.find('.', point + 1) == std::string_view::npos);
}

bool is_formula(std::string_view text) {
  if (text.empty()) return false;
  if (is_one_of(text.front(), "=@\t\r")) return true;
  return is_one_of(text.front(), "+-") && !is_signed_number(text);
}

}  // namespace

std::string not_a_formula(const std::string& text) { return is_formula(text) ? "'" + text : text; }

std::string csv_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string csv_field(const std::string& text) {
  std::string line = as_utf8(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';  // also the escapes of a terminal that shows it
  const bool is_plain = line == text && line.find_first_of(",\"") == std::string::npos;
  return is_plain ? line : csv_quoted(line);
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields)
    line += (&field == &fields.front() ? "" : ",") + csv_field(not_a_formula(field));
  return line;
}

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

}  // namespace rubble
