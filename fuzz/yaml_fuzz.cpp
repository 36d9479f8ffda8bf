// The strict YAML reader below scenarios, arenas, sweeps and robots.
#include "base/yaml/strict_yaml.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads([&] {
    const auto root = rubble::YamlMap::parse(std::string(rubble::fuzz::text_of(data, size)), "input.yaml");
    for (const std::string& key : root.keys()) root.text(key, std::string());
  });
  return 0;
}
