#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "base/image/geotiff.h"
#include "base/image/rich_tiff.h"

namespace rubble::scoring {

/// Where a screenshot shows its map: what is around (title bar, panels, frame, page) is a program's, and its colours
/// say nothing of the map's. A view is an upright rectangle that begins on all four sides with unbroken unknown ground;
/// within, walls stand between that and free ground. What is around ends along its sides in straight lines, is broader
/// than walls and has colours that cover nothing within. Nothing: the picture is all map, or nobody can tell.
std::optional<cv::Rect> view_in_window(const RgbImage& image);

/// "a window's frame taken off (pixels: left 12, top 60, right 12, bottom 12), "
std::string told_of_frame(const RgbImage& image, const cv::Rect& view);

/// What lies within the view.
RgbImage cut_out(const RgbImage& image, const cv::Rect& view);
SampleNotes cut_out(const SampleNotes& notes, const RgbImage& image, const cv::Rect& view);

}  // namespace rubble::scoring
