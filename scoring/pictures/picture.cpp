#include "scoring/pictures/picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "base/image/png.h"
#include "base/planar.h"
#include "base/text/text_file.h"
#include "scoring/pictures/canvas.h"
#include "scoring/pictures/labels.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kAgree = 0.05;         // walls this near count as the same in the overlay [m]
constexpr double kNear = 0.15;          // walls this near as displaced [m]
const Colour kDoubtful(110, 110, 110);  // victims of which nothing says whether they are right

/// From green to the colour of a wall that only one of the maps has: red for the map's (phantom), blue for the truth's
/// (missing), so that nobody takes one for the other.
Colour heat(double share, const Colour& only) {
  const double t = std::clamp(share, 0.0, 1.0);
  const Colour good(40, 160, 40);
  const Colour middle = mixed(mixed(good, only, 0.5), Colour(160, 235, 235), 0.6);
  return t < 0.5 ? mixed(good, middle, 2.0 * t) : mixed(middle, only, 2.0 * t - 1.0);
}

/// From a point to the edge of the nearest wall cell [m], as the score has it.
double to_wall(const WallField& field, const TPoint2D& p, const OccupancyGrid& grid) {
  return std::max(0.0, field.distance(p) - 0.5 * grid.resolution());
}

/// The centre of the cell of `grid` that p lies in: a wall's cell has one colour, as the score asks it at one place.
TPoint2D centre_of_cell(const OccupancyGrid& grid, const TPoint2D& p) { return grid.centre(grid.cell(p)); }

/// How a wall `off` metres from the nearest of the other map is drawn.
Colour wall_colour(double off, const Colour& only) { return off <= kAgree ? kInk : off <= kNear ? kDisplaced : only; }

/// Walls of the map that lie where the truth knows nothing: lines of sight and overlap do not count them, for nobody
/// can say whether they are phantoms. So legends, axes, names and arrows beside a drawing are not shown as wrong walls.
bool is_judged(Occupancy truth, double off) { return truth != Occupancy::Unknown || off <= kNear; }

Colour background(Occupancy map, Occupancy truth) {
  const bool map_known = map != Occupancy::Unknown;
  const bool truth_known = truth != Occupancy::Unknown;
  if (map_known && truth_known) return kBothFree;
  return map_known ? kMapFree : truth_known ? kTruthFree : kUnknown;
}

/// What is not coloured by a distance.
const std::vector<LegendEntry> kGrounds = {
    {kNotJudged, "not judged"}, {kMapFree, "seen by map only"}, {kTruthFree, "not seen by map"}};

void draw_heat_bar(Canvas& canvas, double tau) {
  std::vector<StripItem> items;
  for (const bool of_map : {true, false}) {
    const std::string least = of_map ? "map's wall off: 0" : "truth's wall off: 0";
    const std::string most = cv::format("%.2g m: ", tau) + (of_map ? "phantom" : "missing");
    items.push_back(bar_item(canvas.image, least, most,
                             [of_map](double share) { return bgr_of(heat(share, of_map ? kMapOnly : kTruthOnly)); }));
  }
  for (StripItem& item : legend_items(canvas.image, kGrounds)) items.push_back(std::move(item));
  put_strip(canvas.image, items, canvas.frame, canvas.scale);
}

void draw_cross(cv::Mat& image, const cv::Point& at, int reach, const Colour& colour, int width) {
  cv::line(image, at - cv::Point(reach, reach), at + cv::Point(reach, reach), cv::Scalar(colour), width, cv::LINE_AA);
  cv::line(image, at - cv::Point(reach, -reach), at + cv::Point(reach, -reach), cv::Scalar(colour), width, cv::LINE_AA);
}

/// Victims that are reported where the picture does not reach.
int reported_outside(const Canvas& canvas, const Marks& marks, const TPose2D& T_truth_map) {
  const cv::Rect picture(0, 0, canvas.image.cols, canvas.image.rows);
  int out = 0;
  for (const std::vector<Mark>* all : {&marks.map_only, &marks.unjudged})
    for (const Mark& mark : *all) out += picture.contains(canvas.pixel(T_truth_map.composePoint(mark.p))) ? 0 : 1;
  return out;
}

/// At a pose that is not trusted nobody knows which of them were found: all are grey, and said by name only. So are
/// those that nothing says anything of.
void draw_victims(Canvas& canvas, const Marks& marks, const TPose2D& T_truth_map, bool trusted) {
  constexpr int kRing = 8, kDot = 3;
  const Colour found = trusted ? kFound : kDoubtful;
  Labels names(canvas.image.size());
  const auto ring = [&](const cv::Point& at, const Colour& colour, const std::string& name) {
    cv::circle(canvas.image, at, kRing, cv::Scalar(colour), 2, cv::LINE_AA);
    names.add(name, at, kRing + 1);
  };
  const auto dot = [&](const cv::Point& at, const Colour& colour, const std::string& name) {
    cv::circle(canvas.image, at, kDot, cv::Scalar(colour), cv::FILLED, cv::LINE_AA);
    names.add(name, at, kDot);
  };
  for (const auto& [map, truth] : marks.pairs) {
    const cv::Point reported = canvas.pixel(T_truth_map.composePoint(map.p));
    const cv::Point there = canvas.pixel(truth.p);
    if (trusted) cv::line(canvas.image, reported, there, cv::Scalar(found), 1, cv::LINE_AA);
    ring(there, found, trusted ? joined_name(map, truth) : truth.name);
    dot(reported, found, trusted ? "" : map.name);
  }
  for (const Mark& missed : marks.truth_only)
    ring(canvas.pixel(missed.p), trusted ? kTruthOnly : kDoubtful, missed.name + (trusted ? " missed" : ""));
  for (const Mark& reported : marks.unjudged)
    dot(canvas.pixel(T_truth_map.composePoint(reported.p)), kDoubtful, reported.name + ", not judged");
  for (const Mark& wrong : marks.map_only) {
    const cv::Point at = canvas.pixel(T_truth_map.composePoint(wrong.p));
    if (!trusted) {
      dot(at, kDoubtful, wrong.name);
      continue;
    }
    draw_cross(canvas.image, at, kRing - 2, kMapOnly, 2);
    names.add(wrong.name + " false", at, kRing);
  }
  draw_labels(canvas.image, names);
}

/// What draw_victims() has drawn.
std::vector<LegendEntry> victim_entries(const Marks& marks, bool trusted) {
  std::vector<LegendEntry> entries;
  const auto add = [&](bool drawn, const Colour& colour, const char* words, Sign sign) {
    if (drawn) entries.emplace_back(colour, words, sign);
  };
  const bool any = !marks.pairs.empty() || !marks.map_only.empty() || !marks.truth_only.empty();
  add(trusted && !marks.pairs.empty(), kFound, "victim found = true one", Sign::Ring);
  add(trusted && !marks.truth_only.empty(), kTruthOnly, "true victim missed", Sign::Ring);
  add(trusted && !marks.map_only.empty(), kMapOnly, "false victim", Sign::Cross);
  add(!marks.unjudged.empty() || (!trusted && any), kDoubtful, "victim not judged", Sign::Dot);
  return entries;
}

/// Dashes, so that nobody takes it for a wall.
void draw_seam(Canvas& canvas, const std::pair<TPoint2D, TPoint2D>& seam) {
  constexpr double kDash = 9.0;  // [pixels]
  const cv::Point2d a = canvas.pixel(seam.first);
  const cv::Point2d b = canvas.pixel(seam.second);
  const double length = cv::norm(b - a);
  for (double at = 0.0; at < length; at += 2.0 * kDash)
    cv::line(canvas.image, a + (b - a) * (at / length), a + (b - a) * (std::min(length, at + kDash) / length),
             cv::Scalar(kSeam), 3, cv::LINE_AA);
}

TPoint2D middle_of(const OccupancyGrid& grid) {
  const GridFrame f = known_frame(grid, 0.0).value_or(grid.frame());
  return {f.x0 + 0.5 * f.width * f.resolution, f.y0 + 0.5 * f.height * f.resolution};
}

TPose2D middle_on_middle(const OccupancyGrid& map, const OccupancyGrid& truth) {
  const TPoint2D shift = middle_of(truth) - middle_of(map);
  return {shift.x, shift.y, 0.0};
}

/// Paints the ground, and walls as `wall` says, which is given a place in both maps and what either map has there.
template <class Wall>
void paint(Canvas& canvas, const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
           const Wall& wall) {
  const PlanarTransform T(T_truth_map);
  for (int row = 0; row < canvas.map_rows(); ++row) {
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const TPoint2D p_truth = canvas.point(column, row);
      const TPoint2D p_map = T.inverse(p_truth);
      const Occupancy in_map = occupancy_at(map, p_map);
      const Occupancy in_truth = occupancy_at(truth, p_truth);
      Colour& colour = canvas.image.at<Colour>(row, column);
      colour = background(in_map, in_truth);
      wall(p_map, in_map, p_truth, in_truth, colour);
    }
  }
}

}  // namespace

std::string overlay_png(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                        const std::string& warning, const Marks& marks) {
  Canvas canvas(common_frame(map, truth, T_truth_map, 0.5));
  const WallField to_map(map, 0.5);
  const WallField to_truth(truth, 0.5);
  paint(canvas, map, truth, T_truth_map,
        [&](const TPoint2D& p_map, Occupancy in_map, const TPoint2D& p_truth, Occupancy in_truth, Colour& colour) {
          if (in_truth == Occupancy::Occupied)
            colour = wall_colour(to_wall(to_map, T_truth_map.inverseComposePoint(centre_of_cell(truth, p_truth)), map),
                                 kTruthOnly);
          if (in_map != Occupancy::Occupied || colour == kInk) return;
          const double off = to_wall(to_truth, T_truth_map.composePoint(centre_of_cell(map, p_map)), truth);
          colour = is_judged(in_truth, off) ? wall_colour(off, kMapOnly) : kNotJudged;
        });
  if (marks.seam) draw_seam(canvas, *marks.seam);
  const int outside = reported_outside(canvas, marks, T_truth_map);
  draw_victims(canvas, marks, T_truth_map, warning.empty());
  draw_warning(canvas, warning);
  std::vector<LegendEntry> legend = {{kInk, "walls within 5 cm"},
                                     {kDisplaced, "within 15 cm"},
                                     {kMapOnly, "only in map"},
                                     {kTruthOnly, "only in truth"}};
  legend.insert(legend.end(), kGrounds.begin(), kGrounds.end());
  for (LegendEntry& entry : victim_entries(marks, warning.empty())) legend.push_back(std::move(entry));
  if (outside > 0) {
    const bool are_false = warning.empty() && marks.unjudged.empty();
    legend.push_back({are_false ? kMapOnly : kDoubtful,
                      cv::format("%d %sreported outside the picture", outside, are_false ? "false, " : "")});
  }
  if (marks.seam) legend.push_back({kSeam, "seam of two parts"});
  draw_legend(canvas.image, legend, canvas.frame, canvas.scale);
  return png_bytes(canvas.image);
}

void write_overlay(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                   const TPose2D& T_truth_map, const std::string& warning, const Marks& marks) {
  write_text_file(path, overlay_png(map, truth, T_truth_map, warning, marks));
}

std::string error_map_png(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                          double tau) {
  Canvas canvas(common_frame(map, truth, T_truth_map, 0.5));
  const WallField to_map(map, tau);
  const WallField to_truth(truth, tau);
  paint(canvas, map, truth, T_truth_map,
        [&](const TPoint2D& p_map, Occupancy in_map, const TPoint2D& p_truth, Occupancy in_truth, Colour& colour) {
          if (in_truth == Occupancy::Occupied)
            colour = heat(to_wall(to_map, T_truth_map.inverseComposePoint(centre_of_cell(truth, p_truth)), map) / tau,
                          kTruthOnly);
          else if (in_map == Occupancy::Occupied) {
            const double off = to_wall(to_truth, T_truth_map.composePoint(centre_of_cell(map, p_map)), truth);
            colour = is_judged(in_truth, off) ? heat(off / tau, kMapOnly) : kNotJudged;
          }
        });
  draw_heat_bar(canvas, tau);
  return png_bytes(canvas.image);
}

void write_error_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const TPose2D& T_truth_map, double tau) {
  write_text_file(path, error_map_png(map, truth, T_truth_map, tau));
}

void write_side_by_side(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                        const std::optional<TPose2D>& pose, const Marks& marks, const std::string& warning) {
  constexpr int kGap = 24;  // [pixels]
  const TPose2D T_truth_map = pose ? *pose : middle_on_middle(map, truth);
  // Both panes show the same piece of the plane, so that a shift of a partner is a shift in the picture.
  Canvas pane(common_frame(map, truth, T_truth_map, 0.5));
  const int rows = pane.map_rows();
  const int columns = pane.map_columns();
  Canvas both = pane;
  both.image = cv::Mat(rows, std::max(2 * columns + kGap, kLeastWidth), CV_8UC3, cv::Scalar(kUnknown));
  const auto plain = [](Occupancy o) {
    return o == Occupancy::Free ? kBothFree : o == Occupancy::Occupied ? kInk : kUnknown;
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const TPoint2D p_truth = pane.point(column, row);
      both.image.at<Colour>(row, column) = plain(occupancy_at(map, T_truth_map.inverseComposePoint(p_truth)));
      both.image.at<Colour>(row, columns + kGap + column) = plain(occupancy_at(truth, p_truth));
    }
  both.image(cv::Rect(columns, 0, kGap, rows)).setTo(cv::Scalar(250, 250, 250));
  const cv::Point east(columns + kGap, 0);
  const auto on_map = [&](const TPoint2D& p) { return pane.pixel(T_truth_map.composePoint(p)); };
  const auto on_truth = [&](const TPoint2D& p) { return pane.pixel(p) + east; };
  const auto draw_box = [&](const Mark& mark, const cv::Scalar& colour, const auto& place) {
    if (!mark.box) return;
    const auto& [low, high] = *mark.box;
    const std::vector<cv::Point> corners = {place(low), place({high.x, low.y}), place(high), place({low.x, high.y})};
    cv::polylines(both.image, corners, true, colour, 1, cv::LINE_AA);
  };
  for (std::size_t i = 0; i < marks.pairs.size(); ++i) {
    const auto& [of_map, of_truth] = marks.pairs[i];
    // Hues a golden angle apart.
    cv::Mat hue(1, 1, CV_8UC3, cv::Scalar(static_cast<double>(i * 68 % 180), 220, 190));
    cv::cvtColor(hue, hue, cv::COLOR_HSV2BGR);
    const cv::Scalar colour(hue.at<Colour>(0, 0));
    const cv::Point a = on_map(of_map.p);
    const cv::Point b = on_truth(of_truth.p);
    cv::line(both.image, a, b, colour, 1, cv::LINE_AA);
    for (const cv::Point& p : {a, b}) cv::circle(both.image, p, 4, colour, 2, cv::LINE_AA);
    draw_box(of_map, colour, on_map);
    draw_box(of_truth, colour, on_truth);
    if (!of_map.name.empty()) draw_text(both.image, of_map.name, a.x + 7, a.y - 5);
    if (!of_truth.name.empty()) draw_text(both.image, of_truth.name, b.x + 7, b.y - 5);
  }
  for (const Mark& mark : marks.map_only) {
    draw_cross(both.image, on_map(mark.p), 4, kMapOnly, 1);
    draw_box(mark, cv::Scalar(kMapOnly), on_map);
    draw_text(both.image, mark.name, on_map(mark.p).x + 7, on_map(mark.p).y - 5);
  }
  for (const Mark& mark : marks.truth_only) {
    draw_cross(both.image, on_truth(mark.p), 4, kTruthOnly, 1);
    draw_box(mark, cv::Scalar(kTruthOnly), on_truth);
    draw_text(both.image, mark.name, on_truth(mark.p).x + 7, on_truth(mark.p).y - 5);
  }
  draw_warning(both, warning);
  if (marks.what.empty())
    draw_legend(both.image, {{kInk, "left: the map, right: the truth"}}, both.frame, both.scale);
  else
    draw_legend(both.image,
                {{kInk, cv::format("%s: %zu matched, each pair in one colour", marks.what.c_str(), marks.pairs.size())},
                 {kMapOnly, cv::format("%zu of the map alone", marks.map_only.size())},
                 {kTruthOnly, cv::format("%zu of the truth alone", marks.truth_only.size())}},
                both.frame, both.scale);
  write_png(path, both.image);
}

}  // namespace rubble::scoring
