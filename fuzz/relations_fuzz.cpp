// Relations that trajectories are judged by.
#include "fuzz/harness.h"
#include "scoring/trajectory/relative_error.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scoring::read_relations(file.path()); });
  return 0;
}
