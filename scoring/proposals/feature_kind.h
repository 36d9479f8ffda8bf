#pragma once

namespace rubble::scoring {

/// Kinds of distinctive places of a map that can be matched.
enum class FeatureKind { Surf, Akaze, Orb };
const char* name_of(FeatureKind kind);

}  // namespace rubble::scoring
