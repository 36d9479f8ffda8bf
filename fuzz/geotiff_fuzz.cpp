// GeoTIFF maps of other teams.
#include "base/image/geotiff.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::read_geotiff(file.path()); });
  return 0;
}
