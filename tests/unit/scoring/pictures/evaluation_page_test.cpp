#include "scoring/pictures/evaluation_page.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

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

/// A judge reads from the top.
void expect_in_order(const std::string& page, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = page.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << " is not there, or not behind what stands before it";
    at = found + part.size();
  }
}

TEST(EvaluationPage, TheScoreOfTheProgramStandsBeforeTheOverlapByHand) {
  EvaluationStart start;
  start.score = 0.9;
  const std::string hand = "id=\"figure-overlap\"";
  expect_in_order(evaluation_page(maze({}), maze({}), start),
                  {"<b>0.900</b> <span>score</span><small>at the pose that the program found", hand,
                   "The score of the pose by hand comes from the command line", "id=\"command\"", "id=\"figures\""});
  start.by = AlignBy::Hand;
  expect_in_order(evaluation_page(maze({}), maze({}), start),
                  {"<b>0.900</b> <span>score</span><small>at the pose that was given", hand});
}

TEST(EvaluationPage, OfARefusedMapTheReasonComesFirstThenScoreZeroThenTheScoreThere) {
  EvaluationStart start;
  start.score = 0.07;
  start.not_trusted = "agrees nowhere";
  const std::string page = evaluation_page(maze({}), maze({}), start);
  expect_in_order(page, {"id=\"warning\"", "<b>0.000</b> <span>score</span>", "<b>0.070</b> <span>score there</span>",
                         "id=\"figure-overlap\""});
  EXPECT_THAT(page, HasSubstr("\"warning\":\"agrees nowhere\""));
  start.by = AlignBy::Auto;
  EXPECT_THAT(evaluation_page(maze({}), maze({}), start), Not(HasSubstr("score there"))) << "there is no pose";
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
