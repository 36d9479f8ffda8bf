#pragma once

#include <string>
#include <vector>

namespace rubble {

/// `text`, with an apostrophe before it when a spreadsheet would take it for a formula and run it: = @ tab or return
/// first, or a sign that no number follows.
std::string not_a_formula(const std::string& text);

/// A CSV field in quotes, as RFC 4180 has it.
std::string csv_quoted(const std::string& text);

/// `text` as one CSV field: in quotes where it needs them, line breaks as spaces (every record stays one line).
std::string csv_field(const std::string& text);

/// The fields of one record, joined; no line end. What a spreadsheet would run gets an apostrophe before it.
std::string csv_line(const std::vector<std::string>& fields);

/// Fields of one line of CSV; quotes keep commas.
std::vector<std::string> csv_fields(const std::string& line);

}  // namespace rubble
