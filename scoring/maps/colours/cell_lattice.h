#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Where the cells of a map lie in a picture that shows each as a square of pixels: its walls begin and end at every
/// `pixels`-th row and column. What was drawn over them later, as words, does not.
struct CellLattice {
  int pixels = 1;  ///< side of a cell; 1: no larger squares are seen
  int left = 0;    ///< column at which a cell begins
  int top = 0;
  bool has_column(int x) const { return (x - left) % pixels == 0; }
  bool has_row(int y) const { return (y - top) % pixels == 0; }
};

/// The widest that nearly all edges of `walls` (CV_8U, 255) lie on.
CellLattice cell_lattice(const cv::Mat& walls);

/// Edges of `walls` beside each pixel, to the left and above, that no cell has (CV_8U, 0 to 2).
cv::Mat edges_off(const CellLattice& lattice, const cv::Mat& walls);

}  // namespace rubble::scoring
