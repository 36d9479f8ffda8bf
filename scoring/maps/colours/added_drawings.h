#pragma once

#include <opencv2/core.hpp>

#include "base/image/geotiff.h"

namespace rubble::scoring {

inline constexpr int kInkColour = 60;    ///< difference of the channels of ink: more is coloured
inline constexpr double kMostInk = 0.1;  ///< of all pixels: drawings are few, more of it are walls or areas

/// Coloured lines and symbols on a map of greys (the way of the robot, poses, marks) take in `grey`, its
/// brightness, that of the nearest ground. Colours are drawings only where they are few and the greys alone have thin
/// walls. `apart`: 255 where a pixel has no say. False: there are none.
bool paint_over_colours(const RgbImage& image, const cv::Mat& apart, cv::Mat& grey);

/// Walls in many colours on grounds of grey (by their place, their height or the scan that saw them) take one grey in
/// `grey`: where coloured lines are few and thin, the greys alone have no walls but the rims of these lines, and the
/// lines' own greys differ: one pen is told apart by its grey. `apart`: as above. False: there are none.
bool even_out_coloured_walls(const RgbImage& image, const cv::Mat& apart, cv::Mat& grey);

/// What plotting programs put around a map (margins with axes, titles, frames) is unknown: ground that reaches a whole
/// side of the picture and leaves of it one upright rectangle, which itself begins with unknown ground or is framed.
/// `classes`: CV_8U, Occupancy. False: there is nothing of that kind.
bool clear_around_panel(cv::Mat& classes);

/// The same around a league map on a page, where a legend and a scale bar may have the walls' own blue: the whole rim
/// of the rectangle is unknown ground. Free ground that an arena's own walls bound is never taken for a page.
bool clear_around_league_map(cv::Mat& classes);

}  // namespace rubble::scoring
