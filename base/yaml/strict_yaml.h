#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rubble {

struct YamlNode;

/// A strict view of a YAML document. Every access names the place when it fails (InputError `file:line:column: ...`),
/// duplicate keys fail on loading, and finish() fails on keys nobody asked for, with "did you mean".
///
///   const YamlMap root = YamlMap::load(path);
///   config.slope = root.number("slope_deg", 10.0, 0.0, 45.0);
///   root.finish();
///
/// Copies share one document. A key written without a value counts as an empty map or list, and as missing otherwise.
class YamlMap {
 public:
  /// Throws InputError: missing file, broken YAML, duplicate key, not a map at the top. `name` stands for the file.
  static YamlMap load(const std::string& path);
  static YamlMap parse(const std::string& text, const std::string& name);
  /// A view of a tree that was put together from documents; its values keep the places they came from.
  static YamlMap of(std::shared_ptr<YamlNode> tree);

  YamlMap(const YamlMap&);
  YamlMap(YamlMap&&) noexcept;
  YamlMap& operator=(const YamlMap&);
  YamlMap& operator=(YamlMap&&) noexcept;
  ~YamlMap();

  /// The key is there and has a value. It still must be read: finish() fails on a key that only has() was asked about.
  bool has(const std::string& key) const;
  /// With a default the key may be absent; `low` and `high` are inclusive bounds.
  double number(const std::string& key, std::optional<double> fallback, double low, double high) const;
  std::int64_t integer(const std::string& key, std::optional<std::int64_t> fallback, std::int64_t low,
                       std::int64_t high) const;
  bool boolean(const std::string& key, std::optional<bool> fallback) const;
  std::string text(const std::string& key, std::optional<std::string> fallback) const;
  /// One of `choices`.
  std::string choice(const std::string& key, std::optional<std::string> fallback,
                     const std::vector<std::string>& choices) const;
  /// A list of numbers; absent: empty. `count` 0: any length.
  std::vector<double> numbers(const std::string& key, std::size_t count = 0) const;
  std::vector<std::string> texts(const std::string& key) const;
  /// A nested map; absent: an empty one.
  YamlMap map(const std::string& key) const;
  /// A list of maps; absent: empty.
  std::vector<YamlMap> maps(const std::string& key) const;
  /// Keys in the order of the file.
  std::vector<std::string> keys() const;

  /// Fails on any key that was never asked for, also in nested maps that were handed out.
  void finish() const;
  /// Throws InputError that points at `key` (or at the map itself when the key is absent or empty).
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  /// The same for line `row` (0-based) of a block text value: points into the drawing.
  [[noreturn]] void fail_at(const std::string& key, int row, int column, const std::string& message) const;
  /// `file:line:column` of a key, or of the map.
  std::string place(const std::string& key = "") const;

  /// Sets `dotted.key` to a YAML scalar or flow value, creating maps on the way: what `--set key=value` does. A number
  /// in the key counts the items of a list from 0 (`robots.0.name`). Call before reading: maps handed out stay as is.
  /// Errors about such a value then name `place`, or "--set dotted.key" where that is empty.
  void set(const std::string& dotted_key, const std::string& value, const std::string& place = "");
  /// The whole document as YAML text, overrides included.
  std::string dump() const;
  /// The tree behind this map (base/yaml_node.h), shared, for who puts documents together.
  const std::shared_ptr<YamlNode>& tree() const { return node_; }

 private:
  explicit YamlMap(std::shared_ptr<YamlNode> node);
  std::shared_ptr<YamlNode> node_;
};

}  // namespace rubble
