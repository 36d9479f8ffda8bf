#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/digest.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "tests/support/base_files.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

TEST(TextFile, ReadsBackEveryByte) {
  const test::TempFolder folder;
  std::string bytes;
  for (int i = 0; i < 200000; ++i) bytes += static_cast<char>(i * 7);
  write_text_file(folder / "a", bytes);
  EXPECT_EQ(read_text_file(folder / "a"), bytes);
  write_text_file(folder / "a", "");
  EXPECT_EQ(read_text_file(folder / "a"), "");
}

TEST(TextFile, LeavesNothingElseInTheFolder) {
  const test::TempFolder folder;
  write_text_file(folder / "a", "x");
  write_text_file(folder / "a", "y");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
  fs::create_directory(folder / "b");
  EXPECT_THROW(write_text_file(folder / "b", "x"), RunError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(TextFile, ALinkStaysALink) {
  const test::TempFolder folder;
  write_text_file(folder / "a", "old");
  fs::create_symlink("a", folder / "link");
  write_text_file(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text_file(folder / "a"), "new");
}

TEST(TextFile, ADeviceIsWrittenToAndStays) {
  EXPECT_NO_THROW(write_text_file("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (fs::exists("/dev/full")) {
    EXPECT_THROW(write_text_file("/dev/full", "x"), RunError);
  }
}

TEST(TextFile, ErrorsNameThePath) {
  const test::TempFolder folder;
  const auto message = [](auto act) -> std::string {
    try {
      act();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([&] { read_text_file(folder / "x"); }),
            (folder / "x") + ": cannot be opened (No such file or directory); check the path");
  EXPECT_EQ(message([&] { read_text_file(folder.path()); }), folder.path() + ": is a folder; give the path of a file");
  EXPECT_EQ(message([&] { write_text_file(folder / "x/y", ""); }),
            (folder / "x/y") + ": cannot be written (No such file or directory); check the folder and the free space");
}

// FIPS 180-2, appendix B, and the digest of nothing.
TEST(Digest, TheSumIsThatOfZlibAndPng) {
  EXPECT_EQ(crc32_of(""), 0u);
  EXPECT_EQ(crc32_of("123456789"), 0xcbf43926u);  // the check value of this CRC-32
}

TEST(Digest, Sha256GivesThePublishedVectors) {
  EXPECT_EQ(sha256_of_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of_text(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Digest, AFileHasTheDigestOfItsBytes) {
  const test::TempFolder folder;
  for (const std::size_t size : {0u, 1u, 65535u, 65536u, 65537u, 200000u}) {
    const std::string bytes(size, 'q');
    write_text_file(folder / "a", bytes);
    EXPECT_EQ(sha256_of_file(folder / "a"), sha256_of_text(bytes)) << size;
  }
  EXPECT_THROW(sha256_of_file(folder / "absent"), InputError);
  EXPECT_THROW(sha256_of_file(folder.path()), InputError);
}

}  // namespace
}  // namespace rubble
