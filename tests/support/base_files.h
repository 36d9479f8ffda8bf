#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace rubble::test {

/// A folder of its own for one test; gone afterwards.
class TempFolder {
 public:
  TempFolder() {
    std::string name = testing::TempDir() + "rubble-XXXXXX";
    path_ = mkdtemp(name.data()) == nullptr ? "" : name + "/";
    EXPECT_FALSE(path_.empty());
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return path_ + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

struct Finished {
  int code = -1;
  std::string output;  ///< stdout, and stderr when the command says so
};

/// Runs a shell command and waits for it.
inline Finished run(const std::string& command) {
  Finished finished;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return finished;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    finished.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return finished;
}

inline bool has_program(const std::string& name) { return run("command -v " + name + " 2>&1").code == 0; }

}  // namespace rubble::test
