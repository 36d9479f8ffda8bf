#include "scoring/maps/colours/cell_lattice.h"

#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace rubble::scoring {
namespace {

/// How many edges begin at each column: a wall there and none to its left, or the other way round.
std::vector<std::size_t> edges_at_columns(const cv::Mat& walls) {
  std::vector<std::size_t> out(static_cast<std::size_t>(walls.cols), 0);
  for (int y = 0; y < walls.rows; ++y) {
    const unsigned char* const row = walls.ptr<unsigned char>(y);
    for (int x = 1; x < walls.cols; ++x) out[static_cast<std::size_t>(x)] += row[x] != row[x - 1] ? 1 : 0;
  }
  return out;
}

/// The first place of the lattice that most edges lie on, and their share.
std::pair<int, double> best_start(const std::vector<std::size_t>& edges, int pixels) {
  std::vector<std::size_t> at(static_cast<std::size_t>(pixels), 0);
  std::size_t all = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    at[i % at.size()] += edges[i];
    all += edges[i];
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < at.size(); ++i)
    if (at[i] > at[best]) best = i;
  return {static_cast<int>(best), all == 0 ? 0.0 : static_cast<double>(at[best]) / static_cast<double>(all)};
}

}  // namespace

CellLattice cell_lattice(const cv::Mat& walls) {
  constexpr int kLargest = 8;       // [pixels]
  constexpr double kNearly = 0.75;  // of the edges; words in four rooms have up to a fifth of them
  const std::vector<std::size_t> columns = edges_at_columns(walls), rows = edges_at_columns(walls.t());
  constexpr double kFiner = 0.5;  // of the edges off a lattice that a finer one has: of words half of them or less
  constexpr double kSome = 0.02;  // edges off it in rows and columns together: fewer are strays
  CellLattice out;
  double off = 0.0;
  for (int pixels = kLargest; pixels > 1; --pixels) {
    const auto [left, across] = best_start(columns, pixels);
    const auto [top, down] = best_start(rows, pixels);
    const double off_here = 2.0 - across - down;
    if (across < kNearly || down < kNearly) continue;
    // Straight walls two cells wide have a lattice of two cells, too, which walls aslant tell from the cells' own.
    if (out.pixels > 1 && (out.pixels % pixels != 0 || off < kSome || off_here > kFiner * off)) continue;
    out = {pixels, left, top};
    off = off_here;
  }
  return out;
}

cv::Mat edges_off(const CellLattice& lattice, const cv::Mat& walls) {
  cv::Mat out = cv::Mat::zeros(walls.size(), CV_8U);
  if (lattice.pixels == 1) return out;
  for (int y = 1; y < walls.rows; ++y) {
    const unsigned char *const row = walls.ptr<unsigned char>(y), *const above = walls.ptr<unsigned char>(y - 1);
    unsigned char* const to = out.ptr<unsigned char>(y);
    const bool between_rows = !lattice.has_row(y);
    for (int x = 1; x < walls.cols; ++x) {
      if (row[x] != row[x - 1] && !lattice.has_column(x)) ++to[x];
      if (between_rows && row[x] != above[x]) ++to[x];
    }
  }
  return out;
}

}  // namespace rubble::scoring
