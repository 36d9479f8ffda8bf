#include "slam/mappers.h"

#include "base/error.h"
#include "slam/paper/paper_mapper.h"

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
  };
  return kinds;
}

MapperConfig::MapperConfig() { choose(mapper_kinds().front().name); }
MapperConfig::MapperConfig(const MapperConfig& other) : kind_(other.kind_), parameters_(other.parameters_->copy()) {}

MapperConfig& MapperConfig::operator=(const MapperConfig& other) {
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

std::unique_ptr<Mapper> MapperConfig::make(const robot::RobotModel& model, std::uint64_t seed) const {
  return parameters_->make(model, seed);
}

}  // namespace rubble::slam
