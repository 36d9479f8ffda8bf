#include "scoring/figures/figures.h"

#include <gmock/gmock.h>

#include <set>

namespace rubble::scoring {
namespace {

const Figure& row(const std::string& key) {
  const Figure* figure = find_figure(key);
  if (figure == nullptr) throw std::runtime_error("no figure " + key);
  return *figure;
}

TEST(Figures, EveryKeyAndEveryLabelStandsOnce) {
  std::set<std::string> keys, labels;
  for (const Figure& figure : figures()) {
    EXPECT_TRUE(keys.insert(figure.key).second) << figure.key;
    EXPECT_TRUE(labels.insert(figure.label).second) << figure.label;
    EXPECT_EQ(find_figure(figure.key), &figure);
    EXPECT_TRUE(figure.get) << figure.key;
  }
  EXPECT_EQ(find_figure("beauty"), nullptr);
}

TEST(Figures, WhatPeopleAreShownHasAMeaning) {
  for (const Figure& figure : figures()) {
    const bool in_a_table = figure.is(kShown) || figure.is(kReport) || figure.is(kRanking);
    EXPECT_EQ(in_a_table && figure.meaning.empty(), false) << figure.key;
    EXPECT_LE(figure.meaning.size(), 100u) << figure.key << ": it stands behind a value, on one line";
    EXPECT_NE(figure.meaning, figure.label) << figure.key;
  }
  for (const char* key : {"victims_found", "victims_total", "victims_false", "victims_error_m"})
    EXPECT_FALSE(row(key).meaning.empty()) << key << ", which share a line of the terminal";
  Evidence trajectories;  // what is known of them alone is shown whole
  trajectories.error = TrajectoryError{2, 0.1, 0.1};
  trajectories.pieces = PieceErrors();
  trajectories.relations = RelationError();
  trajectories.relations->relations = 1;
  for (const Figure& figure : figures())
    EXPECT_FALSE(figure.meaning.empty() && !text_of(figure, figure.get(trajectories)).empty()) << figure.key;
}

TEST(Figures, KeysEndInTheirUnit) {
  for (const Figure& figure : figures()) {
    std::string unit = figure.unit;
    for (char& c : unit) c = static_cast<char>(std::tolower(c));
    if (unit.empty() || unit == "%") continue;
    const std::string end = "_" + unit;
    ASSERT_GT(figure.key.size() + 1, end.size()) << figure.key;
    EXPECT_TRUE(figure.key.compare(figure.key.size() - end.size(), end.size(), end) == 0 || figure.key == "align_rad")
        << figure.key << " in " << figure.unit;
  }
}

TEST(Figures, WordsAreNeverJudged) {
  for (const Figure& figure : figures())
    EXPECT_FALSE(figure.is(kText) && figure.better != Better::Neither) << figure.key;
}

TEST(Figures, NothingIsKnownOfNothing) {
  for (const Figure& figure : figures()) {
    const Value value = figure.get({});
    EXPECT_TRUE(std::holds_alternative<std::monostate>(value)) << figure.key;
    EXPECT_EQ(text_of(figure, value), "");
  }
}

TEST(Figures, EveryFigureHasACaseInWhichItIsKnown) {
  const OccupancyGrid map(GridFrame{20, 20, 0.05, 0.0, 0.0}), truth = map;
  const Trajectory path = {{Stamp{0}, {}}, {Stamp{1000000000}, {1.0, 0.0, 0.0}}};
  Evidence all;
  all.map = &map;
  all.truth = &truth;
  all.estimate = all.live_estimate = all.true_path = &path;
  all.score = MapScore();
  all.score->aligned = all.score->warped = all.score->broken.found = true;
  for (const EvidenceKind kind : {EvidenceKind::Surf, EvidenceKind::Corners, EvidenceKind::Rooms}) {
    all.score->by_features.kinds.emplace_back();
    all.score->by_features.kinds.back().kind = kind;
    all.score->by_features.kinds.back().usable = true;
  }
  all.map_read_as = all.truth_read_as = "GeoTIFF";
  all.error = all.live_error = TrajectoryError{2, 0.1, 0.1};
  all.victims = VictimFigures();
  all.victims->judged = true;
  all.victims->found = 1;
  all.run = RunFigures();
  all.mission = MissionFigures();
  all.machine = MachineFigures{1.0, 1.0};
  all.devices = DeviceFigures();
  all.pieces = PieceErrors();
  all.relations = RelationError();
  all.relations->relations = 1;
  for (const Figure& figure : figures()) {
    const Value value = figure.get(all);
    EXPECT_FALSE(std::holds_alternative<std::monostate>(value)) << figure.key;
    EXPECT_EQ(std::holds_alternative<std::string>(value), figure.is(kText)) << figure.key;
  }
}

TEST(Figures, OfRelationsThatCouldNotBeComparedThereIsNoError) {
  Evidence none;
  none.relations = RelationError();
  none.relations->missing = 3;
  for (const Figure& figure : figures())
    if (figure.key.rfind("relation_", 0) == 0) {
      EXPECT_TRUE(std::holds_alternative<std::monostate>(figure.get(none))) << figure.key;
    }
}

TEST(Figures, AMapThatWasNotPlacedShowsNothingOfTheTruth) {
  Evidence stranger;
  stranger.score = MapScore();
  for (const char* key : {"known", "phantom_m", "missing_m", "ignored_m"})
    EXPECT_EQ(row(key).get(stranger), Value()) << key;
  EXPECT_EQ(row("score").get(stranger), Value(0.0));
}

TEST(Figures, VictimErrorNeedsAVictimThatWasFound) {
  Evidence evidence;
  evidence.victims = VictimFigures();
  EXPECT_EQ(row("victims_found").get(evidence), Value()) << "nobody knows the true ones";
  evidence.victims->judged = true;
  EXPECT_EQ(row("victims_found").get(evidence), Value(std::uint64_t{0}));
  EXPECT_EQ(row("victims_error_m").get(evidence), Value());
  evidence.victims->found = 1;
  evidence.victims->error_m = 0.25;
  EXPECT_EQ(row("victims_error_m").get(evidence), Value(0.25));
}

TEST(Figures, PeopleReadUnitsAndPercent) {
  EXPECT_EQ(text_of(row("psi_m"), 0.0104), "0.010 m");
  EXPECT_EQ(plain_text_of(row("psi_m"), 0.0104), "0.010");
  EXPECT_EQ(heading(row("psi_m")), "psi [m]");
  EXPECT_EQ(text_of(row("known"), 0.8194), "81.9 %");
  EXPECT_EQ(plain_text_of(row("known"), 0.8194), "0.819");
  EXPECT_EQ(heading(row("known")), "arena known");
  EXPECT_EQ(text_of(row("aligned"), true), "yes");
  EXPECT_EQ(text_of(row("scans"), std::uint64_t{17}), "17");
}

}  // namespace
}  // namespace rubble::scoring
