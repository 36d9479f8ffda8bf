#include "base/text/shell.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

namespace rubble {
namespace {

/// What a shell makes of one word.
std::string read_by_shell(const std::string& word) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("printf %s " + word).c_str(), "r"), pclose);
  std::string out;
  std::array<char, 64> part{};
  for (std::size_t n = 0; pipe && (n = std::fread(part.data(), 1, part.size(), pipe.get())) > 0;)
    out.append(part.data(), n);
  return out;
}

TEST(ShellWord, IsReadBackAsItWas) {
  for (const char* text :
       {"plain", "maps/team a.tif", "it's", "$HOME", "a;rm b", "`x`", "\"q\"", "a\\b", "*", "-x", "~"})
    EXPECT_EQ(read_by_shell(shell_word(text)), text);
  EXPECT_EQ(shell_word("maps/a-1_b.tif"), "maps/a-1_b.tif");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace rubble
