#include "explore/explorers.h"

#include "base/error.h"
#include "explore/paper/paper_explorer.h"

namespace rubble::explore {
namespace {

/// Parameters kept in a plain struct `Config` that functions bind(Binder&, Config&) and mistake(const Config&) beside
/// it know, of an explorer whose constructor takes (model, config, mission).
template <class Config, class Kind>
class ParametersOf : public ExplorerParameters {
 public:
  void bind(Binder& binder) override { explore::bind(binder, config_); }
  std::string mistake() const override { return explore::mistake(config_); }
  double occupied_threshold() const override { return config_.occupied_threshold; }
  std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const override {
    return std::make_unique<Kind>(model, config_, mission);
  }
  std::unique_ptr<ExplorerParameters> copy() const override { return std::make_unique<ParametersOf>(*this); }

 private:
  Config config_;
};

template <class Config, class Kind>
ExplorerKind row(const std::string& name, const std::string& about) {
  return {name, about, [] { return std::make_unique<ParametersOf<Config, Kind>>(); }};
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const ExplorerKind& kind : explorer_kinds()) all.push_back(kind.name);
  return all;
}

}  // namespace

const std::vector<ExplorerKind>& explorer_kinds() {
  static const std::vector<ExplorerKind> kinds = {
      row<PaperExplorerConfig, PaperExplorer>(
          "paper", "Pellenz 2008: Exploration Transform to a close frontier, then the search for victims"),
  };
  return kinds;
}

ExplorerConfig::ExplorerConfig() { choose(explorer_kinds().front().name); }
ExplorerConfig::ExplorerConfig(const ExplorerConfig& other)
    : kind_(other.kind_), parameters_(other.parameters_->copy()) {}

ExplorerConfig& ExplorerConfig::operator=(const ExplorerConfig& other) {
  kind_ = other.kind_;
  parameters_ = other.parameters_->copy();
  return *this;
}

void ExplorerConfig::choose(const std::string& kind) {
  for (const ExplorerKind& row : explorer_kinds())
    if (row.name == kind) {
      kind_ = kind;
      parameters_ = row.parameters();
      return;
    }
  std::string known;
  for (const std::string& name : names()) known += (known.empty() ? "" : ", ") + name;
  throw InputError("explorer.kind: '" + kind + "' is no explorer; known are " + known);
}

void ExplorerConfig::bind(Binder& binder) {
  std::string kind = kind_;
  binder.choice("kind", kind, names());
  if (kind != kind_) choose(kind);
  parameters_->bind(binder);
}

}  // namespace rubble::explore
