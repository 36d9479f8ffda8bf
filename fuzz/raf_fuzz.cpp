// The league's arena files.
#include "arenas/raf/raf.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads(
      [&] { rubble::arenas::parse_raf(std::string(rubble::fuzz::text_of(data, size)), "input.raf"); });
  return 0;
}
