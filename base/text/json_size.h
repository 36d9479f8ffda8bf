#pragma once

#include <string_view>

namespace rubble {

/// Whether a JSON text of somebody else may be given to the parser: 64 levels, 1000 keys an object and 10 million
/// values at most. Beyond that an object with its keys in order takes time by their square, each bracket takes 50 times
/// its byte, and whatever walks over a value afterwards uses up the stack. Says nothing of whether it is JSON at all.
bool is_modest_json(std::string_view text);

}  // namespace rubble
