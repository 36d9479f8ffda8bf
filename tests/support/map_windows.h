#pragma once

#include <opencv2/imgproc.hpp>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/map_styles.h"

/// Windows of programs around a map, and the colours that maps have in them.
namespace rubble::scoring::testing {

inline Colour rgb(int r, int g, int b) {
  return {static_cast<unsigned char>(b), static_cast<unsigned char>(g), static_cast<unsigned char>(r)};
}

struct MapColours {
  std::string name;
  Colour wall, unknown, free;
};

/// Puts a map into a window. `scale` of what comes back is 1.
struct Window {
  std::string name;
  std::function<Styled(const cv::Mat&)> around;
};

inline void bar(cv::Mat& m, int top, int bottom, const Colour& colour) {
  cv::rectangle(m, P(0, top), P(m.cols - 1, bottom - 1), cv::Scalar(colour), cv::FILLED);
}

inline void knobs(cv::Mat& m, const P& first, int step) {
  const std::vector<Colour> colours{rgb(255, 95, 87), rgb(254, 188, 46), rgb(40, 200, 64)};
  for (std::size_t k = 0; k < colours.size(); ++k)
    cv::circle(m, first + P(step * static_cast<int>(k), 0), 6, cv::Scalar(colours[k]), cv::FILLED, cv::LINE_AA);
}

inline std::vector<MapColours> map_colours() {
  return {{"white walls on grey in black", rgb(255, 255, 255), rgb(0, 0, 0), rgb(90, 90, 90)},
          {"orange walls on blue", rgb(255, 140, 0), rgb(20, 20, 40), rgb(60, 90, 160)},
          {"grey walls on black in white", rgb(128, 128, 128), rgb(255, 255, 255), rgb(0, 0, 0)},
          {"solarized", rgb(38, 139, 210), rgb(0, 43, 54), rgb(238, 232, 213)},
          {"rviz", rgb(0, 0, 0), rgb(112, 137, 134), rgb(230, 230, 230)},
          {"ros", rgb(0, 0, 0), rgb(205, 205, 205), rgb(254, 254, 254)},
          {"night", rgb(220, 220, 220), rgb(30, 30, 30), rgb(60, 60, 60)},
          {"blueprint", rgb(255, 255, 255), rgb(20, 60, 120), rgb(40, 100, 170)}};
}

inline std::vector<Window> windows() {
  return {{"dark title bar with coloured knobs",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 1, 32, 1, 1, rgb(28, 28, 28));
             bar(s.image, 0, 32, rgb(55, 59, 60));
             knobs(s.image, P(16, 16), 20);
             write_on(s.image, "map.pgm", P(100, 21), 0.45, grey(220));
             return s;
           }},
          {"light grey panel all around", [](const cv::Mat& m) { return framed(m, 1.0, 24, 24, 24, 24, grey(238)); }},
          {"light panel, title, menu and status",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 12, 76, 12, 36, rgb(240, 240, 240));
             bar(s.image, 0, 30, rgb(222, 222, 222));
             knobs(s.image, P(16, 15), 20);
             write_on(s.image, "Map viewer", P(120, 20), 0.45, grey(40));
             write_on(s.image, "File  Edit  View  Help", P(10, 52), 0.45, kBlack);
             write_on(s.image, "Ready", P(10, s.image.rows - 12), 0.4, kBlack);
             return s;
           }},
          {"light panel with a title in words",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 20, 44, 20, 20, grey(225));
             write_on(s.image, "Occupancy grid, 03:12", P(30, 28), 0.5, grey(30));
             return s;
           }},
          {"dark view with a light panel on its left",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 170, 60, 30, 40, grey(48));
             bar(s.image, 0, 28, rgb(55, 59, 60));
             write_on(s.image, "map.rviz* - RViz", P(120, 19), 0.5, grey(220));
             cv::rectangle(s.image, P(0, 28), P(150, s.image.rows), cv::Scalar(grey(240)), cv::FILLED);
             for (int k = 0; k < 7; ++k)
               write_on(s.image, "Display " + std::to_string(k), P(10, 60 + 24 * k), 0.4, kBlack);
             return s;
           }},
          {"title bar alone",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 0, 28, 0, 0, rgb(232, 230, 232));
             knobs(s.image, P(14, 14), 20);
             write_on(s.image, "grid.png", P(120, 19), 0.45, grey(60));
             return s;
           }},
          {"blue bar and borders",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 4, 30, 4, 4, rgb(0, 84, 227));
             write_on(s.image, "map - Viewer", P(10, 20), 0.5, kWhite);
             cv::rectangle(s.image, P(s.image.cols - 26, 5), P(s.image.cols - 7, 24), cv::Scalar(rgb(224, 67, 40)),
                           cv::FILLED);
             return s;
           }},
          {"page in lilac with a line around the map", [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 40, 60, 40, 50, rgb(214, 205, 232));
             cv::rectangle(s.image, P(39, 59), P(40 + m.cols, 60 + m.rows), cv::Scalar(grey(90)), 1);
             return s;
           }}};
}

/// Others, which the reader was not made with.
inline std::vector<MapColours> other_map_colours() {
  return {{"dracula", rgb(248, 248, 242), rgb(40, 42, 54), rgb(98, 114, 164)},
          {"gruvbox", rgb(251, 73, 52), rgb(40, 40, 40), rgb(235, 219, 178)},
          {"nord", rgb(191, 97, 106), rgb(46, 52, 64), rgb(216, 222, 233)},
          {"terminal", rgb(0, 255, 0), rgb(0, 20, 0), rgb(0, 80, 20)},
          {"cartographer", rgb(20, 20, 20), rgb(128, 128, 128), rgb(235, 235, 235)},
          {"yellow walls on black in grey", rgb(255, 230, 0), rgb(110, 110, 110), rgb(0, 0, 0)},
          {"sepia", rgb(60, 30, 10), rgb(200, 180, 150), rgb(245, 235, 215)},
          {"rose", rgb(120, 0, 60), rgb(255, 228, 240), rgb(255, 180, 210)}};
}

inline std::vector<Window> other_windows() {
  return {{"thin blue frame and bar",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 2, 20, 2, 2, rgb(40, 85, 119));
             write_on(s.image, "feh [1 of 1] - map.png", P(8, 14), 0.4, kWhite);
             return s;
           }},
          {"browser",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 60, 110, 76, 80, rgb(250, 250, 252));
             bar(s.image, 0, 40, rgb(222, 225, 230));
             cv::rectangle(s.image, P(10, 8), P(190, 40), cv::Scalar(kWhite), cv::FILLED);
             write_on(s.image, "Map of the arena", P(20, 28), 0.4, grey(60));
             bar(s.image, 40, 76, rgb(255, 255, 255));
             write_on(s.image, "localhost:8080/map", P(60, 62), 0.4, grey(90));
             return s;
           }},
          {"dark viewer with thumbnails and tools",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 110, 24, 24, 60, rgb(34, 34, 38));
             for (int k = 0; k < 4; ++k)
               cv::rectangle(s.image, P(14, 30 + 80 * k), P(90, 90 + 80 * k), cv::Scalar(grey(150 + 20 * k)),
                             cv::FILLED);
             bar(s.image, s.image.rows - 36, s.image.rows, rgb(64, 64, 70));
             for (int k = 0; k < 5; ++k)
               cv::circle(s.image, P(140 + 36 * k, s.image.rows - 18), 9, cv::Scalar(grey(200)), 2, cv::LINE_AA);
             return s;
           }},
          {"dark panel on the right",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 16, 52, 200, 16, rgb(21, 21, 26));
             cv::rectangle(s.image, P(s.image.cols - 184, 0), P(s.image.cols, s.image.rows),
                           cv::Scalar(rgb(62, 62, 70)), cv::FILLED);
             for (int k = 0; k < 8; ++k)
               write_on(s.image, "topic " + std::to_string(k), P(s.image.cols - 170, 40 + 30 * k), 0.45, grey(210));
             write_on(s.image, "3D", P(20, 32), 0.5, grey(210));
             return s;
           }},
          {"figure with tools below",
           [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 50, 50, 50, 90, rgb(246, 243, 238));
             bar(s.image, s.image.rows - 40, s.image.rows, rgb(205, 205, 208));
             for (int k = 0; k < 6; ++k)
               cv::rectangle(s.image, P(12 + 36 * k, s.image.rows - 32), P(34 + 36 * k, s.image.rows - 10),
                             cv::Scalar(grey(70)), 2);
             return s;
           }},
          {"desktop around", [](const cv::Mat& m) {
             Styled s = framed(m, 1.0, 62, 90, 62, 62, rgb(70, 120, 125));
             cv::Mat inner = s.image(cv::Rect(50, 50, s.image.cols - 100, s.image.rows - 100));
             inner.setTo(cv::Scalar(grey(236)));
             m.copyTo(s.image(cv::Rect(62, 90, m.cols, m.rows)));
             cv::rectangle(s.image, P(50, 50), P(s.image.cols - 50, 78), cv::Scalar(rgb(205, 205, 210)), cv::FILLED);
             knobs(s.image, P(66, 64), 20);
             write_on(s.image, "Preview", P(150, 69), 0.45, grey(50));
             return s;
           }}};
}

}  // namespace rubble::scoring::testing
