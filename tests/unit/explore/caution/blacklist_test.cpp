#include "explore/caution/blacklist.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

/// Seen from the origin.
AnchoredPoint place(double x, double y) { return {Anchor{Stamp::from_seconds(1.0), {}}, {x, y}}; }

TEST(Blacklist, BarsADiscUntilItExpires) {
  Blacklist list;
  list.bar(place(1.0, 1.0), 0.5, Stamp::from_seconds(10.0));
  EXPECT_TRUE(list.barred({1.3, 1.3}, Stamp::from_seconds(5.0)));
  EXPECT_FALSE(list.barred({1.5, 1.5}, Stamp::from_seconds(5.0)));
  EXPECT_FALSE(list.barred({1.3, 1.3}, Stamp::from_seconds(10.0)));
  EXPECT_EQ(list.times_barred({1.0, 1.2}), 1) << "it remembers what has expired";
}

TEST(Blacklist, PardonsWhatWouldExpireAndNothingElse) {
  Blacklist list;
  const Stamp now = Stamp::from_seconds(5.0);
  EXPECT_FALSE(list.pardon(now));
  list.bar(place(1.0, 1.0), 0.5, Stamp::from_seconds(10.0));
  list.bar_for_good(place(5.0, 5.0), 0.5);
  EXPECT_TRUE(list.pardon(now));
  EXPECT_FALSE(list.barred({1.0, 1.0}, now));
  EXPECT_TRUE(list.barred({5.0, 5.0}, now));
  EXPECT_FALSE(list.pardon(now)) << "nothing is left to pardon";
}

TEST(Blacklist, PardonOfAllEndsBarsForGoodAsWell) {
  const Stamp now = Stamp::from_seconds(10.0);
  Blacklist list;
  list.bar_for_good(place(1.0, 0.0), 0.5);
  EXPECT_FALSE(list.pardon(now));
  EXPECT_TRUE(list.barred({1.0, 0.0}, now));
  EXPECT_TRUE(list.pardon_all(now));
  EXPECT_FALSE(list.barred({1.0, 0.0}, now));
  EXPECT_FALSE(list.pardon_all(now)) << "nothing is left to pardon";
}

/// A place that was visited in vain, pardoned, and visited in vain again.
TEST(Blacklist, WhatWasBarredForGoodTwiceStaysSo) {
  const Stamp now = Stamp::from_seconds(10.0);
  Blacklist list;
  for (const bool twice : {false, true}) {
    list.bar_for_good(place(1.0, twice ? 0.3 : 0.0), 0.5);
    list.bar_for_good(place(twice ? 7.0 : 5.0, 0.0), 0.5);
    EXPECT_TRUE(list.barred_for_good({1.0, 0.1}));
    EXPECT_TRUE(list.pardon_all(now)) << "the other one";
    EXPECT_EQ(list.barred({1.0, 0.1}, now), twice);
    EXPECT_FALSE(list.barred({5.0, 0.0}, now));
  }
}

}  // namespace
}  // namespace rubble::explore
