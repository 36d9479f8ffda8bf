// Baselines of a regression check.
#include "fuzz/harness.h"
#include "scenarios/evidence/baseline.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_baseline(file.path()); });
  return 0;
}
