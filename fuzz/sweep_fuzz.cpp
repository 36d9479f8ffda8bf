// Sweep files.
#include "fuzz/harness.h"
#include "scenarios/batch/sweep.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_sweep(file.path()); });
  return 0;
}
