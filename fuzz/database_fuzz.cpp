// Merged results, which are an SQLite database.
#include "fuzz/harness.h"
#include "scenarios/batch/merge.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_results(file.path()); });
  return 0;
}
