#pragma once

#include "app/command.h"

namespace rubble::app {

// Each in the file of its name, in the wing of its subject.
Command run_command();
Command map_command();
Command merge_command();
Command score_command();
Command rooms_command();
Command plan_command();
Command replay_command();
Command export_command();
Command arena_command();
Command batch_command();
Command batch_merge_command();
Command batch_report_command();
Command benchmark_command();
Command compare_command();
Command check_command();
Command devices_command();
Command calibrate_command();
Command drive_command();
Command emulate_command();

}  // namespace rubble::app
