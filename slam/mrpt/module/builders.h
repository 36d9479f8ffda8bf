#pragma once

#include "slam/mrpt/mrpt_slam.h"

namespace rubble::slam {

std::unique_ptr<Icp> make_icp(const IcpOptions& options);
std::unique_ptr<MapBuilder> make_icp_builder(const robot::RobotModel& model, const MrptIcpConfig& config);
std::unique_ptr<MapBuilder> make_rbpf_builder(const robot::RobotModel& model, const MrptRbpfConfig& config,
                                              std::uint64_t seed);

}  // namespace rubble::slam
