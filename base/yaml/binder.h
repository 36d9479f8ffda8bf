#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/yaml/strict_yaml.h"

namespace rubble {

/// Walks over the fields of a configuration: one list of keys, units and bounds serves both reading and writing.
class Binder {
 public:
  virtual ~Binder() = default;
  /// Bounds are inclusive.
  virtual void number(const char* key, double& value, double low, double high) = 0;
  virtual void integer(const char* key, int& value, int low, int high) = 0;
  virtual void boolean(const char* key, bool& value) = 0;
  virtual void text(const char* key, std::string& value) = 0;
  virtual void choice(const char* key, std::string& value, const std::vector<std::string>& choices) = 0;
  /// The same for an enum whose values stand in the order of their names, from 0 on.
  template <class Enum>
  void choice(const char* key, Enum& value, const std::vector<std::string>& names) {
    std::string name = names.at(static_cast<std::size_t>(value));
    choice(key, name, names);
    value = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  virtual void section(const char* key, const std::function<void(Binder&)>& fields) = 0;
  /// Whether the fields are written rather than read: what has its usual value may then be left out.
  virtual bool writes() const { return false; }
  /// Where the value of `key` stands, as file:line:column; empty when fields are written.
  virtual std::string place(const char* /*key*/) const { return ""; }
  /// Radians inside, degrees in the file; the bounds are degrees.
  void degrees(const char* key, double& radians, double low, double high);
};

/// Fills fields from YAML; absent keys keep their value. Throws InputError.
class YamlReader : public Binder {
 public:
  explicit YamlReader(YamlMap map) : map_(std::move(map)) {}
  void number(const char* key, double& value, double low, double high) override;
  void integer(const char* key, int& value, int low, int high) override;
  void boolean(const char* key, bool& value) override;
  void text(const char* key, std::string& value) override;
  void choice(const char* key, std::string& value, const std::vector<std::string>& choices) override;
  void section(const char* key, const std::function<void(Binder&)>& fields) override;
  std::string place(const char* key) const override { return map_.place(key); }

 private:
  YamlMap map_;
};

/// Writes fields as YAML lines that YamlReader reads back to the same bits.
class YamlWriter : public Binder {
 public:
  explicit YamlWriter(int indent = 0) : indent_(indent) {}
  void number(const char* key, double& value, double low, double high) override;
  void integer(const char* key, int& value, int low, int high) override;
  void boolean(const char* key, bool& value) override;
  void text(const char* key, std::string& value) override;
  void choice(const char* key, std::string& value, const std::vector<std::string>& choices) override;
  void section(const char* key, const std::function<void(Binder&)>& fields) override;
  bool writes() const override { return true; }
  const std::string& yaml() const { return yaml_; }

 private:
  void line(const char* key, const std::string& value);

  int indent_;
  std::string yaml_;
};

/// `text` as a double-quoted YAML scalar.
std::string yaml_quoted(const std::string& text);

}  // namespace rubble
