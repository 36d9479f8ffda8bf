#include "scenarios/config/notes.h"

#include <gmock/gmock.h>

#include "base/error.h"
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
  std::vector<std::string> of_settings(const std::vector<Override>& overrides) const {
    return setting_notes(scenario("arena: {generate: {columns: 3, rows: 3}}\n", overrides));
  }
  std::string refusal(const std::vector<Override>& overrides) const {
    try {
      of_settings(overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  }
};

TEST_F(Notes, ARobotThatClimbsNothingIsShutInWhereAnotherIsNot) {
  write("sill.yaml", "ramp_deg: 4\nmaze: |\n  +---+---+---+\n  |S1  .   .  |\n  +---+---+---+\n");
  const std::string text = "arena: {file: sill.yaml}\n";
  EXPECT_THAT(arena_notes(scenario(text)), IsEmpty()) << "a sill of 84 mm";
  EXPECT_THAT(arena_notes(scenario(text, {{"robot.climbable_step_m", "0.05"}})),
              ElementsAre(AllOf(HasSubstr("sill.yaml: from the start "), HasSubstr("move the start"))));
}

TEST_F(Notes, VictimsWithoutASenseForThemAreNamed) {
  write("faint.yaml",
        "maze: |\n  +---+---+---+---+\n  |S.  A.  B.  C. |\n  +---+---+---+---+\n"
        "victims:\n  - {name: anna, cell: A, wall: north, cues: [sound]}\n"
        "  - {name: bert, cell: B, wall: north, cues: [co2]}\n"
        "  - {name: carl, cell: C, wall: north, cues: [heat, sound]}\n");
  const std::string text = "arena: {file: faint.yaml}\n";
  EXPECT_THAT(arena_notes(scenario(text)), IsEmpty());
  EXPECT_THAT(arena_notes(scenario(text, {{"sim.microphones", "false"}})),
              ElementsAre(AllOf(HasSubstr("cannot find anna, to be heard only"), HasSubstr("sim.microphones=true"))));
  EXPECT_THAT(arena_notes(scenario(text, {{"sim.microphones", "false"}, {"sim.co2_probe", "false"}})),
              ElementsAre(HasSubstr("cannot find anna, bert, to be heard or smelt only")));
  EXPECT_THAT(
      arena_notes(scenario("arena: {generate: {victims: 3, sound_alone: 1}}\n", {{"sim.microphones", "false"}})),
      ElementsAre(HasSubstr("to be heard only")))
      << "nor those of a generated arena";
}

TEST_F(Notes, SpeedsThatTheRobotHasNotAreTold) {
  EXPECT_THAT(of_settings({}), IsEmpty());
  EXPECT_THAT(of_settings({{"robot.max_v", "0.2"}}), IsEmpty()) << "a careful drive with the usual speeds";
  EXPECT_THAT(of_settings({{"explorer.cruise_speed", "0.7"}}), IsEmpty());
  EXPECT_THAT(of_settings({{"explorer.cruise_speed", "1.5"}, {"explorer.turn_speed_deg", "200"}}),
              ElementsAre(AllOf(HasSubstr("explorer.cruise_speed=1.5:"), HasSubstr("no faster than robot.max_v=0.7")),
                          AllOf(HasSubstr("explorer.turn_speed_deg=200:"), HasSubstr("robot.max_w_deg=100"))));
}

TEST_F(Notes, ASearchBySensesThatAreNotFittedIsTold) {
  const Override everywhere{"explorer.victims.other_senses", "everywhere"}, deaf{"sim.microphones", "false"};
  EXPECT_THAT(of_settings({everywhere}), IsEmpty());
  EXPECT_THAT(of_settings({everywhere, deaf}), IsEmpty()) << "it smells";
  EXPECT_THAT(of_settings({everywhere, deaf, {"sim.co2_probe", "false"}}),
              ElementsAre(HasSubstr("neither microphones nor a CO2 probe")));
}

TEST_F(Notes, AFloorOfDMinAboveItIsAMistake) {
  EXPECT_THAT(refusal({{"explorer.d_min_floor_m", "0.5"}}),
              HasSubstr("d_min_floor_m, 0.5, must not be larger than d_min_m, 0.4"));
  EXPECT_EQ(refusal({{"explorer.d_min_floor_m", "0.4"}}), "taken");
  EXPECT_EQ(refusal({{"explorer.d_min_m", "0.2"}}), "taken") << "the floor is the default";
}

TEST_F(Notes, ABatteryThatIsEmptyAtOnceIsAMistake) {
  EXPECT_THAT(refusal({{"sim.battery_wh", "0.001"}}),
              AllOf(HasSubstr("sim.battery_wh"), HasSubstr("0.001 Wh last 0.1 s")));
  EXPECT_EQ(refusal({{"sim.battery_wh", "0"}}), "taken") << "no end of it";
  EXPECT_EQ(refusal({{"sim.battery_wh", "2"}}), "taken");
}

}  // namespace
}  // namespace rubble::scenarios
