#include "slam/mrpt/module/builders.h"

extern "C" __attribute__((visibility("default"))) const rubble::slam::MrptSlam* rubble_mrpt_slam() {
  using namespace rubble::slam;
  static const MrptSlam module = {make_icp, make_icp_builder, make_rbpf_builder};
  return &module;
}
