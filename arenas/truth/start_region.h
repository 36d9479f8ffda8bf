#pragma once

#include <optional>
#include <string>

#include "arenas/model/arena.h"
#include "arenas/truth/visible.h"

namespace rubble::arenas {

/// Who gets to less than this share of the floor starts badly: of that of another part, or of all parts together.
inline constexpr double kSmallShare = 0.5;

/// What is amiss with the start of an arena that can be run all the same, one line: it lies on a platform without a way
/// down or in a room without a door, and the robot gets to less than half of the floor that it could drive on. Names
/// that share, and the place and key of a better start where there is one. Looked at in cells of 0.1 m.
std::optional<std::string> small_start(const Arena& arena, const Viewer& viewer = {});

}  // namespace rubble::arenas
