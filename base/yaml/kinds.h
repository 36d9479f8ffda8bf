#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/yaml/binder.h"

namespace rubble {

/// A row of a table of kinds: what can be had in several kinds behind one interface (mappers, explorers), with how each
/// is described and how its parameters come to be. `Parameters` is an abstract class with bind(Binder&) and
/// copy() -> std::unique_ptr<Parameters>, and builds what they are the parameters of.
template <class Parameters>
struct Kind {
  std::string name;   ///< `mapper.kind`, `explorer.kind`
  std::string about;  ///< one line, for people
  std::function<std::unique_ptr<Parameters>()> parameters;
};

/// Finds the bind() that stands beside the Config.
template <class Config>
void bind_fields(Binder& binder, Config& config) {
  bind(binder, config);
}

/// Parameters kept in a plain struct `Config` that a function bind(Binder&, Config&) beside it knows.
template <class Parameters, class Config>
class ParametersIn : public Parameters {
 public:
  void bind(Binder& binder) override { bind_fields(binder, config); }

  Config config;
};

/// One kind of a table, chosen by name, with its parameters. A value: copies are independent.
template <class Parameters>
class KindChoice {
 public:
  const std::string& kind() const { return kind_; }

  /// Takes another kind, with its usual parameters. Throws InputError for an unknown one.
  void choose(const std::string& kind) {
    for (const Kind<Parameters>& row : *table_)
      if (row.name == kind) {
        kind_ = kind;
        parameters_ = row.parameters();
        return;
      }
    std::string known;
    for (const std::string& name : names()) known += (known.empty() ? "" : ", ") + name;
    throw InputError(std::string(what_) + ".kind: '" + kind + "' is no " + what_ + "; known are " + known);
  }

  /// `kind` first, then the parameters of that kind.
  void bind(Binder& binder) {
    std::string kind = kind_;
    binder.choice("kind", kind, names());
    if (kind != kind_) choose(kind);
    parameters_->bind(binder);
  }

 protected:
  /// The first row of the table. what: one of its rows is, for people; it and the table outlive the choice.
  KindChoice(const char* what, const std::vector<Kind<Parameters>>& table) : what_(what), table_(&table) {
    choose(table.front().name);
  }
  KindChoice(const KindChoice& other)
      : what_(other.what_), table_(other.table_), kind_(other.kind_), parameters_(other.parameters_->copy()) {}
  KindChoice& operator=(const KindChoice& other) {
    what_ = other.what_;
    table_ = other.table_;
    kind_ = other.kind_;
    parameters_ = other.parameters_->copy();
    return *this;
  }
  ~KindChoice() = default;

  const Parameters& parameters() const { return *parameters_; }

 private:
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Kind<Parameters>& row : *table_) all.push_back(row.name);
    return all;
  }

  const char* what_;
  const std::vector<Kind<Parameters>>* table_;
  std::string kind_;
  std::unique_ptr<Parameters> parameters_;
};

}  // namespace rubble
