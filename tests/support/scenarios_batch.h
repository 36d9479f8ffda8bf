#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "scenarios/batch/results.h"
#include "scoring/scorecard.h"

namespace rubble::scenarios {

/// A test with an empty folder of its own.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = (std::filesystem::temp_directory_path() /
               ("rubble-" + std::string(info->test_suite_name()) + "-" + info->name()))
                  .string();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::string folder_;
};

/// A finished run with a score of one number.
inline RunRecord record(const std::string& scenario, const std::string& configuration, std::uint64_t seed,
                        double score) {
  RunRecord r;
  r.run_id = scenario + "-" + configuration + "-" + std::to_string(seed);
  r.scenario = scenario;
  r.configuration = configuration;
  r.seed = seed;
  r.status = RunStatus::Ok;
  r.end = "explored";
  *r.score = {{"score", score}, {"score_version", scoring::kScoreVersion}};
  r.folder = "runs/" + r.run_id;
  r.code = "test";
  return r;
}

}  // namespace rubble::scenarios
