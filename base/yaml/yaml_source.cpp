#include "base/yaml/yaml_source.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/text/words.h"

namespace rubble {
namespace {

int indent_of(const std::string& line) {
  const std::size_t n = line.find_first_not_of(' ');
  return static_cast<int>(n == std::string::npos ? line.size() : n);
}

bool is_blank(const std::string& line) { return line.find_first_not_of(" \t") == std::string::npos; }

/// Of its first line that is not blank: what the source line has more than these is indentation.
int leading_spaces_of_value(const std::string& text) {
  const std::size_t word = text.find_first_not_of(" \t\n");
  if (word == std::string::npos) return 0;
  const std::size_t line_end = text.rfind('\n', word);
  return indent_of(text.substr(line_end == std::string::npos ? 0 : line_end + 1));
}

/// The character a scalar starts with, after its tag and anchor (`!!str &a |2-`), and where it is; npos: none.
std::size_t content_column(const YamlPlace& place) {
  const std::string& line = place.line_text();
  auto i = static_cast<std::size_t>(place.column);
  while (i < line.size() && (line[i] == '!' || line[i] == '&')) {
    i = line.find_first_of(" \t", i);
    if (i != std::string::npos) i = line.find_first_not_of(" \t", i);
  }
  return i < line.size() ? i : std::string::npos;
}

}  // namespace

std::shared_ptr<const YamlSource> make_yaml_source(const std::string& text, const std::string& name, bool is_option) {
  auto source = std::make_shared<YamlSource>();
  source->name = name;
  source->is_option = is_option;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    source->lines.push_back(line);
  }
  if (source->lines.empty()) source->lines.emplace_back();
  return source;
}

std::string YamlPlace::str() const {
  if (source->is_option) return source->name;
  return source->name + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1);
}

void YamlPlace::fail(const std::string& message) const { throw InputError(str() + ": " + one_line(message)); }

std::optional<YamlBlock> block_at(const YamlPlace& place, const std::string& text) {
  const std::size_t indicator = content_column(place);
  if (indicator == std::string::npos) return std::nullopt;
  const char style = place.line_text()[indicator];
  if (style != '|' && style != '>') return std::nullopt;

  const std::vector<std::string>& lines = place.source->lines;
  const auto line = [&](int i) -> const std::string& { return lines[static_cast<std::size_t>(i)]; };
  const auto count = static_cast<int>(lines.size());
  YamlBlock block;
  block.literal = style == '|';
  block.first_line = block.end_line = place.line + 1;
  int first = block.first_line;
  while (first < count && is_blank(line(first))) ++first;
  if (first < count) block.indent = std::max(0, indent_of(line(first)) - leading_spaces_of_value(text));
  while (block.end_line < count && (is_blank(line(block.end_line)) || indent_of(line(block.end_line)) >= block.indent))
    ++block.end_line;
  return block;
}

bool quote_is_closed(const YamlPlace& place) {
  const std::vector<std::string>& lines = place.source->lines;
  std::size_t column = content_column(place);
  auto i = static_cast<std::size_t>(place.line);
  if (column == std::string::npos || (lines[i][column] != '"' && lines[i][column] != '\'')) return true;
  const char quote = lines[i][column++];
  for (; i < lines.size(); ++i, column = 0) {
    for (; column < lines[i].size(); ++column) {
      const char next = column + 1 < lines[i].size() ? lines[i][column + 1] : '\n';
      if (quote == '"' && lines[i][column] == '\\') {
        ++column;
      } else if (quote == '\'' && lines[i][column] == quote && next == quote) {
        ++column;  // '' is a quote inside the text
      } else if (lines[i][column] == quote) {
        return true;
      }
    }
  }
  return false;
}

bool is_tab_indented(const std::string& line) {
  const std::size_t word = line.find_first_not_of(" \t");
  return word != std::string::npos && line[word] != '#' && line.find('\t') < word;
}

}  // namespace rubble
