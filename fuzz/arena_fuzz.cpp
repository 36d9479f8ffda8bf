// Arena files and what is checked of them.
#include "arenas/files/arena_file.h"
#include "fuzz/harness.h"

RUBBLE_FUZZ_TARGET {
  rubble::fuzz::refuses_or_reads([&] {
    const auto arena = rubble::arenas::parse_arena(std::string(rubble::fuzz::text_of(data, size)), "input.yaml");
    rubble::arenas::check(arena, "input.yaml");
  });
  return 0;
}
