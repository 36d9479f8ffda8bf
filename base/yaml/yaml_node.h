#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/yaml/yaml_source.h"

namespace rubble {

/// One value of a YAML document: the tree behind YamlMap.
struct YamlNode {
  enum class Kind { Null, Scalar, List, Map };
  enum class Style { Plain, Quoted, Block };
  struct Entry {
    std::string key;
    YamlPlace place;  ///< of the key
    std::shared_ptr<YamlNode> value;
    bool asked = false;
  };

  Kind kind = Kind::Null;
  Style style = Style::Plain;
  YamlPlace place;
  std::string text;                              ///< of a scalar
  std::vector<std::shared_ptr<YamlNode>> items;  ///< of a list
  std::vector<Entry> entries;                    ///< of a map, in the order of the source
  std::set<std::string> known;                   ///< keys that were asked for, present or not
  bool handed_out = false;                       ///< as a map, so that finish() looks inside

  Entry* find(const std::string& key) {
    for (Entry& entry : entries)
      if (entry.key == key) return &entry;
    return nullptr;
  }
};

/// Parses one YAML document; the result is null when there is none. Aliases become copies of what they name. Throws
/// InputError with the place: broken YAML, tab as indentation, open quote or bracket, duplicate key, second document,
/// tag other than !!str, key that is no word, control character.
std::shared_ptr<YamlNode> parse_yaml(const std::string& text, const std::string& name, bool is_option = false);

/// The tree as YAML text that parses to the same values: plain stays plain, block text stays block text.
std::string yaml_text(const YamlNode& node);

}  // namespace rubble
