#pragma once

#include <opencv2/imgproc.hpp>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/map_styles.h"

/// Palettes, dithers, floors of rooms, colour schemes.
namespace rubble::scoring::testing {

inline std::vector<Style> styles_of_colours() {
  Styles out;
  // Palettes.
  for (const int n : {4, 8, 16})
    out.add("palette league " + std::to_string(n),
            [=](const OccupancyGrid& g) { return with_own_palette(league_image(g, true), n); });
  out.add("palette searched 8",
          [](const OccupancyGrid& g) { return with_own_palette(with_searched_floor(league_image(g, true)), 8); });
  out.add("palette league bare 4", [](const OccupancyGrid& g) { return with_own_palette(league_image(g, false), 4); });
  for (const bool searched : {false, true})
    for (const bool drawings : {false, true}) {
      const std::string what = std::string(searched ? " searched" : "") + (drawings ? " drawings" : "");
      const auto of = [=](const OccupancyGrid& g) {
        return searched ? with_searched_floor(league_image(g, drawings)) : league_image(g, drawings);
      };
      const auto web = nearest_level(6);
      out.add("palette web-safe" + what, [=](const OccupancyGrid& g) {
        cv::Mat i = of(g);
        for (int y = 0; y < i.rows; ++y)
          for (int x = 0; x < i.cols; ++x) i.at<Colour>(y, x) = web(cv::Vec3f(i.at<Colour>(y, x)));
        return i;
      });
      out.add("palette web-safe diffused" + what, [=](const OccupancyGrid& g) { return diffused(of(g), web); });
      out.add("palette 565" + what, [=](const OccupancyGrid& g) {
        cv::Mat i = of(g);
        for (int y = 0; y < i.rows; ++y)
          for (int x = 0; x < i.cols; ++x) {
            Colour& c = i.at<Colour>(y, x);
            c = {static_cast<unsigned char>((c[0] >> 3) * 255 / 31), static_cast<unsigned char>((c[1] >> 2) * 255 / 63),
                 static_cast<unsigned char>((c[2] >> 3) * 255 / 31)};
          }
        return i;
      });
      out.add("palette 332" + what, [=](const OccupancyGrid& g) {
        cv::Mat i = of(g);
        for (int y = 0; y < i.rows; ++y)
          for (int x = 0; x < i.cols; ++x) {
            Colour& c = i.at<Colour>(y, x);
            c = {static_cast<unsigned char>((c[0] >> 6) * 85), static_cast<unsigned char>((c[1] >> 5) * 255 / 7),
                 static_cast<unsigned char>((c[2] >> 5) * 255 / 7)};
          }
        return i;
      });
      out.add("palette 16 of old" + what, [=](const OccupancyGrid& g) {
        std::vector<Colour> old;
        for (int i = 0; i < 8; ++i)
          for (const int l : {128, 255})
            old.push_back({static_cast<unsigned char>(i & 1 ? l : 0), static_cast<unsigned char>(i & 2 ? l : 0),
                           static_cast<unsigned char>(i & 4 ? l : 0)});
        old.push_back(grey(192));
        return by_palette(of(g), old);
      });
      out.add("black and white diffused, league" + what,
              [=](const OccupancyGrid& g) { return diffused(greyed(of(g)), nearest_level(2)); });
      out.add("black and white ordered 4, league" + what, [=](const OccupancyGrid& g) { return ordered(of(g), 4); });
    }
  for (const auto& [unknown, free] : {std::pair{205, 254}, {127, 255}, {150, 225}}) {
    const std::string what = " " + std::to_string(unknown) + " " + std::to_string(free);
    const int u = unknown, f = free;
    for (const int scale : {1, 2}) {
      const std::string many = what + (scale > 1 ? " twice" : "");
      const auto of = [=](const OccupancyGrid& g) { return in_colours(g, kBlack, grey(u), grey(f), scale); };
      out.add(
          "black and white diffused" + many, [=](const OccupancyGrid& g) { return diffused(of(g), nearest_level(2)); },
          scale);
      for (const int side : {4, 8})
        out.add(
            "black and white ordered " + std::to_string(side) + many,
            [=](const OccupancyGrid& g) { return ordered(of(g), side); }, scale);
      out.add(
          "four greys diffused" + many, [=](const OccupancyGrid& g) { return diffused(of(g), nearest_level(4)); },
          scale);
    }
    out.add("black and white cut" + what, [=](const OccupancyGrid& g) {
      cv::Mat o;
      cv::threshold(in_colours(g, kBlack, grey(u), grey(f)), o, 100, 255, cv::THRESH_BINARY);
      return o;
    });
  }

  // Rooms in colours.
  const std::vector<Colour> pastel{{200, 220, 255}, {200, 255, 210}, {255, 220, 200}, {190, 240, 250},
                                   {240, 200, 240}, {220, 220, 180}, {180, 250, 240}};
  const std::vector<Colour> strong{{60, 60, 220},  {60, 200, 60},  {220, 120, 40}, {40, 200, 230},
                                   {200, 60, 200}, {200, 200, 40}, {40, 130, 240}};
  const auto few = [](const std::vector<Colour>& c, int n) { return std::vector<Colour>(c.begin(), c.begin() + n); };
  for (const int n : {2, 5, 7})
    for (const int unknown : {255, 205, 128}) {
      const std::string what = " " + std::to_string(n) + " unknown " + std::to_string(unknown);
      out.add("rooms pastel" + what,
              [=](const OccupancyGrid& g) { return with_rooms(g, few(pastel, n), 2.4, kBlack, grey(unknown)); }, 1.0,
              {85});
      out.add("rooms strong" + what,
              [=](const OccupancyGrid& g) { return with_rooms(g, few(strong, n), 2.4, kBlack, grey(unknown)); });
    }
  out.add("rooms greys 3", [=](const OccupancyGrid& g) {
    return with_rooms(g, {grey(255), grey(240), grey(225)}, 2.4, kBlack, grey(160));
  });
  out.add("rooms greys 3 around white", [=](const OccupancyGrid& g) {
    return with_rooms(g, {grey(190), grey(210), grey(230)}, 2.4, kBlack, kWhite);
  });

  // Colour schemes of three classes.
  struct Scheme {
    const char* name;
    Colour wall, unknown, free;
  };
  for (const Scheme& s : std::vector<Scheme>{
           {"rviz", kBlack, {134, 137, 112}, grey(230)},
           {"rviz over grey", grey(14), {108, 110, 93}, grey(193)},
           {"blueprint", kWhite, {120, 60, 20}, {170, 100, 40}},
           {"night", grey(220), grey(30), grey(60)},
           {"night blue", {255, 200, 80}, {40, 20, 10}, {90, 60, 40}},
           {"red walls", {0, 0, 220}, grey(190), kWhite},
           {"red walls dark unknown", {30, 30, 200}, grey(90), kWhite},
           {"green walls", {0, 130, 0}, grey(200), kWhite},
           {"blue walls", {200, 40, 20}, grey(200), kWhite},
           {"brown walls, cream", {40, 70, 110}, {200, 220, 230}, {240, 250, 255}},
           {"yellow free", kBlack, grey(128), {120, 240, 250}},
           {"green free", kBlack, grey(160), {120, 220, 120}},
           {"green free, white unknown", kBlack, kWhite, {120, 220, 120}},
           {"blue unknown", kBlack, {200, 120, 60}, kWhite},
           {"turquoise unknown", kBlack, {160, 160, 20}, kWhite},
           {"viridis", {37, 231, 253}, {140, 145, 33}, {84, 1, 68}},
           {"jet", {0, 0, 128}, {122, 255, 130}, {128, 0, 0}},
           {"costmap", {255, 0, 255}, {134, 137, 112}, {230, 230, 230}},
           {"cartographer 128", grey(20), grey(128), grey(235)},
           {"hector grey", kBlack, grey(221), kWhite},
           {"white unknown, grey free", kBlack, kWhite, grey(200)},
           {"white unknown, dark free", kBlack, kWhite, grey(110)},
           {"black unknown, white walls", kWhite, kBlack, grey(120)},
           {"orange walls on black", {0, 140, 255}, kBlack, grey(70)},
           {"league walls, plain unknown", {120, 40, 0}, grey(226), kWhite},
           {"league walls, dark unknown", {120, 40, 0}, grey(128), kWhite},
       }) {
    out.add(std::string("scheme ") + s.name,
            [=](const OccupancyGrid& g) { return in_colours(g, s.wall, s.unknown, s.free); }, 1.0, {75});
    out.add(
        std::string("scheme twice smoothed ") + s.name,
        [=](const OccupancyGrid& g) {
          cv::Mat o;
          cv::resize(in_colours(g, s.wall, s.unknown, s.free), o, {}, 2.0, 2.0, cv::INTER_CUBIC);
          return o;
        },
        2.0);
  }

  return out.all;
}

}  // namespace rubble::scoring::testing
