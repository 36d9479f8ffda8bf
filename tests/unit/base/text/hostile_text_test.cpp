#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/text/csv.h"
#include "base/text/file_name.h"
#include "base/text/html.h"
#include "base/text/text_file.h"
#include "base/text/utf8.h"
#include "base/text/words.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

TEST(FileName, StaysInItsFolder) {
  for (const char* name : {"", "..", ".", "../../evil", "a/b", "a\\b", "-rf", ".hidden", "a b", "a\nb", "a\x1b[2J",
                           "a'b", "sixty-one-bytes-xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"})
    EXPECT_TRUE(file_name_trouble(name)) << name;
  for (const char* name : {"yellow", "red-2", "a.b", "k=v,w=x", "gr\xc3\xbcn", "_"})
    EXPECT_FALSE(file_name_trouble(name)) << name;
}

TEST(FileName, AnyTextBecomesOneThatIsAllowed) {
  for (const char* text : {"", "..", "a b/c", "-x", "\x1b]0;title\x07", "my log\n", "yellow"})
    EXPECT_FALSE(file_name_trouble(as_file_name(text))) << text;
  EXPECT_FALSE(file_name_trouble(as_file_name(std::string(500, 'x'))));
  EXPECT_EQ(as_file_name("yellow"), "yellow");
  EXPECT_EQ(as_file_name("my log"), "my_log");
}

TEST(Formula, NothingThatASpreadsheetRuns) {
  for (const char* text : {"=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "-cmd", "\t=1", "-", "-2+3+cmd|'calc'!A0",
                           "-1+HYPERLINK(\"x\")", "+1.2.3", "-.", "-1e", "-e5", "-1e5+A1", "-1e-", "+1E2E3"})
    EXPECT_EQ(not_a_formula(text), std::string("'") + text);
  for (const char* text : {"-5", "+3.5", "team", "-.5", "", "a=b", "-5.049117803694082e-05", "+2E7", "-1e+3"})
    EXPECT_EQ(not_a_formula(text), text);
}

TEST(OneLine, NoByteThatATerminalObeys) {
  EXPECT_EQ(one_line("a\x1b[2J\n\xc2\x9b\x9b"
                     "2J\xff"),
            "a\\x1b[2J\\n\\xc2\\x9b\\x9b2J\\xff");
  EXPECT_EQ(one_line("gr\xc3\xbcn \xe2\x82\xac \xf0\x9f\xa4\x96"), "gr\xc3\xbcn \xe2\x82\xac \xf0\x9f\xa4\x96");
  EXPECT_EQ(printable("a\nb\x1b\n"), "a\nb\\x1b\n");
}

TEST(OneLine, NoCharacterThatHidesOrTurnsTheOthers) {
  EXPECT_EQ(one_line("a\xe2\x80\xaegnp.exe"), "a\\xe2\\x80\\xaegnp.exe") << "right-to-left override";
  for (const char* character : {"\xc2\xad", "\xd8\x9c", "\xe2\x80\x8b", "\xe2\x80\x8e", "\xe2\x80\xa8", "\xe2\x81\xa6",
                                "\xe2\x81\xa9", "\xef\xbb\xbf", "\xf3\xa0\x81\x81"})
    EXPECT_EQ(one_line(character).front(), '\\') << character;
  for (const char* character :
       {"\xc2\xac", "\xd8\xa7", "\xe2\x80\x93", "\xe2\x80\x8d", "\xe2\x82\xac", "\xf0\x9f\xa4\x96"})
    EXPECT_EQ(one_line(character), character);
}

TEST(Utf8, NamesThatAreNoTextBecomeText) {
  EXPECT_EQ(as_utf8("a\xff\xc3\xbc\xed\xa0\x80"), "a\xef\xbf\xbd\xc3\xbc\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(escape_html("<\xff\x1b>\n"), "&lt;\xef\xbf\xbd\xef\xbf\xbd&gt;\n");
  EXPECT_EQ(csv_field("a\x1b[2J\xff"), "\"a [2J\xef\xbf\xbd\"");
  for (int code = 1; code < 256; ++code)
    EXPECT_EQ(utf8_length(std::string(1, static_cast<char>(code)), 0), code < 0x80 ? 1u : 0u) << code;
}

class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "rubble_text_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

TEST(AtomicWriter, PlantedLinkIsNotFollowed) {
  const Folder folder;
  const std::string victim = folder.file("victim"), target = folder.file("score.json");
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, target + "." + std::to_string(getpid()) + ".part");
  write_text_file(target, "new");
  EXPECT_EQ(read_text_file(victim), "precious");
  EXPECT_EQ(read_text_file(target), "new");
  EXPECT_FALSE(fs::is_symlink(target));
}

TEST(AtomicWriter, OlderFileStaysWhenTheNewOneCannotBeWritten) {
  const Folder folder;
  const std::string target = folder.file("score.json");
  write_text_file(target, "old");
  rlimit whole{};
  getrlimit(RLIMIT_FSIZE, &whole);
  rlimit small = whole;
  small.rlim_cur = 1000;
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_text_file(target, std::string(5000, 'x')), RunError);
  setrlimit(RLIMIT_FSIZE, &whole);
  std::signal(SIGXFSZ, before);
  EXPECT_EQ(read_text_file(target), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.file("")), fs::directory_iterator()), 1) << "no part is left";
}

}  // namespace
}  // namespace rubble
