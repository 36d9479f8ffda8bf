// Lists of victims.
#include "fuzz/harness.h"
#include "scoring/maps/pois.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scoring::read_poi_list(file.path()); });
  return 0;
}
