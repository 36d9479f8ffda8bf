#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "base/text/words.h"
#include "base/yaml/yaml_node.h"

namespace rubble {
namespace {

using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;
using Style = YamlNode::Style;

constexpr std::size_t kDeepest = 100;
constexpr std::size_t kMostNodes = 200000;  // aliases of aliases grow without bound otherwise

std::size_t depth_of(const YamlNode& node) {
  std::size_t deepest = 0;
  for (const NodePtr& item : node.items) deepest = std::max(deepest, depth_of(*item));
  for (const auto& entry : node.entries) deepest = std::max(deepest, depth_of(*entry.value));
  return deepest + 1;
}

/// yaml-cpp's words for the commonest slips, in terms of what to change.
std::string remedy(const std::string& message) {
  if (message == "illegal map value")
    return "a ':' where no value can start; write one 'key: value' a line and quote text that holds ': '";
  if (message == "end of map not found") return "not in line with the keys above; indent the keys of a map alike";
  if (message == "end of sequence not found") return "not in line with the list above; start every item with '- '";
  if (message == "illegal flow end") return "a closing bracket without an opening one; remove it";
  if (message == "unknown token") return "a value cannot start with this character; put the text in quotes";
  return "broken YAML: " + message;
}

/// Builds the tree from yaml-cpp's events and refuses what yaml-cpp lets pass.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::shared_ptr<const YamlSource> source)
      : source_(std::move(source)), is_text_(source_->lines.size(), false) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) place(mark).fail("a second document; keep one document in a file");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { finish(make(mark, Kind::Null), anchor); }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = anchors_.find(anchor);
    if (named == anchors_.end()) place(mark).fail("an alias that stands inside the value it names");
    if (open_.size() + depth_of(*named->second) > kDeepest) place(mark).fail("nested too deeply");
    finish(copy(*named->second, mark), 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& v) override {
    check_tag(mark, tag, "tag:yaml.org,2002:str");
    const NodePtr node = make(mark, Kind::Scalar);
    node->text = v;
    if (tag != "?") node->style = Style::Quoted;
    if (!quote_is_closed(node->place)) node->place.fail("the quote is not closed");
    if (const auto block = block_at(node->place, v)) {
      node->style = Style::Block;
      last_block_ = block;
      for (int i = block->first_line; i < block->end_line; ++i) is_text_[static_cast<std::size_t>(i)] = true;
    }
    finish(node, anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    check_tag(mark, tag, "tag:yaml.org,2002:seq");
    open(mark, anchor, Kind::List, style);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    check_tag(mark, tag, "tag:yaml.org,2002:map");
    open(mark, anchor, Kind::Map, style);
  }
  void OnMapEnd() override { close(); }

  /// Tells what yaml-cpp found at `mark` in terms of what to change.
  [[noreturn]] void explain(const YAML::Mark& mark, const std::string& message) const {
    if (!open_.empty() && open_.back().flow && message.rfind("end of ", 0) == 0) {
      const bool list = open_.back().node->kind == Kind::List;
      open_.back().node->place.fail(list ? "'[' is not closed; add ']'" : "'{' is not closed; add '}'");
    }
    const YamlPlace found = place(mark);
    for (int line = found.line; line >= std::max(0, found.line - 1); --line) check_tab(line);
    if (last_block_ && last_block_->end_line == found.line)
      found.fail("indented less than the first line of the block text above; indent both alike, or write '|2'");
    found.fail(remedy(message));
  }

  /// yaml-cpp takes some tabs for spaces.
  void check_tabs() const {
    for (std::size_t line = 0; line < source_->lines.size(); ++line) check_tab(static_cast<int>(line));
  }

 private:
  struct Open {
    NodePtr node;
    YAML::anchor_t anchor = 0;
    bool flow = false;                       ///< written with brackets
    NodePtr key;                             ///< of a map, when its value comes next
    std::map<std::string, int> line_of_key;  ///< from 1
  };

  YamlPlace place(const YAML::Mark& mark) const {
    const int last = static_cast<int>(source_->lines.size()) - 1;
    return {source_, std::clamp(mark.line, 0, last), std::max(0, mark.column)};
  }

  void check_tab(int line) const {
    const auto i = static_cast<std::size_t>(line);
    if (is_text_[i] || !is_tab_indented(source_->lines[i])) return;
    YamlPlace{source_, line, static_cast<int>(source_->lines[i].find('\t'))}.fail(
        "a tab in the indentation; indent with spaces");
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag, const char* allowed) const {
    if (tag.empty() || tag == "?" || tag == "!" || tag == allowed) return;
    place(mark).fail("the tag " + in_quotes(tag) + " means nothing here; remove it");
  }

  NodePtr make(const YAML::Mark& mark, Kind kind) {
    if (++nodes_ > kMostNodes) place(mark).fail("more than " + std::to_string(kMostNodes) + " values");
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->place = place(mark);
    return node;
  }

  NodePtr copy(const YamlNode& from, const YAML::Mark& mark) {
    const NodePtr node = make(mark, from.kind);
    *node = from;
    for (NodePtr& item : node->items) item = copy(*item, mark);
    for (auto& entry : node->entries) entry.value = copy(*entry.value, mark);
    return node;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Kind kind, YAML::EmitterStyle::value style) {
    if (open_.size() >= kDeepest) place(mark).fail("nested too deeply");
    open_.push_back({make(mark, kind), anchor, style == YAML::EmitterStyle::Flow, nullptr, {}});
  }

  void close() {
    const Open done = std::move(open_.back());
    open_.pop_back();
    finish(done.node, done.anchor);
  }

  /// Puts a complete value where it belongs.
  void finish(const NodePtr& node, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = node;
    if (open_.empty()) {
      root_ = node;
      return;
    }
    Open& parent = open_.back();
    if (parent.node->kind == Kind::List) {
      parent.node->items.push_back(node);
    } else if (!parent.key) {
      check_key(*node, parent);
      parent.key = node;
    } else {
      if (node->kind == Kind::Null) node->place = parent.key->place;  // yaml-cpp marks what comes after it
      parent.node->entries.push_back({parent.key->text, parent.key->place, node});
      parent.key = nullptr;
    }
  }

  static void check_key(const YamlNode& key, Open& map) {
    if (key.kind != Kind::Scalar || key.style == Style::Block) key.place.fail("a key must be one word or text");
    const auto [first, is_new] = map.line_of_key.emplace(key.text, key.place.line + 1);
    if (is_new) return;
    const std::string where =
        key.place.source->is_option ? "" : " (first on line " + std::to_string(first->second) + ")";
    key.place.fail("key " + in_quotes(key.text) + " is given twice" + where + "; remove one");
  }

  std::shared_ptr<const YamlSource> source_;
  std::vector<bool> is_text_;  ///< lines of block scalars, where tabs are text
  std::optional<YamlBlock> last_block_;
  NodePtr root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, NodePtr> anchors_;
  std::size_t nodes_ = 0;
};

/// yaml-cpp ends a file at \x04, guesses UTF-16 from zero bytes and takes a lone \r for a line end: none of them here.
void check_characters(const std::shared_ptr<const YamlSource>& source) {
  for (std::size_t i = 0; i < source->lines.size(); ++i) {
    const std::string& line = source->lines[i];
    const auto bad = std::find_if(line.begin(), line.end(), [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return (byte < 0x20 && c != '\t') || byte == 0x7f;
    });
    if (bad == line.end()) continue;
    YamlPlace{source, static_cast<int>(i), static_cast<int>(bad - line.begin())}.fail(
        "control character '" + one_line({&*bad, 1}) + "'; save the file as UTF-8 text");
  }
}

}  // namespace

std::shared_ptr<YamlNode> parse_yaml(const std::string& text, const std::string& name, bool is_option) {
  constexpr char kByteOrderMark[] = "\xef\xbb\xbf";
  const std::string body = text.compare(0, 3, kByteOrderMark) == 0 ? text.substr(3) : text;
  const auto source = make_yaml_source(body, name, is_option);
  check_characters(source);
  TreeBuilder builder(source);
  try {
    std::istringstream stream(body);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    builder.explain(error.mark, error.msg);
  }
  builder.check_tabs();
  return builder.root();
}

}  // namespace rubble
