#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/yaml/binder.h"
#include "explore/explorer.h"
#include "robot/model.h"

namespace rubble::explore {

/// The parameters of one kind of explorer, and how to build it. A new kind implements this beside its explorer and adds
/// a row to explorers.cpp; scenario files, sweeps and the command line then know it.
class ExplorerParameters {
 public:
  virtual ~ExplorerParameters() = default;
  /// Names, units and bounds of the parameters: the keys of a scenario's `explorer` section beside `kind`.
  virtual void bind(Binder& binder) = 0;
  /// What is wrong with the parameters taken together, for people; empty: nothing.
  virtual std::string mistake() const = 0;
  /// p_occ from which a cell is an obstacle, for maps drawn as the explorer sees them.
  virtual double occupied_threshold() const = 0;
  virtual std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const = 0;
  virtual std::unique_ptr<ExplorerParameters> copy() const = 0;
};

/// A row of the table of explorers.
struct ExplorerKind {
  std::string name;   ///< `explorer.kind`
  std::string about;  ///< one line, for people
  std::function<std::unique_ptr<ExplorerParameters>()> parameters;
};

/// All kinds of explorers, the default first.
const std::vector<ExplorerKind>& explorer_kinds();

/// Which explorer a run uses, with its parameters. A value: copies are independent.
class ExplorerConfig {
 public:
  /// The default kind with its usual parameters.
  ExplorerConfig();
  ExplorerConfig(const ExplorerConfig& other);
  ExplorerConfig& operator=(const ExplorerConfig& other);

  const std::string& kind() const { return kind_; }
  /// Takes another kind, with its usual parameters. Throws InputError for an unknown one.
  void choose(const std::string& kind);
  /// `kind` first, then the parameters of that kind.
  void bind(Binder& binder);
  std::string mistake() const { return parameters_->mistake(); }
  double occupied_threshold() const { return parameters_->occupied_threshold(); }
  std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const {
    return parameters_->make(model, mission);
  }

 private:
  std::string kind_;
  std::unique_ptr<ExplorerParameters> parameters_;
};

}  // namespace rubble::explore
