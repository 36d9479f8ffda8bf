#include "base/text/json_size.h"

#include <gtest/gtest.h>

#include <string>

namespace rubble {
namespace {

std::string repeated(const std::string& piece, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += piece;
  return text;
}

TEST(JsonSize, WhatProgramsWriteIsModest) {
  EXPECT_TRUE(is_modest_json(""));
  EXPECT_TRUE(is_modest_json(R"({"a": {"b": [1, 2, {"c": null}]}})"));
  EXPECT_TRUE(is_modest_json(repeated("[", 64) + repeated("]", 64)));
  EXPECT_TRUE(is_modest_json("{" + repeated("\"k\":0,", 1000) + "}"));
  EXPECT_TRUE(is_modest_json("[" + repeated("{\"k\":0},", 5000) + "{}]")) << "the keys of an object end with it";
  EXPECT_TRUE(is_modest_json("\"" + repeated("[{:,", 5000) + R"(\"[[[")")) << "brackets in a text are text";
}

TEST(JsonSize, WhatNoProgramWritesIsNot) {
  EXPECT_FALSE(is_modest_json(repeated("[", 65)));
  EXPECT_FALSE(is_modest_json(repeated("{\"a\":", 65)));
  EXPECT_FALSE(is_modest_json("{" + repeated("\"k\":0,", 1001) + "}"));
  EXPECT_FALSE(is_modest_json("{\"in\": {}, " + repeated("\"k\":0,", 1001) + "}"));
  EXPECT_FALSE(is_modest_json(R"(["\\",)" + repeated("[", 65))) << "a backslash that was escaped ends nothing";
  EXPECT_FALSE(is_modest_json("[" + repeated("0,", 10000001) + "0]"));
  EXPECT_FALSE(is_modest_json(repeated("[]", 10000001))) << "also where it is no JSON";
}

}  // namespace
}  // namespace rubble
