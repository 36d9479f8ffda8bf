// `bits SCENARIO FOLDER [key=value ...]`: a run as `rubble run` makes it, without the command line, the drivers and the
// emulators. These take a fifth of a build and no part in the bits of a run, which tests/cli/debug_release_test.sh
// compares between builds.
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/config/scenario.h"
#include "scenarios/run/run.h"

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: bits SCENARIO FOLDER [key=value ...]\n", stderr);
    return 2;
  }
  try {
    std::vector<rubble::scenarios::Override> overrides;
    for (int i = 3; i < argc; ++i) {
      const std::string set = argv[i];
      const std::size_t equals = set.find('=');
      if (equals == std::string::npos) throw std::invalid_argument(set + ": is no key=value");
      overrides.emplace_back(set.substr(0, equals), set.substr(equals + 1));
    }
    const auto scenario = rubble::scenarios::load_scenario(argv[1], overrides);
    rubble::scenarios::RunOptions options;
    options.out = argv[2];
    const auto report = rubble::scenarios::run_scenario(scenario, options);
    return report.failure.empty() ? 0 : 4;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
