// What a mapper process says, which is a foreign program.
#include "fuzz/harness.h"
#include "fuzz/memory_source.h"
#include "slam/process/answer.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble::slam;
  rubble::fuzz::MemorySource source(data, size);
  MessageReader in(source);
  try {
    read_ready(in);
    for (;;) read_answer(in);  // ends by what it throws at the end of the bytes
  } catch (const BadMessage&) {
  }
  return 0;
}
