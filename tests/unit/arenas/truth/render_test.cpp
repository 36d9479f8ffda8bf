#include "arenas/truth/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "arenas/truth/canvas.h"
#include "tests/support/arenas_draw.h"

namespace rubble::arenas {
namespace {

using testing::arena;

/// Brightness of the picture at a place of the arena.
int brightness(const RgbImage& image, const Arena& a, double pixels_per_metre, double x, double y) {
  const int column = static_cast<int>((x - a.min_corner.x + 0.3) * pixels_per_metre);
  const int row = image.height - 1 - static_cast<int>((y - a.min_corner.y + 0.3) * pixels_per_metre);
  const std::uint8_t* p = image.pixel(column, row);
  return p[0] + p[1] + p[2];
}

TEST(Render, ShowsWallsDarkAndRampsLighterUphill) {
  const Arena a = arena({"+---+---+",  //
                         "| S | > |",  //
                         "+---+---+"});
  const RgbImage image = render(a, 100.0);
  EXPECT_EQ(image.width, static_cast<int>((2.42 + 0.6) * 100.0));
  EXPECT_LT(brightness(image, a, 100.0, 1.2, 0.3), 250);
  EXPECT_GT(brightness(image, a, 100.0, 0.2, 0.2), 400);
  EXPECT_GT(brightness(image, a, 100.0, 2.2, 0.2), brightness(image, a, 100.0, 1.4, 0.2) + 20);
}

TEST(Render, PaperIsBrightAndVictimsAreRed) {
  const Arena a = arena({"+---+---+",  //
                         "| S  A. |",  //
                         "+---+---+"},
                        "paper: [{x_m: 0.6, y_m: 0.2, length_m: 0.3, width_m: 0.3}]\n"
                        "victims: [{name: v, cell: A, wall: east}]\n");
  const RgbImage image = render(a, 50.0);
  EXPECT_GT(brightness(image, a, 50.0, 0.6, 0.15), 700);
  const int column = static_cast<int>((a.victims[0].position.x - a.min_corner.x + 0.3) * 50.0);
  const int row = image.height - 1 - static_cast<int>((a.victims[0].position.y - a.min_corner.y + 0.3) * 50.0);
  const std::uint8_t* p = image.pixel(column, row);
  EXPECT_GT(p[0], 150);
  EXPECT_LT(p[1], 80);
}

TEST(Render, LargeArenaGetsFewerPixelsAMetre) {
  const Arena a = arena(
      {"+---+---+---+---+---+---+---+---+", "| S   .   .   .   .   .   .   . |", "+---+---+---+---+---+---+---+---+"});
  const RgbImage image = render(a, 1e5);
  EXPECT_LE(std::max(image.width, image.height), 6000);
  EXPECT_GT(std::max(image.width, image.height), 5900);
}

TEST(Render, TheLegendStandsBelowThePlanAndNamesWhatIsThere) {
  const Arena bare = arena({"+---+---+---+---+", "| S   .   .   . |", "+---+---+---+---+"});
  const RgbImage plan = render(bare, 100.0), whole = render_with_legend(bare, 100.0);
  ASSERT_EQ(whole.width, plan.width);
  ASSERT_GT(whole.height, plan.height + 20);
  EXPECT_EQ(whole.rgb.size(), 3u * static_cast<std::size_t>(whole.width) * static_cast<std::size_t>(whole.height));
  EXPECT_TRUE(std::equal(plan.rgb.begin(), plan.rgb.end(), whole.rgb.begin())) << "it hides nothing";
  const auto shows = [](const RgbImage& image, int from, std::array<int, 3> colour) {
    for (int row = from; row < image.height; ++row)
      for (int column = 0; column < image.width; ++column)
        if (std::equal(colour.begin(), colour.end(), image.pixel(column, row))) return true;
    return false;
  };
  const std::array<int, 3> start{28, 128, 76}, victim{205, 38, 38};
  EXPECT_TRUE(shows(whole, plan.height, start));
  EXPECT_FALSE(shows(whole, plan.height, victim)) << "there is none";
  const Arena peopled = arena({"+---+---+---+---+", "| S  A.   .   . |", "+---+---+---+---+"},
                              "victims: [{name: v, cell: A, wall: east}]\n");
  EXPECT_TRUE(shows(render_with_legend(peopled, 100.0), plan.height, victim));
  const Arena small = arena({"+---+", "| S |", "+---+"});
  EXPECT_GE(render_with_legend(small, 150.0).width, 300) << "the words have room";
}

/// Step fields and ramps that cross are wood as all floor is: each has a sign of its own beside the floor's.
TEST(Render, TheLegendNamesTheLeaguesFields) {
  const auto wood = [](const std::string& element) {
    const Arena a = arena({"+---+---+---+---+", "| S   .   .   . |", "+---+---+---+---+"},
                          element.empty() ? "" : "elements: [{type: " + element + ", x_m: 3.0, y_m: 0.6}]\n");
    const RgbImage plan = render(a, 100.0), whole = render_with_legend(a, 100.0);
    const std::array<int, 3> colour{199, 177, 141};  // of floor on the ground
    int count = 0;
    for (int row = plan.height; row < whole.height; ++row)
      for (int column = 0; column < whole.width; ++column)
        count += std::equal(colour.begin(), colour.end(), whole.pixel(column, row)) ? 1 : 0;
    return count;
  };
  const int floor = wood("");
  ASSERT_GT(floor, 50);
  EXPECT_EQ(wood("wooden_block"), floor);
  for (const char* element :
       {"stepfield_orange_diagonal", "stepfield_red_diagonal", "crossing_ramps", "elevated_ramps", "stairs_120_solid"})
    EXPECT_GT(wood(element), floor + 20) << element;
}

TEST(Render, PaintedInBandsIsTheWholePicture) {
  const auto paint = [](int band) {
    RgbImage picture;
    for (int row = 0; row == 0 || row < picture.height; row += band) {
      Canvas canvas({-1.0, -2.0}, {3.0, 2.5}, 37.0, {250, 250, 240}, row, band);
      if (row == 0) picture = RgbImage(canvas.width(), canvas.height());
      canvas.fill({{-0.5, -1.9}, {2.9, -1.0}, {1.0, 2.2}}, [](const auto& p) { return Colour{60 * p.x + 60, 90, 30}; });
      canvas.disc({0.3, 0.4}, 1.1, {200, 30, 30}, 0.6);
      canvas.arrow({-0.8, -1.5}, {2.0, 2.0}, 0.1, {0, 0, 0}, 0.8);
      canvas.copy_to(picture);
    }
    return picture;
  };
  const RgbImage whole = paint(1000);
  EXPECT_EQ(whole.height, 167);
  for (const int band : {1, 7, 64, 166, 167}) EXPECT_EQ(paint(band).rgb, whole.rgb) << "bands of " << band << " rows";
}

}  // namespace
}  // namespace rubble::arenas
