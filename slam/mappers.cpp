#include "slam/mappers.h"

#include "base/error.h"
#include "base/text/words.h"
#include "slam/paper/paper_mapper.h"
#include "slam/peers/mrpt_kinds.h"
#include "slam/process/process_mapper.h"
#include "slam/robust/robust_mapper.h"

namespace rubble::slam {
namespace {

template <class Config, class Kind>
MapperKind row(const std::string& name, const std::string& about) {
  return {name, about, [] { return std::make_unique<ParametersOf<Config, Kind>>(); }};
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const MapperKind& kind : mapper_kinds()) all.push_back(kind.name);
  return all;
}

}  // namespace

const std::vector<MapperKind>& mapper_kinds() {
  static const std::vector<MapperKind> kinds = {
      row<PaperConfig, PaperMapper>("paper", "Pellenz 2008: ICP, 300 particles, two-plane count map; no loop closure"),
      row<RobustConfig, RobustMapper>("robust", "local map matching, verified loops, pose graph, restamped map"),
      {"process", "a program of yours, over its standard input and output (docs/mapper_protocol.md)",
       process_parameters},
      {"mrpt-icp", "MRPT's icp-slam: scans matched to a map of points; for comparison", mrpt_icp_parameters},
      {"mrpt-rbpf", "MRPT's rbpf-slam: particles that each carry a grid; for comparison", mrpt_rbpf_parameters},
  };
  return kinds;
}

MapperConfig::MapperConfig() { choose(mapper_kinds().front().name); }
MapperConfig::MapperConfig(const MapperConfig& other)
    : permitted_(other.permitted_), kind_(other.kind_), parameters_(other.parameters_->copy()) {}

MapperConfig& MapperConfig::operator=(const MapperConfig& other) {
  permitted_ = other.permitted_;
  kind_ = other.kind_;
  parameters_ = other.parameters_->copy();
  return *this;
}

void MapperConfig::choose(const std::string& kind) {
  for (const MapperKind& row : mapper_kinds())
    if (row.name == kind) {
      kind_ = kind;
      parameters_ = row.parameters();
      return;
    }
  std::string known;
  for (const std::string& name : names()) known += (known.empty() ? "" : ", ") + name;
  throw InputError("mapper.kind: '" + kind + "' is no mapper; known are " + known);
}

void MapperConfig::bind(Binder& binder) {
  std::string kind = kind_;
  binder.choice("kind", kind, names());
  if (kind != kind_) choose(kind);
  parameters_->bind(binder);
}

void MapperConfig::require_permission() const {
  if (permitted_ || command().empty()) return;
  throw InputError("mapper.command: " + quoted(command(), 200) +
                   " stands in a file, and a command of a file runs only with --allow-commands");
}

std::unique_ptr<Mapper> MapperConfig::make(const robot::RobotModel& model, const MapperSetting& setting) const {
  require_permission();
  return parameters_->make(model, setting);
}

std::unique_ptr<Mapper> make_here(const MapperConfig& config, const robot::RobotModel& model,
                                  const MapperSetting& setting) {
  config.require_permission();
  return config.parameters_->make_here(model, setting);
}

}  // namespace rubble::slam
