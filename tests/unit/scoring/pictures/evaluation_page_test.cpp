#include "scoring/pictures/evaluation_page.h"

#include <gmock/gmock.h>

#include "base/text/html.h"
#include "scoring/pictures/picture.h"
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

/// Victims or not.
TEST(EvaluationPage, ThePictureAtStartShowsWhereTheMapCameApart) {
  const OccupancyGrid map = maze({});
  Marks marks;
  marks.seam = {{1.0, 1.0}, {3.0, 2.0}};
  EvaluationStart start;
  const std::string without = base64(overlay_png(map, map, {}));
  const std::string with = base64(overlay_png(map, map, {}, "", marks));
  EXPECT_THAT(evaluation_page(map, map, start), HasSubstr(without));
  start.seam = marks.seam;
  EXPECT_THAT(evaluation_page(map, map, start), HasSubstr(with));
}

}  // namespace
}  // namespace rubble::scoring
