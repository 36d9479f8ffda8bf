#pragma once

#include <string>
#include <string_view>

#include "robot/logs/foreign/foreign_log.h"

namespace rubble::robot {

/// True when the first line is a CoreSLAM .dat line: a hundred numbers or more and nothing else.
bool is_coreslam(std::string_view text);

/// Reads a CoreSLAM / BreezySLAM .dat log (Mines ParisTech's robot with a URG-04LX): 707 numbers a line, of which
/// [0] is the time [us], [2] and [3] the left and right encoder, [24..706] the ranges [mm]. Throws InputError.
ForeignLog read_coreslam(std::string_view text, const std::string& path);

}  // namespace rubble::robot
