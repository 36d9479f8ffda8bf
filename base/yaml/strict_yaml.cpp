#include "base/yaml/strict_yaml.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "base/yaml/yaml_node.h"

namespace rubble {
namespace {

using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;
using Style = YamlNode::Style;

/// What a value is, for a message.
std::string described(const YamlNode& node) {
  switch (node.kind) {
    case Kind::Null:
      return "has no value";
    case Kind::List:
      return "is a list";
    case Kind::Map:
      return "is a map";
    case Kind::Scalar:
      break;
  }
  if (node.style == Style::Block) return "is a block of text";
  return "is " + (node.style == Style::Quoted ? "the text " : std::string{}) + in_quotes(node.text);
}

[[noreturn]] void fail_value(const std::string& name, const YamlNode& node, const std::string& wanted) {
  node.place.fail(in_quotes(name) + " " + described(node) + "; give " + wanted);
}

/// ", from 0 to 45" and the like; empty without bounds.
template <class T>
std::string range_text(T low, T high, std::string (*text)(T)) {
  const bool has_low = low > std::numeric_limits<T>::lowest();
  const bool has_high = high < std::numeric_limits<T>::max();
  if (has_low && has_high) return " from " + text(low) + " to " + text(high);
  if (has_low) return " of at least " + text(low);
  if (has_high) return " of at most " + text(high);
  return "";
}

std::string integer_text(std::int64_t value) { return std::to_string(value); }

double to_number(const std::string& name, const YamlNode& node, double low, double high) {
  std::optional<double> value;
  if (node.kind == Kind::Scalar && node.style == Style::Plain) value = parse_number(node.text);
  if (!value || *value < low || *value > high) fail_value(name, node, "a number" + range_text(low, high, number_text));
  return *value;
}

std::string to_text(const std::string& name, const YamlNode& node) {
  if (node.kind != Kind::Scalar) fail_value(name, node, "text");
  return node.text;
}

std::vector<std::string> known_keys(const YamlNode& node) { return {node.known.begin(), node.known.end()}; }

void finish_node(const YamlNode& node) {
  for (const YamlNode::Entry& entry : node.entries) {
    if (!entry.asked) {
      const std::string near = did_you_mean(entry.key, known_keys(node));
      const std::string known = joined(known_keys(node));
      entry.place.fail("unknown key " + in_quotes(entry.key) +
                       (!near.empty()   ? near
                        : known.empty() ? "; remove it"
                                        : "; known here: " + known));
    }
    if (entry.value->handed_out) finish_node(*entry.value);
    for (const NodePtr& item : entry.value->items)
      if (item->handed_out) finish_node(*item);
  }
}

/// The value of `key` when it has one; marks the key as asked for.
NodePtr ask(YamlNode& map, const std::string& key) {
  map.known.insert(key);
  YamlNode::Entry* const entry = map.find(key);
  if (entry == nullptr) return nullptr;
  entry->asked = true;
  return entry->value;
}

/// A value that must be there unless there is a fallback (then: null).
NodePtr ask_value(YamlNode& map, const std::string& key, bool has_fallback, const std::string& wanted) {
  const NodePtr node = ask(map, key);
  if (!node && !has_fallback) map.place.fail("missing key " + in_quotes(key) + "; add '" + key + ": <" + wanted + ">'");
  if (node && node->kind == Kind::Null) fail_value(key, *node, wanted);
  return node;
}

/// The items of a list; an absent key or one without a value has none.
std::vector<NodePtr> ask_items(YamlNode& map, const std::string& key, const std::string& wanted) {
  const NodePtr node = ask(map, key);
  if (!node || node->kind == Kind::Null) return {};
  if (node->kind != Kind::List) fail_value(key, *node, wanted);
  return node->items;
}

std::string item_name(const std::string& key, std::size_t i) { return key + "[" + std::to_string(i) + "]"; }

}  // namespace

YamlMap::YamlMap(std::shared_ptr<YamlNode> node) : node_(std::move(node)) { node_->handed_out = true; }
YamlMap::YamlMap(const YamlMap&) = default;
YamlMap::YamlMap(YamlMap&&) noexcept = default;
YamlMap& YamlMap::operator=(const YamlMap&) = default;
YamlMap& YamlMap::operator=(YamlMap&&) noexcept = default;
YamlMap::~YamlMap() = default;

YamlMap YamlMap::load(const std::string& path) { return parse(read_text_file(path), path); }

YamlMap YamlMap::parse(const std::string& text, const std::string& name) {
  NodePtr root = parse_yaml(text, name);
  if (!root || root->kind == Kind::Null) throw InputError(at(name, 1, 1, "is empty; write 'key: value' lines"));
  if (root->kind != Kind::Map) root->place.fail("is no map; write 'key: value' lines");
  return YamlMap(std::move(root));
}

YamlMap YamlMap::of(std::shared_ptr<YamlNode> tree) { return YamlMap(std::move(tree)); }

bool YamlMap::has(const std::string& key) const {
  node_->known.insert(key);
  const YamlNode::Entry* const entry = node_->find(key);
  return entry != nullptr && entry->value->kind != Kind::Null;
}

double YamlMap::number(const std::string& key, std::optional<double> fallback, double low, double high) const {
  const std::string wanted = "a number" + range_text(low, high, number_text);
  const NodePtr node = ask_value(*node_, key, fallback.has_value(), wanted);
  return node ? to_number(key, *node, low, high) : *fallback;
}

std::int64_t YamlMap::integer(const std::string& key, std::optional<std::int64_t> fallback, std::int64_t low,
                              std::int64_t high) const {
  const std::string wanted = "a whole number" + range_text(low, high, integer_text);
  const NodePtr node = ask_value(*node_, key, fallback.has_value(), wanted);
  if (!node) return *fallback;
  std::optional<std::int64_t> value;
  if (node->kind == Kind::Scalar && node->style == Style::Plain) value = parse_integer(node->text);
  if (!value || *value < low || *value > high) fail_value(key, *node, wanted);
  return *value;
}

bool YamlMap::boolean(const std::string& key, std::optional<bool> fallback) const {
  const NodePtr node = ask_value(*node_, key, fallback.has_value(), "true or false");
  if (!node) return *fallback;
  if (node->kind == Kind::Scalar && node->style == Style::Plain) {
    if (node->text == "true" || node->text == "True" || node->text == "TRUE") return true;
    if (node->text == "false" || node->text == "False" || node->text == "FALSE") return false;
  }
  fail_value(key, *node, "true or false");
}

std::string YamlMap::text(const std::string& key, std::optional<std::string> fallback) const {
  const NodePtr node = ask_value(*node_, key, fallback.has_value(), "text");
  return node ? to_text(key, *node) : *fallback;
}

std::string YamlMap::choice(const std::string& key, std::optional<std::string> fallback,
                            const std::vector<std::string>& choices) const {
  const std::string wanted = "one of " + joined(choices);
  const NodePtr node = ask_value(*node_, key, fallback.has_value(), wanted);
  if (!node) return *fallback;
  if (node->kind != Kind::Scalar) fail_value(key, *node, wanted);
  if (std::find(choices.begin(), choices.end(), node->text) == choices.end())
    fail_value(key, *node, wanted + did_you_mean(node->text, choices));
  return node->text;
}

std::vector<double> YamlMap::numbers(const std::string& key, std::size_t count) const {
  const std::string wanted = count == 0 ? "a list of numbers" : "a list of " + std::to_string(count) + " numbers";
  const std::vector<NodePtr> items = ask_items(*node_, key, wanted);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> values;
  for (std::size_t i = 0; i < items.size(); ++i)
    values.push_back(to_number(item_name(key, i), *items[i], -kInfinity, kInfinity));
  if (count != 0 && has(key) && values.size() != count)
    node_->find(key)->value->place.fail(in_quotes(key) + " has " + std::to_string(values.size()) + " numbers; give " +
                                        wanted);
  return values;
}

std::vector<std::string> YamlMap::texts(const std::string& key) const {
  const std::vector<NodePtr> items = ask_items(*node_, key, "a list of texts");
  std::vector<std::string> values;
  for (std::size_t i = 0; i < items.size(); ++i) values.push_back(to_text(item_name(key, i), *items[i]));
  return values;
}

YamlMap YamlMap::map(const std::string& key) const {
  NodePtr node = ask(*node_, key);
  if (node && node->kind != Kind::Null && node->kind != Kind::Map)
    fail_value(key, *node, "a map: indented 'key: value' lines");
  if (node && node->kind == Kind::Map) return YamlMap(std::move(node));
  auto empty = std::make_shared<YamlNode>();
  empty->kind = Kind::Map;
  empty->place = node ? node->place : node_->place;
  return YamlMap(std::move(empty));
}

std::vector<YamlMap> YamlMap::maps(const std::string& key) const {
  const std::vector<NodePtr> items = ask_items(*node_, key, "a list of maps: '- key: value'");
  std::vector<YamlMap> values;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i]->kind != Kind::Map) fail_value(item_name(key, i), *items[i], "a map: '- key: value'");
    values.push_back(YamlMap(items[i]));
  }
  return values;
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> keys;
  for (const YamlNode::Entry& entry : node_->entries) keys.push_back(entry.key);
  return keys;
}

void YamlMap::finish() const { finish_node(*node_); }

std::string YamlMap::place(const std::string& key) const {
  const YamlNode::Entry* const entry = node_->find(key);
  return (entry != nullptr ? entry->place : node_->place).str();
}

void YamlMap::fail(const std::string& key, const std::string& message) const {
  throw InputError(place(key) + ": " + one_line(message));
}

void YamlMap::fail_at(const std::string& key, int row, int column, const std::string& message) const {
  const YamlNode::Entry* const entry = node_->find(key);
  if (entry == nullptr || entry->value->kind != Kind::Scalar) fail(key, message);
  YamlPlace place = entry->value->place;
  const auto block = block_at(place, entry->value->text);
  if (block && block->literal && entry->value->style == Style::Block) {
    const int last = std::max(block->first_line, static_cast<int>(place.source->lines.size()) - 1);
    place.line = std::clamp(block->first_line + row, block->first_line, last);
    place.column = block->indent + std::max(0, column);
  } else if (row == 0 && entry->value->style != Style::Block) {
    place.column += std::max(0, column) + (entry->value->style == Style::Quoted ? 1 : 0);
  }
  place.fail(message);
}

}  // namespace rubble
