#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scoring/scorecard.h"

namespace rubble::app {

/// What --align says. auto, walls, rooms, features (SURF), surf, akaze or orb.
scoring::AlignmentConfig parse_align(const std::string& text);

/// The rows below the score: what is wrong and where, the warp.
void print_parts(const scoring::MapScore& score);
void add_parts(nlohmann::ordered_json& json, const scoring::MapScore& score);

}  // namespace rubble::app
