// Our own log: frames, header, ticks, commands and codes, played to the end.
#include "fuzz/harness.h"
#include "robot/logs/log.h"

RUBBLE_FUZZ_TARGET {
  const rubble::fuzz::MemoryFile file(data, size);
  rubble::fuzz::refuses_or_reads([&] {
    rubble::robot::ReplayRobot robot(file.path());
    while (robot.read()) {
    }
  });
  return 0;
}
