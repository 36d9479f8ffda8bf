#include "scenarios/config/seeds.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "scenarios/config/needed_key.h"

namespace rubble::scenarios {
namespace {

constexpr std::size_t kMostSeeds = 1000000;

std::optional<std::uint64_t> whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end || value > INT64_MAX) return std::nullopt;
  return value;
}

/// First and last of a range of seeds (1-24), or one seed as both; nothing where it is neither. A range is not
/// backwards.
std::optional<std::pair<std::uint64_t, std::uint64_t>> seed_range(const std::string& text) {
  const auto dash = text.find('-');
  const auto first = whole_number(text.substr(0, dash));
  const auto last = dash == std::string::npos ? first : whole_number(text.substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return std::pair(*first, *last);
}

}  // namespace

std::vector<std::string> one_or_more(const YamlMap& map, const std::string& key) {
  try {
    return {map.text(key, std::nullopt)};
  } catch (const InputError&) {
    return map.texts(key);
  }
}

std::vector<std::uint64_t> chosen_seeds(const std::vector<std::uint64_t>& seeds, const std::string& text) {
  const auto range = seed_range(text);
  const bool how_many = text.find('-') == std::string::npos;
  if (!range || (how_many && (range->first == 0 || range->first > kMostSeeds)))
    throw std::invalid_argument("needs how many of the sweep's seeds to take (6) or a range of others (101-108)");
  if (how_many) {
    const auto end = seeds.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(range->first, seeds.size()));
    return {seeds.begin(), end};
  }
  if (range->second - range->first >= kMostSeeds) throw std::invalid_argument("are more than a million seeds");
  std::vector<std::uint64_t> others(range->second - range->first + 1);
  std::iota(others.begin(), others.end(), range->first);
  return others;
}

std::vector<std::uint64_t> read_seeds(const YamlMap& root) {
  const std::string remedy = "; write a range (seeds: 1-24) or a list (seeds: [1, 5, 9])";
  refuse_misspelt(root, "seeds");
  if (!root.has("seeds")) root.fail("seeds", "'seeds' are needed" + remedy);
  std::vector<std::uint64_t> seeds;
  std::set<std::uint64_t> seen;
  for (const auto& text : one_or_more(root, "seeds")) {
    const auto range = seed_range(text);
    if (!range) root.fail("seeds", "'" + text + "' is neither a seed nor a range" + remedy);
    const auto& [first, last] = *range;
    if (last - first >= kMostSeeds - seeds.size()) root.fail("seeds", "are more than a million seeds; split the file");
    for (std::uint64_t seed = first;; ++seed) {
      if (!seen.insert(seed).second) root.fail("seeds", "seed " + std::to_string(seed) + " is there twice" + remedy);
      seeds.push_back(seed);
      if (seed == last) break;
    }
  }
  if (seeds.empty()) root.fail("seeds", "the list is empty" + remedy);
  return seeds;
}

}  // namespace rubble::scenarios
