// Each fuzz target with its corpus and with changes of it, in every build: the long search for more is tests/fuzz.sh.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "base/rng.h"
#include "base/text/text_file.h"
#include "tests/support/source_dir.h"

#define FUZZ_TARGET(name) extern "C" int fuzz_##name(const std::uint8_t*, std::size_t);
#include "tests/fuzz/targets.h"
#undef FUZZ_TARGET

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct Target {
  std::string name;
  int (*feed)(const std::uint8_t*, std::size_t);
};

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
#define FUZZ_TARGET(name) {#name, fuzz_##name},
#include "tests/fuzz/targets.h"
#undef FUZZ_TARGET
  };
  return all;
}

/// Sorted by name, so that each run changes the same bytes.
std::vector<std::string> corpus_of(const std::string& target) {
  std::vector<std::string> files;
  for (const char* place : {"/fuzz/corpus/", "/tests/fuzz/"})
    if (const std::string folder = RUBBLE_SOURCE_DIR + std::string(place) + target; fs::is_directory(folder))
      for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const std::string& file : files) inputs.push_back(read_text_file(file));
  return inputs;
}

/// Some of its bytes replaced, taken out, said again, or the rest of another input behind it.
std::string changed(std::string input, const std::vector<std::string>& corpus, Rng& rng) {
  const auto below = [&](std::size_t end) { return std::size_t{rng.below(static_cast<std::uint32_t>(end))}; };
  constexpr unsigned char kTelling[] = {0, 1, 0x7F, 0x80, 0xFF, '"', '[', '{', ':', ',', '-', '\n', '9', ' '};
  for (std::size_t changes = 1 + below(4); changes > 0 && !input.empty(); --changes) {
    const std::size_t at = below(input.size());
    const std::size_t length = std::min(1 + below(16), input.size() - at);
    switch (below(6)) {
      case 0:
        input[at] = static_cast<char>(below(256));
        break;
      case 1:
        input[at] = static_cast<char>(kTelling[below(std::size(kTelling))]);
        break;
      case 2:
        input.erase(at, length);
        break;
      case 3:
        input.insert(at, input.substr(at, length));
        break;
      case 4:
        input.insert(below(input.size()), input.substr(at, length));
        break;
      default:
        if (const std::string& other = corpus[below(corpus.size())]; !other.empty())
          input = input.substr(0, at) + other.substr(below(other.size()));
    }
  }
  return input;
}

/// What the program holds, in small blocks and large ones [bytes]; under a sanitizer, which allocates itself, 0.
std::size_t held() {
  const struct mallinfo2 now = mallinfo2();
  return now.uordblks + now.hblkhd;
}

class Fuzz : public testing::TestWithParam<Target> {};

// A finding ends the program, as it does under a fuzzer. RUBBLE_FUZZ_INPUTS: how many changed inputs, for a longer
// search.
TEST_P(Fuzz, TakesItsCorpusAndChangesOfItAndKeepsNothing) {
  const Target& target = GetParam();
  const std::vector<std::string> corpus = corpus_of(target.name);
  ASSERT_FALSE(corpus.empty()) << "put a small input into fuzz/corpus/" << target.name;
  const auto feed = [&](const std::string& input) {
    target.feed(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  };
  feed("");
  for (const std::string& input : corpus) feed(input);
  const char* const said = std::getenv("RUBBLE_FUZZ_INPUTS");
  Rng rng{said != nullptr ? 2u : 1u, target.name};
  // Each rawlog is read by a process of its own, and the colours are those of a whole picture.
  const long usual = target.name == "rawlog" ? 100 : target.name == "colours" ? 300 : 2000;
  const long inputs = said != nullptr ? std::atol(said) : usual;
  std::size_t halfway = 0;
  for (long i = 0; i < inputs; ++i) {
    if (i == inputs / 2) halfway = held();
    const std::string& from = corpus[rng.below(static_cast<std::uint32_t>(corpus.size()))];
    feed(changed(from, corpus, rng));
  }
  // A fuzzer feeds millions: what one leaves behind, if only its name in a list, reaches the limit of memory.
  EXPECT_LT(held(), halfway + 50'000) << "in " << inputs - inputs / 2 << " inputs";
}

INSTANTIATE_TEST_SUITE_P(Each, Fuzz, testing::ValuesIn(targets()),
                         [](const testing::TestParamInfo<Target>& info) { return info.param.name; });

}  // namespace
}  // namespace rubble
