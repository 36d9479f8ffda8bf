#pragma once

#include <opencv2/imgproc.hpp>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/map_styles.h"
#include "tests/support/scoring_maze.h"

/// What is drawn over maps and around them, and walls drawn otherwise.
namespace rubble::scoring::testing {

inline std::vector<Style> styles_of_pages() {
  Styles out;
  // What is drawn over maps.
  const auto arrow = [](cv::Mat& i, const P& at, const Colour& c, int size) {
    cv::arrowedLine(i, at - P(size, size / 2), at + P(size, size / 2), cv::Scalar(c), std::max(1, size / 4),
                    cv::LINE_AA, 0, 0.4);
  };
  for (const auto& [name, colour] : std::vector<std::pair<std::string, Colour>>{
           {"red", {0, 0, 255}}, {"blue", {255, 0, 0}}, {"orange", {0, 140, 255}}}) {
    const Colour c = colour;
    for (const int scale : {1, 2})
      out.over_ros("arrow " + name + (scale > 1 ? " twice" : ""), scale,
                   [=](cv::Mat& i, const OccupancyGrid& g) {
                     for (int k = 0; k < 3; ++k) arrow(i, scale * open_place(g, 6, k), c, 5 * scale);
                   },
                   {75});
    out.over_ros("way " + name, 2,
                 [=](cv::Mat& i, const OccupancyGrid& g) {
                   cv::polylines(i, way_of(g, 2), false, cv::Scalar(c), 2, cv::LINE_AA);
                 },
                 {60});
    out.over_ros("names on floor " + name, 3,
                 [=](cv::Mat& i, const OccupancyGrid& g) {
                   for (int k = 0; k < 4; ++k)
                     write_on(i, "R" + std::to_string(k + 1), 3 * open_place(g, 7, k) - P(15, -8), 0.6, c, 2);
                 },
                 {80});
  }
  out.over_ros("names on floor black", 3,
               [=](cv::Mat& i, const OccupancyGrid& g) {
                 for (int k = 0; k < 4; ++k) write_on(i, "Room", 3 * open_place(g, 8, k) - P(22, -8), 0.5, kBlack, 1);
               },
               {85});
  out.add("names on floor in the walls' blue, league",
          [=](const OccupancyGrid& g) {
            cv::Mat i;
            cv::resize(league_image(g, true), i, {}, 3, 3, cv::INTER_NEAREST);
            for (int k = 0; k < 4; ++k) write_on(i, "Room", 3 * open_place(g, 8, k) - P(22, -8), 0.5, {120, 40, 0}, 1);
            return i;
          },
          3.0, {90});
  out.add("names on floor in the walls' blue, no smoothing, league",
          [=](const OccupancyGrid& g) {
            cv::Mat i;
            cv::resize(league_image(g, true), i, {}, 3, 3, cv::INTER_NEAREST);
            for (int k = 0; k < 4; ++k)
              write_on(i, "START", 3 * open_place(g, 8, k) - P(22, -8), 0.45, {120, 40, 0}, 1, cv::LINE_8);
            return i;
          },
          3.0, {90});
  out.over_ros("laser points red", 2,
               [=](cv::Mat& i, const OccupancyGrid& g) {
                 cv::RNG random(3);
                 for (int y = 0; y < g.height(); ++y)
                   for (int x = 0; x < g.width() / 2; ++x)
                     if (g[{x, g.height() - 1 - y}] == Occupancy::Occupied && random.uniform(0, 3) == 0)
                       cv::circle(i, 2 * P(x, y), 1, {0, 0, 255}, cv::FILLED);
               },
               {85});
  out.over_ros("grid over all grey", 2,
               [=](cv::Mat& i, const OccupancyGrid&) {
                 for (int x = 0; x < i.cols; x += 40) cv::line(i, {x, 0}, {x, i.rows}, {160, 160, 164}, 1);
                 for (int y = 0; y < i.rows; y += 40) cv::line(i, {0, y}, {i.cols, y}, {160, 160, 164}, 1);
               },
               {85});
  out.over_ros("grid light blue", 2,
               [=](cv::Mat& i, const OccupancyGrid&) {
                 for (int x = 0; x < i.cols; x += 40) cv::line(i, {x, 0}, {x, i.rows}, {255, 200, 120}, 1);
                 for (int y = 0; y < i.rows; y += 40) cv::line(i, {0, y}, {i.cols, y}, {255, 200, 120}, 1);
               },
               {85});

  // Pages.
  out.page("page scale bar and north arrow below",
           [=](const OccupancyGrid& g) {
             const cv::Mat m = in_ros_greys(g, 2);
             Styled s = framed(m, 2.0, 10, 10, 10, 60, kWhite);
             const int y = s.image.rows - 30;
             cv::line(s.image, {30, y}, {70, y}, cv::Scalar(kBlack), 2);
             cv::line(s.image, {30, y - 5}, {30, y + 5}, cv::Scalar(kBlack), 2);
             cv::line(s.image, {70, y - 5}, {70, y + 5}, cv::Scalar(kBlack), 2);
             write_on(s.image, "1 m", {80, y + 5}, 0.5, kBlack);
             cv::arrowedLine(s.image, {150, y + 15}, {150, y - 18}, cv::Scalar(kBlack), 2, cv::LINE_AA, 0, 0.4);
             write_on(s.image, "N", {160, y}, 0.5, kBlack);
             return s;
           },
           {85});
  out.page("scale bar in a corner of the unknown",
           [=](const OccupancyGrid& g) {
             cv::Mat m = in_ros_greys(g, 2);
             const int y = m.rows - 8;
             cv::line(m, {10, y}, {50, y}, cv::Scalar(kBlack), 2);
             write_on(m, "1 m", {55, y + 4}, 0.4, kBlack);
             cv::arrowedLine(m, {m.cols - 12, 26}, {m.cols - 12, 6}, cv::Scalar(kBlack), 2, cv::LINE_AA, 0, 0.4);
             return Styled{m, 2.0};
           },
           {85});
  out.page("legend to the right",
           [=](const OccupancyGrid& g) {
             Styled s = framed(in_ros_greys(g, 2), 2.0, 10, 10, 130, 10, kWhite);
             const int x = s.image.cols - 115;
             const std::vector<std::pair<std::string, Colour>> rows{
                 {"wall", kBlack}, {"free", grey(254)}, {"unknown", grey(205)}};
             for (std::size_t k = 0; k < rows.size(); ++k) {
               const P at(x, 40 + 30 * static_cast<int>(k));
               cv::rectangle(s.image, at, at + P(20, 14), cv::Scalar(rows[k].second), cv::FILLED);
               cv::rectangle(s.image, at, at + P(20, 14), cv::Scalar(kBlack), 1);
               write_on(s.image, rows[k].first, at + P(28, 12), 0.45, kBlack);
             }
             return s;
           },
           {85});
  out.page("legend box over the unknown",
           [=](const OccupancyGrid& g) {
             cv::Mat m = in_colours(padded(g, 40), kBlack, grey(205), grey(254), 2);
             cv::rectangle(m, P(6, 6), P(106, 70), cv::Scalar(kWhite), cv::FILLED);
             cv::rectangle(m, P(6, 6), P(106, 70), cv::Scalar(kBlack), 1);
             for (int k = 0; k < 2; ++k) {
               cv::rectangle(m, P(12, 14 + 26 * k), P(30, 28 + 26 * k), cv::Scalar(k == 0 ? kBlack : grey(254)),
                             cv::FILLED);
               write_on(m, k == 0 ? "wall" : "free", P(36, 27 + 26 * k), 0.45, kBlack);
             }
             Styled s{m, 2.0};
             s.left = s.top = 80;
             return s;
           },
           {85});
  out.page("plot with axes and title",
           [=](const OccupancyGrid& g) {
             const cv::Mat m = in_ros_greys(g, 2);
             Styled s = framed(m, 2.0, 60, 40, 20, 50, kWhite);
             cv::rectangle(s.image, P(59, 39), P(60 + m.cols, 40 + m.rows), cv::Scalar(kBlack), 1);
             for (int x = 0; x < m.cols; x += 80) {
               cv::line(s.image, P(60 + x, 40 + m.rows), P(60 + x, 45 + m.rows), cv::Scalar(kBlack), 1);
               write_on(s.image, std::to_string(x / 40), P(55 + x, 60 + m.rows), 0.4, kBlack);
             }
             for (int y = 0; y < m.rows; y += 80) {
               cv::line(s.image, P(54, 40 + y), P(59, 40 + y), cv::Scalar(kBlack), 1);
               write_on(s.image, std::to_string(y / 40), P(30, 45 + y), 0.4, kBlack);
             }
             write_on(s.image, "Occupancy grid", P(80, 25), 0.6, kBlack);
             return s;
           },
           {85});
  out.page("plot with colour bar, viridis", [=](const OccupancyGrid& g) {
    const cv::Mat m = in_colours(g, {37, 231, 253}, {140, 145, 33}, {84, 1, 68}, 2);
    Styled s = framed(m, 2.0, 40, 40, 90, 40, kWhite);
    for (int y = 0; y < m.rows; ++y) {
      const double t = 1.0 - static_cast<double>(y) / m.rows;
      cv::Mat one(1, 1, CV_8U, cv::Scalar(255 * t)), colour;
      cv::applyColorMap(one, colour, cv::COLORMAP_VIRIDIS);
      cv::line(s.image, P(55 + m.cols, 40 + y), P(70 + m.cols, 40 + y), cv::Scalar(colour.at<Colour>(0, 0)));
    }
    return s;
  });
  out.page("two panels, the map and a smaller one",
           [=](const OccupancyGrid& g) {
             const cv::Mat m = in_ros_greys(g, 2);
             Styled s = framed(m, 2.0, 20, 20, 60 + m.cols / 2, 20, kWhite);
             cv::Mat small;
             cv::resize(m, small, {}, 0.5, 0.5, cv::INTER_NEAREST);
             small.copyTo(s.image(cv::Rect(m.cols + 50, 20, small.cols, small.rows)));
             return s;
           },
           {85});
  out.page("window with a dark bar and a panel",
           [=](const OccupancyGrid& g) {
             const cv::Mat m = in_colours(g, kBlack, {134, 137, 112}, grey(230), 2);
             Styled s = framed(m, 2.0, 160, 60, 30, 40, {48, 48, 48});
             cv::rectangle(s.image, P(0, 0), P(s.image.cols, 28), cv::Scalar(60, 59, 55), cv::FILLED);
             write_on(s.image, "map.rviz* - RViz", P(120, 19), 0.5, grey(220));
             cv::rectangle(s.image, P(0, 28), P(140, s.image.rows), cv::Scalar(240, 240, 240), cv::FILLED);
             for (int k = 0; k < 7; ++k)
               write_on(s.image, "Display " + std::to_string(k), P(10, 60 + 24 * k), 0.4, kBlack);
             return s;
           },
           {85});
  out.page("league page with a title bar",
           [=](const OccupancyGrid& g) {
             cv::Mat m;
             cv::resize(league_image(g, true), m, {}, 2, 2, cv::INTER_NEAREST);
             Styled s = framed(m, 2.0, 0, 30, 0, 0, kWhite);
             write_on(s.image, "RoboCup 2012 Rescue", P(10, 20), 0.5, kBlack);
             return s;
           },
           {85});
  out.page("league on a white page",
           [=](const OccupancyGrid& g) {
             cv::Mat m;
             cv::resize(league_image(g, true), m, {}, 2, 2, cv::INTER_NEAREST);
             return framed(m, 2.0, 40, 40, 40, 40, kWhite);
           },
           {85});
  out.page("shadow and white page", [=](const OccupancyGrid& g) {
    const cv::Mat m = in_ros_greys(g, 2);
    Styled s = framed(m, 2.0, 40, 40, 40, 40, kWhite);
    cv::Mat shade(s.image.size(), CV_8UC3, cv::Scalar(kWhite));
    cv::rectangle(shade, P(46, 46), P(46 + m.cols, 46 + m.rows), cv::Scalar(grey(120)), cv::FILLED);
    cv::GaussianBlur(shade, shade, {}, 5);
    m.copyTo(shade(cv::Rect(40, 40, m.cols, m.rows)));
    s.image = shade;
    return s;
  });
  for (const int degrees : {11, 33})
    out.page("page turned by " + std::to_string(degrees),
             [=](const OccupancyGrid& g) {
               const cv::Mat m = in_ros_greys(g, 2);
               Styled s = framed(m, 2.0, 30, 30, 30, 30, kWhite);
               turn(s, degrees, kWhite);
               return s;
             },
             {85});
  out.page("framed and turned on black", [=](const OccupancyGrid& g) {
    Styled s = framed(in_ros_greys(g, 2), 2.0, 3, 3, 3, 3, kBlack);
    turn(s, 9, kBlack);
    return s;
  });

  // Walls and ground drawn otherwise.
  out.add("walls of three pixels smoothed",
          [=](const OccupancyGrid& g) {
            cv::Mat o;
            cv::resize(in_ros_greys(g), o, {}, 3, 3, cv::INTER_LINEAR);
            return o;
          },
          3.0, {85});
  out.add("unknown hatched",
          [=](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, kBlack, kWhite, grey(254), 2);
            for (int y = 0; y < i.rows; ++y)
              for (int x = 0; x < i.cols; ++x)
                if (i.at<Colour>(y, x) == kWhite) i.at<Colour>(y, x) = (x + y) % 8 < 2 ? grey(150) : grey(230);
            return i;
          },
          2.0, {85});
  out.over_ros("probabilities, grades of grey", 1,
               [=](cv::Mat& i, const OccupancyGrid&) {
                 cv::RNG random(9);
                 for (int y = 0; y < i.rows; ++y)
                   for (int x = 0; x < i.cols; ++x) {
                     Colour& c = i.at<Colour>(y, x);
                     if (c[0] == 254)
                       c = grey(215 + random.uniform(0, 40));
                     else if (c[0] == 0)
                       c = grey(random.uniform(0, 70));
                     else
                       c = grey(128);
                   }
               },
               {85});
  out.add("probabilities, free fades to unknown",
          [=](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, kBlack, grey(127), kWhite), free = i.clone();
            cv::Mat f;
            cv::inRange(i, cv::Scalar::all(255), cv::Scalar::all(255), f);
            cv::copyMakeBorder(f, f, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
            cv::Mat unknown_only = i.clone();
            for (int y = 0; y < i.rows; ++y)
              for (int x = 0; x < i.cols; ++x) {
                bool near = false;
                for (int v = -2; v <= 2; ++v)
                  for (int u = -2; u <= 2; ++u) {
                    const int a = std::clamp(x + u, 0, i.cols - 1), b = std::clamp(y + v, 0, i.rows - 1);
                    near = near || i.at<Colour>(b, a)[0] == 127;
                  }
                if (near && i.at<Colour>(y, x)[0] == 255) free.at<Colour>(y, x) = grey(200);
              }
            return free;
          },
          1.0, {85});
  out.add("tiny slam, walls with slopes",
          [=](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, kBlack, grey(127), kWhite), o;
            cv::Mat wide;
            cv::erode(i, wide, cv::Mat::ones(3, 3, CV_8U));
            cv::addWeighted(i, 0.75, wide, 0.25, 0.0, o);
            return o;
          },
          1.0, {85});
  out.add(
      "costmap inflated",
      [=](const OccupancyGrid& g) {
        cv::Mat i = in_colours(g, {255, 0, 255}, {134, 137, 112}, grey(230), 2), walls, far;
        cv::inRange(i, cv::Scalar(255, 0, 255), cv::Scalar(255, 0, 255), walls);
        cv::distanceTransform(~walls, far, cv::DIST_L2, 3);
        for (int y = 0; y < i.rows; ++y)
          for (int x = 0; x < i.cols; ++x) {
            Colour& c = i.at<Colour>(y, x);
            const float d = far.at<float>(y, x);
            if (c != grey(230)) continue;
            if (d < 3)
              c = {255, 255, 0};
            else if (d < 12)
              c = {static_cast<unsigned char>(255 * (d - 3) / 9), 0, static_cast<unsigned char>(255 * (12 - d) / 9)};
          }
        return i;
      },
      2.0, {85});
  out.add("see-through on dark",
          [=](const OccupancyGrid& g) {
            cv::Mat i = in_ros_greys(g), o;
            cv::addWeighted(i, 0.7, cv::Mat(i.size(), i.type(), cv::Scalar::all(48)), 0.3, 0.0, o);
            return o;
          },
          1.0, {85});
  out.add("walls hatched in outline",
          [=](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, kBlack, grey(205), grey(254), 4), walls, inner;
            cv::inRange(i, cv::Scalar::all(0), cv::Scalar::all(0), walls);
            cv::erode(walls, inner, cv::Mat::ones(3, 3, CV_8U));
            i.setTo(cv::Scalar(grey(110)), inner);
            return i;
          },
          4.0, {85});
  return out.all;
}

/// League maps on white pages, whose legends and scale bars are in the league's colours too.
inline std::vector<Style> styles_of_league_legends() {
  Styles out;
  const Colour blue{120, 40, 0};
  for (const int scale : {1, 2}) {
    const std::string size = scale == 1 ? "" : " twice";
    const auto on_page = [=](const OccupancyGrid& g) {
      cv::Mat m;
      cv::resize(league_image(g, true), m, {}, scale, scale, cv::INTER_NEAREST);
      return framed(m, scale, 40 * scale, 40 * scale, 70 * scale, 40 * scale, kWhite);
    };
    out.page("league swatch" + size,
             [=](const OccupancyGrid& g) {
               Styled s = on_page(g);
               const P at(s.image.cols - 50 * scale, 60 * scale);
               cv::rectangle(s.image, cv::Rect(at.x, at.y, 21 * scale, 11 * scale), cv::Scalar(blue), cv::FILLED);
               return s;
             },
             {85});
    out.page("league scale bar" + size,
             [=](const OccupancyGrid& g) {
               Styled s = on_page(g);
               const P at(s.image.cols - 150 * scale, s.image.rows - 25 * scale);
               cv::rectangle(s.image, cv::Rect(at.x, at.y, 61 * scale, 4 * scale), cv::Scalar(blue), cv::FILLED);
               write_on(s.image, "3 m", at + P(66 * scale, 6), 0.4, blue);
               return s;
             },
             {85});
    out.page("league legend" + size,
             [=](const OccupancyGrid& g) {
               Styled s = on_page(g);
               const std::vector<std::pair<std::string, Colour>> rows{
                   {"wall", blue}, {"free", kWhite}, {"unknown", Colour(227, 226, 226)}};
               for (std::size_t k = 0; k < rows.size(); ++k) {
                 const P at(s.image.cols - 65 * scale, (50 + 22 * static_cast<int>(k)) * scale);
                 cv::rectangle(s.image, at, at + P(16 * scale, 10 * scale), cv::Scalar(rows[k].second), cv::FILLED);
                 cv::rectangle(s.image, at, at + P(16 * scale, 10 * scale), cv::Scalar(blue), scale);
                 write_on(s.image, rows[k].first, at + P(19 * scale, 9 * scale), 0.3 * scale, blue);
               }
               return s;
             },
             {85});
  }
  return out.all;
}

}  // namespace rubble::scoring::testing
