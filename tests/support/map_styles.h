#pragma once

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "tests/support/map_pictures.h"

/// Styles in which teams, their programs and their editors draw and save maps. Row 0 is at the top; colours are BGR.
namespace rubble::scoring::testing {

/// A drawing in a style. The map's pixel (column, row) is at (left + scale * column, top + scale * row), turned about
/// the picture's middle.
struct Styled {
  cv::Mat image;
  double scale = 1.0;
  double left = 0.0, top = 0.0;  ///< [pixels]
  cv::Mat turn{};                ///< 2 x 3, pixel of the picture before -> of the picture; empty: not turned
};

struct Style {
  std::string name;
  std::function<Styled(const OccupancyGrid&)> draw;
  int quality = 0;  ///< of JPEG; 0: PNG
};

using Colour = cv::Vec3b;

inline cv::Mat in_colours(const OccupancyGrid& grid, Colour wall, Colour unknown, Colour free, int scale = 1) {
  cv::Mat out(grid.height(), grid.width(), CV_8UC3);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const Occupancy o = grid[{x, grid.height() - 1 - y}];
      out.at<Colour>(y, x) = o == Occupancy::Occupied ? wall : o == Occupancy::Free ? free : unknown;
    }
  if (scale > 1) cv::resize(out, out, {}, scale, scale, cv::INTER_NEAREST);
  return out;
}

inline Colour grey(int level) {
  const auto l = static_cast<unsigned char>(level);
  return {l, l, l};
}

/// Each pixel by the nearest colour of the palette.
inline cv::Mat by_palette(const cv::Mat& image, const std::vector<Colour>& palette) {
  cv::Mat out = image.clone();
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const Colour c = image.at<Colour>(y, x);
      const auto off = [&](const Colour& p) {
        int sum = 0;
        for (int i = 0; i < 3; ++i) sum += (c[i] - p[i]) * (c[i] - p[i]);
        return sum;
      };
      out.at<Colour>(y, x) = *std::min_element(palette.begin(), palette.end(),
                                               [&](const Colour& a, const Colour& b) { return off(a) < off(b); });
    }
  return out;
}

/// Error diffusion (Floyd & Steinberg 1976) onto what `nearest` makes of a colour.
template <class Nearest>
cv::Mat diffused(const cv::Mat& image, const Nearest& nearest) {
  cv::Mat rest, out = image.clone();
  image.convertTo(rest, CV_32FC3);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const cv::Vec3f wanted = rest.at<cv::Vec3f>(y, x);
      const Colour got = nearest(wanted);
      out.at<Colour>(y, x) = got;
      cv::Vec3f error;
      for (int i = 0; i < 3; ++i) error[i] = std::clamp(wanted[i], -60.0F, 315.0F) - got[i];
      const auto give = [&](int dx, int dy, float share) {
        if (x + dx < 0 || x + dx >= out.cols || y + dy >= out.rows) return;
        rest.at<cv::Vec3f>(y + dy, x + dx) += share * error;
      };
      give(1, 0, 7.0F / 16), give(-1, 1, 3.0F / 16), give(0, 1, 5.0F / 16), give(1, 1, 1.0F / 16);
    }
  return out;
}

/// In so many evenly spaced levels a channel.
inline auto nearest_level(int levels) {
  return [step = 255.0F / static_cast<float>(levels - 1)](const cv::Vec3f& c) {
    Colour out;
    for (int i = 0; i < 3; ++i)
      out[i] = cv::saturate_cast<unsigned char>(std::round(std::clamp(c[i], 0.0F, 255.0F) / step) * step);
    return out;
  };
}

inline cv::Mat greyed(const cv::Mat& image) {
  cv::Mat out;
  cv::cvtColor(image, out, cv::COLOR_BGR2GRAY);
  cv::cvtColor(out, out, cv::COLOR_GRAY2BGR);
  return out;
}

/// Ordered dither to black and white, by Bayer's matrix of `side` (2, 4 or 8).
inline cv::Mat ordered(const cv::Mat& image, int side) {
  std::vector<int> matrix{0};
  for (int n = 1; n < side; n *= 2) {
    std::vector<int> next(static_cast<std::size_t>(4 * n * n));
    for (int y = 0; y < 2 * n; ++y)
      for (int x = 0; x < 2 * n; ++x) {
        const int quarter[2][2] = {{0, 2}, {3, 1}};
        next[static_cast<std::size_t>(y * 2 * n + x)] =
            4 * matrix[static_cast<std::size_t>((y % n) * n + x % n)] + quarter[y / n][x / n];
      }
    matrix = next;
  }
  cv::Mat out = greyed(image);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const double bound =
          255.0 * (matrix[static_cast<std::size_t>((y % side) * side + x % side)] + 0.5) / (side * side);
      out.at<Colour>(y, x) = grey(out.at<Colour>(y, x)[0] >= bound ? 255 : 0);
    }
  return out;
}

/// The colours that k-means finds, as programs make palettes of their own.
inline cv::Mat with_own_palette(const cv::Mat& image, int colours) {
  cv::Mat samples, labels, centres;
  image.reshape(1, static_cast<int>(image.total())).convertTo(samples, CV_32F);
  cv::setRNGSeed(11);
  cv::kmeans(samples, colours, labels, cv::TermCriteria(cv::TermCriteria::COUNT, 12, 1.0), 2, cv::KMEANS_PP_CENTERS,
             centres);
  cv::Mat out = image.clone();
  for (int i = 0; i < labels.rows; ++i)
    for (int k = 0; k < 3; ++k)
      out.data[3 * i + k] = cv::saturate_cast<unsigned char>(centres.at<float>(labels.at<int>(i), k));
  return out;
}

/// Free cells by the room that they are in: blocks of `metres` that walls do not heed.
inline cv::Mat with_rooms(const OccupancyGrid& grid, const std::vector<Colour>& rooms, double metres, Colour wall,
                          Colour unknown) {
  cv::Mat out = in_colours(grid, wall, unknown, grey(255));
  const int side = static_cast<int>(std::lround(metres / grid.resolution()));
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      if (grid[{x, grid.height() - 1 - y}] == Occupancy::Free)
        out.at<Colour>(y, x) =
            rooms[static_cast<std::size_t>(5 * (y / side) * (y / side) + 3 * (x / side) + (x / side) / 2) %
                  rooms.size()];
  return out;
}

/// A free place with nothing but free ground `reach` cells around, the `nth` of those in rows from the top.
inline cv::Point open_place(const OccupancyGrid& grid, int reach, int nth) {
  cv::Mat free(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < free.rows; ++y)
    for (int x = 0; x < free.cols; ++x)
      free.at<unsigned char>(y, x) = grid[{x, grid.height() - 1 - y}] == Occupancy::Free ? 255 : 0;
  cv::Mat open;
  cv::erode(free, open, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  std::vector<cv::Point> places;
  cv::findNonZero(open, places);
  if (places.empty()) return {grid.width() / 2, grid.height() / 2};
  return places[places.size() * static_cast<std::size_t>(2 * nth + 1) / 12 % places.size()];
}

/// A picture set into a page.
inline Styled framed(const cv::Mat& image, double scale, int left, int top, int right, int bottom, Colour page) {
  Styled out{{}, scale, static_cast<double>(left), static_cast<double>(top)};
  cv::copyMakeBorder(image, out.image, top, bottom, left, right, cv::BORDER_CONSTANT, cv::Scalar(page));
  return out;
}

/// A way through the free cells, from one open place to the next.
inline std::vector<cv::Point> way_of(const OccupancyGrid& grid, int scale) {
  std::vector<cv::Point> out;
  cv::Point at = open_place(grid, 3, 1);
  cv::RNG random(5);
  for (int i = 0; i < 700; ++i) {
    const cv::Point next = at + cv::Point(random.uniform(-4, 5), random.uniform(-4, 5));
    bool open = true;  // with a cell beside
    for (int y = std::min(at.y, next.y) - 2; y <= std::max(at.y, next.y) + 2; ++y)
      for (int x = std::min(at.x, next.x) - 2; x <= std::max(at.x, next.x) + 2; ++x) {
        const Cell c{x, grid.height() - 1 - y};
        open = open && grid.inside(c) && grid[c] == Occupancy::Free;
      }
    if (!open) continue;
    at = next;
    out.push_back(scale * at);
  }
  return out;
}

inline const Colour kBlack{0, 0, 0}, kWhite{255, 255, 255};
using P = cv::Point;

inline void write_on(cv::Mat& image, const std::string& text, const P& at, double size, const Colour& colour,
                     int pen = 1, int line = cv::LINE_AA) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar(colour), pen, line);
}

inline cv::Mat in_ros_greys(const OccupancyGrid& g, int scale = 1) {
  return in_colours(g, kBlack, grey(205), grey(254), scale);
}

/// Turns a picture about its middle onto a canvas of `around`.
inline void turn(Styled& s, double degrees, const Colour& around) {
  const TurnedImage t = turned(s.image, degrees, cv::INTER_LINEAR, cv::Scalar(around));
  s.image = t.image;
  s.turn = t.turn;
}

/// Gathers styles, each as PNG and as JPEG of these qualities.
class Styles {
 public:
  using Draw = std::function<cv::Mat(const OccupancyGrid&)>;
  void add(const std::string& name, const Draw& draw, double scale = 1.0, const std::vector<int>& qualities = {}) {
    page(
        name,
        [=](const OccupancyGrid& g) {
          return Styled{draw(g), scale};
        },
        qualities);
  }
  void page(const std::string& name, const std::function<Styled(const OccupancyGrid&)>& draw,
            const std::vector<int>& qualities = {}) {
    all.push_back({name, draw, 0});
    for (const int q : qualities) all.push_back({name + ", JPEG " + std::to_string(q), draw, q});
  }
  /// `pen` draws over a map in ROS' greys of `scale` pixels a cell.
  void over_ros(const std::string& name, int scale, const std::function<void(cv::Mat&, const OccupancyGrid&)>& pen,
                const std::vector<int>& qualities = {}) {
    add(
        name,
        [=](const OccupancyGrid& g) {
          cv::Mat image = in_ros_greys(g, scale);
          pen(image, g);
          return image;
        },
        scale, qualities);
  }
  /// Nothing but three colours, of `scale` pixels a cell.
  void plain(const std::string& name, const Colour& wall, const Colour& unknown, const Colour& free, int scale,
             const std::vector<int>& qualities = {}) {
    add(
        name, [=](const OccupancyGrid& g) { return in_colours(g, wall, unknown, free, scale); }, scale, qualities);
  }
  std::vector<Style> all;
};

}  // namespace rubble::scoring::testing
