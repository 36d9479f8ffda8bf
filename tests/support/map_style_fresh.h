#pragma once

#include <opencv2/imgproc.hpp>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/map_styles.h"

/// Further ones, which the readers had not seen when they were made: views, sheets, scans, schemes of plots.
namespace rubble::scoring::testing {

inline std::vector<Style> further_styles() {
  Styles out;
  const std::vector<Colour> rooms{{180, 200, 250}, {190, 250, 190}, {250, 200, 180}, {170, 240, 250}, {230, 180, 230}};
  const auto in_rooms = [=](const OccupancyGrid& g, const Colour& unknown, int scale, int how = cv::INTER_NEAREST) {
    cv::Mat m;
    cv::resize(with_rooms(g, rooms, 2.4, kBlack, unknown), m, {}, scale, scale, how);
    return m;
  };
  const auto rviz = [](const OccupancyGrid& g, int scale) {
    return in_colours(g, kBlack, {134, 137, 112}, grey(230), scale);
  };
  out.page("view with laser points, axes and grid",
           [=](const OccupancyGrid& g) {
             cv::Mat m = rviz(g, 2);
             cv::RNG random(8);
             for (int y = 0; y < g.height() / 2; ++y)
               for (int x = 0; x < g.width(); ++x)
                 if (g[{x, g.height() - 1 - y}] == Occupancy::Occupied && random.uniform(0, 4) == 0)
                   m.at<Colour>(2 * y, 2 * x) = m.at<Colour>(2 * y, 2 * x + 1) = {0, 0, 255};
             const P at = 2 * open_place(g, 6, 1);
             cv::line(m, at, at + P(14, 0), {0, 0, 255}, 2);
             cv::line(m, at, at + P(0, -14), {0, 255, 0}, 2);
             Styled s = framed(m, 2.0, 50, 40, 70, 40, {48, 48, 48});
             for (int x = 10; x < s.image.cols; x += 40)
               cv::line(s.image, {x, 0}, {x, s.image.rows}, {164, 160, 160}, 1);
             for (int y = 10; y < s.image.rows; y += 40)
               cv::line(s.image, {0, y}, {s.image.cols, y}, {164, 160, 160}, 1);
             return s;
           },
           {90, 70});
  out.add("cartographer, noise and fading",
          [](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, grey(40), grey(128), grey(232)), o;
            cv::GaussianBlur(i, o, {}, 0.7);
            cv::Mat noise(o.size(), CV_16SC1), n3;
            cv::RNG random(2);
            random.fill(noise, cv::RNG::NORMAL, 0.0, 5.0);
            cv::cvtColor(o, o, cv::COLOR_BGR2GRAY);
            cv::add(o, noise, o, cv::noArray(), CV_8U);
            return o;
          },
          1.0, {90});
  out.add("grey walls with black outlines",
          [](const OccupancyGrid& g) {
            cv::Mat i = in_colours(g, kBlack, grey(225), kWhite, 3), walls, inner;
            cv::inRange(i, cv::Scalar::all(0), cv::Scalar::all(0), walls);
            cv::erode(walls, inner, cv::Mat::ones(3, 3, CV_8U));
            i.setTo(cv::Scalar(grey(90)), inner);
            return i;
          },
          3.0, {85});
  out.plain("dark grey walls, light unknown", grey(60), grey(232), kWhite, 1, {90, 60});
  out.plain("low contrast", grey(90), grey(140), grey(190), 1, {90, 70});
  out.add(
      "palette 16 of a smoothed view",
      [=](const OccupancyGrid& g) {
        cv::Mat o;
        cv::resize(rviz(g, 1), o, {}, 2.0, 2.0, cv::INTER_LINEAR);
        return with_own_palette(o, 16);
      },
      2.0);
  out.add(
      "web-safe diffused view", [=](const OccupancyGrid& g) { return diffused(rviz(g, 2), nearest_level(6)); }, 2.0);
  out.add(
      "eight colours diffused view", [=](const OccupancyGrid& g) { return diffused(rviz(g, 2), nearest_level(2)); },
      2.0);
  out.add(
      "black and white diffused, three to one",
      [](const OccupancyGrid& g) { return diffused(in_ros_greys(g, 3), nearest_level(2)); }, 3.0);
  out.add(
      "black and white ordered, dark unknown",
      [](const OccupancyGrid& g) { return ordered(in_colours(g, kBlack, grey(100), kWhite, 2), 4); }, 2.0);
  out.add(
      "black and white diffused, white walls",
      [](const OccupancyGrid& g) { return diffused(in_colours(g, kWhite, grey(60), grey(0), 2), nearest_level(2)); },
      2.0);
  out.add(
      "five greys diffused",
      [](const OccupancyGrid& g) { return diffused(in_colours(g, kBlack, grey(140), grey(245), 2), nearest_level(5)); },
      2.0);
  out.page("black and white diffused, turned", [](const OccupancyGrid& g) {
    Styled s{in_ros_greys(g, 2), 2.0};
    turn(s, 12, grey(205));
    s.image = diffused(s.image, nearest_level(2));
    return s;
  });
  for (const int degrees : {15, 45})
    out.page("rooms turned by " + std::to_string(degrees),
             [=](const OccupancyGrid& g) {
               Styled s{in_rooms(g, kWhite, 2), 2.0};
               turn(s, degrees, kWhite);
               return s;
             },
             {85});
  out.add("rooms with names",
          [=](const OccupancyGrid& g) {
            cv::Mat m = in_rooms(g, grey(205), 3);
            for (int k = 0; k < 4; ++k) write_on(m, "Room", 3 * open_place(g, 8, k) - P(22, -8), 0.5, kBlack, 1);
            return m;
          },
          3.0, {85});
  out.add("rooms, white walls on black",
          [=](const OccupancyGrid& g) {
            return with_rooms(g, {{120, 60, 40}, {40, 110, 50}, {60, 50, 130}}, 2.4, kWhite, kBlack);
          },
          1.0, {85});
  out.add("rooms smoothed", [=](const OccupancyGrid& g) { return in_rooms(g, grey(190), 2, cv::INTER_CUBIC); }, 2.0,
          {60});
  out.page("rooms on a page with a frame",
           [=](const OccupancyGrid& g) {
             const cv::Mat m = in_rooms(g, grey(205), 2);
             Styled s = framed(m, 2.0, 40, 50, 40, 40, kWhite);
             cv::rectangle(s.image, P(39, 49), P(40 + m.cols, 50 + m.rows), cv::Scalar(kBlack), 1);
             write_on(s.image, "Rooms of the arena", P(60, 30), 0.6, kBlack);
             return s;
           },
           {85});
  out.page("rooms on a page",
           [=](const OccupancyGrid& g) { return framed(in_rooms(g, grey(205), 2), 2.0, 40, 50, 40, 40, kWhite); },
           {85});
  out.add("rooms of greens and blues, arrows",
          [=](const OccupancyGrid& g) {
            cv::Mat m;
            cv::resize(with_rooms(g, {{200, 255, 200}, {255, 220, 180}, {220, 240, 160}}, 2.4, kBlack, grey(180)), m,
                       {}, 2, 2, cv::INTER_NEAREST);
            for (int k = 0; k < 3; ++k) {
              const P at = 2 * open_place(g, 6, k);
              cv::arrowedLine(m, at - P(10, 4), at + P(10, 4), {0, 0, 230}, 2, cv::LINE_AA, 0, 0.4);
            }
            return m;
          },
          2.0, {85});
  out.page("a sheet with header, footer and logo",
           [](const OccupancyGrid& g) {
             Styled s = framed(in_ros_greys(g, 2), 2.0, 60, 110, 60, 80, kWhite);
             write_on(s.image, "Mission report 3", P(70, 60), 0.9, kBlack, 2);
             write_on(s.image, "team: rubble   time: 14:03   arena: yellow", P(70, 90), 0.4, grey(60));
             write_on(s.image, "page 1 of 2", P(s.image.cols / 2 - 30, s.image.rows - 30), 0.4, kBlack);
             cv::circle(s.image, P(s.image.cols - 60, 50), 30, {180, 90, 20}, cv::FILLED);
             return s;
           },
           {85});
  out.page("two frames, one in the other",
           [](const OccupancyGrid& g) {
             Styled s = framed(in_ros_greys(g, 2), 2.0, 30, 30, 30, 30, kWhite);
             cv::rectangle(s.image, P(29, 29), P(s.image.cols - 30, s.image.rows - 30), cv::Scalar(kBlack), 1);
             cv::rectangle(s.image, P(12, 12), P(s.image.cols - 13, s.image.rows - 13), cv::Scalar(kBlack), 3);
             return s;
           },
           {85});
  out.page("a frame in blue",
           [](const OccupancyGrid& g) {
             return framed(in_ros_greys(g, 2), 2.0, 12, 12, 12, 12, {200, 90, 30});
           },
           {85});
  out.over_ros("compass rose in the unknown", 2,
               [](cv::Mat& m, const OccupancyGrid&) {
                 cv::circle(m, P(20, 20), 14, cv::Scalar(kBlack), 1, cv::LINE_AA);
                 cv::line(m, P(20, 3), P(20, 37), cv::Scalar(kBlack), 1);
                 cv::line(m, P(3, 20), P(37, 20), cv::Scalar(kBlack), 1);
               },
               {85});
  out.over_ros("ways of four robots", 2,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 const std::vector<Colour> pens{{0, 0, 255}, {255, 0, 0}, {0, 170, 0}, {200, 0, 200}};
                 std::vector<P> way = way_of(g, 2);
                 for (std::size_t k = 0; k < 4; ++k)
                   cv::polylines(m,
                                 std::vector<P>(way.begin() + static_cast<std::ptrdiff_t>(k * way.size() / 4),
                                                way.begin() + static_cast<std::ptrdiff_t>((k + 1) * way.size() / 4)),
                                 false, cv::Scalar(pens[k]), 3, cv::LINE_AA);
               },
               {90, 70});
  out.over_ros("frontiers in green and red", 1,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 for (int y = 1; y + 1 < m.rows; ++y)
                   for (int x = 1; x + 1 < m.cols; ++x) {
                     const auto at = [&](int u, int v) { return g[{u, g.height() - 1 - v}]; };
                     if (at(x, y) != Occupancy::Free) continue;
                     if (at(x + 1, y) == Occupancy::Unknown || at(x - 1, y) == Occupancy::Unknown ||
                         at(x, y + 1) == Occupancy::Unknown || at(x, y - 1) == Occupancy::Unknown)
                       m.at<Colour>(y, x) = x % 40 < 20 ? Colour(0, 200, 0) : Colour(0, 0, 220);
                   }
               },
               {85});
  out.over_ros("cloud of poses", 2,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 cv::RNG random(12);
                 for (int k = 0; k < 60; ++k) {
                   const P at = 2 * open_place(g, 4, k % 6) + P(random.uniform(-6, 7), random.uniform(-6, 7));
                   cv::arrowedLine(m, at, at + P(random.uniform(-6, 7), random.uniform(-6, 7)), {0, 0, 255}, 1,
                                   cv::LINE_AA, 0, 0.4);
                 }
               },
               {85});
  out.plain("dark theme", grey(230), {34, 30, 30}, {76, 70, 70}, 2, {90, 60});
  out.plain("white walls on black, grey free", kWhite, kBlack, grey(90), 2, {90, 60});
  out.add("see-through squares for unknown",
          [](const OccupancyGrid& g) {
            cv::Mat m = in_colours(g, kBlack, grey(1), grey(240), 2);
            for (int y = 0; y < m.rows; ++y)
              for (int x = 0; x < m.cols; ++x)
                if (m.at<Colour>(y, x) == grey(1)) m.at<Colour>(y, x) = (x / 8 + y / 8) % 2 == 0 ? grey(204) : kWhite;
            return m;
          },
          2.0, {85});
  out.plain("street map", grey(120), {223, 227, 229}, kWhite, 2, {90, 60});
  out.add("watermark",
          [](const OccupancyGrid& g) {
            cv::Mat m = in_ros_greys(g, 2), o = m.clone();
            write_on(o, "DRAFT", P(m.cols / 8, m.rows / 2), 3.0, grey(225), 8);
            cv::Mat walls;
            cv::inRange(m, cv::Scalar::all(0), cv::Scalar::all(0), walls);
            o.setTo(cv::Scalar(kBlack), walls);
            return o;
          },
          2.0, {85});
  out.page("scanned from paper",
           [](const OccupancyGrid& g) {
             Styled s = framed(in_ros_greys(g, 3), 3.0, 60, 60, 60, 60, kWhite);
             turn(s, 1.5, kWhite);
             cv::Mat noise(s.image.size(), CV_16SC3);
             cv::RNG random(4);
             random.fill(noise, cv::RNG::NORMAL, 0.0, 4.0);
             cv::multiply(s.image, cv::Scalar(0.9, 0.96, 1.0), s.image);
             cv::add(s.image, noise, s.image, cv::noArray(), CV_8UC3);
             return s;
           },
           {80});
  out.page("plot in greys with a colour bar",
           [](const OccupancyGrid& g) {
             const cv::Mat m = in_colours(g, kBlack, grey(128), kWhite, 2);
             Styled s = framed(m, 2.0, 50, 40, 90, 40, kWhite);
             cv::rectangle(s.image, P(49, 39), P(50 + m.cols, 40 + m.rows), cv::Scalar(kBlack), 1);
             for (int y = 0; y < m.rows; ++y)
               cv::line(s.image, P(65 + m.cols, 40 + y), P(80 + m.cols, 40 + y),
                        cv::Scalar(grey(255 - 255 * y / m.rows)));
             return s;
           },
           {85});
  const std::vector<std::pair<const char*, int>> schemes{
      {"plasma", cv::COLORMAP_PLASMA}, {"magma", cv::COLORMAP_MAGMA},     {"hot", cv::COLORMAP_HOT},
      {"bone", cv::COLORMAP_BONE},     {"cool", cv::COLORMAP_COOL},       {"parula", cv::COLORMAP_PARULA},
      {"turbo", cv::COLORMAP_TURBO},   {"cividis", cv::COLORMAP_CIVIDIS}, {"pink", cv::COLORMAP_PINK},
      {"summer", cv::COLORMAP_SUMMER}};
  for (const auto& [name, map] : schemes) {
    const int which = map;
    out.add(std::string("plot scheme ") + name,
            [=](const OccupancyGrid& g) {
              cv::Mat o;
              cv::applyColorMap(greyed(in_colours(g, kWhite, grey(128), kBlack, 2)), o, which);
              return o;
            },
            2.0, {90});
  }
  return out.all;
}

}  // namespace rubble::scoring::testing
