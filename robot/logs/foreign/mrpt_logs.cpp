#include "robot/logs/foreign/mrpt_logs.h"

#include "base/module.h"

namespace rubble::robot {

const MrptLogs& mrpt_logs() {
  static const MrptLogs& module = *reinterpret_cast<MrptLogsFunction>(module_function(
      "MRPT's files", "rubble_mrpt_logs.so", kMrptLogsSymbol, "install libmrpt-slam-dev and build again"))();
  return module;
}

}  // namespace rubble::robot
