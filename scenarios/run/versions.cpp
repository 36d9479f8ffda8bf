// A file of its own: it is compiled again at every commit.
#include <nlohmann/json.hpp>

#include "scenarios/run/run.h"
#include "scenarios/run/version.h"

namespace rubble::scenarios {

Versions versions() { return {kVersion, kCommit, __VERSION__, kBuildType}; }

std::string Versions::json(int indent) const {
  return nlohmann::ordered_json{{"rubble", rubble}, {"commit", commit}, {"compiler", compiler}, {"build", build}}.dump(
      indent);
}

}  // namespace rubble::scenarios
