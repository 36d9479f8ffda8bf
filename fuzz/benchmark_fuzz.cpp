// Lists of what a benchmark runs.
#include "fuzz/harness.h"
#include "scenarios/benchmark/benchmark_list.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] { rubble::scenarios::load_benchmark(file.path()); });
  return 0;
}
