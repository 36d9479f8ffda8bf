// The gzip layer below every log.
#include "fuzz/harness.h"
#include "robot/logs/foreign/file_bytes.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads(
      [&] { rubble::robot::unpacked(std::string(rubble::fuzz::text_of(data, size)), "input.gz"); });
  return 0;
}
