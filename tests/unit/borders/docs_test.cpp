// What docs/ says of the tree holds: the files it names are there, and another mapper or explorer costs the two files
// and the row that docs/extending.md promises.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

const fs::path kTop = RUBBLE_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::smatch> all_matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// A file or folder of the tree, with or without the ending; a benchmark by its program.
bool is_there(const std::string& name) {
  for (const char* ending : {"", ".h", ".cpp"})
    if (fs::exists(kTop / (name + ending))) return true;
  return false;
}

/// What the reader shall write himself, or put in the place of a word.
bool is_example(const std::string& name) {
  static const std::regex example(R"re((^|/)(mine|my_[a-z_]+|[A-Z]+)(/|\.|$))re");
  return std::regex_search(name, example);
}

TEST(Docs, NameFilesThatAreThere) {
  static const std::regex quoted(
      R"re(`((?:app|arenas|base|bench|cmake|docs|examples|explore|fuzz|robot|robots|scenarios|scoring|sim|slam|tests)/[A-Za-z0-9_./-]*)`)re");
  std::vector<fs::path> pages{kTop / "README.md"};
  for (const auto& entry : fs::directory_iterator(kTop / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::size_t names = 0;
  for (const fs::path& page : pages) {
    const std::string text = text_of(page);
    for (const std::smatch& match : all_matches(text, quoted)) {
      ++names;
      EXPECT_TRUE(is_example(match[1]) || is_there(match[1])) << page << " names " << match[1];
    }
  }
  EXPECT_GT(names, 100u);
  EXPECT_TRUE(is_example("slam/mine/my_mapper.h"));
  EXPECT_FALSE(is_example("slam/grid/CountMap") || is_there("slam/grid/CountMap"));
}

TEST(Docs, ThePageOfTheBaseListsAllItsHeaders) {
  const std::string page = text_of(kTop / "docs/base.md");
  std::size_t headers = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kTop / "base")) {
    if (entry.path().extension() != ".h") continue;
    ++headers;
    const std::string name = fs::relative(entry.path(), kTop / "base").generic_string();
    EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name;
  }
  EXPECT_GT(headers, 25u);
}

/// The only two places that know the number: the program, and the table of what each version changed.
TEST(Docs, TheTableOfScoreVersionsEndsWithTheOneThatTheProgramHas) {
  static const std::regex row(R"re(\n\| (\d+) \| )re"), constant(R"re(kScoreVersion = (\d+);)re");
  const std::string page = text_of(kTop / "docs/scoring.md");
  const std::string table = page.substr(page.find("\n### Versions of the score"));
  const std::vector<std::smatch> rows = all_matches(table, row);
  const std::string header = text_of(kTop / "scoring/scorecard.h");
  std::smatch version;
  ASSERT_TRUE(std::regex_search(header, version, constant));
  const int versions = std::stoi(version[1]);
  ASSERT_GE(static_cast<int>(rows.size()), versions);
  for (int i = 0; i < versions; ++i) EXPECT_EQ(rows[static_cast<std::size_t>(i)][1], std::to_string(i + 1));
  const std::string next = "\n| " + std::to_string(versions + 1) + " | ";
  EXPECT_EQ(table.substr(0, table.find("\nSource:")).find(next), std::string::npos) << "a row that no program has";
  static const std::regex told(R"re(`score_version`[^\n]{0,20}\b\d)re");
  for (const char* other : {"README.md", "docs/scoring.md", "docs/scenarios.md"})
    EXPECT_FALSE(std::regex_search(text_of(kTop / other), told)) << other << " tells the number once more";
}

TEST(Docs, TheFrontPageHasARowForEachFolder) {
  const std::string page = text_of(kTop / "README.md");
  const std::string rows = page.substr(page.find("\n## Folders"));
  for (const char* name : {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "app", "robots",
                           "examples", "tests", "bench", "fuzz", "cmake"}) {
    EXPECT_TRUE(fs::is_directory(kTop / name)) << name;
    EXPECT_TRUE(std::regex_search(rows, std::regex("\n\\|[^|]*`" + std::string(name) + "`[^|]*\\|"))) << name;
  }
}

/// Files of the program that hold a word, also as a part of another one.
std::set<std::string> files_with(const std::string& word) {
  std::set<std::string> files;
  for (const char* room : {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kTop / room))
      if (entry.is_regular_file() && text_of(entry.path()).find(word) != std::string::npos)
        files.insert(fs::relative(entry.path(), kTop).generic_string());
  return files;
}

TEST(Docs, AKindIsKnownToItsRowAlone) {
  for (const char* table : {"slam/mappers.cpp", "explore/explorers.cpp"}) {
    const std::string rows = text_of(kTop / table);
    static const std::regex row(R"re(row<\w+, (\w+)>\(\s*"(\w+)")re");
    const std::vector<std::smatch> kinds = all_matches(rows, row);
    EXPECT_FALSE(kinds.empty()) << table;
    for (const std::smatch& kind : kinds) {
      const std::string wing = fs::path(table).parent_path().generic_string() + "/" + kind[2].str() + "/";
      EXPECT_TRUE(fs::is_directory(kTop / wing)) << wing;
      for (const std::string& file : files_with(kind[1]))
        EXPECT_TRUE(file == table || file.rfind(wing, 0) == 0) << file << " knows " << kind[1];
    }
  }
}

}  // namespace
}  // namespace rubble
