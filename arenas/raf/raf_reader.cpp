#include "arenas/raf/raf_reader.h"
#include "arenas/raf/raf_layout.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"

namespace rubble::arenas {
namespace {

constexpr std::size_t kMostElements = 5000;

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == ':';
}

/// One tag: its name and attributes.
struct Tag {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::size_t position = 0;
};

class Reader {
 public:
  Reader(const std::string& text, const std::string& name) : text_(text), name_(name) {
    if (starts_with("\xef\xbb\xbf")) position_ = 3;  // byte order mark
  }

  /// The next tag, without prolog and comments; false at the end.
  bool next(Tag& tag) {
    while (true) {
      skip_blanks();
      if (position_ >= text_.size()) return false;
      if (starts_with("<?")) {
        skip_past("?>");
      } else if (starts_with("<!--")) {
        skip_past("-->");
      } else if (starts_with("<!DOCTYPE")) {
        skip_past(">");
      } else if (text_[position_] == '<') {
        tag = read_tag();
        return true;
      } else {
        fail(position_, "text between the elements: only <element .../> is expected");
      }
    }
  }

  [[noreturn]] void fail(std::size_t position, const std::string& message) const {
    int line = 1;
    int column = 1;
    for (std::size_t i = 0; i < position && i < text_.size(); ++i) {
      ++column;
      if (text_[i] != '\n') continue;
      ++line;
      column = 1;
    }
    throw InputError(at(name_, line, column, message));
  }

 private:
  bool starts_with(const char* what) const { return text_.compare(position_, std::string(what).size(), what) == 0; }

  void skip_blanks() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_])) != 0) ++position_;
  }

  void skip_past(const char* end) {
    const std::size_t found = text_.find(end, position_);
    if (found == std::string::npos) fail(position_, std::string("the file ends before '") + end + "'");
    position_ = found + std::string(end).size();
  }

  std::string read_name() {
    const std::size_t first = position_;
    while (position_ < text_.size() && is_name_character(text_[position_])) ++position_;
    if (position_ == first) fail(first, "a name is missing here: expected <element .../>");
    return text_.substr(first, position_ - first);
  }

  Tag read_tag() {
    Tag tag;
    tag.position = position_++;
    if (position_ < text_.size() && text_[position_] == '/') {
      tag.name = "/";
      ++position_;
    }
    tag.name += read_name();
    while (true) {
      skip_blanks();
      if (starts_with("/>")) {
        position_ += 2;
        return tag;
      }
      if (position_ < text_.size() && text_[position_] == '>') {
        ++position_;
        return tag;
      }
      if (position_ >= text_.size()) fail(tag.position, "the file ends inside this element");
      read_attribute(tag);
    }
  }

  void read_attribute(Tag& tag) {
    const std::size_t first = position_;
    const std::string name = read_name();
    skip_blanks();
    const bool has_value = starts_with("=");
    if (has_value) ++position_;
    skip_blanks();
    if (!has_value || !(starts_with("\"") || starts_with("'")))
      fail(position_, "attribute '" + name + "' has no value: write " + name + "=\"...\"");
    const char quote = text_[position_++];
    const std::size_t end = text_.find(quote, position_);
    if (end == std::string::npos) fail(first, "the value of '" + name + "' has no closing quote");
    if (!tag.attributes.emplace(name, text_.substr(position_, end - position_)).second) {
      fail(first, "attribute '" + name + "' is given twice");
    }
    position_ = end + 1;
  }

  const std::string& text_;
  const std::string& name_;
  std::size_t position_ = 0;
};

double number(const Reader& reader, const Tag& tag, const std::string& key, double low, double high) {
  const std::string& value = tag.attributes.at(key);
  const std::optional<double> parsed = parse_number(value);
  if (!parsed || !(*parsed >= low && *parsed <= high)) {
    reader.fail(tag.position, key + "=\"" + value + "\" is not a number from " + std::to_string(static_cast<int>(low)) +
                                  " to " + std::to_string(static_cast<int>(high)));
  }
  return *parsed;
}

double number_or_zero(const Reader& reader, const Tag& tag, const std::string& key, double low, double high) {
  return tag.attributes.count(key) > 0 ? number(reader, tag, key, low, high) : 0.0;
}

Element element_of(const Reader& reader, const Tag& tag) {
  for (const auto& [key, value] : tag.attributes) {
    static const std::map<std::string, int> kKnown{{"type", 0},        {"rotation", 0}, {"x", 0},       {"y", 0},
                                                   {"mount-point", 0}, {"offset-x", 0}, {"offset-y", 0}};
    if (kKnown.count(key) == 0) reader.fail(tag.position, "unknown attribute '" + key + "' of an element");
  }
  for (const char* key : {"type", "x", "y"}) {
    if (tag.attributes.count(key) == 0) reader.fail(tag.position, std::string("the element has no '") + key + "'");
  }
  Element element;
  element.type = tag.attributes.at("type");
  const bool is_name = std::all_of(element.type.begin(), element.type.end(), is_name_character);
  if (element.type.empty() || !is_name) {
    reader.fail(tag.position, "the element's type is not a name of letters, digits, '_' and '-'");
  }
  element.position = {kPallet * number(reader, tag, "x", -300, 300), kPallet * number(reader, tag, "y", -300, 300)};
  element.rotation = deg_to_rad(std::fmod(number_or_zero(reader, tag, "rotation", -36000, 36000), 360.0));
  element.offset = {kPallet * number_or_zero(reader, tag, "offset-x", -10, 10),
                    kPallet * number_or_zero(reader, tag, "offset-y", -10, 10)};
  if (tag.attributes.count("mount-point") > 0) {
    element.mount_point = static_cast<int>(std::lround(number(reader, tag, "mount-point", -1, 100)));
  }
  return element;
}

}  // namespace

std::vector<Element> read_raf_elements(const std::string& text, const std::string& name) {
  Reader reader(text, name);
  std::vector<Element> elements;
  Tag tag;
  bool is_open = false;
  while (reader.next(tag)) {
    if (tag.name == "elements" && !is_open && elements.empty()) {
      is_open = true;
    } else if (tag.name == "element" && is_open) {
      if (elements.size() == kMostElements)
        reader.fail(tag.position, "more than 5,000 elements, where an arena of the league has some hundreds: split it");
      elements.push_back(element_of(reader, tag));
    } else if (tag.name == "/elements" && is_open) {
      is_open = false;
    } else if (tag.name != "/element") {
      reader.fail(tag.position,
                  "<" + tag.name + "> does not belong here: expected <elements> with <element .../> inside");
    }
  }
  if (is_open) reader.fail(text.size(), "the file ends without </elements>");
  if (elements.empty()) reader.fail(0, "no <element .../> in the file: is this an arena of the rescue arena designer?");
  return elements;
}

}  // namespace rubble::arenas
