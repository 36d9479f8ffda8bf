#pragma once

#include <nlohmann/json.hpp>

#include "scoring/scorecard.h"

namespace rubble::scenarios {

/// Puts the numbers of a scored map under the keys of score.json. `known` is null for a map that was not placed: nobody
/// can say what of the truth it shows.
void add_map_score(nlohmann::ordered_json& json, const scoring::MapScore& score);

}  // namespace rubble::scenarios
