#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/yaml/strict_yaml.h"

namespace rubble::scenarios {

/// The values of a key that may be one value or a list.
std::vector<std::string> one_or_more(const YamlMap& map, const std::string& key);

/// The seeds that a sweep is made with where the command line names `text`: the first so many of `seeds`, or a range of
/// others. Throws std::invalid_argument, what is wrong with it.
std::vector<std::uint64_t> chosen_seeds(const std::vector<std::uint64_t>& seeds, const std::string& text);

/// `seeds` of a file, as a range (1-24) or a list, in its order and without repeats; up to a million. Throws
/// InputError.
std::vector<std::uint64_t> read_seeds(const YamlMap& root);

}  // namespace rubble::scenarios
