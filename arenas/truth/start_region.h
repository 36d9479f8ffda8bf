#pragma once

#include <optional>
#include <string>

#include "arenas/model/arena.h"
#include "arenas/truth/visible.h"

namespace rubble::arenas {

/// Of the floors that can be driven on apart from each other, one is less than this share of another: too small to
/// start on.
inline constexpr double kSmallShare = 0.5;

/// What is amiss with the start of an arena that can be run all the same, one line: it lies on a platform without a way
/// down or in a room without a door, while another floor on which the robot could start is more than twice as large.
/// Looked at in cells of 0.1 m.
std::optional<std::string> small_start(const Arena& arena, const Viewer& viewer = {});

}  // namespace rubble::arenas
