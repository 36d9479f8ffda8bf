#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "arenas/files/arena_file.h"
#include "base/error.h"
#include "tests/support/source_dir.h"

namespace rubble::arenas {
namespace {

namespace fs = std::filesystem;

/// Where each file of tests/invalid/arenas is broken, and a piece of what must be said about it.
const std::map<std::string, std::string>& faults() {
  static const std::map<std::string, std::string> faults{
      {"ball_in_a_wall.yaml", ":6:5: paper ball at (2.40, 0.60) lies in a solid 'wall': move it"},
      {"double_key.yaml", ":2:1: key 'ramp_deg' is given twice"},
      {"even_rows.yaml", ":5:3: the drawing ends after a row of pallets: add the row"},
      {"friction_of_a_wall.yaml", ":6:33: no wheel stands on a 'small_wall': take the key out"},
      {"friction_of_nothing.yaml", ":6:51: 'friction' is '0'; give a number from 0.01 to 2"},
      {"half_a_wall.yaml", ":2:6: half a wall: draw '---' or three blanks"},
      {"include_at.yaml", ":6:30: give 'at: [columns, rows]' in whole pallets"},
      {"include_bad_point.yaml", "pieces/half_a_point.yaml:6:28: 'to_m' has 1 numbers; give a list of 2"},
      {"include_beyond.yaml", ":6:6: room.yaml reaches column 4 and row 1 of pallets, but the drawing of"},
      {"include_cycle.yaml", "pieces/cycle.yaml:6:6: the file includes itself: include_cycle.yaml -> cycle.yaml -> "},
      {"include_error_inside.yaml", "pieces/unknown_key.yaml:6:26: unknown key 'colour'; known here"},
      {"include_legend.yaml", "pieces/legend.yaml:2:6: no pallet of the drawing is marked 'Q': write that letter"},
      {"include_letter_unused.yaml", "pieces/letter_unused.yaml:3:5: nothing below refers to the letter 'A'"},
      {"include_missing.yaml", ":6:6: there is no arena file '"},
      {"include_no_start.yaml", ":1:1: where does the robot start? write S"},
      {"include_overlap.yaml", ":6:6: room.yaml draws pallet [1, 0], which include_overlap.yaml has already; move"},
      {"include_raf_size.yaml", "pieces/pallet.raf:1:1: 'cell_m' is 1.2 here but 2.0 at "},
      {"include_same_names.yaml", ":4:6: two victims are named 'anna'; give this piece a name"},
      {"include_settings.yaml", "pieces/steep.yaml:1:1: 'ramp_deg' is 15 here but 10 at "},
      {"include_turn.yaml", ":6:48: 'turn' is '45'; give one of 0, 90, 180, 270"},
      {"include_unknown_key.yaml", ":6:42: unknown key 'rotate'; known here: at, file, name, turn"},
      {"letter_unknown.yaml", ":6:6: no pallet of the drawing is marked 'Q': write that letter"},
      {"letter_unused.yaml", ":3:9: nothing below refers to the letter 'A': use it"},
      {"list_where_a_map_belongs.yaml", ":5:8: 'start' is a list; give a map"},
      {"no_start.yaml", ":1:1: where does the robot start? write S"},
      {"not_a_number.yaml", ":1:17: 'floor_friction' is 'slippery'; give a number"},
      {"number_out_of_range.yaml", ":1:11: 'ramp_deg' is '80'; give a number from 0 to 45"},
      {"object_off_the_floor.yaml", ":6:5: object 'bottle' at (5.00, 5.00) is off the floor: move it"},
      {"open_tag.raf", ":4:1: "},
      {"paper_crosses_itself.yaml", ":6:6: the outline crosses itself or has no area"},
      {"place_missing.yaml", ":6:5: where is it? give 'cell: A'"},
      {"post_missing.yaml", ":4:3: '-' where a post belongs: draw '+'"},
      {"slope_of_a_wall.yaml", ":6:33: a 'small_wall' has no slope: take the key out"},
      {"start_in_a_wall.yaml", ":5:1: start (0.05, 0.60) is 0.27 m from where the floor ends"},
      {"start_off_the_floor.yaml", ":5:1: start (7.00, 7.00) is off the floor: move it"},
      {"start_twice.yaml", ":5:9: the drawing marks the start with S already: remove"},
      {"tabs.yaml", ":6:1: a tab in the indentation; indent with spaces"},
      {"two_starts.yaml", ":3:9: a second S: the robot starts in one pallet"},
      {"unknown_cue.yaml", ":6:39: unknown cue 'smell': use appearance"},
      {"unknown_element.yaml", ":6:12: 'type' is 'trampoline'; give one of"},
      {"unknown_key.yaml", ":5:1: unknown key 'sloep'; known here"},
      {"unknown_object.yaml", ":6:12: 'type' is 'piano'; give one of bottle, radio"},
      {"unknown_part.raf", ": 1 parts built; UNKNOWN, left out: trampoline 1: remove these parts"},
      {"victim_without_name.yaml", ":6:5: missing key 'name'; add"},
      {"victims_of_one_name.yaml", ":7:6: two victims are named 'anna': rename one"},
      {"wall_of_no_length.yaml", ":6:22: the wall has no length: give two different points"},
      {"wrong_glyph.yaml", ":3:9: '?' is no glyph of a pallet: use"},
  };
  return faults;
}

TEST(InvalidArenas, EachGetsOneLineWithPlaceAndRemedy) {
  const std::string folder = std::string(RUBBLE_SOURCE_DIR) + "/tests/invalid/arenas/";
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) continue;  // pieces that others include
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    ++files;
    ASSERT_EQ(faults().count(name), 1u) << "say in this test what is wrong with the file";
    try {
      load_arena(folder + name);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      const std::string message = error.what();
      const std::string& fault = faults().at(name);  // with a file of its own, or in the one that was loaded
      EXPECT_EQ(message.find(fault[0] == ':' ? folder + name + fault : folder + fault), 0u) << message;
      EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
    }
  }
  EXPECT_EQ(files, faults().size());
}

}  // namespace
}  // namespace rubble::arenas
