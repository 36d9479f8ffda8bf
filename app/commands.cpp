#include "app/commands.h"

namespace rubble::app {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      run_command(),         map_command(),          merge_command(),   score_command(),     rooms_command(),
      plan_command(),        replay_command(),       export_command(),  arena_command(),     batch_command(),
      batch_merge_command(), batch_report_command(), compare_command(), check_command(),     benchmark_command(),
      drive_command(),       emulate_command(),      devices_command(), calibrate_command(),
  };
  return table;
}

}  // namespace rubble::app
