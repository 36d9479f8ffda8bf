#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scoring/figures/figures.h"

namespace rubble::scenarios {

/// The content of score.json, of a run and of `rubble score` alike: every row of the table of figures, null where it is
/// not known (special ones are left out there); then the worst places (null without a verdict), then the figures of
/// that kind of mapper alone.
nlohmann::ordered_json score_json(const scoring::Evidence& evidence);

/// Only the rows that are known.
nlohmann::ordered_json known_figures(const scoring::Evidence& evidence);

/// A number, word or yes-or-no of score.json as the table of figures has it; lists are unknown.
scoring::Value value_of(const nlohmann::ordered_json& json);

/// Without what depends on the machine: equal for equal seeds.
nlohmann::ordered_json without_machine(const nlohmann::ordered_json& score);

}  // namespace rubble::scenarios
