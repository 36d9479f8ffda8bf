// CARMEN's text logs.
#include "fuzz/harness.h"
#include "robot/logs/foreign/carmen.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads([&] { rubble::robot::read_carmen(rubble::fuzz::text_of(data, size), "input.log"); });
  return 0;
}
