// What the devices of a drive said, read and played to the drivers again.
#include "fuzz/harness.h"
#include "robot/drivers/black_box_replay.h"
#include "robot/drivers/scip/scip_replay.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble::robot;
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] {
    const auto entries = read_black_box(file.path());
    replay_scanner(entries, {5.6, true});
    replay_black_box(entries, "arcos", {}, {});
  });
  return 0;
}
