#pragma once

#include "robot/logs/foreign/mrpt_logs.h"

/// The functions of MrptLogs.
namespace rubble::robot {

void tell_rawlog(std::string_view bytes, const std::string& path, const std::function<void(std::string_view)>& send);
void pack_rawlog(const std::function<std::optional<Inputs>()>& next, const mrpt::math::TPose3D& T_base_laser,
                 const std::string& comment, const std::function<void(std::string_view)>& put);
std::string packed_simplemap(const std::vector<PosedScan>& scans, const mrpt::math::TPose3D& T_base_laser);

}  // namespace rubble::robot
