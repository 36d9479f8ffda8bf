// CoreSLAM's text logs.
#include "fuzz/harness.h"
#include "robot/logs/foreign/coreslam.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads([&] { rubble::robot::read_coreslam(rubble::fuzz::text_of(data, size), "input.dat"); });
  return 0;
}
