// Rubble's explorer drives a robot of one's own by the map of a mapper of one's own.
#include <rubble/explore/explorers.h>

#include <cstdio>

#include "my_mapper.h"
#include "my_robot.h"

int main() {
  MyRobot robot;
  MyMapper mapper(robot.model());
  const auto explorer = rubble::explore::ExplorerConfig().make(robot.model(), {});
  while (const auto inputs = robot.read()) {
    mapper.update(*inputs);
    robot.command(explorer->next(mapper, *inputs));
    if (explorer->finished()) break;
  }
  const rubble::GridFrame& frame = mapper.map().frame();
  double known = 0.0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (mapper.map().seen({x, y}) > 0) known += frame.resolution * frame.resolution;
  std::printf("%s; %.1f m2 known\n", explorer->finished() ? explorer->reason().c_str() : "time is over", known);
}
