#include "base/text/file_name.h"

namespace rubble {
namespace {

constexpr std::size_t kLongest = 60;

bool is_refused(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte <= 0x20 || byte == 0x7f || c == '/' || c == '\\' || c == '\'' || c == '"';
}

bool is_refused_first(char c) { return c == '.' || c == '-'; }

}  // namespace

std::optional<std::string> file_name_trouble(std::string_view name) {
  const std::string use = "is used as a folder name: ";
  if (name.empty()) return use + "give at least one letter";
  if (name.size() > kLongest) return use + "at most 60 bytes";
  if (is_refused_first(name.front())) return use + "no dot or dash at its beginning";
  for (const char c : name)
    if (is_refused(c)) return use + "no spaces, slashes, quotes or control characters";
  return std::nullopt;
}

std::string as_file_name(std::string_view text) {
  std::string name(text.substr(0, kLongest));
  while (text.size() > kLongest && !name.empty() && (static_cast<unsigned char>(text[name.size()]) & 0xC0) == 0x80)
    name.pop_back();  // not inside a UTF-8 letter
  for (char& c : name)
    if (is_refused(c)) c = '_';
  if (name.empty() || is_refused_first(name.front())) name = "_" + name.substr(name.empty() ? 0 : 1);
  return name;
}

}  // namespace rubble
