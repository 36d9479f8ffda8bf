#include "robot/logs/foreign/file_bytes.h"

#include <bzlib.h>

#include "base/error.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using testing::message_of;
using testing::TempFolder;

std::string long_text() {
  std::string text;
  for (unsigned i = 0; i < 400000; ++i) text += std::to_string(i * i) + " ";
  return text;
}

std::string gzipped(const std::string& text, const TempFolder& folder) {
  write_gzip(folder.file("a.gz"), text);
  return testing::read_bytes(folder.file("a.gz"));
}

std::string bzipped(std::string text) {
  auto size = static_cast<unsigned>(text.size() + text.size() / 100 + 600);  // as bzlib's manual asks for
  std::string packed(size, '\0');
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), static_cast<unsigned>(text.size()), 9, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}

TEST(FileBytes, Bzip2ComesBackAlsoInSeveralMembers) {
  const std::string text = long_text();
  const std::string packed = bzipped(text);
  EXPECT_LT(packed.size(), text.size());
  EXPECT_EQ(unpacked(packed, "a.bz2"), text);
  EXPECT_EQ(unpacked(bzipped("one ") + bzipped("two"), "a.bz2"), "one two");
}

TEST(FileBytes, CutBzip2SaysWhereItEnds) {
  const std::string packed = bzipped(long_text().substr(0, 200000));
  for (std::size_t size = 4; size < packed.size(); size += packed.size() / 40) {
    const std::string message = message_of<InputError>([&] { unpacked(packed.substr(0, size), "a.bz2"); });
    EXPECT_EQ(message.find("a.bz2: the bzip2 data stop at byte " + std::to_string(size)), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(FileBytes, DamagedBzip2IsRefused) {
  std::string packed = bzipped(long_text().substr(0, 200000));
  packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 0x55);
  EXPECT_THROW(unpacked(packed, "a.bz2"), InputError);
  EXPECT_THROW(unpacked(bzipped("text") + "behind", "a.bz2"), InputError);
}

TEST(FileBytes, GzipComesBackAndIsDeterministic) {
  const TempFolder folder;
  const std::string text = long_text();
  const std::string packed = gzipped(text, folder);
  EXPECT_LT(packed.size(), text.size());
  EXPECT_EQ(unpacked(packed, "a.gz"), text);
  EXPECT_EQ(gzipped(text, folder), packed);
  EXPECT_EQ(unpacked("plain", "a"), "plain");
}

TEST(FileBytes, GzipInPiecesIsTheSameFile) {
  const TempFolder folder;
  const std::string text = long_text().substr(0, 2'000'000);
  for (const std::size_t piece : {1u, 777u, 1500000u}) {
    GzipFile file(folder.file("b.gz"));
    const std::size_t most = piece == 1 ? 5000 : text.size();
    for (std::size_t at = 0; at < most; at += piece) file.put(std::string_view(text).substr(at, piece));
    file.keep();
    EXPECT_EQ(testing::read_bytes(folder.file("b.gz")), gzipped(text.substr(0, most), folder)) << piece;
  }
}

TEST(FileBytes, WhatIsNotKeptLeavesTheOlderFileAndNothingBeside) {
  const TempFolder folder;
  testing::write_bytes(folder.file("a.gz"), "older");
  GzipFile(folder.file("a.gz")).put(long_text().substr(0, 1'000'000));
  EXPECT_EQ(testing::read_bytes(folder.file("a.gz")), "older");
  const std::filesystem::directory_iterator files(folder.file("."));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(FileBytes, SeveralMembersAndPaddingAreRead) {
  const TempFolder folder;
  const std::string packed = gzipped("one ", folder) + gzipped("two", folder) + std::string(512, '\0');
  EXPECT_EQ(unpacked(packed, "a.gz"), "one two");
}

TEST(FileBytes, CutGzipSaysWhereItEnds) {
  const TempFolder folder;
  const std::string packed = gzipped(long_text(), folder);
  Rng rng(2, "cuts");
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t size = 2 + rng.below(static_cast<std::uint32_t>(packed.size()) - 2);
    const std::string message = message_of<InputError>([&] { unpacked(packed.substr(0, size), "a.gz"); });
    EXPECT_NE(message.find("a.gz: the gzip data stop at byte " + std::to_string(size)), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(FileBytes, DamagedGzipIsRefused) {
  const TempFolder folder;
  std::string packed = gzipped(long_text(), folder);
  packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 0x55);
  EXPECT_THROW(unpacked(packed, "a.gz"), InputError);
  EXPECT_THROW(unpacked(gzipped("text", folder) + "behind", "a.gz"), InputError);
}

TEST(FileBytes, UnwritablePathIsReported) {
  EXPECT_NE(message_of<RunError>([] { write_gzip("/nowhere/a.gz", "x"); }).find("/nowhere/a.gz"), std::string::npos);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  EXPECT_THROW(write_gzip("/dev/full", long_text()), RunError);
}

TEST(FileBytes, GzipOfZerosIsRefusedBeforeItFillsTheMemory) {
  const TempFolder folder;
  const std::string bomb = gzipped(std::string(std::size_t{100} << 20, '\0'), folder);
  ASSERT_LT(bomb.size(), 200000u);
  const std::string message = message_of<InputError>([&] { unpacked(bomb, "a.gz"); });
  EXPECT_NE(message.find("unpack to more than"), std::string::npos) << message;
}

TEST(FileBytes, DevicesAreNoLogs) {
  const std::string message = message_of<InputError>([&] { read_file("/dev/zero"); });
  EXPECT_EQ(message, "/dev/zero: is a device; give the path of a log");
}

TEST(FileBytes, HugeFileIsRefusedByItsSize) {
  const TempFolder folder;
  testing::write_bytes(folder.file("a.log"), "x");
  std::filesystem::resize_file(folder.file("a.log"), kLargestLog + 1);  // sparse
  const std::string message = message_of<InputError>([&] { read_file(folder.file("a.log")); });
  EXPECT_NE(message.find("is over 2 GB"), std::string::npos) << message;
}

}  // namespace
}  // namespace rubble::robot
