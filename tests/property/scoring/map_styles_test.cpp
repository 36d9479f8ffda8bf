#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/normalise.h"
#include "scoring/maps/wall_drawing.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/overlap.h"
#include "tests/support/base_files.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_style_colours.h"
#include "tests/support/map_style_fresh.h"
#include "tests/support/map_style_hard.h"
#include "tests/support/map_style_pages.h"
#include "tests/support/map_style_teams.h"
#include "tests/support/scoring_grounds.h"

/// Styles of drawing: a map in the style of any program or team is read as its plain picture is, or refused by a
/// sentence that is true.
namespace rubble::scoring {
namespace {

using namespace testing;
/// A map on its truth, and what its plain picture would be worth at so many pixels a cell.
class DrawnMap {
 public:
  struct Worth {
    double score = 0.0, overlap = 0.0;
  };
  DrawnMap(std::string name, OccupancyGrid truth, OccupancyGrid map)
      : name_(std::move(name)), truth_(std::move(truth)), map_(std::move(map)), sights_(truth_) {}
  const std::string& name() const { return name_; }
  const OccupancyGrid& map() const { return map_; }
  Worth worth(const OccupancyGrid& read, const PlanarTransform& T) const {
    return {sights_.at(read, T).score, overlap(read, truth_, T.pose(), 0.5).score};
  }
  Worth plain(double pixels) {
    const int n = std::max(1, static_cast<int>(pixels));
    if (plain_.count(n) > 0) return plain_.at(n);
    GridFrame f = map_.frame();
    f.width *= n, f.height *= n, f.resolution /= n;
    OccupancyGrid fine(f);
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) fine[{x, y}] = map_[{x / n, y / n}];
    return plain_[n] = worth(fine, PlanarTransform());
  }

 private:
  std::string name_;
  OccupancyGrid truth_, map_;
  SightLines sights_;
  std::map<int, Worth> plain_;
};

/// A damaged maze, a yellow arena seen in part, and a maze with ragged walls. Others of the same kinds with another
/// `seed`, or RUBBLE_STYLE_SEED=N in the environment.
std::vector<DrawnMap> drawn_maps(std::uint64_t seed = 0) {
  std::vector<DrawnMap> out;
  const char* const text = std::getenv("RUBBLE_STYLE_SEED");
  const std::uint64_t more = 100 * (text == nullptr ? seed : std::strtoull(text, nullptr, 10));
  const OccupancyGrid maze = truth_of({"maze", 5, 7, 9 + more});
  out.emplace_back("maze", maze, padded(with_gaps(with_phantoms(maze, 2, 3 + more), 3, 6 + more), 16));
  const OccupancyGrid yellow = truth_of({"yellow", 6, 7, 23 + more});
  out.emplace_back("yellow", yellow, padded(with_coverage(with_gaps(yellow, 3, 8 + more), 0.75), 12));
  const OccupancyGrid laser = truth_of({"maze", 6, 7, 31 + more});
  out.emplace_back("ragged", laser, padded(ragged(laser, 1, 4), 15));
  return out;
}

PlanarTransform pose_of(const Styled& style, const OccupancyGrid& read, const OccupancyGrid& map) {
  const double f = map.resolution() / style.scale;
  cv::Mat back = (cv::Mat_<double>(2, 3) << 1, 0, 0, 0, 1, 0);
  if (!style.turn.empty()) cv::invertAffineTransform(style.turn, back);
  const auto onto = [&](const TPoint2D& p) {
    const double column = (p.x - read.frame().x0) / f - 0.5;
    const double row = read.height() - (p.y - read.frame().y0) / f - 0.5;
    const auto at = [&](int i) {
      return back.at<double>(i, 0) * column + back.at<double>(i, 1) * row + back.at<double>(i, 2) + 0.5;
    };
    const double c = (at(0) - style.left) / style.scale, r = (at(1) - style.top) / style.scale;
    return TPoint2D(map.frame().x0 + c * map.resolution(), map.frame().y0 + (map.height() - r) * map.resolution());
  };
  const TPoint2D o(read.frame().x0, read.frame().y0), a = o + TPoint2D(5, 0), b = o + TPoint2D(0, 5);
  return PlanarTransform(fit_rigid({o, a, b}, {onto(o), onto(a), onto(b)}));
}

struct Outcome {
  int cases = 0, right = 0, refused = 0;
  int told = 0;     ///< read otherwise than the plain picture, with a word about what is doubtful
  int wrong = 0;    ///< without a word
  int doubted = 0;  ///< of those that are right
};

bool says_a_doubt(const LoadedMap& read) {
  const auto says = [&](const char* what) { return read.recognised.find(what) != std::string::npos; };
  return says(kDoubt) || says(kWallsPale) || says(kFreeNotKnown);
}

Outcome outcome_of(std::vector<DrawnMap> maps, const std::vector<Style>& styles) {
  const char* const only = std::getenv("RUBBLE_STYLE");  // a part of their names
  const test::TempFolder folder;
  Outcome out;
  std::size_t turn = 0;
  for (DrawnMap& map : maps) {
    std::size_t place = turn++;
    for (const Style& style : styles) {
      if (!is_tried(place++) || (only != nullptr && style.name.find(only) == std::string::npos)) continue;
      const Styled drawn = style.draw(map.map());
      const DrawnMap::Worth plain = map.plain(drawn.scale);
      const std::string path = folder / "map" + (style.quality > 0 ? ".jpg" : ".png");
      std::vector<int> options;
      if (style.quality > 0) options = {cv::IMWRITE_JPEG_QUALITY, style.quality};
      ++out.cases;
      const bool is_written = cv::imwrite(path, drawn.image, options);
      EXPECT_TRUE(is_written) << style.name;
      if (!is_written) continue;  // else the file of the style before would be read
      try {
        const LoadedMap read = load_map(path, {map.map().resolution() / drawn.scale});
        const DrawnMap::Worth worth = map.worth(read.grid, pose_of(drawn, read.grid, map.map()));
        const bool doubted = says_a_doubt(read);
        if (std::abs(worth.score - plain.score) <= 0.02 && std::abs(worth.overlap - plain.overlap) <= 0.05) {
          ++out.right;
          out.doubted += doubted ? 1 : 0;
          continue;
        }
        ++(doubted ? out.told : out.wrong);
        std::printf("%s: %s of %s: %.3f instead of %.3f, overlap %.3f instead of %.3f; %s\n",
                    doubted ? "told" : "wrong", style.name.c_str(), map.name().c_str(), worth.score, plain.score,
                    worth.overlap, plain.overlap, read.recognised.c_str());
      } catch (const InputError& error) {
        ++out.refused;
        EXPECT_THAT(error.what(), ::testing::ContainsRegex("dither|colour|blended|evenly bright"));
        std::printf("refused: %s of %s: %s\n", style.name.c_str(), map.name().c_str(), error.what());
      }
    }
  }
  std::printf("%d cases, %d right (%d of them doubted), %d refused, %d told, %d wrong\n", out.cases, out.right,
              out.doubted, out.refused, out.told, out.wrong);
  return out;
}

bool are_all_tried() { return std::getenv("RUBBLE_STYLE") == nullptr && std::getenv("RUBBLE_STYLE_SEED") == nullptr; }

TEST(MapStyles, AreReadAsThePlainPictureIsOrRefusedWithTheReason) {
  std::vector<Style> styles = styles_of_colours();
  for (const auto& more : {styles_of_pages(), further_styles()}) styles.insert(styles.end(), more.begin(), more.end());
  const Outcome out = outcome_of(drawn_maps(), styles);
  if (!are_all_tried()) return;
  // Those that are wrong and not told: docs/map_readers.md, known weaknesses.
  EXPECT_GE(out.right, is_tried(1) ? 891 : 297);
  EXPECT_LE(out.wrong + out.told, is_tried(1) ? 74 : 25);
  EXPECT_LE(out.wrong, is_tried(1) ? 24 : 6);
  // Nor are they many that are refused, or doubted though they are right: who doubts all is never wrong.
  EXPECT_LE(out.refused, is_tried(1) ? 34 : 11);
  EXPECT_LE(out.doubted, is_tried(1) ? 116 : 43);
}

TEST(MapStyles, WhatTheToolsOfTeamsSaveIsReadOrDoubted) {
  const Outcome out = outcome_of(drawn_maps(), styles_of_teams());
  if (!are_all_tried()) return;
  EXPECT_LE(out.wrong, is_tried(1) ? 3 : 2);  // small words in blue, and a map without unknown ground
  EXPECT_GE(out.right, is_tried(1) ? 650 : 220);
  EXPECT_LE(out.refused, is_tried(1) ? 34 : 11);
  EXPECT_LE(out.doubted, is_tried(1) ? 158 : 52);
}

/// The readers were mended on the arenas above: how they do on others.
TEST(MapStyles, WhatTheToolsOfTeamsSaveIsReadOrDoubtedOnOtherArenasToo) {
  const Outcome out = outcome_of(drawn_maps(10), styles_of_teams());
  if (!are_all_tried()) return;
  EXPECT_LE(out.wrong, is_tried(1) ? 14 : 6);
  EXPECT_GE(out.right, is_tried(1) ? 598 : 199);
  EXPECT_LE(out.refused, is_tried(1) ? 33 : 11);
  EXPECT_LE(out.doubted, is_tried(1) ? 121 : 40);
}

TEST(MapStyles, LegendsInTheLeaguesOwnColoursAreNoPartOfTheMap) {
  const Outcome out = outcome_of(drawn_maps(), styles_of_league_legends());
  EXPECT_GE(out.right, 5 * out.cases / 6);
}

TEST(MapStyles, WherePartOfTheMapIsLostThatIsSaid) {
  const Outcome out = outcome_of(drawn_maps(), hard_styles());
  if (!are_all_tried()) return;
  EXPECT_LE(out.wrong, is_tried(1) ? 2 : 0);  // words, all of them
  EXPECT_GE(out.right, is_tried(1) ? 232 : 80);
  EXPECT_LE(out.refused, is_tried(1) ? 22 : 8);
  EXPECT_LE(out.doubted, is_tried(1) ? 81 : 29);
}

}  // namespace
}  // namespace rubble::scoring
