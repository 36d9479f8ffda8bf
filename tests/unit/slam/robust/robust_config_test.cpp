#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "slam/robust/robust_mapper.h"

namespace rubble::slam {
namespace {

RobustConfig config_of(const std::string& yaml) {
  RobustConfig config;
  const YamlMap map = YamlMap::parse(yaml, "lab.yaml");
  YamlReader reader(map);
  bind(reader, config);
  map.finish();
  return config;
}

std::string refused(const std::string& yaml) {
  try {
    config_of(yaml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Surfels of a tenth of a millimetre fill the memory.
TEST(RobustConfig, CellsOfSurfelsAreChosenByReachOrHaveASize) {
  EXPECT_EQ(config_of("matching: {cell_m: 0}").tracker.cell, 0.0);
  EXPECT_EQ(config_of("matching: {cell_m: 0.02}").tracker.cell, 0.02);
  EXPECT_EQ(config_of("matching: {cell_m: 1}").tracker.cell, 1.0);
  for (const char* cell : {"0.0001", "1e-9", "0.0199", "-0.1", "1.1", "-1e-9"}) {
    const std::string error = refused("matching: {cell_m: " + std::string(cell) + "}");
    EXPECT_EQ(error.rfind("lab.yaml:1:", 0), 0u) << cell << ": " << error;
    EXPECT_NE(error.find("'cell_m'"), std::string::npos) << cell << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(RobustConfig, WhatIsWrittenIsReadBack) {
  for (const double cell : {0.0, 0.02, 0.15}) {
    RobustConfig config;
    config.tracker.cell = cell;
    YamlWriter writer;
    bind(writer, config);
    EXPECT_EQ(config_of(writer.yaml()).tracker.cell, cell) << writer.yaml();
  }
}

}  // namespace
}  // namespace rubble::slam
