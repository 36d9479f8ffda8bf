// The judge's points of a league.
#include "fuzz/harness.h"
#include "scoring/league/league.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scoring::read_judge(file.path()); });
  return 0;
}
