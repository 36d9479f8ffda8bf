#include "scenarios/batch/score_version.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace rubble::scenarios {
namespace {

constexpr int kFirst = 1;
constexpr const char* kRemedy = " cannot be compared; make the older runs again with this program";

std::string version_text(int version) { return "score of version " + std::to_string(version); }

}  // namespace

std::optional<int> score_version_of(const std::vector<RunRecord>& runs, const std::string& source) {
  std::optional<int> version;
  std::string first;
  for (const RunRecord& run : runs) {
    if (std::isnan(run.metric("score"))) continue;
    if (const auto told = run.score->find("score_version"); told != run.score->end() && !told->is_number_integer())
      throw InputError(source + ": run " + run.run_id + " has a score_version that is no whole number (" +
                       told->dump().substr(0, 40) + "); make it again with this program");
    const double said = run.metric("score_version");
    const int of_run = std::isnan(said) ? kFirst : static_cast<int>(std::clamp(said, -1e9, 1e9));
    if (!version) {
      version = of_run;
      first = run.run_id;
    }
    if (*version != of_run)
      throw InputError(source + ": run " + first + " has a " + version_text(*version) + ", run " + run.run_id + " a " +
                       version_text(of_run) + ": they" + kRemedy);
  }
  return version;
}

void require_same_score(const std::optional<int>& a, const std::string& name_a, const std::optional<int>& b,
                        const std::string& name_b) {
  if (a && b && *a != *b)
    throw InputError(name_a + " has a " + version_text(*a) + ", " + name_b + " a " + version_text(*b) + ": they" +
                     kRemedy);
}

}  // namespace rubble::scenarios
