#include <algorithm>

#include "base/text/words.h"
#include "base/yaml/binder.h"
#include "base/yaml/strict_yaml.h"
#include "base/yaml/yaml_node.h"

namespace rubble {

std::string yaml_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\x" + hex_digits(byte);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

namespace {

using Kind = YamlNode::Kind;
using Style = YamlNode::Style;

constexpr std::size_t kLineLength = 100;

bool is_word_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
}

bool is_null_word(const std::string& text) { return text == "null" || text == "Null" || text == "NULL"; }

/// Text that every YAML reader takes as one plain scalar, also inside brackets. Stricter than YAML: what is not plain
/// here is quoted, and only words and numbers must be plain.
bool is_plain(const std::string& text) {
  if (text.empty() || is_null_word(text)) return false;
  std::size_t start = 0;
  if (text[start] == '-' || text[start] == '+') ++start;
  if (start < text.size() && text[start] == '.') ++start;
  if (start >= text.size() || !is_word_letter(text[start]) || text.back() == ' ') return false;
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return is_word_letter(c) || c == '.' || c == '-' || c == '+' || c == ' '; });
}

std::string scalar_text(const YamlNode& node) {
  if (node.kind == Kind::Null) return "null";
  return node.style == Style::Plain && is_plain(node.text) ? node.text : yaml_quoted(node.text);
}

/// Literal block style can hold it: printable, and starts and ends with a line that is not blank.
bool fits_block(const std::string& text) {
  const std::string first = text.substr(0, text.find('\n'));
  const bool printable = std::none_of(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == '\x7f';
  });
  return printable && first.find_first_not_of(" \t") != std::string::npos && first[0] != '\t';
}

std::string block_text(const std::string& text, const std::string& indent) {
  std::string out = "|";
  if (text[0] == ' ') out += "2";
  const std::size_t end = text.find_last_not_of('\n') + 1;  // the line ends at the end decide the chomping
  out += end == text.size() ? "-" : end + 1 == text.size() ? "" : "+";
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t stop = std::min(text.find('\n', start), text.size());
    out += "\n";
    if (stop > start) out += indent + text.substr(start, stop - start);
    start = stop + 1;
  }
  return out;
}

/// `[1, 2, 3]` when it is a short list of scalars; otherwise empty.
std::string flow_text(const YamlNode& list) {
  std::string out = "[";
  for (const auto& item : list.items) {
    if (item->kind != Kind::Scalar && item->kind != Kind::Null) return "";
    if (item->style == Style::Block && fits_block(item->text)) return "";
    out += (out.size() > 1 ? ", " : "") + scalar_text(*item);
    if (out.size() > kLineLength) return "";
  }
  return out + "]";
}

void write(const YamlNode& node, const std::string& indent, bool after_dash, std::string& out);

/// What follows `key:` or `-`, line end included.
void write_value(const YamlNode& node, const std::string& indent, bool after_dash, std::string& out) {
  const bool is_block = node.kind == Kind::Scalar && node.style == Style::Block && fits_block(node.text);
  const std::string flow = node.kind == Kind::List ? flow_text(node) : "";
  if (is_block) {
    out += " " + block_text(node.text, indent + "  ") + "\n";
  } else if (!flow.empty()) {
    out += " " + flow + "\n";
  } else if (node.kind == Kind::Map && node.entries.empty()) {
    out += " {}\n";
  } else if (node.kind == Kind::Map || node.kind == Kind::List) {
    out += after_dash ? " " : "\n";
    write(node, indent + "  ", after_dash, out);
  } else {
    out += " " + scalar_text(node) + "\n";
  }
}

void write(const YamlNode& node, const std::string& indent, bool after_dash, std::string& out) {
  bool first = after_dash;  // the first entry stands on the line of its dash
  for (const auto& item : node.items) {
    out += (first ? "" : indent) + "-";
    write_value(*item, indent, true, out);
    first = false;
  }
  for (const auto& entry : node.entries) {
    out += (first ? "" : indent) + (is_plain(entry.key) ? entry.key : yaml_quoted(entry.key)) + ":";
    write_value(*entry.value, indent, false, out);
    first = false;
  }
}

}  // namespace

std::string yaml_text(const YamlNode& node) {
  std::string out;
  write(node, "", false, out);
  return out.empty() ? "{}\n" : out;
}

std::string YamlMap::dump() const { return yaml_text(*node_); }

}  // namespace rubble
