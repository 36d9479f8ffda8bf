#include "base/text/new_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/text/text_file.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

class NewFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("rubble_new_file_" + std::to_string(getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::set<std::string> names() const {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.insert(entry.path().filename().string());
    return out;
  }
  fs::path folder_;
};

/// As a signal that ends the program on the spot does it.
TEST_F(NewFiles, AnEndOnTheSpotLeavesWholeFilesAlone) {
  write_text_file(at("older"), "older");
  for (int i = 0; i < 100; ++i) write_text_file(at("kept"), std::to_string(i));
  NewFile unfinished(at("older"));
  unfinished.put("half of");
  NewFile fresh(at("fresh"));
  ASSERT_EQ(names().size(), 4U);
  remove_unfinished_files();
  EXPECT_EQ(names(), (std::set<std::string>{"kept", "older"}));
  EXPECT_EQ(read_text_file(at("older")), "older");
  EXPECT_EQ(read_text_file(at("kept")), "99");
}

TEST_F(NewFiles, AChildThatEndsLeavesItsParentsFilesAlone) {
  NewFile parents(at("of parent"));
  parents.put("whole");
  const pid_t child = fork();
  if (child == 0) {
    remove_unfinished_files();
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  parents.keep();
  EXPECT_EQ(names(), std::set<std::string>{"of parent"});
}

/// More than are noted at once: all are written, and given back.
TEST_F(NewFiles, ManyAtOnceAreWrittenAllTheSame) {
  {
    std::vector<std::unique_ptr<NewFile>> files;
    for (int i = 0; i < 40; ++i) files.push_back(std::make_unique<NewFile>(at("file" + std::to_string(i))));
    for (std::size_t i = 0; i < files.size(); i += 2) files[i]->keep();
  }
  EXPECT_EQ(names().size(), 20U);
  NewFile last(at("last"));
  remove_unfinished_files();
  EXPECT_EQ(names().size(), 20U);
}

}  // namespace
}  // namespace rubble
