#include "scenarios/run/film.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/grid.h"
#include "base/image/legend.h"
#include "base/planar.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPoint2D;

constexpr int kPanelSide = 360;       ///< longer side of a frame [pixels]
constexpr std::size_t kLines = 3;     ///< that are written below it
constexpr int kLineHeight = 17;       ///< [pixels]
constexpr int kCaption = 57;          ///< height of all lines [pixels]
constexpr int kBetween = 10;          ///< two frames [pixels]
constexpr double kRim = 0.3;          ///< around all that is known [m]
constexpr double kArrow = 0.35;       ///< length of the robot [m]
constexpr double kLetterWidth = 7.4;  ///< [pixels]
using Ink = cv::Vec3b;                ///< blue, green, red
const Ink kUnknownGround(226, 226, 226), kFreeGround(255, 255, 255), kSearchedGround(180, 230, 180),
    kWallInk(120, 40, 0), kWayInk(140, 0, 120), kPlanInk(60, 160, 0), kVictimInk(10, 10, 240), kRobotInk(0, 130, 255);

/// The ground that all frames show, and how large.
struct Stage {
  explicit Stage(const std::vector<FilmFrame>& frames) : cell(frames.back().map.frame().resolution) {
    for (const FilmFrame& frame : frames) {
      const GridFrame& f = frame.map.frame();
      if (f.resolution != cell) continue;
      const OccupancyGrid map = frame.map.unpacked();
      for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x)
          if (map[{x, y}] != Occupancy::Unknown) hold(map.centre({x, y}));
      for (const TPoint2D& p : frame.way) hold(p);
      hold(position(frame.pose));
    }
    low = low - TPoint2D(kRim, kRim);
    high = high + TPoint2D(kRim, kRim);
    scale = kPanelSide / std::max(high.x - low.x, high.y - low.y);
  }
  void hold(const TPoint2D& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  int width() const { return static_cast<int>(std::ceil((high.x - low.x) * scale)); }
  int height() const { return static_cast<int>(std::ceil((high.y - low.y) * scale)); }
  cv::Point at(const TPoint2D& p) const {
    return {static_cast<int>(std::floor((p.x - low.x) * scale)),
            height() - 1 - static_cast<int>(std::floor((p.y - low.y) * scale))};
  }

  TPoint2D low{1e9, 1e9};
  TPoint2D high{-1e9, -1e9};
  double cell;
  double scale = 1.0;  ///< [pixels/m]
};

/// The cells of one kind.
void draw_cells(const OccupancyGrid& map, Occupancy what, const Ink& ink, const Stage& stage, cv::Mat& panel) {
  const GridFrame& frame = map.frame();
  const auto corner = [&](int x, int y) {
    return stage.at({frame.x0 + x * frame.resolution, frame.y0 + y * frame.resolution});
  };
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != what) continue;
      // Corners are reckoned alike for both cells beside them: else rounding leaves gaps between.
      const cv::Point a = corner(x, y), b = corner(x + 1, y + 1);
      cv::rectangle(panel, a, {std::max(a.x, b.x - 1), std::min(a.y, b.y + 1)}, cv::Scalar(ink), cv::FILLED);
    }
}

/// Ground and walls. Where a pixel covers several cells, a wall among them is seen.
void draw_map(const FilmFrame& frame, const OccupancyGrid& map, const Stage& stage, cv::Mat& panel) {
  draw_cells(map, Occupancy::Free, kFreeGround, stage, panel);
  draw_cells(frame.searched.unpacked(), Occupancy::Occupied, kSearchedGround, stage, panel);
  draw_cells(map, Occupancy::Occupied, kWallInk, stage, panel);
}

void draw_line(const std::vector<TPoint2D>& points, const Stage& stage, const Ink& ink, cv::Mat& panel) {
  for (std::size_t i = 1; i < points.size(); ++i)
    cv::line(panel, stage.at(points[i - 1]), stage.at(points[i]), cv::Scalar(ink), 1, cv::LINE_AA);
}

void draw_robot(const mrpt::math::TPose2D& pose, const Stage& stage, cv::Mat& panel) {
  const auto corner = [&](double ahead, double left) {
    return stage.at(PlanarTransform(pose)(TPoint2D(ahead * kArrow, left * kArrow)));
  };
  const std::vector<cv::Point> arrow{corner(0.7, 0.0), corner(-0.5, 0.45), corner(-0.25, 0.0), corner(-0.5, -0.45)};
  cv::fillPoly(panel, std::vector<std::vector<cv::Point>>{arrow}, cv::Scalar(kRobotInk), cv::LINE_AA);
}

double known_ground(const OccupancyGrid& map) {
  const auto cells =
      std::count_if(map.cells().begin(), map.cells().end(), [](Occupancy c) { return c != Occupancy::Unknown; });
  return static_cast<double>(cells) * map.resolution() * map.resolution();
}

void write_below(const FilmFrame& frame, double known, int top, cv::Mat& panel) {
  char words[80];
  const std::size_t victims = frame.victims.size();
  std::snprintf(words, sizeof words, "%.0f s, %.0f m2, %zu victim%s confirmed", frame.time, known, victims,
                victims == 1 ? "" : "s");
  std::vector<std::string> lines{words};
  const auto fits = static_cast<std::size_t>(std::max(10.0, panel.cols / kLetterWidth));
  for (std::string why = frame.why; !why.empty() && lines.size() < kLines;) {
    const bool is_last = lines.size() + 1 == kLines;
    std::size_t end = why.size() <= fits ? why.size() : is_last ? fits - 2 : why.rfind(' ', fits);
    if (end == std::string::npos || end == 0) end = fits;
    lines.push_back(why.substr(0, end) + (is_last && end < why.size() ? ".." : ""));
    why.erase(0, std::min(why.size(), why[end] == ' ' ? end + 1 : end));
  }
  int y = top + 15;
  for (const std::string& line : lines) {
    draw_text(panel, line, 2, y);
    y += kLineHeight;
  }
}

cv::Mat panel_of(const FilmFrame& frame, const Stage& stage) {
  cv::Mat panel(stage.height() + kCaption, stage.width(), CV_8UC3, cv::Scalar(255, 255, 255));
  cv::Mat ground = panel.rowRange(0, stage.height());
  ground.setTo(cv::Scalar(kUnknownGround));
  const OccupancyGrid map = frame.map.unpacked();
  if (map.resolution() == stage.cell) draw_map(frame, map, stage, ground);
  draw_line(frame.way, stage, kWayInk, ground);
  draw_line(frame.plan, stage, kPlanInk, ground);
  for (const TPoint2D& victim : frame.victims)
    cv::circle(ground, stage.at(victim), std::max(3, static_cast<int>(0.15 * stage.scale)), cv::Scalar(kVictimInk),
               cv::FILLED, cv::LINE_AA);
  draw_robot(frame.pose, stage, ground);
  write_below(frame, known_ground(map), stage.height(), panel);
  return panel;
}

}  // namespace

cv::Mat film_strip(const std::vector<FilmFrame>& frames) {
  if (frames.empty()) return {};
  const Stage stage(frames);
  const auto count = static_cast<int>(frames.size());
  const int columns = count <= 3 ? count : static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  const int width = stage.width() + kBetween, height = stage.height() + kCaption + kBetween;
  cv::Mat strip(rows * height + kBetween, columns * width + kBetween, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 0; i < count; ++i) {
    const cv::Mat panel = panel_of(frames[static_cast<std::size_t>(i)], stage);
    panel.copyTo(strip({kBetween + i % columns * width, kBetween + i / columns * height, panel.cols, panel.rows}));
  }
  return strip;
}

cv::Mat film_picture(const std::vector<FilmFrame>& frames) {
  cv::Mat picture = film_strip(frames);
  if (frames.empty()) return picture;
  if (picture.cols < kLeastWidth)
    cv::copyMakeBorder(picture, picture, 0, 0, 0, kLeastWidth - picture.cols, cv::BORDER_CONSTANT,
                       cv::Scalar(255, 255, 255));
  draw_legend(picture,
              {{kWallInk, "wall"},
               {kFreeGround, "free floor"},
               {kSearchedGround, "searched for victims"},
               {kUnknownGround, "unknown"},
               {kWayInk, "way driven"},
               {kPlanInk, "plan"},
               {kRobotInk, "robot"},
               {kVictimInk, "victim confirmed"}},
              frame_of_pixels(Stage(frames).scale), 1);
  return picture;
}

void Film::see(const Core& core, const robot::Inputs& inputs, double share, double occupied_threshold) {
  now_ = inputs.now;
  if (first_ == Stamp::never()) first_ = now_;
  const auto taken = static_cast<double>(frames_.size());
  if (taken + 1.0 < wanted_ && share * wanted_ >= taken + 1.0) take(core, occupied_threshold);
}

void Film::end(const Core& core, double occupied_threshold) {
  if (wanted_ > 0) take(core, occupied_threshold);
}

namespace {

OccupancyGrid searched_ground(const explore::Explorer& explorer, const OccupancyGrid& map) {
  OccupancyGrid out(map.frame());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (map[{x, y}] == Occupancy::Free && explorer.searched(map.centre({x, y}))) out[{x, y}] = Occupancy::Occupied;
  return out;
}

}  // namespace

void Film::take(const Core& core, double occupied_threshold) {
  FilmFrame frame;
  frame.time = first_ == Stamp::never() ? 0.0 : now_ - first_;
  const OccupancyGrid map = core.mapper().map().classify(occupied_threshold);
  frame.map = map;
  for (const StampedPose& stamped : core.mapper().trajectory()) frame.way.push_back(position(stamped.pose));
  frame.pose = core.mapper().pose();
  for (const explore::VictimReport& victim : core.victims()) frame.victims.push_back(victim.p_map);
  if (const explore::Explorer* explorer = core.explorer()) {
    frame.searched = searched_ground(*explorer, map);
    frame.plan = explorer->path();
    if (!explorer->decisions().empty()) frame.why = explorer->decisions().back().why;
    if (explorer->finished()) frame.plan.clear();
  }
  frames_.push_back(std::move(frame));
}

}  // namespace rubble::scenarios
