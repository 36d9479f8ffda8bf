#include "robot/drivers/watch/answer_watch.h"

#include <gtest/gtest.h>

namespace rubble::robot {
namespace {

const Stamp kStart = Stamp::from_seconds(100.0);

TEST(AnswerWatch, OnceLateTheyMustBeInTimeForAWhile) {
  AnswerWatch watch(0.3);
  Stamp now = kStart;
  EXPECT_TRUE(watch.look({0.29, false}, now));
  EXPECT_FALSE(watch.look({0.31, false}, now));
  EXPECT_EQ(watch.trouble({0.31, false}),
            "answers 0.3 s late (at most 0.3 s); the line to it or this computer is too slow");
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(watch.look({0.0, false}, now = now + 0.1));
  EXPECT_FALSE(watch.look({0.5, false}, now = now + 0.05)) << "all over again";
  EXPECT_FALSE(watch.look({0.0, false}, now + 0.95));
  EXPECT_TRUE(watch.look({0.0, false}, now + 1.05));
}

TEST(AnswerWatch, MissingOnesAreSaidToBeMissingAlsoWhenTheyAreBack) {
  AnswerWatch watch(0.3);
  EXPECT_FALSE(watch.look({2.0, true}, kStart));
  EXPECT_EQ(watch.trouble({2.0, true}),
            "reports, but has not answered for 2.0 s; it does not hear, or the line to it is too slow");
  EXPECT_FALSE(watch.look({0.01, false}, kStart + 0.5));
  EXPECT_EQ(watch.trouble({0.01, false}),
            "had not answered for 2.0 s; it does not hear, or the line to it is too slow");
}

}  // namespace
}  // namespace rubble::robot
