// A file of its own: it is compiled again at every commit.
#include "scenarios/run/run.h"
#include "scenarios/run/version.h"

namespace rubble::scenarios {

nlohmann::ordered_json versions() {
  return {{"rubble", kVersion}, {"commit", kCommit}, {"compiler", __VERSION__}, {"build", kBuildType}};
}

}  // namespace rubble::scenarios
