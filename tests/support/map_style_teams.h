#pragma once

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/map_style_hard.h"
#include "tests/support/map_styles.h"

/// What the tools of teams save: plots, views, windows, maps of probability, of time and of height, layers without
/// ground. Made when the readers stood.
namespace rubble::scoring::testing {

/// Smooth noise, -1 to 1: what a scanner saw more or less often.
inline cv::Mat waves(const cv::Size& size, double pixels, int seed) {
  cv::Mat coarse(static_cast<int>(size.height / pixels) + 3, static_cast<int>(size.width / pixels) + 3, CV_32F), out;
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(coarse, cv::RNG::UNIFORM, -1.0, 1.0);
  cv::resize(coarse, out, {}, pixels, pixels, cv::INTER_CUBIC);
  return out(cv::Rect({0, 0}, size)).clone();
}

/// Ticks and numbers along the lower and the left side of what was set into a page at (left, top).
inline void draw_axes(cv::Mat& page, const P& left_top, const cv::Size& size, int step, const Colour& ink) {
  const P low(left_top.x, left_top.y + size.height);
  cv::rectangle(page, left_top - P(1, 1), left_top + P(size.width, size.height), cv::Scalar(ink), 1);
  for (int x = 0; x < size.width; x += step) {
    cv::line(page, low + P(x, 1), low + P(x, 5), cv::Scalar(ink), 1);
    write_on(page, std::to_string(x / 20), low + P(x - 5, 18), 0.35, ink);
  }
  for (int y = 0; y < size.height; y += step) {
    cv::line(page, left_top + P(-6, y), left_top + P(-2, y), cv::Scalar(ink), 1);
    write_on(page, std::to_string(y / 20), left_top + P(-30, y + 4), 0.35, ink);
  }
}

/// By how much a picture's sides grow, at a factor that may be any.
inline cv::Mat at_scale(const cv::Mat& image, double scale, int how) {
  cv::Mat out;
  cv::resize(image, out, {}, scale, scale, how);
  return out;
}

inline void add_plots(Styles& out) {
  out.page("plot at 1.7 pixels a cell",
           [](const OccupancyGrid& g) {
             const cv::Mat m = at_scale(in_ros_greys(g), 1.7, cv::INTER_NEAREST);
             Styled s = framed(m, 1.7, 60, 40, 20, 40, kWhite);
             draw_axes(s.image, P(60, 40), m.size(), 68, kBlack);
             write_on(s.image, "t = 312 s, 87 % explored", P(90, 25), 0.5, kBlack);
             return s;
           },
           {85, 60});
  out.page("heat map with a colour bar",
           [](const OccupancyGrid& g) {
             const cv::Mat m = in_colours(g, {26, 10, 3}, {79, 27, 203}, {221, 235, 250}, 2);  // rocket
             Styled s = framed(m, 2.0, 50, 20, 80, 40, kWhite);
             const P bar(m.cols + 65, 20);
             for (int y = 0; y < m.rows; ++y) {
               const double t = static_cast<double>(y) / m.rows;
               const cv::Scalar c = t < 0.5
                                        ? (1 - 2 * t) * cv::Scalar(221, 235, 250) + 2 * t * cv::Scalar(79, 27, 203)
                                        : (2 - 2 * t) * cv::Scalar(79, 27, 203) + (2 * t - 1) * cv::Scalar(26, 10, 3);
               cv::line(s.image, bar + P(0, y), bar + P(12, y), c);
             }
             for (int k = 0; k <= 4; ++k)
               write_on(s.image, std::to_string(25 * k), bar + P(16, m.rows - k * m.rows / 4), 0.35, kBlack);
             draw_axes(s.image, P(50, 20), m.size(), 60, kBlack);
             return s;
           },
           {85, 60});
  out.page("plot with dashed grid and numbers over the map",
           [](const OccupancyGrid& g) {
             const cv::Mat m = in_ros_greys(g, 3);
             Styled s = framed(m, 3.0, 50, 30, 20, 40, kWhite);
             for (int x = 0; x < m.cols; x += 60)
               for (int y = 0; y < m.rows; y += 6)
                 cv::line(s.image, P(50 + x, 30 + y), P(50 + x, 33 + y), {176, 176, 176});
             for (int y = 0; y < m.rows; y += 60)
               for (int x = 0; x < m.cols; x += 6)
                 cv::line(s.image, P(50 + x, 30 + y), P(53 + x, 30 + y), {176, 176, 176});
             draw_axes(s.image, P(50, 30), m.size(), 60, kBlack);
             return s;
           },
           {85, 60});
}

inline void add_views(Styles& out) {
  out.page("view with its grid over the map, axes and footprint",
           [](const OccupancyGrid& g) {
             cv::Mat m = in_colours(g, kBlack, {134, 137, 112}, grey(230), 2), lines = m.clone();
             for (int x = 5; x < m.cols; x += 40) cv::line(lines, P(x, 0), P(x, m.rows), {164, 160, 160}, 1);
             for (int y = 5; y < m.rows; y += 40) cv::line(lines, P(0, y), P(m.cols, y), {164, 160, 160}, 1);
             cv::addWeighted(lines, 0.5, m, 0.5, 0.0, m);
             const P at = 2 * open_place(g, 7, 2);
             cv::rectangle(m, at - P(8, 6), at + P(8, 6), {0, 200, 0}, 1);
             cv::line(m, at, at + P(10, 2), {0, 0, 255}, 2, cv::LINE_AA);
             cv::line(m, at, at + P(2, -10), {0, 255, 0}, 2, cv::LINE_AA);
             return framed(m, 2.0, 30, 60, 90, 30, {48, 48, 48});
           },
           {85, 60});
  out.page("dark panel, white free, grey unknown",
           [](const OccupancyGrid& g) {
             cv::Mat m = in_colours(g, kBlack, grey(128), kWhite, 2);
             Styled s = framed(m, 2.0, 40, 70, 40, 40, {26, 21, 21});
             for (int x = 0; x < s.image.cols; x += 40)
               for (int y = 0; y < s.image.rows; ++y) {
                 Colour& c = s.image.at<Colour>(y, x);
                 for (int k = 0; k < 3; ++k)
                   c[k] = static_cast<unsigned char>(0.8 * c[k] + 0.2 * Colour(255, 142, 36)[k]);
               }
             cv::rectangle(s.image, P(0, 0), P(s.image.cols, 30), {52, 45, 45}, cv::FILLED);
             write_on(s.image, "3D   /map   120.4 s", P(12, 20), 0.45, grey(220));
             return s;
           },
           {85, 60});
  out.page("window at 1.6 pixels a cell, smoothed",
           [](const OccupancyGrid& g) {
             const cv::Mat m = at_scale(in_ros_greys(g), 1.6, cv::INTER_LINEAR);
             Styled s = framed(m, 1.6, 1, 64, 1, 24, {200, 200, 200});
             cv::rectangle(s.image, P(0, 0), P(s.image.cols, 32), {60, 59, 55}, cv::FILLED);
             write_on(s.image, "map.pgm (384x384)", P(60, 21), 0.45, grey(240));
             for (int k = 0; k < 3; ++k)
               cv::circle(s.image, P(14 + 18 * k, 16), 6, {60, 90, 230}, cv::FILLED, cv::LINE_AA);
             cv::rectangle(s.image, P(0, 32), P(s.image.cols, 64), {240, 240, 240}, cv::FILLED);
             write_on(s.image, "File  Edit  View  Zoom 160 %", P(10, 53), 0.45, kBlack);
             write_on(s.image, "Ready", P(8, s.image.rows - 8), 0.4, kBlack);
             return s;
           },
           {85, 60});
  out.over_ros("pointer and a dashed selection", 2,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 const P at = 2 * open_place(g, 8, 3);
                 const std::vector<P> pointer{
                     at, at + P(0, 14), at + P(4, 11), at + P(7, 17), at + P(9, 16), at + P(6, 10), at + P(11, 10)};
                 cv::fillPoly(m, std::vector<std::vector<P>>{pointer}, cv::Scalar(kWhite));
                 cv::polylines(m, pointer, true, cv::Scalar(kBlack), 1);
                 for (int x = 8; x + 4 < m.cols - 8; x += 8)
                   for (const int y : {8, m.rows - 9}) cv::line(m, P(x, y), P(x + 3, y), cv::Scalar(kBlack));
                 for (int y = 8; y + 4 < m.rows - 8; y += 8)
                   for (const int x : {8, m.cols - 9}) cv::line(m, P(x, y), P(x, y + 3), cv::Scalar(kBlack));
               },
               {85});
}

inline void add_marks(Styles& out) {
  out.over_ros("logo, team's name and a scale bar of checks in the unknown", 2,
               [](cv::Mat& m, const OccupancyGrid&) {
                 cv::circle(m, P(13, 13), 10, {30, 120, 240}, cv::FILLED, cv::LINE_AA);
                 cv::circle(m, P(13, 13), 5, cv::Scalar(kWhite), cv::FILLED, cv::LINE_AA);
                 write_on(m, "Team Rubble", P(28, 16), 0.4, kBlack);
                 for (int k = 0; k < 4; ++k)
                   cv::rectangle(m, P(10 + 20 * k, m.rows - 10), P(29 + 20 * k, m.rows - 6),
                                 cv::Scalar(k % 2 == 0 ? kBlack : kWhite), cv::FILLED);
                 cv::rectangle(m, P(9, m.rows - 11), P(90, m.rows - 5), cv::Scalar(kBlack), 1);
               },
               {85, 60});
  out.over_ros("circles and names of victims in red", 2,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 for (int k = 0; k < 4; ++k) {
                   const P at = 2 * open_place(g, 7, k);
                   cv::circle(m, at, 7, {30, 30, 230}, 2, cv::LINE_AA);
                   write_on(m, "V" + std::to_string(k), at + P(9, 4), 0.35, {30, 30, 230});
                 }
               },
               {85, 60});
  out.over_ros("rooms' areas written in grey", 3,
               [](cv::Mat& m, const OccupancyGrid& g) {
                 for (int k = 0; k < 4; ++k)
                   write_on(m, std::to_string(3 + k) + ".4 m2", 3 * open_place(g, 8, k) - P(20, -4), 0.4, grey(90));
               },
               {85, 60});
  out.over_ros("stamp across the map, half transparent", 2,
               [](cv::Mat& m, const OccupancyGrid&) {
                 cv::Mat o = m.clone();
                 write_on(o, "RUBBLE", P(m.cols / 10, m.rows / 2 + 20), 2.4, {200, 120, 60}, 6);
                 cv::addWeighted(o, 0.3, m, 0.7, 0.0, m);
               },
               {85});
  out.add("league with numbers of symbols and a way all over",
          [](const OccupancyGrid& g) {
            cv::Mat m = at_scale(league_image(g, true), 2.0, cv::INTER_NEAREST);
            cv::polylines(m, way_of(g, 2), false, {140, 0, 120}, 2, cv::LINE_AA);
            for (int k = 0; k < 4; ++k) {
              const P at = 2 * open_place(g, 6, k);
              cv::circle(m, at, 7, {10, 10, 240}, cv::FILLED, cv::LINE_AA);
              write_on(m, std::to_string(k + 1), at - P(4, -4), 0.35, kWhite);
            }
            return m;
          },
          2.0, {85, 60});
}

inline void add_small_words(Styles& out) {
  const std::vector<std::string> words{"exit", "Ramp 2", "LAB", "base"};
  const auto league = [](const OccupancyGrid& g, int scale) {
    return at_scale(league_image(g, true), scale, cv::INTER_NEAREST);
  };
  const auto ros = [](const OccupancyGrid& g, int scale) { return in_ros_greys(g, scale); };
  const auto rviz = [](const OccupancyGrid& g, int scale) {
    return in_colours(g, kBlack, {134, 137, 112}, grey(230), scale);
  };
  const auto add = [&](const std::string& name, const auto& draw, const Colour& pen) {
    for (const int scale : {2, 3})
      for (const int line : {cv::LINE_AA, cv::LINE_8})
        out.add("small words, " + name + (line == cv::LINE_AA ? ", smooth" : "") + ", x" + std::to_string(scale),
                [=](const OccupancyGrid& g) {
                  cv::Mat m = draw(g, scale);
                  for (int k = 0; k < 4; ++k)
                    write_on(m, words[static_cast<std::size_t>(k)],
                             scale * open_place(g, 8, k) - P(6 * scale, -2 * scale), 0.13 * scale, pen, 1, line);
                  return m;
                },
                scale, {95, 75});
  };
  add("black", ros, kBlack);
  add("black in rviz", rviz, kBlack);
  add("the walls' blue", league, {120, 40, 0});
  add("black on league", league, kBlack);
}

inline void add_quantities(Styles& out) {
  // Each pixel's probability by how often it was seen; unknown ground 128.
  const auto probabilities = [](const OccupancyGrid& g, int scale, double spread) {
    const cv::Mat base = in_colours(g, kBlack, grey(128), kWhite, scale), seen = waves(base.size(), 9.0 * scale, 5);
    cv::Mat m(base.size(), CV_8UC3);
    for (int y = 0; y < m.rows; ++y)
      for (int x = 0; x < m.cols; ++x) {
        const int b = base.at<Colour>(y, x)[0];
        const double s = 0.5 + 0.5 * static_cast<double>(seen.at<float>(y, x));
        m.at<Colour>(y, x) = grey(b == 128 ? 128
                                  : b == 0 ? static_cast<int>(5 + spread * 55 * s)
                                           : static_cast<int>(250 - spread * 70 * s));
      }
    return m;
  };
  for (const int scale : {1, 2})
    out.add("probabilities by sightings, x" + std::to_string(scale),
            [=](const OccupancyGrid& g) { return probabilities(g, scale, 1.0); }, scale, {85, 60});
  out.add("probabilities in viridis",
          [=](const OccupancyGrid& g) {
            cv::Mat m;
            cv::applyColorMap(probabilities(g, 2, 0.6), m, cv::COLORMAP_VIRIDIS);
            return m;
          },
          2.0, {85});
  // Free ground in colours of when it was seen, of its kind, of its height.
  const auto over_free = [](const OccupancyGrid& g, int scale, const Colour& wall, const Colour& unknown,
                            const auto& colour_of) {
    cv::Mat m = in_colours(g, wall, unknown, kWhite, scale);
    const cv::Mat w = waves(m.size(), 0.4 * m.cols, 9);
    for (int y = 0; y < m.rows; ++y)
      for (int x = 0; x < m.cols; ++x) {
        Colour& c = m.at<Colour>(y, x);
        if (c == kWhite) c = colour_of(std::clamp(0.5 + 0.5 * static_cast<double>(w.at<float>(y, x)), 0.0, 1.0));
      }
    return m;
  };
  const auto of_time = [](double t) {
    return Colour(static_cast<unsigned char>(255 * (1 - t)), static_cast<unsigned char>(90 + 60 * t),
                  static_cast<unsigned char>(255 * t));
  };
  const auto pale_time = [](double t) {
    return Colour(static_cast<unsigned char>(255 - 60 * t), 235, static_cast<unsigned char>(195 + 60 * t));
  };
  out.add("free ground by the time it was seen",
          [=](const OccupancyGrid& g) { return over_free(g, 2, kBlack, grey(205), of_time); }, 2.0, {85});
  out.add("free ground by the time it was seen, pale",
          [=](const OccupancyGrid& g) { return over_free(g, 2, kBlack, grey(205), pale_time); }, 2.0, {85});
  out.add("free ground by its kind",
          [=](const OccupancyGrid& g) {
            return over_free(g, 2, kBlack, grey(190), [](double t) {
              return t < 0.4 ? Colour(245, 245, 245) : t < 0.6 ? Colour(90, 220, 250) : Colour(80, 160, 245);
            });
          },
          2.0, {85});
  out.add("free ground by its height in greys",
          [=](const OccupancyGrid& g) {
            return over_free(g, 2, kBlack, grey(60), [](double t) { return grey(static_cast<int>(150 + 105 * t)); });
          },
          2.0, {85});
  out.add("walls by their place in a rainbow",
          [](const OccupancyGrid& g) {
            cv::Mat m = in_ros_greys(g, 2), hue(m.size(), CV_8U), rainbow;
            for (int x = 0; x < m.cols; ++x) hue.col(x) = cv::Scalar(255.0 * x / m.cols);
            cv::applyColorMap(hue, rainbow, cv::COLORMAP_JET);
            cv::Mat walls;
            cv::inRange(m, cv::Scalar::all(0), cv::Scalar::all(0), walls);
            rainbow.copyTo(m, walls);
            return m;
          },
          2.0, {85});
  out.add("points of walls on black, by height",
          [](const OccupancyGrid& g) {
            cv::Mat m = in_colours(g, grey(1), kBlack, kBlack, 2);
            cv::RNG random(21);
            for (int y = 0; y < m.rows; ++y)
              for (int x = 0; x < m.cols; ++x) {
                Colour& c = m.at<Colour>(y, x);
                if (c == grey(1))
                  c = random.uniform(0, 5) < 4 ? Colour(40, static_cast<unsigned char>(random.uniform(90, 255)), 230)
                                               : kBlack;
              }
            return m;
          },
          2.0, {85});
}

inline void add_layers(Styles& out) {
  const auto layer = [](const OccupancyGrid& g, int wall, int unknown, int free, int under) {
    // Opacity of each class; colours as ROS draws them where it is opaque.
    const cv::Mat m = in_ros_greys(g, 2);
    cv::Mat o(m.size(), CV_8UC4);
    for (int y = 0; y < m.rows; ++y)
      for (int x = 0; x < m.cols; ++x) {
        const int c = m.at<Colour>(y, x)[0];
        const int a = c == 0 ? wall : c == 205 ? unknown : free;
        const auto shown = static_cast<unsigned char>(a == 0 ? under : c);
        o.at<cv::Vec4b>(y, x) = {shown, shown, shown, static_cast<unsigned char>(a)};
      }
    return o;
  };
  out.add(
      "layer, unknown transparent black", [=](const OccupancyGrid& g) { return layer(g, 255, 0, 255, 0); }, 2.0);
  out.add(
      "layer, unknown transparent white", [=](const OccupancyGrid& g) { return layer(g, 255, 0, 255, 255); }, 2.0);
  out.add(
      "layer, free transparent black", [=](const OccupancyGrid& g) { return layer(g, 255, 255, 0, 0); }, 2.0);
  out.add(
      "layer, free transparent white", [=](const OccupancyGrid& g) { return layer(g, 255, 255, 0, 255); }, 2.0);
  out.add(
      "layer, walls alone opaque", [=](const OccupancyGrid& g) { return layer(g, 255, 0, 0, 0); }, 2.0);
  out.add(
      "layer, all half transparent", [=](const OccupancyGrid& g) { return layer(g, 178, 178, 178, 0); }, 2.0);
  out.add(
      "layer, all a third opaque", [=](const OccupancyGrid& g) { return layer(g, 85, 85, 85, 0); }, 2.0);
  for (const double factor : {0.37, 0.55})
    out.add("five to one, made smaller by " + std::to_string(factor).substr(0, 4),
            [=](const OccupancyGrid& g) {
              cv::Mat o;
              cv::resize(in_ros_greys(g, 5), o, {}, factor, factor, cv::INTER_LINEAR);
              return o;
            },
            5.0 * factor, {85, 60});
}

/// League maps whose tones a program changed.
inline void add_gammas(Styles& out) {
  for (const double power : {0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.2})
    for (const bool searched : {false, true})
      for (const bool drawings : {false, true})
        out.add("league of gamma " + std::to_string(power).substr(0, 4) + (searched ? ", searched" : "") +
                    (drawings ? ", drawings" : ""),
                [=](const OccupancyGrid& g) {
                  const cv::Mat m = at_scale(league_image(g, drawings), 2.0, cv::INTER_NEAREST);
                  cv::Mat curve(1, 256, CV_8U), o;
                  for (int i = 0; i < 256; ++i)
                    curve.at<unsigned char>(i) = cv::saturate_cast<unsigned char>(255.0 * std::pow(i / 255.0, power));
                  cv::LUT(searched ? with_searched_floor(m, 0.7) : m, curve, o);
                  return o;
                },
                2.0, {90, 60});
}

/// League maps whose contrast and brightness a program changed, so that white was clipped or not.
inline void add_contrasts(Styles& out) {
  for (const auto& [gain, offset] : {std::pair{1.0, 10.0}, {1.05, -2.0}, {1.2, -30.0}, {0.9, 10.0}})
    for (const bool searched : {false, true})
      for (const bool drawings : {false, true})
        out.add("league of contrast " + std::to_string(gain).substr(0, 4) + " and brightness " +
                    std::to_string(static_cast<int>(offset)) + (searched ? ", searched" : "") +
                    (drawings ? ", drawings" : ""),
                [=, by = gain, more = offset](const OccupancyGrid& g) {
                  const cv::Mat m = at_scale(league_image(g, drawings), 2.0, cv::INTER_NEAREST);
                  cv::Mat o;
                  (searched ? with_searched_floor(m, 0.7) : m).convertTo(o, CV_8U, by, more);
                  return o;
                },
                2.0, {90, 60});
}

inline std::vector<Style> styles_of_teams() {
  Styles out;
  add_plots(out);
  add_views(out);
  add_marks(out);
  add_small_words(out);
  add_quantities(out);
  add_layers(out);
  add_gammas(out);
  add_contrasts(out);
  return out.all;
}

}  // namespace rubble::scoring::testing
