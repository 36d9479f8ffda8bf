#include "scoring/league/league.h"
#include "base/text/csv.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scoring/league/league_page.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

LeagueEntry entry(const std::string& team, double score, double judge = 0.0) {
  LeagueEntry e;
  e.team = team;
  e.file = team + ".tif";
  e.score.score = score;
  e.judge = judge;
  return e;
}

TEST(League, RanksDependNeitherOnOrderNorOnNames) {
  std::vector<LeagueEntry> entries = {entry("a", 0.5),    entry("b", 0.7),       entry("c", 0.7002),
                                      entry("d", 0.2, 3), entry("e", 0.2, 3.01), entry("f", 0.1)};
  entries[5].error = "f.tif: cannot be read";
  std::vector<std::string> names = {"a", "b", "c", "d", "e", "f"};
  do {
    std::vector<LeagueEntry> shuffled;
    for (const std::string& name : names) shuffled.push_back(entries[static_cast<std::size_t>(name[0] - 'a')]);
    rank_league(shuffled);
    std::string order;
    std::string ranks;
    for (const LeagueEntry& e : shuffled) {
      order += e.team;
      ranks += std::to_string(e.rank);
    }
    ASSERT_EQ(order, "bcadef");  // score first, then points; equal figures by name; what cannot be read last
    ASSERT_EQ(ranks, "113440");
  } while (std::next_permutation(names.begin(), names.end()));
}

/// Precision and psi of a map that lies nowhere are no measurements.
TEST(League, ThePageShowsNoFigureOfAPlaceThatNobodyKnows) {
  LeagueEntry refused = entry("lost", 0.0);
  refused.score.psi_m = 5.0;
  const auto page = [&] { return league_page("truth.tif", false, {refused}, {{}}, ""); };
  EXPECT_EQ(page().find("5.000 m"), std::string::npos) << page();
  EXPECT_NE(page().find("<td class=\"n\"></td>"), std::string::npos);
  refused.score.aligned = true;
  EXPECT_NE(page().find("5.000 m"), std::string::npos) << page();
}

TEST(LeaguePoints, PerfectMapEarnsTwentyAVictim) {
  const OccupancyGrid truth = maze({});
  const std::vector<Poi> victims = {{"v1", {0.6, 0.6}}, {"v2", {5.4, 4.2}}};
  const LeaguePoints points = league_points(truth, truth, {}, victims, victims);
  EXPECT_NEAR(points.quality, 20.0, 0.05);  // walls cut by a window are not as thick as whole ones
  EXPECT_NEAR(points.location, 20.0, 1e-9);
  EXPECT_EQ(points.false_alarms, 0u);
}

TEST(LeaguePoints, LocationFallsInALineToOnePallet) {
  const OccupancyGrid truth = maze({});
  const std::vector<Poi> victims = {{"v", {3.0, 3.0}}};
  for (const double error : {0.0, 0.1, 0.65, 1.19, 1.3}) {
    const LeaguePoints points = league_points(truth, truth, {}, {{"r", {3.0 + error, 3.0}}}, victims);
    EXPECT_NEAR(points.location, 10.0 * std::clamp((1.2 - error) / 1.1, 0.0, 1.0), 1e-9) << error;
    EXPECT_EQ(points.victims[0].found, error < 1.2);
  }
}

/// Whoever reports victims everywhere finds them all and earns nothing; far outside the arena a report is as false.
TEST(LeaguePoints, FalseReportsCostHalfAVictimEachDownToNothing) {
  const OccupancyGrid truth = maze({});
  const std::vector<Poi> victims = {{"v1", {0.6, 0.6}}, {"v2", {5.4, 4.2}}};
  std::vector<Poi> reports = victims;
  const double honest = league_points(truth, truth, {}, reports, victims).points();
  EXPECT_NEAR(honest, 40.0, 0.1);
  reports.push_back({"far away", {500.0, -80.0}});
  const LeaguePoints once = league_points(truth, truth, {}, reports, victims);
  EXPECT_EQ(once.false_alarms, 1u);
  EXPECT_NEAR(once.points(), honest - 10.0, 1e-9);
  EXPECT_NEAR(once.unfined(), honest, 1e-9);
  std::vector<Poi> everywhere;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 42; ++x) everywhere.push_back({"r", {0.25 * x, 0.25 * y}});
  const LeaguePoints grid = league_points(truth, truth, {}, everywhere, victims);
  EXPECT_EQ(grid.points(), 0.0);
  EXPECT_GT(grid.unfined(), 30.0);
}

TEST(LeaguePoints, DriftCostsLocationButNotLocalQuality) {
  const OccupancyGrid truth = maze({});
  const OccupancyGrid drifted = moved(truth, 0.0, 0.3, 0.2);
  const std::vector<Poi> victims = {{"v", {4.2, 4.2}}};
  const LeaguePoints points = league_points(drifted, truth, {}, {{"r", {4.5, 4.4}}}, victims);
  EXPECT_GT(points.quality, 9.0);
  EXPECT_LT(points.location, 8.0);
  EXPECT_LT(league_points(with_salt(drifted, 0.2, 1), truth, {}, {{"r", {4.5, 4.4}}}, victims).quality,
            points.quality - 1.0);
}

TEST(LeaguePoints, WindowsBeyondTheMapEarnNothing) {
  const OccupancyGrid truth = maze({});
  EXPECT_EQ(local_quality(truth, truth, {}, {500.0, 500.0}), 0.0);
  EXPECT_EQ(local_quality(OccupancyGrid(truth.frame()), truth, {}, {3.0, 3.0}), 0.0);
}

TEST(Pois, FieldsOfCsvKeepCommasAndQuotes) {
  for (const std::string text : {"plain", "a,b", "say \"x\"", ""})
    EXPECT_EQ(csv_fields(csv_field(text) + ",next"), (std::vector<std::string>{text, "next"}));
}

}  // namespace
}  // namespace rubble::scoring
