#pragma once

#include <string>

#include "scoring/scorecard.h"

namespace rubble::app {

/// What --align says: auto, or some of walls, rooms and a kind of features (features is surf; surf, akaze, orb), joined
/// by commas. Throws UsageError.
scoring::AlignmentConfig parse_align(const std::string& text);

/// The rows about the pose: what proposed it, how far it is ahead, and of what.
void print_contest(const scoring::MapScore& score);

/// The rows about where the map is wrong, worst first.
void print_worst_places(const scoring::MapScore& score);

}  // namespace rubble::app
