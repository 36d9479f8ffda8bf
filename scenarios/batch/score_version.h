#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/batch/results.h"

namespace rubble::scenarios {

/// The version of the score that runs were judged by (scoring::kScoreVersion of the program that made them; 1 where
/// they do not say, as before there were versions). nullopt: no run has a score. Throws InputError that names `source`
/// and two runs when they differ among themselves.
std::optional<int> score_version_of(const std::vector<RunRecord>& runs, const std::string& source);

/// Throws InputError when both have scores and of different versions: these numbers cannot be compared.
void require_same_score(const std::optional<int>& a, const std::string& name_a, const std::optional<int>& b,
                        const std::string& name_b);

}  // namespace rubble::scenarios
