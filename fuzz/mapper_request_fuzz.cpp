// What a mapper process of ours is told.
#include "fuzz/harness.h"
#include "fuzz/memory_source.h"
#include "slam/process/request.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble::slam;
  rubble::fuzz::MemorySource source(data, size);
  MessageReader in(source);
  try {
    read_header(in);
    while (const auto request = read_request(in))
      if (request->finish) break;
  } catch (const BadMessage&) {
  }
  return 0;
}
