#include "base/text/json_size.h"

#include <cstddef>
#include <vector>

namespace rubble {
namespace {

constexpr std::size_t kMostLevels = 64;
constexpr std::size_t kMostKeys = 1000;
constexpr std::size_t kMostValues = 10000000;

}  // namespace

bool is_modest_json(std::string_view text) {
  std::vector<std::size_t> keys = {0};  // of the objects around the place
  std::size_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      in_string = !in_string;
    } else if (in_string) {
      if (c == '\\') ++i;
    } else if (c == '[' || c == '{') {
      keys.push_back(0);
      if (++values > kMostValues || keys.size() > kMostLevels + 1) return false;
    } else if (c == ']' || c == '}') {
      if (keys.size() > 1) keys.pop_back();
    } else if (c == ',') {
      if (++values > kMostValues) return false;
    } else if (c == ':') {
      if (++keys.back() > kMostKeys) return false;
    }
  }
  return true;
}

}  // namespace rubble
