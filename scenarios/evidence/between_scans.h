#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scoring/trajectory/relative_error.h"

namespace rubble::scenarios {

/// What to tell, in one line, of relations many of which name moments without a scan: poses between two scans are
/// guessed, and the error of such relations is worth little. Nothing: they are of these scans. `path`, `log`: where
/// both are from.
std::optional<std::string> between_scans(const Trajectory& scans, const std::vector<scoring::Relation>& relations,
                                         const std::string& path, const std::string& log);

}  // namespace rubble::scenarios
