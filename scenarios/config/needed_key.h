#pragma once

#include <string>

#include "base/yaml/strict_yaml.h"

namespace rubble::scenarios {

/// Throws InputError where `needed` is missing and a key of the file looks like it, misspelt: who reads a file fails on
/// what is missing before finish() comes to what is there instead.
void refuse_misspelt(const YamlMap& root, const std::string& needed);

}  // namespace rubble::scenarios
