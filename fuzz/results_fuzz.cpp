// Results of a batch, which may come from elsewhere.
#include "fuzz/harness.h"
#include "scenarios/batch/results.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_lines(file.path()); });
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_timing(file.path()); });
  return 0;
}
