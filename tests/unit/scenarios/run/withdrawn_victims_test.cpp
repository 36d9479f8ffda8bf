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

TEST(WithdrawnVictims, ThoseThatAreGoneCountOnceThoseThatMovedDoNot) {
  WithdrawnVictims withdrawn;
  withdrawn.note({});
  withdrawn.note({victim_at(1, 0.0), victim_at(2, 1.0)});
  withdrawn.note({victim_at(1, 0.4), victim_at(2, 1.0), victim_at(3, 2.0)});
  EXPECT_EQ(withdrawn.count(), 0);
  withdrawn.note({victim_at(1, 0.4), victim_at(3, 2.0)});
  EXPECT_EQ(withdrawn.count(), 1);
  withdrawn.note({victim_at(4, 1.0)});
  withdrawn.note({victim_at(4, 1.0)});
  EXPECT_EQ(withdrawn.count(), 3);
}

}  // namespace
}  // namespace rubble::scenarios
