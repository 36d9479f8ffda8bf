#include "arenas/truth/unseen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "base/angle.h"
#include "tests/support/sim_arena.h"

namespace rubble::arenas {
namespace {

struct Told {
  std::vector<Unseen> causes;
  double lacking = 0.0;  ///< share of the truth's cells that its visible part lacks

  explicit Told(const Arena& arena, const Viewer& viewer = {}) {
    const OccupancyGrid truth = truth_map(arena);
    const OccupancyGrid visible = visible_truth(arena, truth, viewer);
    causes = unseen_by_cause(arena, truth, visible, viewer);
    std::size_t known = 0, lost = 0;
    for (std::size_t i = 0; i < truth.frame().size(); ++i) {
      if (truth.data()[i] == Occupancy::Unknown) continue;
      ++known;
      lost += visible.data()[i] == Occupancy::Unknown ? 1 : 0;
    }
    lacking = static_cast<double>(lost) / static_cast<double>(known);
  }
  double sum() const {
    double all = 0.0;
    for (const Unseen& cause : causes) all += cause.share;
    return all;
  }
  double of(const std::string& part) const {
    for (const Unseen& cause : causes)
      if (cause.why.find(part) != std::string::npos) return cause.share;
    return 0.0;
  }
};

/// 6 x 2 m, shut off at x = 2 by whatever is added.
Arena room() { return sim::test::room(-1.0, -1.0, 5.0, 1.0); }

TEST(Unseen, OfAnOpenRoomIsNothing) { EXPECT_TRUE(Told(room()).causes.empty()); }

TEST(Unseen, BehindAGapThatIsTooNarrowIsToldAsThat) {
  Arena arena = room();
  sim::test::add_wall(arena, 2.0, -1.0, 2.02, 0.8);
  const Told told(arena);
  EXPECT_GT(told.of("gaps of less than 0.50 m"), 0.2);
  EXPECT_NEAR(told.of("gaps"), told.lacking, 0.01);
}

TEST(Unseen, BehindABlockThatTheLaserPassesOverIsNothing) {
  Arena arena = room();
  sim::test::add_wall(arena, 2.0, -1.0, 2.02, 1.0, 0.2);
  EXPECT_NEAR(Told(arena).lacking, 0.0, 0.02);
}

/// A lane round a corner, which a block of 0.2 m shuts.
TEST(Unseen, BehindABlockRoundTheCornerIsToldAsThat) {
  Arena arena = parse_arena(
      "maze: |\n  +---+---+---+\n  |S.   .   . |\n  +---+---+   +\n  | .   .   . |\n  +---+---+---+\n", "drawn");
  EXPECT_TRUE(Told(arena).causes.empty());
  sim::test::add_wall(arena, 1.4, 1.2, 1.5, 2.4, 0.2);
  const Told told(arena);
  EXPECT_GT(told.of("steps and blocks of more than 0.10 m"), 0.1);
}

/// The floor rises by 30 deg at x = 2, on to a platform of 1.2 m.
TEST(Unseen, BehindARampThatIsTooSteepIsToldAsThat) {
  const double rise = std::tan(deg_to_rad(30.0)), foot = 2.0, top = foot + 1.2 / rise;
  Arena whole = sim::test::room(-1.0, -1.0, 7.0, 1.0);
  whole.floor = {{sim::test::rectangle(-1.0, -1.0, foot, 1.0), 0.0, 0.0, 0.0, "flat"},
                 {sim::test::rectangle(foot, -1.0, top, 1.0), 0.0, rise, 0.0, "ramp"},
                 {sim::test::rectangle(top, -1.0, 7.0, 1.0), 1.2, 0.0, 0.0, "platform"}};
  const Told told(whole);
  EXPECT_GT(told.of("slopes of more than 22 deg"), 0.2);
  Viewer climber;
  climber.max_slope = deg_to_rad(35.0);
  EXPECT_EQ(Told(whole, climber).of("slopes"), 0.0);
}

TEST(Unseen, AVeilIsToldAsOpen) {
  const Arena arena = parse_arena(
      "maze: |\n  +---+---+\n  |S.   . |\n  +---+---+\nelements:\n"
      "  - {type: veil_wall, x_m: 0.6, y_m: 0.6, rotation_deg: 90}\n",
      "drawn");
  const Told told(arena);
  EXPECT_GT(told.of("veils"), 0.0);
  EXPECT_NEAR(told.of("veils"), told.lacking, 1e-12);
}

/// Whatever the arena, each cell that is lacking has one cause.
TEST(Unseen, TheSharesAddUpToWhatIsLacking) {
  for (const char* kind : {"yellow", "orange", "red"})
    for (std::uint64_t seed = 71; seed < 75; ++seed) {
      GenerateConfig config;
      config.kind = arena_kind(kind);
      config.columns = config.rows = 6;
      config.seed = seed;
      config.ramps = 0.4;
      const Told told(parse_arena(generate_arena(config), "generated"));
      EXPECT_NEAR(told.sum(), told.lacking, 1e-12) << kind << " seed " << seed;
      EXPECT_TRUE(std::all_of(told.causes.begin(), told.causes.end(), [](const Unseen& u) { return u.share > 0.0; }));
    }
}

}  // namespace
}  // namespace rubble::arenas
