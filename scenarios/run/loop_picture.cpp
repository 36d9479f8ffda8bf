#include "scenarios/run/loop_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/image/legend.h"
#include "base/planar.h"
#include "base/round_step.h"
#include "scoring/maps/known_box.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using slam::FoundLoop;
using LoopInk = cv::Vec3b;  ///< blue, green, red

constexpr int kTestsHeight = 180;  ///< [pixels]
constexpr int kTestsLeft = 50, kTestsRight = 20, kTestsTop = 34, kTestsBelow = 44;
constexpr int kLeastTests = 700;  ///< width of the picture [pixels]
constexpr int kThickWall = 3;     ///< of the walls where a cell is a pixel [pixels]
constexpr double kLoopRim = 0.5;  ///< around all that is known [m]
const LoopInk kGround(255, 255, 255), kDark(226, 226, 226), kWall(130, 100, 70), kWay(200, 170, 190);

/// Told apart also by the colour-blind (Okabe and Ito). What was refused is drawn first, what holds over it.
struct EndStyle {
  const char* end;
  LoopInk ink;
  const char* words;
};
const std::array<EndStyle, 7> kEnds{{{"unfit", {190, 190, 190}, "unfit"},
                                     {"needless", {233, 180, 86}, "needless (the null test)"},
                                     {"ambiguous", {66, 228, 240}, "ambiguous"},
                                     {"contradicted", {0, 159, 230}, "contradicted (seen through)"},
                                     {"waits", {167, 121, 204}, "waits for others"},
                                     {"removed", {0, 94, 213}, "removed again"},
                                     {"closed", {115, 158, 0}, "closed"}}};

/// The part of the map that is known.
GridFrame known_frame(const slam::CountMap& map) {
  const double cell = map.frame().resolution;
  const scoring::KnownBox box = scoring::known_box(map.frame(), kLoopRim, [&](Cell c) { return map.seen(c) > 0; });
  return {static_cast<int>(std::lround((box.x1 - box.x0) / cell)),
          static_cast<int>(std::lround((box.y1 - box.y0) / cell)), cell, box.x0, box.y0};
}

/// The map from above, north up.
class Ground {
 public:
  explicit Ground(const slam::CountMap& map) : frame_(known_frame(map)), scale_(pixels_per_cell(frame_)) {
    const OccupancyGrid known = map.classify();
    cv::Mat cells(frame_.height, frame_.width, CV_8UC3, cv::Scalar(kDark));
    cv::Mat walls(cells.size(), CV_8UC1, cv::Scalar(0));
    for (int y = 0; y < frame_.height; ++y)
      for (int x = 0; x < frame_.width; ++x) {
        const Occupancy here = occupancy_at(known, frame_.centre({x, y}));
        if (here == Occupancy::Unknown) continue;
        cells.at<cv::Vec3b>(frame_.height - 1 - y, x) = kGround;
        if (here == Occupancy::Occupied) walls.at<std::uint8_t>(frame_.height - 1 - y, x) = 255;
      }
    // A building is looked at scaled down, where lines of one pixel vanish.
    if (scale_ == 1) cv::dilate(walls, walls, cv::Mat::ones(kThickWall, kThickWall, CV_8UC1));
    cells.setTo(cv::Scalar(kWall), walls);
    cv::resize(cells, picture_, {}, scale_, scale_, cv::INTER_NEAREST);
  }

  const GridFrame& frame() const { return frame_; }
  int scale() const { return scale_; }
  cv::Mat& picture() { return picture_; }
  cv::Point at(const TPoint2D& p) const {
    const double pixels = scale_ / frame_.resolution;
    return {static_cast<int>(std::floor((p.x - frame_.x0) * pixels)),
            frame_.height * scale_ - 1 - static_cast<int>(std::floor((p.y - frame_.y0) * pixels))};
  }

 private:
  GridFrame frame_;
  int scale_;
  cv::Mat picture_;
};

/// Where the older place lies: where that is not known, where the loop itself says.
TPoint2D older_place(const FoundLoop& loop, const TPose2D& T_map_to) {
  return position(loop.T_map_from ? *loop.T_map_from : T_map_to + (TPose2D() - loop.T_from_to));
}

void draw_loops(const slam::Mapper& mapper, const std::vector<FoundLoop>& loops, Ground& ground) {
  for (std::size_t i = 1; i < mapper.trajectory().size(); ++i)
    cv::line(ground.picture(), ground.at(position(mapper.trajectory()[i - 1].pose)),
             ground.at(position(mapper.trajectory()[i].pose)), cv::Scalar(kWay), 1, cv::LINE_AA);
  for (const EndStyle& style : kEnds)
    for (const FoundLoop& loop : loops) {
      if (loop.end != style.end) continue;
      const std::optional<TPose2D> to = mapper.pose_at(loop.to);
      if (!to) continue;
      const cv::Point newer = ground.at(position(*to));
      cv::line(ground.picture(), newer, ground.at(older_place(loop, *to)), cv::Scalar(style.ink), 2, cv::LINE_AA);
      cv::circle(ground.picture(), newer, 3, cv::Scalar(style.ink), cv::FILLED, cv::LINE_AA);
    }
}

std::vector<LegendEntry> legend_of(const std::vector<FoundLoop>& loops) {
  std::vector<LegendEntry> entries;
  for (auto style = kEnds.rbegin(); style != kEnds.rend(); ++style) {
    const auto n = std::count_if(loops.begin(), loops.end(), [&](const FoundLoop& l) { return l.end == style->end; });
    if (n > 0) entries.push_back({style->ink, std::string(style->words) + cv::format(": %d", static_cast<int>(n))});
  }
  entries.push_back({kWay, "way driven; a dot is the newer place"});
  return entries;
}

/// One test's value over the time of the newer place; what a loop was not asked is not drawn.
struct TestSeries {
  const char* words;
  std::optional<double> FoundLoop::*value;
  LoopInk ink;
  Sign sign;
};
const std::array<TestSeries, 3> kTests{
    {{"inliers", &FoundLoop::inliers, {178, 114, 0}, Sign::Dot},
     {"contradiction there", &FoundLoop::contradiction, {0, 94, 213}, Sign::Cross},
     {"contradiction where the robot was expected", &FoundLoop::expected_contradiction, {90, 90, 90}, Sign::Ring}}};

void draw_mark(cv::Mat& picture, const cv::Point& at, const TestSeries& test) {
  const cv::Scalar ink(test.ink);
  if (test.sign == Sign::Dot) return cv::circle(picture, at, 3, ink, cv::FILLED, cv::LINE_AA);
  if (test.sign == Sign::Ring) return cv::circle(picture, at, 4, ink, 1, cv::LINE_AA);
  cv::drawMarker(picture, at, ink, cv::MARKER_TILTED_CROSS, 7, 1, cv::LINE_AA);
}

/// Over all scans, from the first to the last.
cv::Mat tests_picture(const slam::Mapper& mapper, const std::vector<FoundLoop>& loops, int width) {
  const Trajectory& scans = mapper.trajectory();
  const Stamp first = scans.empty() ? loops.front().to : std::min(loops.front().to, scans.front().stamp);
  const Stamp last = scans.empty() ? loops.back().to : std::max(loops.back().to, scans.back().stamp);
  const double seconds = std::max(1e-3, last - first);
  cv::Mat picture(kTestsTop + kTestsHeight + kTestsBelow, width, CV_8UC3, cv::Scalar(255, 255, 255));
  const int across = width - kTestsLeft - kTestsRight, bottom = kTestsTop + kTestsHeight;
  const cv::Scalar faint(235, 235, 235);
  for (int k = 0; k <= 4; ++k) {
    const int y = bottom - k * kTestsHeight / 4;
    cv::line(picture, {kTestsLeft, y}, {kTestsLeft + across, y}, faint);
    const std::string words = cv::format("%.2g", 0.25 * k);
    draw_text(picture, words, kTestsLeft - 6 - text_width(words), y + 4);
  }
  const double step = round_step(80.0 * seconds / across);
  for (int k = 0; k * step <= seconds; ++k) {
    const int x = kTestsLeft + static_cast<int>(std::lround(k * step / seconds * across));
    cv::line(picture, {x, kTestsTop}, {x, bottom + 5}, faint);
    const std::string words = cv::format("%.6g", k * step);
    draw_text(picture, words, x - text_width(words) / 2, bottom + 18);
  }
  draw_text(picture, "tests [share of the points] over the newer place's time [s]", kTestsLeft, bottom + 38);
  for (const TestSeries& test : kTests)
    for (const FoundLoop& loop : loops) {
      const std::optional<double>& value = loop.*test.value;
      if (!value) continue;
      const double share = std::clamp((loop.to - first) / seconds, 0.0, 1.0);
      draw_mark(picture,
                {kTestsLeft + static_cast<int>(std::lround(share * across)),
                 bottom - static_cast<int>(std::lround(std::clamp(*value, 0.0, 1.0) * kTestsHeight))},
                test);
    }
  std::vector<LegendEntry> entries;
  for (const TestSeries& test : kTests) entries.push_back({test.ink, test.words, test.sign});
  int x = kTestsLeft;
  for (const StripItem& item : legend_items(picture, entries)) {
    item.draw(x, kTestsTop / 2);
    x += item.width + 14;
  }
  return picture;
}

}  // namespace

cv::Mat loop_picture(const slam::Mapper& mapper, const std::vector<FoundLoop>& loops) {
  Ground ground(mapper.map());
  draw_loops(mapper, loops, ground);
  cv::Mat& picture = ground.picture();
  put_axes(picture, ground.frame(), ground.scale());
  if (picture.cols < kLeastTests)
    cv::copyMakeBorder(picture, picture, 0, 0, 0, kLeastTests - picture.cols, cv::BORDER_CONSTANT,
                       cv::Scalar(255, 255, 255));
  draw_legend(picture, legend_of(loops), ground.frame(), ground.scale());
  cv::Mat whole;
  cv::vconcat(picture, tests_picture(mapper, loops, picture.cols), whole);
  return whole;
}

}  // namespace rubble::scenarios
