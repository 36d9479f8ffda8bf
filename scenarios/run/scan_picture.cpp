#include "scenarios/run/scan_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/image/legend.h"
#include "base/round_step.h"

namespace rubble::scenarios {
namespace {

using CurveInk = cv::Vec3b;  ///< blue, green, red

constexpr int kCurve = 1000;   ///< width of the curves [pixels]
constexpr int kMeanOver = 4;   ///< a step of the line of means [pixels]
constexpr int kLeftEdge = 80;  ///< for the values
constexpr int kRightEdge = 20;
constexpr int kPanelHeight = 84;
constexpr int kDoubtHeight = 22;  ///< of a row of ticks
constexpr int kTitle = 24;        ///< above a panel
constexpr int kApart = 12;        ///< below it
constexpr int kAxis = 50;         ///< for the times and a line of words

/// Told apart also by the colour-blind (Okabe and Ito).
const std::vector<CurveInk> kInks = {{178, 114, 0}, {0, 94, 213}, {115, 158, 0}, {167, 121, 204}, {0, 159, 230}};

/// Columns that are drawn together.
struct Panel {
  std::string title;
  std::string unit;
  std::vector<std::string> columns;
  double factor = 1.0;  ///< of the unit in that of the columns
  double high = 0.0;    ///< of the scale; 0: as the values have it
  bool doubts = false;  ///< columns of 0 and 1, of which the ones are seldom
  bool counts = false;  ///< whole numbers that only grow: the last ones are told
};

const std::vector<Panel> kPanels = {
    {"points that lie on a surface of the map, and points in front of what it saw",
     "share of the scan",
     {"inliers", "contradiction"},
     1.0,
     1.0},
    {"how far the points that lie on a surface are off it, RMS", "mm", {"residual_m"}, 1000.0},
    {"beams with a return, of these beyond the range or on the floor, points that found a surface",
     "a scan",
     {"beams", "beams_rejected", "paired"}},
    {"odometry against match", "squared sigmas", {"odometry_chi2"}},
    {"doubts: the odometry, a leap that is not believed yet, the place",
     "ticks: scans",
     {"slipped", "held", "lost"},
     1.0,
     1.0,
     true},
    {"place on the map of an earlier run", "1: known", {"place_known"}, 1.0, 1.0},
    {"work for the scan, counted, not timed", "ms", {"work_ms"}},
    {"uncertainty of the place", "m, 1 sigma", {"sigma_x_m", "sigma_y_m"}},
    {"uncertainty of the heading", "deg, 1 sigma", {"sigma_heading_deg"}},
    {"how these uncertainties go together", "correlation", {"rho_x_y", "rho_x_heading", "rho_y_heading"}, 1.0, 1.0},
    {"size of the graph, and places looked at for loops",
     "count so far",
     {"key_frames", "near_edges", "loops_searched"},
     1.0,
     0.0,
     false,
     true},
    {"loops",
     "count so far",
     {"loops_closed", "loops_removed", "loops_ambiguous", "loops_contradicted", "loops_needless"},
     1.0,
     0.0,
     false,
     true}};

/// The values of one column in each column of pixels.
struct Series {
  struct Span {
    double least = 0.0, most = 0.0, sum = 0.0;
    int n = 0;
  };
  std::string name;
  std::vector<Span> spans;
  double low = 0.0, high = 0.0;
  std::size_t ones = 0;  ///< scans above a half
};

Series series_of(const slam::ScanRecords& records, std::size_t column, double factor) {
  Series out;
  out.name = records.columns[column];
  out.spans.resize(kCurve);
  const double time = std::max(1e-9, records.stamps.back() - records.stamps.front());
  for (std::size_t i = 0; i < records.stamps.size(); ++i) {
    const double value = factor * static_cast<double>(records.values[i * records.columns.size() + column]);
    if (!std::isfinite(value)) continue;
    const double at = (records.stamps[i] - records.stamps.front()) / time * (kCurve - 1);
    Series::Span& span = out.spans[static_cast<std::size_t>(std::clamp(at, 0.0, kCurve - 1.0))];
    span.least = span.n == 0 ? value : std::min(span.least, value);
    span.most = span.n == 0 ? value : std::max(span.most, value);
    span.sum += value;
    ++span.n;
    out.low = std::min(out.low, value);
    out.high = std::max(out.high, value);
    out.ones += value > 0.5 ? 1 : 0;
  }
  return out;
}

/// Zero is always in sight.
struct Scale {
  double low = 0.0, high = 1.0, step = 0.5;
  bool cut = false;  ///< few values are above
};

/// A single peak does not flatten all else: a scale ends where one in a hundred pixels is higher, if the peak is more
/// than three times that.
Scale scale_of(const std::vector<Series>& all, const Panel& panel) {
  Scale out;
  std::vector<double> peaks;
  double most = 0.0;
  for (const Series& series : all) {
    out.low = std::min(out.low, series.low);
    most = std::max(most, series.high);
    for (const Series::Span& span : series.spans)
      if (span.n > 0) peaks.push_back(span.most);
  }
  if (panel.high > 0.0) most = panel.high;
  if (!peaks.empty() && panel.high == 0.0) {
    const auto usual = peaks.begin() + static_cast<std::ptrdiff_t>((peaks.size() - 1) * 99 / 100);
    std::nth_element(peaks.begin(), usual, peaks.end());
    out.cut = *usual > 0.0 && most > 3.0 * *usual;
    if (out.cut) most = 1.2 * *usual;
  }
  if (most <= out.low) most = out.low + 1.0;
  out.step = round_step(std::max((most - out.low) / 4.0, panel.counts ? 1.0 : 0.0));
  out.high = panel.high > 0.0 ? most : out.step * std::ceil(most / out.step - 1e-9);
  out.low = out.step * std::floor(out.low / out.step + 1e-9);
  return out;
}

CurveInk pale(const CurveInk& ink) {
  CurveInk out;
  for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<std::uint8_t>(0.35 * ink[i] + 0.65 * 255.0);
  return out;
}

void draw_curve(cv::Mat& picture, const Series& series, const Scale& scale, const CurveInk& ink, int top) {
  const auto row = [&](double value) {
    const double share = std::clamp((value - scale.low) / (scale.high - scale.low), 0.0, 1.0);
    return top + kPanelHeight - 1 - static_cast<int>(std::lround(share * (kPanelHeight - 2)));
  };
  for (int x = 0; x < kCurve; ++x)
    if (const Series::Span& span = series.spans[static_cast<std::size_t>(x)]; span.n > 0)
      cv::line(picture, {kLeftEdge + x, row(span.least)}, {kLeftEdge + x, row(span.most)}, cv::Scalar(pale(ink)));
  cv::Point last(-1, 0);
  for (int x = 0; x < kCurve; x += kMeanOver) {
    double sum = 0.0;
    int n = 0;
    for (int k = x; k < std::min(kCurve, x + kMeanOver); ++k) {
      sum += series.spans[static_cast<std::size_t>(k)].sum;
      n += series.spans[static_cast<std::size_t>(k)].n;
    }
    if (n == 0) continue;
    const cv::Point now(kLeftEdge + x + kMeanOver / 2, row(sum / n));
    cv::line(picture, last.x < 0 ? now : last, now, cv::Scalar(ink), 1, cv::LINE_AA);
    last = now;
  }
}

void draw_values(cv::Mat& picture, const Scale& scale, int top) {
  for (double value = scale.low; value <= scale.high + 1e-6 * scale.step; value += scale.step) {
    const double share = (value - scale.low) / (scale.high - scale.low);
    const int y = top + kPanelHeight - 1 - static_cast<int>(std::lround(share * (kPanelHeight - 2)));
    cv::line(picture, {kLeftEdge, y}, {kLeftEdge + kCurve, y}, cv::Scalar(235, 235, 235));
    const std::string words = cv::format("%.4g", value + 0.0);
    draw_text(picture, words, kLeftEdge - 6 - text_width(words), std::clamp(y + 4, top + 6, top + kPanelHeight));
  }
}

void draw_doubts(cv::Mat& picture, const std::vector<Series>& all, int top) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int y = top + static_cast<int>(i) * kDoubtHeight;
    cv::line(picture, {kLeftEdge, y + kDoubtHeight}, {kLeftEdge + kCurve, y + kDoubtHeight}, cv::Scalar(235, 235, 235));
    for (int x = 0; x < kCurve; ++x)
      if (all[i].spans[static_cast<std::size_t>(x)].most > 0.5)
        cv::rectangle(picture, {kLeftEdge + x, y + 4}, {kLeftEdge + x + 1, y + kDoubtHeight - 2}, cv::Scalar(kInks[i]),
                      cv::FILLED);
    draw_text(picture, all[i].name, kLeftEdge - 6 - text_width(all[i].name), y + kDoubtHeight - 6);
  }
}

/// Title at the left, the names of the columns at the right; a column that is zero all the time says so.
void draw_title(cv::Mat& picture, const Panel& panel, const std::vector<Series>& all, const Scale& scale, int top) {
  double most = 0.0;
  for (const Series& series : all) most = std::max(most, series.high);
  const std::string beyond = scale.cut ? cv::format(", highest %.4g", most) : "";
  draw_text(picture, panel.title + (panel.unit.empty() ? "" : " [" + panel.unit + beyond + "]"), kLeftEdge, top - 7);
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_zero = all[i].high == 0.0 && all[i].low == 0.0;
    const std::string told = panel.doubts              ? cv::format(": %zu", all[i].ones)
                             : panel.counts || is_zero ? cv::format(": %.0f", all[i].high)
                                                       : "";
    entries.push_back({kInks[i % kInks.size()], all[i].name + told});
  }
  std::vector<StripItem> items = legend_items(picture, entries);
  int x = kLeftEdge + kCurve;
  for (const StripItem& item : items) x -= item.width + 12;
  for (const StripItem& item : items) {
    item.draw(x + 12, top - 12);
    x += item.width + 12;
  }
}

/// A scale of seconds below the panels, with a faint line up through them at each number.
void draw_axis(cv::Mat& picture, double seconds, int bottom) {
  constexpr int kTicksApart = 80, kTick = 5;  // [pixels]
  const double pixels = (kCurve - 1) / seconds;
  const double step = round_step(kTicksApart / pixels);
  for (int k = 0; k * step <= seconds; ++k) {
    const int x = kLeftEdge + static_cast<int>(std::lround(k * step * pixels));
    cv::line(picture, {x, bottom}, {x, bottom + kTick}, cv::Scalar(kInkBgr[0], kInkBgr[1], kInkBgr[2]));
    const std::string words = cv::format("%.6g", k * step);
    draw_text(picture, words, x - text_width(words) / 2, bottom + kTick + 13);
  }
  draw_text(picture, "time [s]", kLeftEdge - 16 - text_width("time [s]"), bottom + kTick + 13);
}

void draw_seconds(cv::Mat& picture, double seconds, int top, int height) {
  const double pixels = (kCurve - 1) / seconds;
  const double step = round_step(80 / pixels);
  for (int k = 0; k * step <= seconds; ++k) {
    const int x = kLeftEdge + static_cast<int>(std::lround(k * step * pixels));
    cv::line(picture, {x, top}, {x, top + height}, cv::Scalar(235, 235, 235));
  }
}

/// Those that the records have columns for, and one for each column that none of them has.
std::vector<Panel> panels_of(const slam::ScanRecords& records) {
  std::vector<Panel> out;
  const auto is_there = [&](const std::string& name) {
    return std::find(records.columns.begin(), records.columns.end(), name) != records.columns.end();
  };
  for (Panel panel : kPanels) {
    auto& columns = panel.columns;
    columns.erase(std::remove_if(columns.begin(), columns.end(), [&](const auto& name) { return !is_there(name); }),
                  columns.end());
    if (!columns.empty()) out.push_back(std::move(panel));
  }
  for (const std::string& name : records.columns)
    if (std::none_of(out.begin(), out.end(), [&](const Panel& panel) {
          return std::find(panel.columns.begin(), panel.columns.end(), name) != panel.columns.end();
        }))
      out.push_back({name, "", {name}});
  return out;
}

int height_of(const Panel& panel) {
  return panel.doubts ? static_cast<int>(panel.columns.size()) * kDoubtHeight : kPanelHeight;
}

}  // namespace

cv::Mat scan_picture(const slam::ScanRecords& records) {
  const std::vector<Panel> panels = panels_of(records);
  int bottom = 0;
  for (const Panel& panel : panels) bottom += kTitle + height_of(panel) + kApart;
  const double seconds = std::max(1e-9, records.stamps.back() - records.stamps.front());
  cv::Mat picture(bottom + kAxis, kLeftEdge + kCurve + kRightEdge, CV_8UC3, cv::Scalar(255, 255, 255));
  int top = 0;
  for (const Panel& panel : panels) {
    top += kTitle;
    const int height = height_of(panel);
    std::vector<Series> all;
    for (const std::string& name : panel.columns) {
      const auto at = std::find(records.columns.begin(), records.columns.end(), name) - records.columns.begin();
      all.push_back(series_of(records, static_cast<std::size_t>(at), panel.factor));
    }
    const Scale scale = scale_of(all, panel);
    draw_seconds(picture, seconds, top, height);
    cv::rectangle(picture, {kLeftEdge, top}, {kLeftEdge + kCurve, top + height}, cv::Scalar(190, 190, 190));
    if (panel.doubts) {
      draw_doubts(picture, all, top);
    } else {
      draw_values(picture, scale, top);
      for (std::size_t i = 0; i < all.size(); ++i) draw_curve(picture, all[i], scale, kInks[i % kInks.size()], top);
    }
    draw_title(picture, panel, all, scale, top);
    top += height + kApart;
  }
  draw_axis(picture, seconds, bottom);
  draw_text(picture,
            cv::format("%zu scans; pale: from the least to the greatest value of the scans in a pixel, line: their "
                       "mean; each value is in scans.csv",
                       records.stamps.size()),
            8, picture.rows - 10);
  return picture;
}

}  // namespace rubble::scenarios
