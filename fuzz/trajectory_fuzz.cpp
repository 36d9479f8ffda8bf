// Trajectories in the TUM format.
#include "base/trajectory.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::read_tum(file.path()); });
  return 0;
}
