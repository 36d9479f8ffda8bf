// Robot files.
#include "fuzz/harness.h"
#include "scenarios/hardware/robot_file.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_robot_file(file.path()); });
  return 0;
}
