#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/stamp.h"

namespace rubble::robot {

/// The lines of a text, numbered from 1, without line ends and without the byte order mark that some editors set.
class TextLines {
 public:
  explicit TextLines(std::string_view text);
  /// False behind the last line.
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }

 private:
  std::string_view rest_;
  std::string_view line_;
  int number_ = 0;
};

/// Takes the fields of one line, parted by blanks; every failure names file, line and column.
class TextFields {
 public:
  TextFields(const std::string& path, const TextLines& lines)
      : path_(path), line_(lines.line()), number_(lines.number()) {}

  /// Empty at the end of the line.
  std::string_view peek();
  /// `what` names the field in errors. Throws InputError: missing, not a finite number.
  std::string_view text(const char* what);
  double number(const char* what);
  std::int64_t integer(const char* what, std::int64_t low, std::int64_t high);
  /// Decimal seconds, exact to the nanosecond.
  Stamp stamp(const char* what);
  void skip(int fields, const char* what);
  /// Throws InputError that points at the field taken last.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  const std::string& path_;
  std::string_view line_;
  int number_;
  std::size_t at_ = 0;     ///< behind the field taken last
  std::size_t start_ = 0;  ///< of that field
};

}  // namespace rubble::robot
