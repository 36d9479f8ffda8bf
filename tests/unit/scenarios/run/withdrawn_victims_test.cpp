#include "scenarios/run/withdrawn_victims.h"

#include <gtest/gtest.h>

namespace rubble::scenarios {
namespace {

explore::VictimReport victim_at(int id, double x) {
  explore::VictimReport victim;
  victim.id = id;
  victim.p_map = {x, 0.0};
  return victim;
}

TEST(WithdrawnVictims, ThoseThatAreGoneCountThoseThatMovedOrHaveAnotherNumberDoNot) {
  WithdrawnVictims withdrawn;
  withdrawn.note({});
  withdrawn.note({victim_at(1, 0.0), victim_at(2, 5.0)});
  withdrawn.note({victim_at(1, 2.0), victim_at(2, 5.0), victim_at(3, 8.0)});
  EXPECT_EQ(withdrawn.count(), 0) << "moved";
  withdrawn.note({victim_at(1, 2.0), victim_at(3, 8.0)});
  EXPECT_EQ(withdrawn.count(), 1) << "gone";
  withdrawn.note({victim_at(1, 2.0), victim_at(4, 9.1)});
  EXPECT_EQ(withdrawn.count(), 1) << "another number";
  withdrawn.note({victim_at(1, 2.0), victim_at(5, 10.4)});
  withdrawn.note({victim_at(1, 2.0), victim_at(5, 10.4)});
  EXPECT_EQ(withdrawn.count(), 2) << "too far off";
  withdrawn.note({});
  EXPECT_EQ(withdrawn.count(), 4);
}

}  // namespace
}  // namespace rubble::scenarios
