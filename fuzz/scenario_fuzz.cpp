// Scenarios, the arena they name left out.
#include "fuzz/harness.h"
#include "scenarios/config/scenario.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_scenario(file.path(), {}); });
  return 0;
}
