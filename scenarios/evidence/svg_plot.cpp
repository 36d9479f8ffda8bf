#include "scenarios/evidence/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/round_step.h"
#include "base/text/html.h"
#include "scenarios/evidence/metrics.h"
#include "scenarios/evidence/statistics.h"

namespace rubble::scenarios {
namespace {

constexpr double kWidth = 900.0;
constexpr double kRow = 30.0;
constexpr double kBottom = 46.0;

// Okabe and Ito's colours, told apart by colour-blind readers too.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000", "#8c8c00"};

const char* colour(std::size_t i) { return kColours[i % (sizeof kColours / sizeof *kColours)]; }

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" " + style + "/>\n";
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" + escape_html(text) +
         "</text>\n";
}

std::string dot(double x, double y, const std::string& fill, const std::string& title) {
  return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"3.5\" fill=\"" + fill +
         "\" fill-opacity=\"0.55\"><title>" + escape_html(title) + "</title></circle>\n";
}

std::string svg(double height, const std::string& label, const std::string& content) {
  return "<svg viewBox=\"0 0 " + number(kWidth) + " " + number(height) + "\" width=\"" + number(kWidth) +
         "\" role=\"img\" aria-label=\"" + escape_html(label) + "\">\n" + content + "</svg>\n";
}

/// Maps numbers to pixels along one axis and knows its ticks.
struct Axis {
  double low = 0.0, high = 1.0, from = 0.0, to = 1.0;
  std::vector<double> marks;

  Axis(const std::vector<double>& values, double pixel_from, double pixel_to, int wanted)
      : from(pixel_from), to(pixel_to) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    marks = ticks(*least, *most, wanted);
    low = marks.front(), high = marks.back();
  }
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

std::string x_axis(const Axis& axis, double top, double bottom, const std::string& label) {
  std::string out;
  for (const double mark : axis.marks) {
    out += line(axis.at(mark), top, axis.at(mark), bottom, "stroke=\"#d8dee4\"");
    out += text_at(axis.at(mark), bottom + 16.0, "middle", figure(mark));
  }
  return out + text_at((axis.from + axis.to) / 2.0, bottom + 36.0, "middle", label);
}

/// Names of one sweep differ at their ends as often as at their heads: the middle is left out.
std::string shortened(const std::string& name, std::size_t most) {
  if (name.size() <= most) return name;
  const std::size_t head = (most - 3) / 3, tail = most - 3 - head;
  return name.substr(0, head) + "..." + name.substr(name.size() - tail);
}

}  // namespace

std::vector<double> ticks(double low, double high, int wanted) {
  if (!(high > low)) {
    const double room = std::max(std::abs(low) * 0.1, 0.1);
    low -= room, high += room;
  }
  const double step = round_step((high - low) / wanted);
  std::vector<double> marks;
  const auto first = static_cast<long>(std::floor(low / step + 1e-9)),
             last = static_cast<long>(std::ceil(high / step - 1e-9));
  for (long i = first; i <= last; ++i) marks.push_back(static_cast<double>(i) * step);
  return marks;
}

std::string strip_plot(const std::string& label, const std::vector<Strip>& strips) {
  std::vector<double> all;
  std::size_t longest = 0;
  for (const auto& strip : strips) {
    all.insert(all.end(), strip.values.begin(), strip.values.end());
    longest = std::max(longest, strip.name.size());
  }
  if (all.empty()) return "<p class=note>no numbers for " + escape_html(label) + "</p>\n";
  constexpr std::size_t kMostLetters = 52;
  const double left = 20.0 + 6.6 * static_cast<double>(std::min(longest, kMostLetters));
  const double bottom = 10.0 + kRow * static_cast<double>(strips.size());
  const Axis axis(all, left, kWidth - 20.0, 8);
  std::string out = x_axis(axis, 6.0, bottom, label);
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const auto& values = strips[i].values;
    const double y = 10.0 + kRow * (static_cast<double>(i) + 0.5);
    out += text_at(left - 10.0, y + 4.0, "end", shortened(strips[i].name, kMostLetters));
    if (values.empty()) continue;
    const double q1 = axis.at(quantile(values, 0.25)), q3 = axis.at(quantile(values, 0.75));
    out += "<rect x=\"" + number(q1) + "\" y=\"" + number(y - 10.0) + "\" width=\"" + number(q3 - q1) +
           "\" height=\"20\" fill=\"" + colour(i) + "\" fill-opacity=\"0.18\"/>\n";
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double lift = static_cast<double>(k % 5) * 3.5 - 7.0;  // dots of equal numbers beside one another
      out += dot(axis.at(values[k]), y + lift, colour(i), figure(values[k]));
    }
    const double middle = axis.at(median(values));
    out += line(middle, y - 12.0, middle, y + 12.0, std::string("stroke-width=\"2.5\" stroke=\"") + colour(i) + "\"");
  }
  return svg(bottom + kBottom, label, out);
}

std::string scatter_plot(const std::string& x_label, const std::string& y_label, const std::vector<Cloud>& clouds) {
  std::vector<double> xs, ys;
  for (const auto& cloud : clouds)
    for (const auto& p : cloud.points) xs.push_back(p.x), ys.push_back(p.y);
  if (xs.empty()) return "<p class=note>no pairs of numbers for " + escape_html(x_label + " and " + y_label) + "</p>\n";
  const double top = 20.0, bottom = 360.0;
  const Axis x(xs, 70.0, 600.0, 7), y(ys, bottom, top, 6);
  std::string out = x_axis(x, top, bottom, x_label);
  for (const double mark : y.marks) {
    out += line(x.from, y.at(mark), x.to, y.at(mark), "stroke=\"#d8dee4\"");
    out += text_at(x.from - 8.0, y.at(mark) + 4.0, "end", figure(mark));
  }
  out += "<text transform=\"translate(18 " + number((top + bottom) / 2.0) + ") rotate(-90)\" text-anchor=\"middle\">" +
         escape_html(y_label) + "</text>\n";
  double legend = top + 8.0;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    for (const auto& p : clouds[i].points)
      out += dot(x.at(p.x), y.at(p.y), colour(i), clouds[i].name + ": " + figure(p.x) + ", " + figure(p.y));
    out += dot(625.0, legend - 4.0, colour(i), clouds[i].name);
    out += text_at(636.0, legend, "start", shortened(clouds[i].name, 40));
    legend += 18.0;
  }
  return svg(std::max(bottom + kBottom, legend), x_label + " against " + y_label, out);
}

}  // namespace rubble::scenarios
