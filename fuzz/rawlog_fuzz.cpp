// MRPT's rawlog: read in a child, so a finding here is one of ours, or a child beyond its limits.
#include "fuzz/harness.h"
#include "robot/logs/foreign/mrpt_bridge.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads(
      [&] { rubble::robot::read_rawlog_bytes(rubble::fuzz::text_of(data, size), "input.rawlog"); });
  return 0;
}
