#include "robot/logs/foreign/module/packing.h"

extern "C" __attribute__((visibility("default"))) const rubble::robot::MrptLogs* rubble_mrpt_logs() {
  using namespace rubble::robot;
  static const MrptLogs module = {tell_rawlog, pack_rawlog, packed_simplemap};
  return &module;
}
