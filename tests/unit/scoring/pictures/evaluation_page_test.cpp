#include "scoring/pictures/evaluation_page.h"

#include <gmock/gmock.h>

#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(EvaluationPage, NamesCannotBreakThePage) {
  EvaluationStart start;
  start.map_name = "</script><b>\"x\\";
  const std::string page = evaluation_page(maze({}), maze({}), start);
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(page, Not(HasSubstr("@DATA@")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script\\u003e\\u003cb\\u003e\\u0022x\\u005c"));
}

}  // namespace
}  // namespace rubble::scoring
