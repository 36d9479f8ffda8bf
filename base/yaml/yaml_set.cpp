#include <optional>

#include "base/text/number_text.h"
#include "base/text/words.h"
#include "base/yaml/strict_yaml.h"
#include "base/yaml/yaml_node.h"

namespace rubble {
namespace {

using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;

std::vector<std::string> split(const std::string& dotted, const YamlPlace& option) {
  std::vector<std::string> words;
  std::size_t start = 0;
  while (true) {
    const std::size_t dot = dotted.find('.', start);
    words.push_back(dotted.substr(start, dot - start));
    if (words.back().empty()) option.fail("a key is empty; write '--set key=value' or '--set outer.inner=value'");
    if (dot == std::string::npos) return words;
    start = dot + 1;
  }
}

/// The slot that `word` names in `parent`; a map grows by it.
NodePtr& slot(YamlNode& parent, const std::string& word, const std::string& parent_name, const YamlPlace& option) {
  if (parent.kind == Kind::Null) {
    parent.kind = Kind::Map;
    parent.place = option;
  }
  if (parent.kind == Kind::Map) {
    if (YamlNode::Entry* const entry = parent.find(word)) return entry->value;
    parent.entries.push_back({word, option, std::make_shared<YamlNode>()});
    parent.entries.back().value->place = option;
    return parent.entries.back().value;
  }
  if (parent.kind != Kind::List) option.fail(in_quotes(parent_name) + " is no map; nothing can be set inside it");
  const auto index = parse_integer(word);
  if (!index || *index < 0 || *index >= static_cast<std::int64_t>(parent.items.size()))
    option.fail(in_quotes(parent_name) + " is a list of " + std::to_string(parent.items.size()) +
                "; name an item by its number from 0, not " + in_quotes(word));
  return parent.items[static_cast<std::size_t>(*index)];
}

}  // namespace

void YamlMap::set(const std::string& dotted_key, const std::string& value, const std::string& place) {
  const std::string name = place.empty() ? "--set " + one_line(dotted_key) : place;
  const YamlPlace option{make_yaml_source(value, name, true), 0, 0};
  const std::vector<std::string> words = split(dotted_key, option);
  NodePtr parsed = parse_yaml(value, name, true);
  if (!parsed) {
    parsed = std::make_shared<YamlNode>();
    parsed->place = option;
  }

  YamlNode* parent = node_.get();
  std::string parent_name;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    parent = slot(*parent, words[i], parent_name, option).get();
    parent_name += (i == 0 ? "" : ".") + words[i];
  }
  slot(*parent, words.back(), parent_name, option) = parsed;
  if (YamlNode::Entry* const entry = parent->find(words.back())) entry->place = option;
}

}  // namespace rubble
