#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rubble::scoring {

/// What the greys of a map stand for.
struct GreyRoles {
  int wall = 0;       ///< grey level
  int free = 255;     ///< grey level
  int unknown = -1;   ///< grey level; -1: there is none
  bool pure = false;  ///< all pixels are of a few levels: the picture was never interpolated or compressed with loss
  double sure = 1.0;  ///< share of what the walls say that speaks for this choice, 0..1
  std::vector<int> others;  ///< greys that cover further areas
  std::vector<int> drawn;  ///< other levels of a pure picture that are thin lines, and nearer to a ground than to walls
  int areas = 0;           ///< levels that cover broad areas: more than three are no occupancy map
  bool between = false;    ///< walls are neither the darkest nor the lightest level
  bool in_order() const { return unknown < 0 || (wall < unknown) == (unknown < free); }
  /// "wall 0, unknown 205, free 254"
  std::string text() const;
};

/// Decides by shape and place: walls are the level of thin lines; of the others, that is free ground which walls have
/// on both sides. Where neither speaks, walls are dark, free ground is light and unknown lies between. `grey`: CV_8U,
/// `apart`: 255 where a pixel has no say (transparent, canvas). The levels must cover a hundredth of the picture, walls
/// a thousandth.
GreyRoles grey_roles(const cv::Mat& grey, const cv::Mat& apart);

}  // namespace rubble::scoring
