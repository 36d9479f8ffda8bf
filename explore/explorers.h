#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/yaml/kinds.h"
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
  /// What of them has no effect with that robot and mission, for people, one line each.
  virtual std::vector<std::string> notes(const robot::RobotModel& model, const Mission& mission) const = 0;
  /// p_occ from which a cell is an obstacle, for maps drawn as the explorer sees them.
  virtual double occupied_threshold() const = 0;
  virtual std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const = 0;
  virtual std::unique_ptr<ExplorerParameters> copy() const = 0;
};

using ExplorerKind = Kind<ExplorerParameters>;

/// All kinds of explorers, the default first.
const std::vector<ExplorerKind>& explorer_kinds();

/// Which explorer a run uses, with its parameters.
class ExplorerConfig : public KindChoice<ExplorerParameters> {
 public:
  ExplorerConfig() : KindChoice("explorer", explorer_kinds()) {}

  std::string mistake() const { return parameters().mistake(); }
  std::vector<std::string> notes(const robot::RobotModel& model, const Mission& mission) const {
    return parameters().notes(model, mission);
  }
  double occupied_threshold() const { return parameters().occupied_threshold(); }
  std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const {
    return parameters().make(model, mission);
  }
};

}  // namespace rubble::explore
