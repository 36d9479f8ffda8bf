#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "base/yaml/strict_yaml.h"

namespace rubble {
namespace {

/// A document with what it says, made without the code under test.
struct Document {
  std::string yaml;
  std::vector<std::pair<std::string, std::string>> texts;
};

std::string random_text(Rng& rng, bool with_breaks) {
  static const std::string kLetters = "ab z09#:-?,[]{}&*!|>'\"%@`\\~.=<+_ \xc3\xa4";
  std::string text;
  const std::uint32_t length = rng.below(20);
  for (std::uint32_t i = 0; i < length; ++i)
    text += with_breaks && rng.below(5) == 0 ? '\n' : kLetters[rng.below(static_cast<std::uint32_t>(kLetters.size()))];
  return text;
}

std::string single_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string double_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return out + "\"";
}

/// A block literal whose indentation is given, so that any first line will do.
std::string literal(const std::string& text) {
  std::string out = "|2+\n";
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    out += "  " + text.substr(start, end - start) + "\n";
    start = end + 1;
  }
  return out;
}

Document random_document(Rng& rng) {
  Document document;
  const std::uint32_t count = 1 + rng.below(8);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string key = "k" + std::to_string(i);
    const std::uint32_t style = rng.below(3);
    std::string text = random_text(rng, style != 0);
    document.yaml += key + ": ";
    if (style == 0) {
      document.yaml += single_quoted(text) + "\n";
    } else if (style == 1) {
      document.yaml += double_quoted(text) + "\n";
    } else {
      text = "x" + text + "\n";  // a literal keeps its last line end
      document.yaml += literal(text);
    }
    document.texts.emplace_back(key, text);
  }
  return document;
}

TEST(StrictYamlProperty, AnyTextIsReadAndSurvivesTheDump) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Rng rng(seed, "document");
    const Document document = random_document(rng);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + document.yaml);
    const YamlMap root = YamlMap::parse(document.yaml, "f.yaml");
    const std::string dump = root.dump();
    SCOPED_TRACE(dump);
    const YamlMap again = YamlMap::parse(dump, "dump");
    for (const auto& [key, text] : document.texts) {
      ASSERT_EQ(root.text(key, {}), text);
      ASSERT_EQ(again.text(key, {}), text);
    }
    EXPECT_EQ(again.dump(), dump);
    EXPECT_NO_THROW(again.finish());
  }
}

// What a value says and where it comes from survive any way of writing a block text.
TEST(StrictYamlProperty, FailAtFindsEveryLetterOfADrawing) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "drawing");
    const std::uint32_t depth = rng.below(4);
    const std::uint32_t indent = 1 + rng.below(6);
    std::string yaml;
    for (std::uint32_t i = 0; i < depth; ++i) yaml += std::string(2 * i, ' ') + "m:\n";
    const bool leading = rng.below(2) == 0;  // the first row starts with spaces
    yaml += std::string(2 * depth, ' ') + "d: |" + (leading ? std::to_string(indent) : "") + "\n";
    const int first_line = static_cast<int>(depth) + 2;
    const std::uint32_t rows = 1 + rng.below(6);
    for (std::uint32_t row = 0; row < rows; ++row)
      yaml += std::string(2 * depth + indent, ' ') + (leading ? "   " : "") + "#..#\n";
    YamlMap map = YamlMap::parse(yaml, "f");
    for (std::uint32_t i = 0; i < depth; ++i) map = map.map("m");
    const int row = static_cast<int>(rng.below(rows));
    const int column = static_cast<int>(rng.below(4));
    const std::string expected = at("f", first_line + row, static_cast<int>(2 * depth + indent) + column + 1, "here");
    try {
      map.fail_at("d", row, column, "here");
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), expected) << yaml;
    }
  }
}

// Whatever stands in the file: a document or one line of InputError; and what was read can be dumped and read again.
TEST(StrictYamlProperty, DamagedDocumentsNeverCrash) {
  const std::string good =
      "# an arena\nname: 'yellow'\nscale: 1.5\nsize: [8, 8]\nfloor: |\n  ####\n  #..#\n  ####\n"
      "robots:\n  - name: a\n    start: {x: 1, y: 2}\n  - &r {name: b, \"q\": \"\\t\"}\nmore:\n  deep:\n    deeper: "
      "*r\n"
      "fold: >-\n  a\n  b\nnothing:\n";
  static const std::string kLetters = ":-[]{},#|>&*!'\"\\%@` \n\n\t?abc019\r~<";
  int read = 0;
  for (std::uint64_t seed = 0; seed < 8000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "damage");
    std::string text = good;
    const std::uint32_t count = 1 + rng.below(4);
    for (std::uint32_t i = 0; i < count && !text.empty(); ++i) {
      const std::uint32_t position = rng.below(static_cast<std::uint32_t>(text.size()));
      const char letter = kLetters[rng.below(static_cast<std::uint32_t>(kLetters.size()))];
      switch (rng.below(4)) {
        case 0:
          text[position] = letter;
          break;
        case 1:
          text.insert(position, 1, letter);
          break;
        case 2:
          text.erase(position, 1 + rng.below(3));
          break;
        default:
          text.resize(position);
      }
    }
    try {
      const YamlMap root = YamlMap::parse(text, "f");
      const std::string dump = root.dump();
      ASSERT_EQ(YamlMap::parse(dump, "dump").dump(), dump) << text;
      ++read;
    } catch (const InputError& error) {
      const std::string message = error.what();
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
      ASSERT_EQ(message.rfind("f:", 0), 0u) << message << "\n" << text;
    }
  }
  EXPECT_GT(read, 500);
}

}  // namespace
}  // namespace rubble
