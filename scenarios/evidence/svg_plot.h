#pragma once

#include <string>
#include <vector>

namespace rubble::scenarios {

/// Named numbers: one row of a strip plot.
struct Strip {
  std::string name;
  std::vector<double> values;
};

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Named points: one colour of a scatter plot.
struct Cloud {
  std::string name;
  std::vector<PlotPoint> points;
};

/// One row a strip: every value as a dot, the quartiles as a box, the median as a line. Inline SVG.
std::string strip_plot(const std::string& label, const std::vector<Strip>& strips);

/// Inline SVG with a legend; colours repeat after eight clouds.
std::string scatter_plot(const std::string& x_label, const std::string& y_label, const std::vector<Cloud>& clouds);

/// About `wanted` round numbers that cover [low, high].
std::vector<double> ticks(double low, double high, int wanted);

}  // namespace rubble::scenarios
