#include "scenarios/config/notes.h"

#include <gmock/gmock.h>

#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Notes : public FolderTest {
 protected:
  Scenario scenario(const std::string& text, const std::vector<Override>& overrides = {}) const {
    return load_scenario(write("s.yaml", text), overrides);
  }
};

TEST_F(Notes, ARobotThatClimbsNothingIsShutInWhereAnotherIsNot) {
  write("sill.yaml", "ramp_deg: 4\nmaze: |\n  +---+---+---+\n  |S1  .   .  |\n  +---+---+---+\n");
  const std::string text = "arena: {file: sill.yaml}\n";
  EXPECT_THAT(arena_notes(scenario(text)), IsEmpty()) << "a sill of 84 mm";
  EXPECT_THAT(arena_notes(scenario(text, {{"robot.climbable_step_m", "0.05"}})),
              ElementsAre(AllOf(HasSubstr("sill.yaml: from the start "), HasSubstr("move the start"))));
}

}  // namespace
}  // namespace rubble::scenarios
