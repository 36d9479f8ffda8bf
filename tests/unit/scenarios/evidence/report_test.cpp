#include "scenarios/evidence/report.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "base/text/html.h"
#include "scenarios/evidence/svg_plot.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Report : public FolderTest {
 protected:
  /// Two configurations, ten seeds; one run failed, one map is there as a picture.
  ResultSet results() const {
    ResultSet set;
    set.folder = folder_;
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
      for (const char* configuration : {"ramps <on>", "off"}) {
        RunRecord r = record("yellow", configuration, seed, 0.5 + 0.01 * static_cast<double>(seed));
        r.run_id = (configuration[0] == 'o' ? "off-" : "on-") + std::to_string(seed);
        r.folder = "runs/" + r.run_id;
        r.score["ate_aligned_m"] = 0.1 / static_cast<double>(seed);
        set.runs.push_back(r);
        *set.timing[r.run_id] = {{"wall_s", 2.0}};
      }
    set.runs[3].status = RunStatus::TimedOut;
    set.runs[3].error = "killed after 60 s";
    set.runs[3].score->clear();
    std::filesystem::create_directories(path("runs/on-1"));
    cv::imwrite(path("runs/on-1/overlay.png"), cv::Mat(400, 800, CV_8UC3, cv::Scalar(0, 0, 255)));
    return set;
  }
};

TEST_F(Report, StandsOnItsOwn) {
  const ResultSet set = results();
  const std::string page = report_html(set, note_of(set, folder_), folder_);
  EXPECT_THAT(page, HasSubstr("ramps &lt;on&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<on>")));
  EXPECT_THAT(page, HasSubstr("killed after 60 s"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("href=\"runs/on-1/\""));
  for (const char* outside : {"http://", "https://", "<script", "<link", "src=\"runs"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  std::size_t plots = 0;
  for (std::size_t i = 0; (i = page.find("<svg", i)) != std::string::npos; ++i) ++plots;
  EXPECT_EQ(plots, 3u);
}

TEST_F(Report, VictimsThatNobodyCanSeeAreNamed) {
  ResultSet set = results();
  EXPECT_THAT(report_html(set, note_of(set, folder_), folder_), Not(HasSubstr("cannot be seen")));
  for (RunRecord& run : set.runs)
    if (run.ok()) (*run.score)["unseen_victims"] = {"true victim2", "true <b>"};
  EXPECT_THAT(report_html(set, note_of(set, folder_), folder_),
              HasSubstr("cannot be seen from floor the robot reaches: true victim2, true &lt;b&gt;"));
}

TEST_F(Report, LinksFollowThePage) {
  const ResultSet set = results();
  std::filesystem::create_directories(path("pages"));
  EXPECT_THAT(report_html(set, note_of(set, folder_), path("pages")), HasSubstr("href=\"../runs/on-1/\""));
}

TEST_F(Report, MarkdownMeasuresEachConfigurationAgainstItsReference) {
  Sweep sweep;
  sweep.name = "ramps";
  sweep.about = "What ramps cost.";
  sweep.configurations = {{"ramps <on>", "ramps <on>", {}}, {"off", "ramps <on>", {}}};
  save_note(sweep, {}, folder_);
  const ResultSet set = results();
  const std::string text = report_markdown(set, note_of(set, folder_));
  EXPECT_THAT(text, HasSubstr("## ramps\n\nWhat ramps cost.\n"));
  EXPECT_THAT(text, HasSubstr("| ramps <on> | 10 | 0 | 0.555 ["));
  EXPECT_THAT(text, HasSubstr("| off | 10 | 1 |"));
  EXPECT_THAT(text, HasSubstr("| off | ramps <on> | score | 9 | 0 | [0, 0] | 0 : 0 | 1 | identical |"));
  EXPECT_THAT(text, Not(HasSubstr("| ramps <on> | ramps <on> |")));
}

TEST_F(Report, NothingFinishedIsStillAPage) {
  ResultSet set = results();
  for (auto& run : set.runs) {
    run.status = RunStatus::Failed;
    run.score->clear();
  }
  EXPECT_THAT(report_html(set, note_of(set, folder_), folder_), HasSubstr("no numbers for score"));
}

TEST(Base64, MatchesTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\xfe", 2)), "//4=");
}

TEST(Plot, TicksAreRoundAndCoverTheRange) {
  EXPECT_THAT(ticks(0.0, 1.0, 5), ElementsAre(0.0, 0.2, 2 * 0.2, 3 * 0.2, 4 * 0.2, 1.0));
  for (const double high : {1e-6, 0.3, 7.0, 12345.0}) {
    const auto marks = ticks(-0.1 * high, high, 6);
    EXPECT_LE(marks.front(), -0.1 * high * (1.0 - 1e-6));
    EXPECT_GE(marks.back(), high * (1.0 - 1e-6));
    EXPECT_LE(marks.size(), 10u);
  }
  EXPECT_GE(ticks(0.5, 0.5, 5).size(), 2u) << "a single number still has an axis";
}

TEST(Plot, EveryNumberIsADot) {
  const std::string plot = strip_plot("score", {{"a", {0.1, 0.2, 0.3}}, {"b", {}}, {"c", {0.4}}});
  std::size_t dots = 0;
  for (std::size_t i = 0; (i = plot.find("<circle", i)) != std::string::npos; ++i) ++dots;
  EXPECT_EQ(dots, 4u);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace rubble::scenarios
