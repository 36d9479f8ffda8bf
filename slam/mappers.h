#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/yaml/kinds.h"
#include "robot/model.h"
#include "slam/map_base.h"
#include "slam/mapper.h"

namespace rubble::slam {

/// What a mapper is told about its run beside the robot.
struct MapperSetting {
  std::uint64_t seed = 1;
  std::string run_folder;                         ///< for files of its own (mapper.log); empty: there is none
  std::shared_ptr<const MapBase> base = nullptr;  ///< null: the mapper begins with an empty map
};

/// The parameters of one kind of mapper, and how to build it. A new kind implements this beside its mapper and adds a
/// row to mappers.cpp; scenario files, sweeps and the command line then know it.
class MapperParameters {
 public:
  virtual ~MapperParameters() = default;
  /// Names, units and bounds of the parameters: the keys of a scenario's `mapper` section beside `kind`.
  virtual void bind(Binder& binder) = 0;
  virtual std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const = 0;
  virtual std::unique_ptr<MapperParameters> copy() const = 0;
  /// Whether make() takes MapperSetting::base.
  virtual bool goes_on() const { return false; }
  /// The same mapper in this process, where make() gives it one of its own; what `rubble mapper-process` serves.
  virtual std::unique_ptr<Mapper> make_here(const robot::RobotModel& model, const MapperSetting& setting) const {
    return make(model, setting);
  }
  /// The command that make() runs, when the user names one; empty: none.
  virtual std::string command() const { return ""; }
};

/// Parameters kept in a plain struct `Config` that a function bind(Binder&, Config&) beside it knows, of a mapper whose
/// constructor takes (model, config, seed).
template <class Config, class Mine>
class ParametersOf : public ParametersIn<MapperParameters, Config> {
 public:
  std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const override {
    return std::make_unique<Mine>(model, this->config, setting.seed);
  }
  std::unique_ptr<MapperParameters> copy() const override { return std::make_unique<ParametersOf>(*this); }
};

using MapperKind = Kind<MapperParameters>;

/// All kinds of mappers, the default first.
const std::vector<MapperKind>& mapper_kinds();

/// Which mapper a run uses, with its parameters.
class MapperConfig : public KindChoice<MapperParameters> {
 public:
  MapperConfig() : KindChoice("mapper", mapper_kinds()) {}

  void bind(Binder& binder);

  /// Throws InputError for a command that was not permitted.
  std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const;

  /// The parameters of a kind that keeps them in a `Config`. Throws std::bad_cast when the kind chosen does not.
  template <class Config>
  const Config& as() const {
    return dynamic_cast<const ParametersIn<MapperParameters, Config>&>(parameters()).config;
  }

  /// The command that make() would run; empty: none.
  std::string command() const { return parameters().command(); }
  /// A command in a file that came from somebody else must not run by itself: the user has to say so. It is no part of
  /// the configuration, so that no file can permit it.
  void permit_command() { permitted_ = true; }
  /// Throws InputError when there is a command that was not permitted.
  void require_permission() const;

 private:
  friend std::unique_ptr<Mapper> make_here(const MapperConfig&, const robot::RobotModel&, const MapperSetting&);

  bool permitted_ = false;
  std::string place_;  ///< of the command, file:line:column
};

/// The mapper in this process, for those who serve one.
std::unique_ptr<Mapper> make_here(const MapperConfig& config, const robot::RobotModel& model,
                                  const MapperSetting& setting);

}  // namespace rubble::slam
