#include "slam/mrpt/mrpt_slam.h"

#include "base/module.h"

namespace rubble::slam {

const MrptSlam& mrpt_slam() {
  static const MrptSlam& module = *reinterpret_cast<MrptSlamFunction>(
      module_function("MRPT's mapping", "rubble_mrpt_slam.so", kMrptSlamSymbol,
                      "install libmrpt-slam-dev and build again, or use `mapper.kind: robust`"))();
  return module;
}

}  // namespace rubble::slam
