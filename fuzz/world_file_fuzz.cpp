// World files beside pictures.
#include "base/image/geotiff.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::read_world_file(file.path()); });
  return 0;
}
