#include "scoring/alignment/trust.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace rubble::scoring {
namespace {

/// Walls that meet loosely: `met` within 0.6 m, little of it within 0.3 m, on maps that know half of each other.
PoseEvidence loose(double met, double contradicted) {
  PoseEvidence e;
  for (WallEvidence* side : {&e.map, &e.truth}) {
    side->known = 0.6;
    side->met = met;
    side->chance = 0.05;
    side->contradicted = contradicted;
  }
  e.free_common = 0.5;
  e.common_area = 100.0;
  return e;
}

const PoseEvidence kWide = loose(0.5, 0.1);
const PoseEvidence kTight = loose(0.4, 0.2);

Rivals behind_by(double margin) {
  Rivals rivals;
  rivals.log_odds = log_odds(kWide, kTight) - margin;
  return rivals;
}

TEST(Trust, LooseWallsFarAheadOfAllRivalsAreTrustedAndTheNoteSaysWhy) {
  ASSERT_LT(tight_agreement(kTight), kTightEnough);
  ASSERT_GT(log_odds(kWide, kTight), 0.0);
  const Trust trust = judge(kWide, kTight, behind_by(2.0));
  EXPECT_TRUE(trust.trusted);
  EXPECT_FALSE(trust.tight);
  EXPECT_FALSE(trust.open) << "what is trusted needs no other witness";
  EXPECT_NE(trust.note.find("loosely"), std::string::npos) << trust.note;
}

TEST(Trust, OfLooseWallsNarrowlyAheadAnotherWitnessMayDecide) {
  const Trust trust = judge(kWide, kTight, behind_by(0.2));
  EXPECT_FALSE(trust.trusted);
  EXPECT_TRUE(trust.open);
  EXPECT_EQ(trust.note.find("not aligned: "), 0u) << trust.note;
}

TEST(Trust, NoWitnessIsAskedWhereARivalIsAhead) {
  for (const double behind : {0.0, 0.5}) {
    const Trust trust = judge(kWide, kTight, behind_by(-behind));
    EXPECT_FALSE(trust.trusted);
    EXPECT_FALSE(trust.open) << behind;
  }
}

TEST(Trust, NoWitnessIsAskedWhereTheWallsAreRatherAgainstThePose) {
  // Of these the log odds fall below 0 by contradiction alone; the margin stays narrow.
  int for_it = 0, against_it = 0;
  for (double contradicted = 0.0; contradicted < 0.4; contradicted += 0.02) {
    const PoseEvidence wide = loose(0.5, contradicted);
    const double odds = log_odds(wide, kTight);
    Rivals rivals;
    rivals.log_odds = odds - 0.2;
    const Trust trust = judge(wide, kTight, rivals);
    EXPECT_EQ(trust.open, !trust.trusted && odds > 0.0) << contradicted;
    EXPECT_FALSE(trust.trusted && odds < 1.2) << contradicted << ": 2 x 0.2 are too little beside such odds";
    if (trust.trusted) continue;
    ++(odds > 0.0 ? for_it : against_it);
  }
  EXPECT_GT(for_it, 0) << "the law was never tried with walls for the pose";
  EXPECT_GT(against_it, 0) << "nor with walls against it";
}

TEST(Trust, WallsThatMeetToTheDecimetreAtTwoPlacesAreRefusedButOtherWitnessesMayDecide) {
  const PoseEvidence tight = loose(0.9, 0.0);
  ASSERT_GE(tight_agreement(tight), kTightEnough);
  Rivals near;
  near.tight = 0.99 * tight_agreement(tight);
  const Trust trust = judge(tight, tight, near);
  EXPECT_TRUE(trust.tight);
  EXPECT_FALSE(trust.trusted);
  EXPECT_TRUE(trust.open);
  EXPECT_TRUE(judge(tight, tight, Rivals{}).trusted);
}

TEST(Trust, OfAFragmentThatFitsAtTwoPlacesWitnessesAreAskedOnlyIfItIsLargeAndFitsWell) {
  const auto fragment = [](double met, double area) {
    PoseEvidence tight = loose(met, 0.0);
    tight.map.known = 1.0;
    tight.truth.known = 0.2;
    tight.common_area = area;
    Rivals near;
    near.tight = 0.99 * tight_agreement(tight);
    return judge(tight, tight, near);
  };
  EXPECT_FALSE(fragment(0.95, 18.0).trusted);
  EXPECT_TRUE(fragment(0.95, 18.0).fragment);
  EXPECT_TRUE(fragment(0.95, 18.0).open);
  EXPECT_FALSE(fragment(0.95, 14.0).open);
  EXPECT_FALSE(fragment(0.85, 18.0).open);
}

TEST(Trust, ARefusalForRivalsSaysWhichAndWhetherTheMapAgreesAtAll) {
  const auto says = [](const std::string& note, const char* words) { return note.find(words) != std::string::npos; };
  const NearRivals another{true, false}, mirrored{false, true}, both{true, true};
  for (const NearRivals& rivals : {another, mirrored, both}) {
    const std::string nowhere = why_rivalled(rivals, 0.05);
    const std::string well = why_rivalled(rivals, 0.8);
    const std::string unasked = why_rivalled(rivals, std::nullopt);
    for (const std::string& note : {nowhere, well, unasked}) EXPECT_EQ(note.find("not aligned: "), 0u) << note;
    EXPECT_TRUE(says(nowhere, "nowhere") && says(nowhere, "probably another arena")) << nowhere;
    EXPECT_FALSE(says(nowhere, "--start")) << nowhere;
    EXPECT_EQ(says(nowhere, "flip"), rivals.mirrored) << nowhere;
    EXPECT_TRUE(says(well, "agrees well") && says(well, "--start or --pose")) << well;
    EXPECT_FALSE(says(well, "another arena")) << well;
    EXPECT_EQ(says(well, "several poses"), rivals.another_pose) << well;
    EXPECT_EQ(says(well, "as well mirrored"), rivals.mirrored) << well;
    EXPECT_FALSE(says(unasked, "another arena") || says(unasked, "--start")) << unasked;
    EXPECT_EQ(says(unasked, "another pose"), rivals.another_pose) << unasked;
    EXPECT_EQ(says(unasked, "mirror"), rivals.mirrored) << unasked;
  }
}

TEST(Trust, OnlyWhereARivalAloneSpeaksAgainstThePoseItIsToBlame) {
  EXPECT_TRUE(judge(kWide, kTight, behind_by(0.2)).rivalled);
  EXPECT_FALSE(judge(kWide, kTight, behind_by(2.0)).rivalled);
  const PoseEvidence against = loose(0.5, 0.9);
  ASSERT_LT(log_odds(against, kTight), -1.2);
  const Trust trust = judge(against, kTight, Rivals{});
  EXPECT_FALSE(trust.rivalled);
  EXPECT_NE(trust.note.find("probably another arena"), std::string::npos) << trust.note;
}

TEST(Trust, ADuelIsWonByWallsThatAreManyAndClearlyMore) {
  EXPECT_TRUE(is_won({12.0, 2.0}));
  EXPECT_FALSE(is_won({12.0, 8.0})) << "furniture may do that";
  EXPECT_FALSE(is_won({1.2, 0.0})) << "two pieces of wall are soon on one side";
  EXPECT_FALSE(is_won({2.0, 12.0}));
  EXPECT_FALSE(is_won({0.0, 0.0})) << "a symmetric arena";
  for (const WallDuel& duel : {WallDuel{12.0, 2.0}, {12.5, 6.6}, {9.0, 4.0}}) {
    EXPECT_TRUE(is_won_sharply(duel)) << duel.ours << " : " << duel.theirs;
    EXPECT_FALSE(is_won_sharply({duel.theirs, duel.ours}));
  }
  EXPECT_FALSE(is_won_sharply({4.0, 2.6})) << "too few walls";
  EXPECT_FALSE(is_won_sharply({20.0, 13.0})) << "too even";
  EXPECT_FALSE(is_won_sharply({0.0, 0.0}));
}

}  // namespace
}  // namespace rubble::scoring
