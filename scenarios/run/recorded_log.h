#pragma once

#include <string>

namespace rubble::scenarios {

/// The log in a run folder. Throws InputError when there is no such folder, or no log in it: then with what it is
/// instead, and the newest recorded run beside it.
std::string log_in(const std::string& folder);

/// Throws InputError where `path` names the truth of a run folder that has none: with what wrote the folder, and the
/// newest run beside it that has one.
void require_truth(const std::string& path);

}  // namespace rubble::scenarios
