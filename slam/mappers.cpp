#include "slam/mappers.h"

#include "base/error.h"
#include "base/text/words.h"
#include "slam/paper/paper_mapper.h"
#include "slam/peers/mrpt_kinds.h"
#include "slam/process/process_mapper.h"
#include "slam/robust/continued_mapper.h"
#include "slam/robust/robust_mapper.h"

namespace rubble::slam {
namespace {

template <class Config, class Mine>
MapperKind row(const std::string& name, const std::string& about) {
  return {name, about, [] { return std::make_unique<ParametersOf<Config, Mine>>(); }};
}

/// The one kind that can go on with a map of an earlier run.
class RobustParameters : public ParametersIn<MapperParameters, RobustConfig> {
 public:
  std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const override {
    if (setting.base) return std::make_unique<ContinuedMapper>(model, config, setting.base);
    return std::make_unique<RobustMapper>(model, config, setting.seed);
  }
  std::unique_ptr<MapperParameters> copy() const override { return std::make_unique<RobustParameters>(*this); }
  bool goes_on() const override { return true; }
};

}  // namespace

const std::vector<MapperKind>& mapper_kinds() {
  static const std::vector<MapperKind> kinds = {
      {"robust", "local map matching, verified loops, pose graph, restamped map",
       [] { return std::make_unique<RobustParameters>(); }},
      row<PaperConfig, PaperMapper>("paper", "Pellenz 2008: ICP, 300 particles, two-plane count map; no loop closure"),
      {"process", "a program of yours, over its standard input and output (docs/mapper_protocol.md)",
       process_parameters},
      {"mrpt-icp", "MRPT's icp-slam: scans matched to a map of points; for comparison", mrpt_icp_parameters},
      {"mrpt-rbpf", "MRPT's rbpf-slam: particles that each carry a grid; for comparison", mrpt_rbpf_parameters},
  };
  return kinds;
}

void MapperConfig::bind(Binder& binder) {
  KindChoice::bind(binder);
  if (const std::string place = command().empty() ? "" : binder.place("command"); !place.empty()) place_ = place;
}

void MapperConfig::require_permission() const {
  if (permitted_ || command().empty()) return;
  throw InputError((place_.empty() ? "" : place_ + ": ") + "mapper.command: " + in_quotes(command(), 200) +
                   " stands in a file, and a command of a file runs only with --allow-commands");
}

std::unique_ptr<Mapper> MapperConfig::make(const robot::RobotModel& model, const MapperSetting& setting) const {
  require_permission();
  if (setting.base && !parameters().goes_on())
    throw InputError(setting.base->name + ": mapper.kind '" + kind() +
                     "' cannot go on with a map; leave mapper.kind away or set it to robust");
  return parameters().make(model, setting);
}

std::unique_ptr<Mapper> make_here(const MapperConfig& config, const robot::RobotModel& model,
                                  const MapperSetting& setting) {
  config.require_permission();
  return config.parameters().make_here(model, setting);
}

}  // namespace rubble::slam
