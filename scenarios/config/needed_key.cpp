#include "scenarios/config/needed_key.h"

#include "base/text/words.h"

namespace rubble::scenarios {

void refuse_misspelt(const YamlMap& root, const std::string& needed) {
  if (root.has(needed)) return;
  for (const std::string& key : root.keys())
    if (const std::string near = did_you_mean(key, {needed}); key != needed && !near.empty())
      root.fail(key, "unknown key " + in_quotes(key) + near);
}

}  // namespace rubble::scenarios
