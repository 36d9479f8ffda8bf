#include "explore/explorers.h"

#include "explore/paper/paper_explorer.h"

namespace rubble::explore {
namespace {

/// Parameters kept in a plain struct `Config` with a field occupied_threshold, which functions bind(Binder&, Config&),
/// mistake(const Config&) and notes(const Config&, model, mission) beside it know, of an explorer whose constructor
/// takes (model, config, mission).
template <class Config, class Mine>
class ParametersOf : public ParametersIn<ExplorerParameters, Config> {
 public:
  std::string mistake() const override { return explore::mistake(this->config); }
  std::vector<std::string> notes(const robot::RobotModel& model, const Mission& mission) const override {
    return explore::notes(this->config, model, mission);
  }
  double occupied_threshold() const override { return this->config.occupied_threshold; }
  std::unique_ptr<Explorer> make(const robot::RobotModel& model, const Mission& mission) const override {
    return std::make_unique<Mine>(model, this->config, mission);
  }
  std::unique_ptr<ExplorerParameters> copy() const override { return std::make_unique<ParametersOf>(*this); }
};

template <class Config, class Mine>
ExplorerKind row(const std::string& name, const std::string& about) {
  return {name, about, [] { return std::make_unique<ParametersOf<Config, Mine>>(); }};
}

}  // namespace

const std::vector<ExplorerKind>& explorer_kinds() {
  static const std::vector<ExplorerKind> kinds = {
      row<PaperExplorerConfig, PaperExplorer>(
          "paper", "Pellenz 2008: Exploration Transform to a close frontier, then the search for victims"),
  };
  return kinds;
}

}  // namespace rubble::explore
