#pragma once

#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/map_styles.h"

/// Pictures of which a part of the map is lost, or nearly so: costs around walls, drawings over them, words in their
/// colour, few colours, colour scales through JPEG, faint greys. Readers read them rightly or say what is doubtful.
namespace rubble::scoring::testing {

/// Costs around walls as costmap_2d (ROS) computes them: 100 in walls, 99 up to the robot's inscribed radius, from
/// there on falling exponentially.
struct Inflation {
  double inscribed = 0.2;  ///< [m]
  double radius = 0.55;    ///< [m]
  double decay = 10.0;     ///< cost_scaling_factor [1/m]
  int cost_at(double metres) const {
    if (metres <= 0.0) return 100;
    if (metres <= inscribed) return 99;
    return metres > radius ? 0 : static_cast<int>(98.0 * std::exp(-decay * (metres - inscribed)));
  }
};

/// `colour_of(cost)`, -1 in unknown ground.
template <class ColourOf>
cv::Mat costmap(const OccupancyGrid& g, int scale, const Inflation& inflation, const ColourOf& colour_of) {
  cv::Mat out = in_ros_greys(g, scale), walls, far;
  cv::inRange(out, cv::Scalar::all(0), cv::Scalar::all(0), walls);
  cv::distanceTransform(~walls, far, cv::DIST_L2, 5);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      Colour& c = out.at<Colour>(y, x);
      const double metres = static_cast<double>(far.at<float>(y, x)) * g.resolution() / scale;
      c = colour_of(c == grey(205) ? -1 : inflation.cost_at(metres));
    }
  return out;
}

/// RViz's palette of costmaps.
inline Colour rviz_cost(int cost) {
  if (cost < 0) return {134, 137, 112};
  if (cost == 0) return kBlack;
  if (cost == 99) return {255, 255, 0};
  if (cost == 100) return {255, 0, 255};
  const int red = 255 * cost / 100;
  return {static_cast<unsigned char>(255 - red), 0, static_cast<unsigned char>(red)};
}

/// From one open place to the next, over whatever lies between.
inline std::vector<P> way_over_walls(const OccupancyGrid& g, int scale, int first) {
  std::vector<P> out;
  P from = scale * open_place(g, 4, first % 6);
  for (int k = 1; k < 7; ++k) {
    const P to = scale * (open_place(g, 4, (first + 2 * k) % 6) + P(k * 7 % 11 - 5, k * 5 % 9 - 4));
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps;
      const double swing = 4.0 * scale * std::sin(6.28 * t);
      out.push_back(from + P(static_cast<int>(t * (to.x - from.x) + swing), static_cast<int>(t * (to.y - from.y))));
    }
    from = to;
  }
  return out;
}

inline void add_costmaps(Styles& out) {
  for (const auto& [name, inflation] : std::vector<std::pair<std::string, Inflation>>{
           {"narrow", {0.15, 0.55, 10.0}}, {"wide", {0.1, 0.7, 3.0}}, {"flat", {0.12, 1.2, 2.0}}})
    for (const int scale : {1, 2}) {
      const Inflation i = inflation;
      const std::string kind = name;  // no compiler of C++17 need let a binding be captured
      const auto add = [&](const std::string& what, const auto& colour_of) {
        out.add("costs " + what + ", " + kind + (scale > 1 ? ", twice" : ""),
                [=](const OccupancyGrid& g) { return costmap(g, scale, i, colour_of); }, scale, {85});
      };
      add("in rviz", rviz_cost);
      add("over a map in rviz", [](int cost) {
        const Colour below = cost < 0 ? Colour(134, 137, 112) : cost == 100 ? kBlack : grey(230);
        const Colour own = rviz_cost(cost);
        Colour mixed = below;
        for (int k = 0; k < 3 && cost > 0; ++k)
          mixed[k] = cv::saturate_cast<unsigned char>(0.6 * own[k] + 0.4 * below[k]);
        return mixed;
      });
      add("in greys", [](int cost) { return cost < 0 ? grey(205) : grey(254 - 254 * cost / 100); });
      add("in greys, walls apart", [](int cost) {
        return cost < 0 ? grey(205) : cost == 100 ? kBlack : cost == 99 ? grey(75) : grey(254 - 90 * cost / 100);
      });
    }
}

inline void add_hidden_walls(Styles& out) {
  for (const auto& [name, colour] : std::vector<std::pair<std::string, Colour>>{
           {"red", {0, 0, 255}}, {"teal", {128, 128, 0}}, {"purple", {160, 20, 90}}, {"orange", {0, 140, 255}}})
    for (const int pen : {1, 3}) {
      const cv::Scalar ink(colour);
      const std::string what = name + ", pen " + std::to_string(pen);
      out.add("way over walls, " + what,
              [=](const OccupancyGrid& g) {
                cv::Mat m = in_ros_greys(g, 2);
                cv::polylines(m, way_over_walls(g, 2, pen), false, ink, pen, cv::LINE_AA);
                return m;
              },
              2.0, {90, 70});
      out.add("way over walls in rviz, " + what,
              [=](const OccupancyGrid& g) {
                cv::Mat m = in_colours(g, kBlack, {134, 137, 112}, grey(230), 2);
                cv::polylines(m, way_over_walls(g, 2, pen + 1), false, ink, pen, cv::LINE_AA);
                return m;
              },
              2.0, {90, 70});
    }
}

inline void add_words(Styles& out) {
  const std::vector<std::string> words{"Lab 4", "kitchen", "START", "goal 2"};
  for (const int scale : {2, 3})
    for (const int line : {cv::LINE_AA, cv::LINE_8}) {
      const std::string how = std::string(line == cv::LINE_AA ? ", smooth" : "") + ", x" + std::to_string(scale);
      const auto name = [=](cv::Mat m, const OccupancyGrid& g, const Colour& c) {
        for (int k = 0; k < 4; ++k)
          write_on(m, words[static_cast<std::size_t>(k)], scale * open_place(g, 8, k) - P(7 * scale, -3 * scale),
                   0.17 * scale, c, 1, line);
        return m;
      };
      out.add("words in walls' black" + how,
              [=](const OccupancyGrid& g) { return name(in_ros_greys(g, scale), g, kBlack); }, scale, {90, 70});
      out.add("words in walls' blue" + how,
              [=](const OccupancyGrid& g) {
                cv::Mat m;
                cv::resize(league_image(g, true), m, {}, scale, scale, cv::INTER_NEAREST);
                return name(m, g, {120, 40, 0});
              },
              scale, {90, 70});
    }
}

inline std::vector<Style> hard_styles() {
  Styles out;
  add_costmaps(out);
  add_hidden_walls(out);
  add_words(out);
  for (const int colours : {4, 6, 10})
    for (const bool searched : {false, true})
      out.add("own palette of " + std::to_string(colours) + (searched ? ", searched" : ""),
              [=](const OccupancyGrid& g) {
                const cv::Mat m = league_image(g, true);
                return with_own_palette(searched ? with_searched_floor(m, 0.7) : m, colours);
              });
  for (const auto& [name, map] : std::vector<std::pair<std::string, int>>{{"turbo", cv::COLORMAP_TURBO},
                                                                          {"jet", cv::COLORMAP_JET},
                                                                          {"inferno", cv::COLORMAP_INFERNO},
                                                                          {"winter", cv::COLORMAP_WINTER},
                                                                          {"twilight", cv::COLORMAP_TWILIGHT}})
    for (const bool reversed : {false, true}) {
      const int which = map;
      out.add("colour scale " + name + (reversed ? ", reversed" : ""),
              [=](const OccupancyGrid& g) {
                cv::Mat m;
                const Colour low = grey(8), high = grey(247);
                cv::applyColorMap(greyed(in_colours(g, reversed ? low : high, grey(122), reversed ? high : low, 2)), m,
                                  which);
                return m;
              },
              2.0, {90, 70});
    }
  for (const auto& [wall, unknown, free] :
       {std::array{90, 140, 190}, {110, 150, 180}, {80, 100, 130}, {150, 130, 90}}) {
    const int w = wall, u = unknown, f = free;
    out.add("faint greys " + std::to_string(w),
            [=](const OccupancyGrid& g) { return in_colours(g, grey(w), grey(u), grey(f)); }, 1.0, {90, 70});
  }
  return out.all;
}

}  // namespace rubble::scoring::testing
