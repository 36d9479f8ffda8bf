#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rubble {

/// The text a YAML value came from: a file, or one `--set key=value` of the command line.
struct YamlSource {
  std::string name;                ///< path, "--set dotted.key", or where in another file the value stands
  bool is_option = false;          ///< places are the name alone
  std::vector<std::string> lines;  ///< at least one, without line ends
};

/// Splits `text` into the lines of a source.
std::shared_ptr<const YamlSource> make_yaml_source(const std::string& text, const std::string& name, bool is_option);

/// A place in a source; line and column (in bytes) count from 0 here and from 1 in messages.
struct YamlPlace {
  std::shared_ptr<const YamlSource> source;
  int line = 0;
  int column = 0;

  const std::string& line_text() const { return source->lines[static_cast<std::size_t>(line)]; }
  /// `file:line:column`, or the name of an option.
  std::string str() const;
  /// Throws InputError: `place: message` in one line.
  [[noreturn]] void fail(const std::string& message) const;
};

/// The lines of a block scalar ('|' or '>').
struct YamlBlock {
  int first_line = 0;
  int end_line = 0;      ///< one past the last line
  int indent = 0;        ///< columns of its lines that are indentation
  bool literal = false;  ///< '|': lines of the value are lines of the source
};

/// The block scalar whose value is `text` and whose header stands at `place`; nothing if no block starts there.
std::optional<YamlBlock> block_at(const YamlPlace& place, const std::string& text);

/// False when a quoted scalar starts at `place` and its quote never ends.
bool quote_is_closed(const YamlPlace& place);

/// The line has a tab in the white space before its first word (comments aside).
bool is_tab_indented(const std::string& line);

}  // namespace rubble
